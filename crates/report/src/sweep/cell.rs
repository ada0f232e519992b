//! Typed values of a table: the same in a journal, in CSV and in Parquet.

use serde::{Serialize, Serializer};

/// A column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// What its values are.
    pub kind: Kind,
}

/// What the values of a column are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Whole numbers, some of them unknown.
    Count,
    /// Numbers; NaN if there is none.
    Number,
    /// Texts of one line.
    Text,
}

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Of a column of whole numbers; `None` if it is unknown.
    Count(Option<u64>),
    /// Of a column of numbers.
    Number(f64),
    /// Of a column of texts.
    Text(String),
}

impl Cell {
    /// A text of one line, whatever it was.
    pub(super) fn line(text: &str) -> Self {
        let words: Vec<&str> = text.split_whitespace().collect();
        Self::Text(words.join(" "))
    }

    /// Reads what was written, if it is of this kind.
    pub(super) fn read(text: &str, kind: Kind) -> Option<Self> {
        match kind {
            Kind::Count if text.is_empty() => Some(Self::Count(None)),
            Kind::Count => text.parse().ok().map(|n| Self::Count(Some(n))),
            Kind::Number => text.parse().ok().map(Self::Number),
            Kind::Text => Some(Self::Text(text.to_owned())),
        }
    }
}

impl Serialize for Cell {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Count(n) => n.serialize(serializer),
            Self::Number(x) => x.serialize(serializer),
            Self::Text(text) => text.serialize(serializer),
        }
    }
}
