//! Answers for people: sentences and tables, and how they are laid out as text.

use std::iter;

/// A part of an answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Block {
    /// Says what comes next: without a full stop, after an empty line.
    Heading(String),
    /// A sentence after some words, under which its further lines begin.
    Sentence {
        /// The words: as `warning: `, or nothing.
        lead: String,
        /// The sentence.
        text: String,
    },
    /// An empty line: what follows is about something else.
    Gap,
    /// Lines of cells, the first one of them with the names of the columns.
    Table(Vec<Vec<String>>),
}

impl Block {
    /// A sentence.
    #[must_use]
    pub fn sentence(text: impl Into<String>) -> Self {
        Self::after("", text)
    }

    /// A sentence after some words.
    #[must_use]
    pub fn after(lead: impl Into<String>, text: impl Into<String>) -> Self {
        Self::Sentence {
            lead: lead.into(),
            text: text.into(),
        }
    }

    /// A table with the names of its columns.
    #[must_use]
    pub fn table<const N: usize>(
        columns: [&str; N],
        lines: impl IntoIterator<Item = [String; N]>,
    ) -> Self {
        let lines = lines.into_iter().map(Vec::from);
        let head = columns.map(str::to_owned).to_vec();
        Self::Table(iter::once(head).chain(lines).collect())
    }
}

/// The blocks as text. Sentences follow each other; an empty line is before headings and around
/// tables that have none.
#[must_use]
pub fn text(blocks: &[Block]) -> String {
    let mut out = String::new();
    let mut before: Option<&Block> = None;
    for block in blocks {
        let is_apart = match (before, block) {
            (None | Some(Block::Heading(_) | Block::Gap), _) | (_, Block::Gap) => false,
            (_, Block::Heading(_) | Block::Table(_)) | (Some(Block::Table(_)), _) => true,
            (Some(Block::Sentence { .. }), Block::Sentence { .. }) => false,
        };
        if is_apart {
            out.push('\n');
        }
        match block {
            Block::Gap => out.push('\n'),
            Block::Heading(words) => out.push_str(&wrapped("", words)),
            Block::Sentence { lead, text } => out.push_str(&wrapped(lead, text)),
            Block::Table(lines) => out.push_str(&columns(lines)),
        }
        before = Some(block);
    }
    out
}

/// A number with its noun, as `1 body` or `7 bodies`.
#[must_use]
pub fn count(n: usize, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}

/// Names in marks, as `` `A`, `B` ``.
#[must_use]
pub fn marked(names: &[impl AsRef<str>]) -> String {
    let names: Vec<String> = names.iter().map(|n| format!("`{}`", n.as_ref())).collect();
    names.join(", ")
}

/// Width of texts for people (characters).
const WIDTH: usize = 100;

/// Breaks a text into lines of at most 100 characters, if its words are short enough; the first
/// line begins with `lead`, the others are indented by its width.
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

/// Aligns lines of cells in columns; the first line is the header.
#[must_use]
pub fn columns(rows: &[Vec<String>]) -> String {
    let n = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |k: usize| {
        rows.iter()
            .filter_map(|r| r.get(k))
            .map(|c| c.chars().count())
            .max()
    };
    let widths: Vec<usize> = (0..n).map(|k| width(k).unwrap_or(0)).collect();
    let mut out = String::new();
    for row in rows {
        let cells: Vec<String> = row
            .iter()
            .zip(&widths)
            .map(|(cell, &w)| format!("{cell:<w$}"))
            .collect();
        out.push_str(cells.join("  ").trim_end());
        out.push('\n');
    }
    out
}
