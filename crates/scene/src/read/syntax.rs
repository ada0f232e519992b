//! Explains why a text is not valid TOML. The explanation is based on a guess of the intended text.

use std::ops::Range;

use crate::findings::Findings;
use crate::mistake::Mistake;
use crate::units;

/// Reports that a text is not valid TOML, with one error for each line. An error at the end of the
/// text means that a bracket is not closed. Only the first error contains a position; the other
/// errors may be consequences of the first error.
pub(super) fn report(errors: &[toml::de::Error], findings: &Findings) {
    let text = findings.source.text();
    let end = text.trim_end().len();
    let start = |error: &toml::de::Error| error.span().map_or(0, |span| span.start);
    let is_open = errors.iter().any(|error| start(error) >= end);
    let open = errors.first().filter(|_| is_open);
    if let Some(explanation) = open.and_then(|error| never_closed(text, start(error))) {
        return explanation.report(findings);
    }
    let mut line = 0;
    for (k, error) in errors.iter().enumerate() {
        let here = findings.line(start(error));
        if (is_open && k > 0) || here == line {
            continue;
        }
        line = here;
        let span = error.span().unwrap_or(0..0);
        let explanation = match error.message() {
            "duplicate key" => twice(text, span.clone()),
            _ => fault(text, span.clone()),
        };
        match explanation {
            Some(explanation) => explanation.report(findings),
            None => findings.error(Mistake::NotToml, span, error.message(), LABEL),
        }
    }
}

/// An explanation that replaces the message of the parser.
struct Explanation {
    span: Range<usize>,
    message: String,
    label: &'static str,
    help: String,
}

impl Explanation {
    fn report(self, findings: &Findings) {
        let (mistake, help) = (Mistake::NotToml, self.help);
        findings.error_with_help(mistake, self.span, self.message, self.label, help);
    }
}

const LABEL: &str = "not valid TOML";

/// Explains a key that is given twice.
fn twice(text: &str, key: Range<usize>) -> Option<Explanation> {
    let name = text.get(key.clone())?;
    Some(Explanation {
        span: key,
        message: format!("`{name}` is given twice"),
        label: "given again here",
        help: format!("this table has `{name}` already: delete one of the two"),
    })
}

/// Explains a bracket that is open at the first error and is not closed until the end of the text.
fn never_closed(text: &str, first_error: usize) -> Option<Explanation> {
    let at = open_bracket(text, text.floor_char_boundary(first_error))?;
    let closing = match text.as_bytes()[at] {
        b'{' => '}',
        _ => ']',
    };
    Some(Explanation {
        span: at..at + 1,
        message: "a bracket is never closed".to_owned(),
        label: "opens here",
        help: format!("write `{closing}` where its content ends"),
    })
}

/// Returns the explanation of an error at this position, if the intention can be guessed.
fn fault(text: &str, span: Range<usize>) -> Option<Explanation> {
    let at = text.floor_char_boundary(span.start);
    let begin = text[..at].rfind('\n').map_or(0, |k| k + 1);
    let end = text[at..].find('\n').map_or(text.len(), |k| at + k);
    // The scene has not been read yet, so the format is determined by a search for its line.
    let says_format = |line: &str| line.replace(' ', "").starts_with("format=2");
    let computes = text.lines().any(says_format);
    let (message, help) = meant(text[begin..end].trim_end(), at - begin, computes)?;
    Some(Explanation {
        span,
        message: message.to_owned(),
        label: LABEL,
        help,
    })
}

