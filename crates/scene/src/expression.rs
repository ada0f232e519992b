//! Expressions: numbers with units, names, `+ - * / ^`, brackets and functions. The value of an
//! expression is a number with a dimension.
//!
//! This crate has its own parser (operator precedence after V. Pratt, 1973) for two reasons. It
//! must report all unknown names and all conflicting units with their positions, and it must
//! terminate for any text. Existing parsers for expressions support neither units nor positions, or
//! they are complete languages.
//!
//! Other modules determine the position of a text in the file and the meaning of names.
//!
//! Other parsers were rejected: evalexpr has the AGPL licence, exmex and fasteval support neither
//! units nor text positions, and numbat is a complete language. Deeply nested input must end with
//! an error at its position.

mod problem;
mod quantity;
mod term;
mod token;
mod unit;

use std::ops::Range;

pub(crate) use problem::{Fault, Problem};
pub(crate) use quantity::{Bases, Quantity};
pub(crate) use term::{OF_LAW, OF_TIME, law, of_time};
use token::{Token, tokens};
pub(crate) use token::{decimal, is_name};
pub(crate) use unit::{TIME, in_units_here, names_of};
use unit::{UNITS, Unit, named};

use crate::dimension::Dimension;

/// Maximum nesting depth of brackets, signs and powers. At a greater depth, the stack could
/// overflow and the expression would not be readable.
const DEEPEST: usize = 60;

/// Functions and their arguments.
const FUNCTIONS: [(&str, &str); 15] = [
    ("sin", "an angle"),
    ("cos", "an angle"),
    ("tan", "an angle"),
    ("asin", "a number"),
    ("acos", "a number"),
    ("atan", "a number"),
    ("atan2", "two values (y, x)"),
    ("sqrt", "a value"),
    ("abs", "a value"),
    ("min", "two values"),
    ("max", "two values"),
    ("exp", "a number"),
    ("log", "a number"),
    (INTEGRAL, "a value"),
    (LAG, "a value and a time"),
];

/// The integral of a value since the start, in force laws only.
const INTEGRAL: &str = "integral";
/// A value through a first-order lag with a time constant, in force laws only.
const LAG: &str = "lag";

const PI_NAME: &str = "pi";

/// All units with their names, each as a quantity.
pub(crate) fn units() -> impl Iterator<Item = (&'static str, Quantity)> {
    UNITS.iter().map(quantity)
}

/// Returns the unit with this name: its name in the table of units, and its size as a quantity.
pub(crate) fn unit(name: &str) -> Option<(&'static str, Quantity)> {
    named(name).map(quantity)
}

fn quantity(&(name, times, over, of): &Unit) -> (&'static str, Quantity) {
    (name, Quantity::unit(times, over, of))
}

/// The unit or constant with this name.
fn constant(name: &str) -> Option<Quantity> {
    if name == PI_NAME {
        return Some(Quantity::pi());
    }
    unit(name).map(|(_, unit)| unit)
}

fn function(name: &str) -> Option<(&'static str, &'static str)> {
    FUNCTIONS.iter().find(|(known, _)| *known == name).copied()
}

/// Returns the meaning of a name that has the same meaning in every expression. Parameters must
/// have other names, except that a parameter may have the name of a unit; see [`token::UnitTerm`].
pub(crate) fn reserved(name: &str) -> Option<&'static str> {
    match name {
        PI_NAME => Some("a constant"),
        name => function(name).map(|_| "a function"),
    }
}

/// All names with a meaning in an expression without parameters.
pub(crate) fn known_names() -> impl Iterator<Item = &'static str> {
    let units = units().map(|(name, _)| name);
    let functions = FUNCTIONS.iter().map(|(name, _)| *name);
    units.chain(functions).chain([PI_NAME])
}

/// Returns the names in an expression that may be parameters. The list is empty if the expression
/// cannot be parsed.
pub(crate) fn names(text: &str) -> Vec<(&str, Range<usize>)> {
    let words = tokens(text).unwrap_or_default().into_iter();
    let name = |(token, span)| match token {
        Token::Name(name) if reserved(name).is_none() => Some((name, span)),
        _ => None,
    };
    words.filter_map(name).collect()
}

/// The meaning of names in an expression.
pub(crate) trait Scope {
    /// Returns the value of a parameter. The inner value is `None` if the text of the parameter is
    /// wrong.
    fn parameter(&self, name: &str) -> Option<Option<Quantity>>;
    /// Units of bare numbers.
    fn bases(&self) -> Bases;
}

