//! The tokens of an expression: numbers, names, operators and brackets.

use std::ops::Range;

use linalg::Dd;

use super::problem::{Fault, Problem};
use super::unit::named;

/// A token.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Token<'s> {
    Number(Dd),
    Name(&'s str),
    /// A name inside a unit term, which is never a parameter; see [`UnitTerm`].
    Unit(&'s str),
    /// One of the characters `+ - * / ^ ( ) ,`.
    Sign(u8),
    End,
}

/// Longest text (bytes). The tokens of a text need about 40 times as much memory as the text.
pub(super) const LONGEST: usize = 1 << 14;

/// Returns all tokens with their positions; the last token is the end.
pub(crate) fn tokens(text: &str) -> Result<Vec<(Token<'_>, Range<usize>)>, Fault> {
    if text.len() > LONGEST {
        let problem = Problem::Long { most: LONGEST };
        let span = 0..text.len();
        return Err(Fault { span, problem });
    }
    let mut found = Vec::new();
    let (mut at, mut end) = (0, 0);
    let mut term = UnitTerm::Outside;
    while let Some(c) = text[at..].chars().next() {
        let rest = &text[at..];
        let (token, length) = match c {
            c if c.is_whitespace() => {
                at += c.len_utf8();
                continue;
            }
            '0'..='9' | '.' if number_length(rest) > 0 => {
                let length = number_length(rest);
                (Token::Number(decimal(&rest[..length])), length)
            }
            '+' | '-' | '*' | '/' | '^' | '(' | ')' | ',' => (Token::Sign(rest.as_bytes()[0]), 1),
            // Messages contain this character in units, so it is accepted as well.
            '·' => (Token::Sign(b'*'), c.len_utf8()),
            '²' | '³' => {
                let sign = Token::Sign(b'^');
                term = term.after(sign, end == at);
                end = at;
                found.push((sign, at..at + c.len_utf8()));
                let power = if c == '²' { 2.0 } else { 3.0 };
                (Token::Number(power.into()), c.len_utf8())
            }
            '°' => (Token::Unit("deg"), c.len_utf8()),
            c if begins_name(c) => {
                let length = rest.find(|c| !in_name(c)).unwrap_or(rest.len());
                let name = &rest[..length];
                let is_unit = term.takes(name, end == at);
                let token = if is_unit { Token::Unit } else { Token::Name };
                (token(name), length)
            }
            sign => {
                return Err(Fault {
                    span: at..at + sign.len_utf8(),
                    problem: Problem::Sign { sign },
                });
            }
        };
        term = term.after(token, end == at);
        found.push((token, at..at + length));
        at += length;
        end = at;
    }
    found.push((Token::End, text.len()..text.len()));
    Ok(found)
}

/// Position of the reader relative to a unit term. Names in a unit term are never parameters. A
/// unit term starts with the unit after a number. It continues with `*`, `/`, `^`, units and
/// exponents that follow without a blank, as in `0.4 N*s/mm`.
#[derive(Clone, Copy, PartialEq)]
enum UnitTerm {
    Outside,
    /// After a number. A unit at this position starts a unit term.
    Number,
    /// After a unit or its exponent.
    Unit,
    /// After `*` or `/`. A unit at this position continues the unit term.
    Factor,
    /// After `^`. An exponent at this position continues the unit term.
    Power,
}

impl UnitTerm {
    /// Returns the position after another token. `close` states that there is no blank between this
    /// token and the preceding token.
    fn after(self, token: Token, close: bool) -> Self {
        match (self, token) {
            (Self::Power, Token::Number(_)) if close => Self::Unit,
            (_, Token::Number(_)) => Self::Number,
            (_, Token::Unit(_)) => Self::Unit,
            (Self::Unit, Token::Sign(b'*' | b'/')) if close => Self::Factor,
            (Self::Unit, Token::Sign(b'^')) | (Self::Power, Token::Sign(b'+' | b'-')) if close => {
                Self::Power
            }
            _ => Self::Outside,
        }
    }

    /// Whether a name at this position is a unit.
    fn takes(self, name: &str, close: bool) -> bool {
        let here = self == Self::Number || self == Self::Factor && close;
        here && named(name).is_some()
    }
}

fn begins_name(c: char) -> bool {
    c.is_alphabetic() || c == '_'
}

fn in_name(c: char) -> bool {
    begins_name(c) || c.is_ascii_digit()
}

/// Returns whether this name is permitted for a parameter.
pub(crate) fn is_name(name: &str) -> bool {
    name.starts_with(begins_name) && name.chars().all(in_name)
}

/// Length of the number at the start of a text; zero if there is no number. An `e` without
/// following digits belongs to a name.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |from: usize| {
        let rest = bytes[from..].iter();
        from + rest
            .take_while(|b| b.is_ascii_digit() || **b == b'_')
            .count()
    };
    let mut end = digits(0);
    let mut has_digits = end > 0;
    if bytes.get(end) == Some(&b'.') {
        let after = digits(end + 1);
        has_digits |= after > end + 1;
        end = after;
    }
    if !has_digits {
        return 0;
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let power = digits(end + 1 + sign);
        if power > end + 1 + sign {
            end = power;
        }
    }
    end
}

/// Number of digits of the longest integer that is read exactly.
const DIGITS: usize = 30;

/// Reads a decimal number as the sum of two doubles: the nearest double, and the remaining
/// difference. `text` is a number of a file or of an expression. For any other text, the result is
/// NaN.
pub(crate) fn decimal(text: &str) -> Dd {
    let text = text.replace('_', "");
    let nearest: f64 = text.parse().unwrap_or(f64::NAN);
    let (mantissa, power) = text.split_once(['e', 'E']).unwrap_or((&text, "0"));
    let (whole, decimals) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits = [whole.trim_start_matches(['+', '-']), decimals].concat();
    let shift = i32::try_from(decimals.len()).ok();
    let power = power
        .parse::<i32>()
        .ok()
        .zip(shift)
        .map(|(p, s)| p.saturating_sub(s));
    let digits = digits.trim_start_matches('0');
    let (Ok(whole), Some(power)) = (digits.parse::<u128>(), power) else {
        return nearest.into();
    };
    // For larger powers, one of the two doubles leaves the range of doubles in an intermediate
    // step.
    const LARGEST_POWER: u32 = 200;
    if digits.len() > DIGITS || power.unsigned_abs() > LARGEST_POWER {
        return nearest.into();
    }
    #[expect(
        clippy::cast_precision_loss,
        reason = "what is lost is the second part"
    )]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "half a unit in the last place"
    )]
    let parts = {
        let first = whole as f64;
        let second = (whole as i128 - first as i128) as f64;
        Dd::from_sum(first, second)
    };
    let tens = (0..power.unsigned_abs()).fold(Dd::ONE, |tens, _| tens * 10.0);
    let magnitude = if power < 0 {
        parts / tens
    } else {
        parts * tens
    };
    let missed = magnitude - Dd::from(nearest.abs());
    Dd::from_sum(nearest, missed.hi() * nearest.signum())
}
