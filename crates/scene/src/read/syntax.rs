//! Advice for texts that are not TOML: what people mean by the signs that they write.

use std::ops::Range;

/// What to do about a key that is given twice.
pub(super) fn twice(text: &str, key: Range<usize>) -> Option<String> {
    let key = text.get(key)?;
    Some(format!(
        "this table has `{key}` already: delete one of the two"
    ))
}

/// What to do about an error at this place, if that can be guessed.
pub(super) fn advice(text: &str, at: usize, never_closed: bool) -> Option<String> {
    let at = text.floor_char_boundary(at);
    if never_closed && let Some(line) = open_bracket(text, at) {
        return Some(format!("a bracket that opens on line {line} is not closed"));
    }
    let begin = text[..at].rfind('\n').map_or(0, |k| k + 1);
    let end = text[at..].find('\n').map_or(text.len(), |k| at + k);
    let (key, value) = text[begin..end].split_once('=')?;
    let (key, value) = (key.trim(), value.trim());
    if begin + text[begin..].find('=')? > at {
        return None;
    }
    if text[begin..end].matches('"').count() % 2 == 1 {
        return Some("a text ends on its line, with the quote that it began with".to_owned());
    }
    let digits = value.find(|c: char| !(c.is_ascii_digit() || "+-.eE_".contains(c)));
    let (number, rest) = value.split_at(digits.unwrap_or(value.len()));
    let is_number = number.parse::<f64>().is_ok();
    let behind = rest.trim_start();
    if is_number
        && rest
            .strip_prefix(',')
            .is_some_and(|r| r.starts_with(|c: char| c.is_ascii_digit()))
    {
        return Some(format!(
            "decimals follow a point, and lists stand in brackets: `{key} = {number}.{}`",
            rest[1..].trim_end()
        ));
    }
    if is_number && behind.starts_with(|c: char| c.is_alphabetic() || "°%µ".contains(c)) {
        return Some(format!(
            "numbers stand without units, in SI and radians: `{key} = {number}`"
        ));
    }
    if value.starts_with(|c: char| c.is_alphabetic()) {
        let word = value
            .split(|c: char| c.is_whitespace() || c == '#')
            .next()?;
        return Some(format!("texts stand in quotes: `{key} = \"{word}\"`"));
    }
    None
}

/// The line of the last bracket before a place that is still open there.
fn open_bracket(text: &str, at: usize) -> Option<usize> {
    let before: Vec<&str> = text[..at].lines().collect();
    let mut open = 0;
    let blamed = before.iter().rposition(|line| {
        let opened = open_brackets(line);
        open += opened;
        opened > 0 && open > 0
    });
    blamed.map(|k| k + 1)
}

/// Brackets that a line opens and does not close, outside of texts and remarks.
fn open_brackets(line: &str) -> isize {
    let mut quote = None;
    let mut open = 0;
    for c in line.chars() {
        match (quote, c) {
            (Some(q), c) if c == q => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(c),
            (None, '#') => break,
            (None, '[' | '{') => open += 1,
            (None, ']' | '}') => open -= 1,
            _ => {}
        }
    }
    open
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_people_mean() {
        let said = |line: &str, at: usize| advice(line, at, false).unwrap_or_default();
        assert!(said("mass = 2,5", 8).ends_with("`mass = 2.5`"));
        assert!(said("mass = 2.5 kg # heavy", 7).ends_with("`mass = 2.5`"));
        assert!(said("angle = 30°", 8).ends_with("`angle = 30`"));
        assert!(said("type = revolute", 7).ends_with("`type = \"revolute\"`"));
        assert!(said("name = \"rod", 11).starts_with("a text ends on its line"));
        for silent in ["mass == 2", "mass", "", "= 2", "mass = 2"] {
            for at in 0..=silent.len() {
                assert_eq!(said(silent, at), "", "{silent} {at}");
            }
        }
    }

    #[test]
    fn brackets_of_long_lists_are_not_blamed_for_others() {
        let text = "body = [\n  { name = \"a\" },\n]\nat = [0.0, 0.0\n[[body]]\n";
        let at = text.find("[[body").expect("there");
        assert_eq!(
            advice(text, at, true).as_deref(),
            Some("a bracket that opens on line 4 is not closed")
        );
        assert_eq!(advice("[[body]]\n", 0, true), None);
        assert_eq!(open_brackets("keep = [\"a]\", # ]"), 1);
    }
}