/// Returns the value of an expression, or all of its errors. The list of errors is empty if the
/// only cause is a parameter with a wrong text.
pub(crate) fn evaluate(text: &str, scope: &impl Scope) -> Result<Quantity, Vec<Fault>> {
    parse(text, scope, &[])
}

/// Intermediate values of expressions: numbers, or terms with variables.
trait Value: Clone + From<Quantity> {
    fn negated(self) -> Self;

    /// Applies the operator `+ - * / ^` to this and another value.
    fn joined(self, sign: u8, other: Self, bases: Bases) -> Result<Self, Problem>;

    /// Applies a function. The caller has checked the number of values. An error contains a flag
    /// that is true if the problem concerns the first argument.
    fn call(name: &'static str, values: &[Self], bases: Bases) -> Result<Self, (bool, Problem)>;
}

/// Evaluates an expression that may contain these variables.
fn parse<V: Value>(
    text: &str,
    scope: &impl Scope,
    variables: &[(&'static str, V)],
) -> Result<V, Vec<Fault>> {
    let tokens = tokens(text).map_err(|fault| vec![fault])?;
    let mut parser = Parser {
        text,
        tokens,
        at: 0,
        scope,
        variables,
        faults: Vec::new(),
    };
    let value = match parser.whole() {
        Ok(value) => value,
        Err(fault) => {
            parser.faults.push(fault);
            None
        }
    };
    match value {
        Some(value) if parser.faults.is_empty() => Ok(value),
        _ => Err(parser.faults),
    }
}

/// Precedence of operators, lowest first.
const SUM: u8 = 1;
const PRODUCT: u8 = 2;
const SIGNED: u8 = 3;
const POWER: u8 = 4;

struct Parser<'s, S, V> {
    text: &'s str,
    tokens: Vec<(Token<'s>, Range<usize>)>,
    at: usize,
    scope: &'s S,
    variables: &'s [(&'static str, V)],
    /// Errors of names and values; parsing continues after such an error.
    faults: Vec<Fault>,
}

/// A value with its position in the text; the value is `None` after an error.
type Part<V> = (Option<V>, Range<usize>);

impl<'s, S: Scope, V: Value> Parser<'s, S, V> {
    /// Returns the next token with its position; the last token is always the end.
    fn peek(&self) -> (Token<'s>, Range<usize>) {
        self.tokens[self.at.min(self.tokens.len() - 1)].clone()
    }

    fn is_next(&self, sign: u8) -> bool {
        self.peek().0 == Token::Sign(sign)
    }

    fn written(&self, span: &Range<usize>) -> String {
        self.text.get(span.clone()).unwrap_or_default().to_owned()
    }

    /// Stores an error of names or values.
    fn judge(&mut self, span: Range<usize>, q: Result<V, Problem>) -> Option<V> {
        let keep = |problem| self.faults.push(Fault { span, problem });
        q.map_err(keep).ok()
    }

    /// Parses the whole text.
    fn whole(&mut self) -> Result<Option<V>, Fault> {
        if let (Token::End, span) = self.peek() {
            let problem = Problem::Empty;
            return Err(Fault { span, problem });
        }
        let (value, _) = self.sum(SUM, 0)?;
        match self.peek() {
            (Token::End, _) => Ok(value),
            (_, span) => Err(self.unexpected(span)),
        }
    }

    /// Returns the error for a token in place of an operator or the end.
    fn unexpected(&self, span: Range<usize>) -> Fault {
        let problem = match self.peek().0 {
            Token::Sign(b')') => Problem::Closed,
            Token::Sign(b',') => Problem::Comma,
            _ => Problem::NoOperator {
                found: self.written(&span),
            },
        };
        Fault { span, problem }
    }

