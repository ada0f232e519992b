//! Typed values of a table. A journal, a CSV file and a Parquet file contain the same values.

use std::fmt;

use serde::{Serialize, Serializer};

/// A column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Name of the column.
    pub name: String,
    /// Type of the values.
    pub kind: Kind,
}

/// Type of the values of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Integers; a value may be unknown.
    Count,
    /// Numbers. An unknown number is NaN.
    Number,
    /// Texts of one line.
    Text,
}

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// A value of a column of integers; `None` if it is unknown.
    Count(Option<u64>),
    /// A value of a column of numbers.
    Number(f64),
    /// A value of a column of texts.
    Text(String),
}

impl Cell {
    /// A text converted to one line.
    pub(super) fn line(text: &str) -> Self {
        let words: Vec<&str> = text.split_whitespace().collect();
        Self::Text(words.join(" "))
    }

    /// Whether both values are equal, bit by bit; all NaN values count as equal.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Number(a), Self::Number(b)) => {
                a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan()
            }
            _ => self == other,
        }
    }

    /// Parses the text of a value; `None` if the text does not have this type.
    pub(super) fn read(text: &str, kind: Kind) -> Option<Self> {
        match kind {
            Kind::Count if text.is_empty() => Some(Self::Count(None)),
            Kind::Count => text.parse().ok().map(|n| Self::Count(Some(n))),
            Kind::Number => text.parse().ok().map(Self::Number),
            Kind::Text => Some(Self::Text(text.to_owned())),
        }
    }
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Count(None) => f.write_str("unknown"),
            Self::Count(Some(n)) => write!(f, "{n}"),
            Self::Number(x) => write!(f, "{x:?}"),
            Self::Text(text) => write!(f, "\"{text}\""),
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
