//! The entries of the page, parsed on request.

use std::sync::OnceLock;

use super::{Code, PAGE};

/// Meaning of a code.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// The code.
    pub code: Code,
    /// Title of the problem in one line.
    pub title: &'static str,
    /// Advice on how to solve the problem.
    pub advice: &'static str,
    /// An example that produces this code, or the reason why there is no example.
    pub example: Example,
}

/// An example that produces an error code.
#[derive(Clone, Copy, Debug)]
pub enum Example {
    /// The command `pfaff` with these arguments and a scene on standard input.
    Scene(&'static str, &'static str),
    /// The command `pfaff` with these arguments.
    Command(&'static str),
    /// Reason why no short example is possible.
    None(&'static str),
}

/// Returns all entries, by ascending codes.
#[must_use]
pub fn entries() -> &'static [Entry] {
    static ENTRIES: OnceLock<Vec<Entry>> = OnceLock::new();
    ENTRIES.get_or_init(|| PAGE.split("\n## P").skip(1).filter_map(entry).collect())
}

/// Parses a section of the page. The section begins after the `P` of its heading. The paragraphs of
/// the section are the title, the advice, and an example or the reason why there is no example.
fn entry(section: &'static str) -> Option<Entry> {
    let (number, rest) = section.split_once("\n\n")?;
    let (title, rest) = rest.split_once(".\n\n")?;
    let (advice, example) = match rest.split_once(" with this scene:\n\n```text\n") {
        Some((before, scene)) => {
            let (advice, command) = before.rsplit_once("\n\n")?;
            let scene = scene.trim_end().trim_end_matches("```");
            (advice, Example::Scene(arguments(command)?, scene))
        }
        None => {
            let (advice, last) = rest.trim_end().rsplit_once("\n\n")?;
            let example = match last.strip_prefix("No short example: ") {
                Some(reason) => Example::None(reason.trim_end_matches('.')),
                None => Example::Command(arguments(last.strip_prefix("For example ")?)?),
            };
            (advice, example)
        }
    };
    Some(Entry {
        code: Code(number.parse().ok()?),
        title,
        advice,
        example,
    })
}

/// Returns the arguments of `` `pfaff ARGUMENTS` ``.
fn arguments(command: &'static str) -> Option<&'static str> {
    let command = command.trim_end_matches('.').trim_matches('`');
    command.strip_prefix("pfaff ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_heading_of_the_page_has_an_entry() {
        assert_eq!(entries().len(), PAGE.matches("\n## P").count());
        let known = super::super::IS_CODE.iter().filter(|is| **is).count();
        assert_eq!(entries().len(), known);
        for pair in entries().windows(2) {
            assert!(pair[0].code < pair[1].code, "{}", pair[1].code);
        }
    }
}