/// Explains an error in a line and suggests a text. The line is not valid after the position `at`.
/// `computes` is true if texts are expressions.
fn meant(line: &str, at: usize, computes: bool) -> Option<(&'static str, String)> {
    if line.starts_with('[') && is_key(line.trim_matches(['[', ']', ' '])) {
        return Some((
            "the brackets of a section do not fit",
            "a section that occurs once has one pair of brackets, `[simulate]`; other sections have two pairs, `[[body]]`"
                .to_owned(),
        ));
    }
    if line.starts_with('{') {
        return Some((
            "not a line of TOML",
            "a scene is TOML, not JSON: `key = value`, line by line".to_owned(),
        ));
    }
    let Some(equals) = line.find('=') else {
        let (key, value) = line.split_once(':')?;
        let (key, value) = (key.trim(), value.trim());
        let help = format!("write `{key} = {value}` instead of `{key}: {value}`");
        return is_key(key).then_some(("a key without `=`", help));
    };
    let (key, value) = (line[..equals].trim(), line[equals + 1..].trim());
    if equals > at {
        return None;
    }
    if let Some(quoted) = value.strip_prefix(CURLED) {
        let inner = quoted.split(CURLED).next().unwrap_or_default();
        return Some((
            "a text in quotes of another kind",
            format!("write straight quotes: `{key} = \"{inner}\"`"),
        ));
    }
    if line.matches('"').count() % 2 == 1 {
        return Some((
            "a text is never closed",
            "a text ends on its line, with the quote that it began with".to_owned(),
        ));
    }
    // Within a list, only the text at this position is used.
    let value = if value.starts_with(['[', '{']) {
        line.get(at..).unwrap_or_default()
    } else {
        value
    };
    number(key, value, computes).or_else(|| word(key, value))
}

/// Whether a word can be a key without quotes.
fn is_key(word: &str) -> bool {
    let letter = |c: char| c.is_ascii_alphanumeric() || "_-".contains(c);
    word.starts_with(|c: char| c.is_ascii_alphabetic()) && word.chars().all(letter)
}

/// Typographic quotation marks.
const CURLED: [char; 5] = ['“', '”', '„', '‘', '’'];

const COMPUTED: (&str, &str) = (
    "an expression without quotes",
    "write the expression in quotes with `format = 2` in `[scene]`, or write its value",
);

/// Explains a value that begins with a number.
fn number(key: &str, value: &str, computes: bool) -> Option<(&'static str, String)> {
    let digits = value.find(|c: char| !(c.is_ascii_digit() || "+-.eE_".contains(c)));
    let (number, rest) = value.split_at(digits?);
    if let Some(help) = units::advice(value) {
        let help = match units::with_unit(value) {
            Some(quoted) if computes => {
                format!("values with units need quotes: write `\"{quoted}\"`")
            }
            _ => help,
        };
        return Some(("a number with a unit", help));
    }
    if !units::is_number(number) {
        return None;
    }
    let decimals = rest.strip_prefix(',').unwrap_or_default();
    let behind = rest.trim_start();
    if decimals.starts_with(|c: char| c.is_ascii_digit()) {
        let decimals = decimals.trim_end();
        let help = format!(
            "decimals follow a point, and lists need brackets: `{key} = {number}.{decimals}`"
        );
        return Some(("a number with a comma", help));
    }
    if behind.starts_with("//") {
        let help = "remarks begin with `#`".to_owned();
        return Some(("a number is followed by something else", help));
    }
    if behind.starts_with(';') {
        let help = format!("values end with their line: `{key} = {number}`");
        return Some(("a number is followed by `;`", help));
    }
    behind
        .starts_with(['/', '*', '^', '+', '-'])
        .then(|| (COMPUTED.0, COMPUTED.1.to_owned()))
}

/// Explains a value that begins with a letter.
fn word(key: &str, value: &str) -> Option<(&'static str, String)> {
    if !value.starts_with(char::is_alphabetic) {
        return None;
    }
    let end = value.find(|c: char| c.is_whitespace() || "#,]}".contains(c));
    let word = &value[..end.unwrap_or(value.len())];
    if word.contains(['/', '*', '^', '+', '(']) {
        return Some((COMPUTED.0, COMPUTED.1.to_owned()));
    }
    // In a list, the suggestion contains only the word itself.
    let help = if value.len() == word.len() && !key.is_empty() {
        format!("texts need quotes: `{key} = \"{word}\"`")
    } else {
        format!("texts need quotes: `\"{word}\"`")
    };
    Some(("a text without quotes", help))
}

