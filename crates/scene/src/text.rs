//! The text of a scene file: converts byte offsets to lines and columns.

use std::ops::Range;
use std::sync::Arc;

use crate::diagnostic::Label;

/// The text of a file with its name and the start positions of its lines.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SourceText {
    name: String,
    text: Arc<str>,
    line_starts: Arc<[usize]>,
}

impl SourceText {
    /// Creates a text with the name used in diagnostics.
    #[must_use]
    pub fn new(name: &str, text: &str) -> Self {
        let after_breaks = text.match_indices('\n').map(|(at, _)| at + 1);
        Self {
            name: name.to_owned(),
            text: text.into(),
            line_starts: std::iter::once(0).chain(after_breaks).collect(),
        }
    }

    /// Name of the file, usually a path.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The text.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Line and column of a byte offset, both 1-based; columns count characters.
    #[must_use]
    pub fn position(&self, offset: usize) -> (usize, usize) {
        let offset = self.boundary(offset);
        let line = self.line(offset);
        let start = self.line_starts.get(line - 1).copied().unwrap_or(0);
        (line, self.text[start..offset].chars().count() + 1)
    }

    /// Line of a byte offset (1-based).
    #[must_use]
    pub fn line(&self, offset: usize) -> usize {
        let offset = self.boundary(offset);
        self.line_starts
            .partition_point(|&start| start <= offset)
            .max(1)
    }

    /// A label for a range of bytes. A range that ends outside the text or within a character is
    /// shortened.
    #[must_use]
    pub fn label(&self, span: Range<usize>, text: impl Into<String>) -> Label {
        let start = self.boundary(span.start);
        let end = self.boundary(span.end).max(start);
        let (line, column) = self.position(start);
        Label {
            span: start..end,
            line,
            column,
            text: text.into(),
        }
    }

    /// Returns the start of the character that contains this offset.
    fn boundary(&self, offset: usize) -> usize {
        self.text.floor_char_boundary(offset)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters() {
        let text = SourceText::new("a.toml", "φ = 1\r\nname = \"ü\" # x\n");
        assert_eq!(text.position(0), (1, 1));
        assert_eq!(text.position(3), (1, 3)); // φ has two bytes
        assert_eq!(text.position(8), (2, 1));
        assert_eq!(text.position(text.text().len()), (3, 1));
        assert_eq!(text.position(usize::MAX), (3, 1));
    }

    #[test]
    fn labels_stay_inside_the_text() {
        let text = SourceText::new("a.toml", "φ = 1");
        assert_eq!(text.label(1..2, "").span, 0..2);
        assert_eq!(text.label(5..90, "").span, 5..6);
        assert_eq!(SourceText::new("", "").label(1..3, "").span, 0..0);
    }
}