    /// Parses operands between operators with at least this precedence.
    fn sum(&mut self, least: u8, depth: usize) -> Result<Part<V>, Fault> {
        let (mut left, mut span) = self.operand(depth)?;
        loop {
            let Token::Sign(sign) = self.peek().0 else {
                return Ok((left, span));
            };
            // A power is right-associative: 2^3^2 is 2^9.
            let (binds, of_right) = match sign {
                b'+' | b'-' => (SUM, PRODUCT),
                b'*' | b'/' => (PRODUCT, SIGNED),
                b'^' => (POWER, SIGNED),
                _ => return Ok((left, span)),
            };
            if binds < least {
                return Ok((left, span));
            }
            self.at += 1;
            let (right, of) = self.sum(of_right, depth + 1)?;
            let whole = span.start..of.end;
            left = match left.zip(right) {
                None => None,
                Some((a, b)) => {
                    let bases = self.scope.bases();
                    let q = a.joined(sign, b, bases);
                    let of_right = matches!(
                        (sign, &q),
                        (b'/', Err(Problem::DivisionByZero)) | (_, Err(Problem::Exponent { .. }))
                    );
                    let at = if of_right { of } else { whole.clone() };
                    self.judge(at, q)
                }
            };
            span = whole;
        }
    }

    /// Parses a number, a name or a bracket, with its signs.
    fn operand(&mut self, depth: usize) -> Result<Part<V>, Fault> {
        let (token, span) = self.peek();
        if depth > DEEPEST {
            let problem = Problem::Deep { most: DEEPEST };
            return Err(Fault { span, problem });
        }
        self.at += 1;
        match token {
            Token::Number(value) => self.number(Quantity::bare(value).into(), span, depth),
            Token::Name(name) | Token::Unit(name) if self.is_next(b'(') => {
                self.call(name, span, depth)
            }
            Token::Name(name) => Ok((self.name(name, &span), span)),
            Token::Unit(name) => Ok((constant(name).map(V::from), span)),
            Token::Sign(b'(') => {
                let (value, _) = self.sum(SUM, depth + 1)?;
                let end = self.close(&span)?;
                Ok((value, span.start..end))
            }
            Token::Sign(sign @ (b'-' | b'+')) => {
                let (value, of) = self.sum(SIGNED, depth + 1)?;
                let negate = |q: V| if sign == b'-' { q.negated() } else { q };
                Ok((value.map(negate), span.start..of.end))
            }
            Token::Sign(_) | Token::End => Err(Fault {
                problem: Problem::NoOperand {
                    found: self.written(&span),
                },
                span,
            }),
        }
    }

    /// Parses a number, with the unit after it if there is one; `2 mm^2` means 2·(1 mm)².
    fn number(&mut self, q: V, span: Range<usize>, depth: usize) -> Result<Part<V>, Fault> {
        match self.peek().0 {
            Token::Unit(_) => {
                let (unit, of) = self.sum(POWER, depth + 1)?;
                let span = span.start..of.end;
                let bases = self.scope.bases();
                let q = unit.and_then(|unit| self.judge(span.clone(), q.joined(b'*', unit, bases)));
                Ok((q, span))
            }
            _ => Ok((Some(q), span)),
        }
    }

    /// Returns the end position of a closing bracket.
    fn close(&mut self, open: &Range<usize>) -> Result<usize, Fault> {
        let (token, span) = self.peek();
        match token {
            Token::Sign(b')') => {
                self.at += 1;
                Ok(span.end)
            }
            Token::End => Err(Fault {
                span: open.clone(),
                problem: Problem::Open,
            }),
            _ => Err(self.unexpected(span)),
        }
    }

    /// A parameter, or otherwise a constant or a unit.
    fn name(&mut self, name: &str, span: &Range<usize>) -> Option<V> {
        let parameter = self.scope.parameter(name);
        let mut variables = self.variables.iter();
        if let Some((name, variable)) = variables.find(|(variable, _)| *variable == name) {
            let is_free = parameter.is_none();
            let value = is_free.then(|| variable.clone());
            return self.judge(span.clone(), value.ok_or(Problem::Twice { name }));
        }
        if let Some(value) = parameter.or_else(|| constant(name).map(Some)) {
            return value.map(V::from);
        }
        let problem = match function(name) {
            Some((name, _)) => Problem::NoBrackets { name },
            None => Problem::UnknownName {
                name: name.to_owned(),
            },
        };
        self.judge(span.clone(), Err(problem))
    }

    /// Parses `name(value, …)`.
    fn call(&mut self, name: &str, span: Range<usize>, depth: usize) -> Result<Part<V>, Fault> {
        let (_, open) = self.peek();
        self.at += 1;
        let mut values = vec![self.sum(SUM, depth + 1)?];
        while self.is_next(b',') {
            self.at += 1;
            values.push(self.sum(SUM, depth + 1)?);
        }
        let whole = span.start..self.close(&open)?;
        let q = match function(name) {
            Some((name, expected)) => self.apply(name, expected, values, &whole),
            None => {
                let name = name.to_owned();
                self.judge(span, Err(Problem::UnknownFunction { name }))
            }
        };
        Ok((q, whole))
    }