/// Returns the last bracket before a position that is still open at this position.
fn open_bracket(text: &str, at: usize) -> Option<usize> {
    let mut closed = 0;
    let mut end = at;
    loop {
        let begin = text[..end].rfind('\n').map_or(0, |k| k + 1);
        let (open, excess) = open_brackets(&text[begin..end]);
        match open.len().checked_sub(closed + 1) {
            Some(last) => return Some(begin + open[last]),
            None => closed = closed - open.len() + excess,
        }
        end = begin.checked_sub(1)?;
    }
}

/// Returns the brackets that a line opens and does not close, and the number of brackets that were
/// opened earlier and closed in this line. Quoted texts and comments are ignored.
fn open_brackets(line: &str) -> (Vec<usize>, usize) {
    let mut quote = None;
    let (mut open, mut excess) = (Vec::new(), 0);
    for (at, c) in line.char_indices() {
        match (quote, c) {
            (Some(q), c) if c == q => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(c),
            (None, '#') => break,
            (None, '[' | '{') => open.push(at),
            (None, ']' | '}') if open.pop().is_none() => excess += 1,
            _ => {}
        }
    }
    (open, excess)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_people_mean() {
        let said = |line: &str, at: usize| fault(line, at..at).map_or(String::new(), |f| f.help);
        for (line, at, expected) in [
            ("mass = 2,5", 8, "`mass = 2.5`"),
            (
                "mass = 2.5 kg # heavy",
                7,
                "write `2.5` instead of `2.5 kg`",
            ),
            (
                "angle = 30°",
                8,
                "write `0.5235987755982989` instead of `30°`",
            ),
            ("at = [500 mm, 0]", 6, "write `0.5` instead of `500 mm`"),
            ("type = revolute", 7, "`type = \"revolute\"`"),
            ("bodies = [crank, rod]", 10, "`\"crank\"`"),
            ("name = \"rod", 11, "with the quote that it began with"),
            ("name = “rod”", 7, "`name = \"rod\"`"),
            ("angle = pi/6", 8, "or write its value"),
            ("at = [1/2, 0]", 6, "or write its value"),
            ("mass = 2.0;", 10, "`mass = 2.0`"),
            ("mass = 2.0 // heavy", 7, "remarks begin with `#`"),
            ("mass: 2.0", 4, "write `mass = 2.0` instead of `mass: 2.0`"),
            ("[[joint]", 8, "other sections have two pairs, `[[body]]`"),
        ] {
            assert!(
                said(line, at).ends_with(expected),
                "{line}: {}",
                said(line, at)
            );
        }
        for silent in [
            "mass == 2",
            "mass",
            "",
            "= 2",
            "mass = 2",
            "[0.0 1.0],",
            "[[1, 2]",
            "# a: b",
        ] {
            for at in 0..=silent.len() {
                assert_eq!(said(silent, at), "", "{silent} {at}");
            }
        }
    }

    #[test]
    fn brackets_of_long_lists_are_not_blamed_for_others() {
        let text = "body = [\n  { name = \"a\" },\n]\nat = [0.0, 0.0\n[[body]]\n";
        let at = text.find("[[body").expect("there");
        let fault = never_closed(text, at).expect("open");
        assert_eq!(fault.span.start, text.find("[0.0").expect("there"));
        assert!(never_closed("[[body]]\n", 0).is_none());
        assert_eq!(open_brackets("keep = [\"a]\", # ]"), (vec![7], 0));
        // If two brackets are open, the result is the inner bracket. If the inner bracket is closed
        // in a later line, the result is the outer bracket.
        assert_eq!(open_bracket("a = [\n [1,\n", 11), Some(7));
        assert_eq!(open_bracket("a = [\n [1,\n 2],\n", 16), Some(4));
    }
}
