//! Answers as sentences and tables, and their layout as text.

mod table;

pub use model::words::{SceneUnits, UnitSystem, in_units_of_scenes};
pub use table::Cell;
pub(crate) use table::{Scale, html_table};

use std::iter;

/// A part of an answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Block {
    /// The title of the next blocks, without a full stop. It is printed after an empty line.
    Heading(String),
    /// A sentence after an introduction. Further lines of the sentence are indented by the width of
    /// the introduction.
    Sentence {
        /// The introduction, such as `warning: `, or an empty text.
        lead: String,
        /// The sentence.
        text: String,
    },
    /// An explanation below a table: a word and its meaning.
    Legend(String, String),
    /// An empty line before a new subject.
    Gap,
    /// Lines of cells; the first line contains the names of the columns.
    Table(Vec<Vec<Cell>>),
    /// A block that is printed only if details are requested.
    Detail(Box<Block>),
}

impl Block {
    /// Creates a sentence.
    #[must_use]
    pub fn sentence(text: impl Into<String>) -> Self {
        Self::after("", text)
    }

    /// Creates a sentence after an introduction.
    #[must_use]
    pub fn after(lead: impl Into<String>, text: impl Into<String>) -> Self {
        Self::Sentence {
            lead: lead.into(),
            text: text.into(),
        }
    }

    /// A sentence that is printed only if details are requested.
    #[must_use]
    pub fn detail(lead: impl Into<String>, text: impl Into<String>) -> Self {
        Self::Detail(Box::new(Self::after(lead, text)))
    }

    /// Creates a table with the names of its columns.
    #[must_use]
    pub fn table<const N: usize>(
        columns: [&str; N],
        lines: impl IntoIterator<Item = [impl Into<Cell>; N]>,
    ) -> Self {
        let lines = lines.into_iter().map(|line| line.map(Into::into).to_vec());
        let head = columns.map(Cell::from).to_vec();
        Self::Table(iter::once(head).chain(lines).collect())
    }
}

/// Converts the blocks to text. Sentences follow each other. There is an empty line before
/// headings, and around tables that have no heading. Quantities have the units of
/// [`model::words::units`].
#[must_use]
pub fn text(blocks: &[Block], is_verbose: bool) -> String {
    let mut out = String::new();
    let mut before: Option<&Block> = None;
    for block in blocks {
        let block = match block {
            Block::Detail(_) if !is_verbose => continue,
            Block::Detail(detail) => detail.as_ref(),
            block => block,
        };
        let is_apart = match (before, block) {
            (None | Some(Block::Heading(_) | Block::Gap), _)
            | (_, Block::Gap | Block::Legend(..)) => false,
            (_, Block::Heading(_) | Block::Table(_)) | (Some(Block::Table(_)), _) => true,
            (_, Block::Sentence { .. } | Block::Detail(_)) => false,
        };
        if is_apart {
            out.push('\n');
        }
        match block {
            Block::Gap => out.push('\n'),
            Block::Legend(words, text) => out.push_str(&wrapped(&format!("{words}: "), text)),
            Block::Heading(words) => out.push_str(&wrapped("", words)),
            Block::Sentence { lead, text } => out.push_str(&wrapped(lead, text)),
            Block::Table(lines) => out.push_str(&table::columns(lines)),
            // A detail within a detail.
            Block::Detail(inner) => {
                out.push_str(&text(std::slice::from_ref(inner), is_verbose));
            }
        }
        before = Some(block);
    }
    out
}

/// Formats a number with its noun, such as `1 body` or `7 bodies`.
#[must_use]
pub fn count(n: usize, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}

/// Formats the numbers of holonomic and nonholonomic rows.
///
/// ```
/// assert_eq!(pfaff::words::count_of_rows(4, 0), "4 holonomic rows");
/// assert_eq!(pfaff::words::count_of_rows(2, 1), "3 rows (2 holonomic, 1 nonholonomic)");
/// ```
#[must_use]
pub fn count_of_rows(holonomic: usize, nonholonomic: usize) -> String {
    match (holonomic, nonholonomic) {
        (0, 0) => count(0, "row", "rows"),
        (n, 0) => count(n, "holonomic row", "holonomic rows"),
        (0, n) => count(n, "nonholonomic row", "nonholonomic rows"),
        (m, n) => format!("{} rows ({m} holonomic, {n} nonholonomic)", m + n),
    }
}

/// Returns the SI unit of a component of a reaction by its first letter; an empty text for other
/// names, such as that of a sum.
#[must_use]
pub fn load_unit(component: &str) -> &'static str {
    match component.chars().next() {
        Some('T') => "N·m",
        Some('F' | 'N') => "N",
        _ => "",
    }
}

/// Width of printed texts (characters).
const WIDTH: usize = 100;

/// Breaks a text into lines of at most 100 characters, if the words of the text are short enough.
/// The first line begins with `lead`, and the other lines are indented by the width of `lead`.
#[must_use]
pub fn wrapped(lead: &str, text: &str) -> String {
    let indent = " ".repeat(lead.chars().count());
    let (mut out, mut line) = (String::new(), lead.to_owned());
    let mut is_empty = true;
    for word in text.split_whitespace() {
        let width = line.chars().count() + word.chars().count();
        if !is_empty && width >= WIDTH {
            out.push_str(line.trim_end());
            out.push('\n');
            line.clone_from(&indent);
            is_empty = true;
        }
        if !is_empty {
            line.push(' ');
        }
        line.push_str(word);
        is_empty = false;
    }
    out.push_str(line.trim_end());
    out.push('\n');
    out
}

/// Returns the keys in the order of their first values. Each key has the list of all its values.
pub fn grouped<K: PartialEq, V>(pairs: impl IntoIterator<Item = (K, V)>) -> Vec<(K, Vec<V>)> {
    let mut groups: Vec<(K, Vec<V>)> = Vec::new();
    for (key, value) in pairs {
        match groups.iter_mut().find(|(known, _)| *known == key) {
            Some((_, values)) => values.push(value),
            None => groups.push((key, vec![value])),
        }
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_apart_where_something_else_begins() {
        let table = || Block::table(["a", "bc"], [["1".to_owned(), "2".to_owned()]]);
        let blocks = [
            Block::sentence("one"),
            Block::after("- ", "two"),
            table(),
            Block::Legend("a".to_owned(), "letter".to_owned()),
            Block::sentence("three"),
            Block::Heading("next:".to_owned()),
            table(),
            table(),
            Block::Gap,
            Block::sentence("end"),
        ];
        let expected = "one\n- two\n\na  bc\n1  2\na: letter\nthree\n\nnext:\na  bc\n1  2\n\na  bc\n1  2\n\nend\n";
        assert_eq!(text(&blocks, false), expected);
        let detail = [Block::sentence("one"), Block::detail("- ", "two")];
        assert_eq!(text(&detail, false), "one\n");
        assert_eq!(text(&detail, true), "one\n- two\n");
    }

    #[test]
    fn lines_of_a_sentence_begin_below_its_first_word() {
        let long = "word ".repeat(40);
        let lines = text(&[Block::after("note: ", long)], false);
        let widths: Vec<usize> = lines.lines().map(|line| line.chars().count()).collect();
        assert_eq!(widths.len(), 3);
        assert!(widths.iter().all(|width| *width <= 100), "{widths:?}");
        assert!(
            lines
                .lines()
                .skip(1)
                .all(|line| line.starts_with("      word"))
        );
    }
}