    /// Returns the value of a function.
    fn apply(
        &mut self,
        name: &'static str,
        expected: &'static str,
        values: Vec<Part<V>>,
        whole: &Range<usize>,
    ) -> Option<V> {
        let wanted = match name {
            "atan2" | "min" | "max" | LAG => 2,
            _ => 1,
        };
        let found = values.len();
        if found != wanted {
            let problem = Problem::Count {
                name,
                expected,
                found,
            };
            return self.judge(whole.clone(), Err(problem));
        }
        let first = values[0].1.clone();
        let values: Option<Vec<V>> = values.into_iter().map(|(q, _)| q).collect();
        match V::call(name, &values?, self.scope.bases()) {
            Ok(value) => Some(value),
            Err((of_first, problem)) => {
                let at = if of_first { first } else { whole.clone() };
                self.judge(at, Err(problem))
            }
        }
    }
}

/// The required dimension of the argument of a function.
fn taken(name: &str) -> Option<Dimension> {
    match name {
        "sin" | "cos" | "tan" => Some(Dimension::ANGLE),
        "asin" | "acos" | "atan" | "exp" | "log" => Some(Dimension::NONE),
        _ => None,
    }
}

impl Value for Quantity {
    fn negated(self) -> Self {
        Quantity::negated(self)
    }

    fn joined(self, sign: u8, other: Self, bases: Bases) -> Result<Self, Problem> {
        match sign {
            b'+' => self.plus(other, bases),
            b'-' => self.plus(other.negated(), bases),
            b'*' => self.times(other),
            b'/' => self.over(other),
            _ => self.power(other),
        }
    }

    fn call(name: &'static str, q: &[Self], bases: Bases) -> Result<Self, (bool, Problem)> {
        if let INTEGRAL | LAG = name {
            return Err((false, Problem::OnlyInLaw { name }));
        }
        // For functions of numbers and angles, the error is marked at the argument. For other
        // functions, the error is marked at the whole call.
        let x = match taken(name) {
            Some(of) => q[0].at(of, bases).map_err(|e| (true, e))?,
            None => q[0],
        };
        let steep = |x: f64| 1.0 / (1.0 - x * x).max(x_error(q[0])).sqrt();
        let value = match name {
            "sqrt" => x.root(),
            "atan2" => x.angle(q[1], bases),
            "min" => x.least(q[1], 1.0, bases),
            "max" => x.least(q[1], -1.0, bases),
            "sin" => sine(x),
            "cos" => cosine(x),
            "tan" => tangent(x),
            "asin" => x
                .smooth("`asin`", f64::asin, steep)
                .map(Quantity::in_radians),
            "acos" => x
                .smooth("`acos`", f64::acos, |x| -steep(x))
                .map(Quantity::in_radians),
            "atan" => x
                .smooth("`atan`", f64::atan, |x| 1.0 / (1.0 + x * x))
                .map(Quantity::in_radians),
            "exp" => x.smooth("`exp`", f64::exp, f64::exp),
            "log" => x.smooth("`log`", f64::ln, |x| 1.0 / x),
            // "abs"
            _ => Ok(x.abs()),
        };
        value.map_err(|e| (false, e))
    }
}

/// Lower limit of 1 − x² near the ends of the range of inverse sine and cosine. The limit is the
/// error of x, so the error of the arc is at most the square root of this limit.
fn x_error(x: Quantity) -> f64 {
    x.error.max(f64::EPSILON)
}

fn sine(x: Quantity) -> Result<Quantity, Problem> {
    x.smooth("`sin`", f64::sin, f64::cos)
}

fn cosine(x: Quantity) -> Result<Quantity, Problem> {
    x.smooth("`cos`", f64::cos, |x| -x.sin())
}

fn tangent(x: Quantity) -> Result<Quantity, Problem> {
    let ratio = sine(x)?.over(cosine(x)?);
    ratio.map_err(|_| Problem::Undefined {
        name: "`tan`",
        value: x.to_f64(),
    })
}

#[cfg(test)]
mod tests;
