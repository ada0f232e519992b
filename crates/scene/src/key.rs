//! The keys of the format: what the reader asks for is what the schema says. Keys of joints and
//! forces are not here: they come from their definitions.

use serde_json::Value;

use crate::dimension::Dimension;

/// The key that names a definition.
pub(crate) const TYPE: &str = "type";

/// A key of a table.
#[derive(Clone, Copy)]
pub(crate) struct Key {
    pub(crate) name: &'static str,
    /// What it takes, in the words of messages.
    pub(crate) expected: &'static str,
    pub(crate) takes: Takes,
    /// The dimension of its numbers.
    pub(crate) unit: Dimension,
    /// Whether that is multiplied by the dimension of a function's values.
    is_of_values: bool,
    /// What it means.
    pub(crate) doc: &'static str,
    pub(crate) is_required: bool,
    /// What holds where it is not given.
    pub(crate) default: Option<fn() -> Value>,
}

/// What a key takes.
#[derive(Clone, Copy)]
pub(crate) enum Takes {
    /// The name of something.
    Name,
    /// Any text.
    Text,
    /// One of these texts.
    OneOf(fn() -> Vec<&'static str>),
    /// `true` or `false`
    Flag,
    /// A whole number between these.
    Whole(i64, i64),
    /// Units of bare numbers.
    Units,
    /// One number.
    Number(Interval),
    /// Two numbers.
    Pair(Interval),
    /// At least so many numbers.
    Numbers(usize),
    /// Texts, at least so many.
    Texts(usize),
    /// All, none, or the names of some.
    Names,
    /// Rows, counted from 1.
    Rows,
    /// A number or a function of time.
    Function,
    /// Steps of a function of time, at least one.
    Steps,
}

/// Numbers that are allowed.
#[derive(Clone, Copy)]
pub(crate) enum Interval {
    Any,
    NotNegative,
    Positive,
    Within(f64, f64),
}

impl Interval {
    pub(crate) fn contains(self, x: f64) -> bool {
        match self {
            Self::Any => true,
            Self::NotNegative => x >= 0.0,
            Self::Positive => x > 0.0,
            Self::Within(least, most) => (least..=most).contains(&x),
        }
    }
}

impl Key {
    /// A key that must be given.
    pub(crate) const fn required(name: &'static str, expected: &'static str, takes: Takes) -> Self {
        Self {
            is_required: true,
            ..Self::optional(name, expected, takes)
        }
    }

    /// A key that may be left out.
    pub(crate) const fn optional(name: &'static str, expected: &'static str, takes: Takes) -> Self {
        Self {
            name,
            expected,
            takes,
            unit: Dimension::NONE,
            is_of_values: false,
            doc: "",
            is_required: false,
            default: None,
        }
    }

    /// It must be given.
    pub(crate) const fn needed(self) -> Self {
        Self {
            is_required: true,
            ..self
        }
    }

    /// With numbers of this dimension.
    pub(crate) const fn unit(self, unit: Dimension) -> Self {
        Self { unit, ..self }
    }

    /// With numbers of the dimension of a function's values, times `unit`.
    pub(crate) const fn of_values(self) -> Self {
        Self {
            is_of_values: true,
            ..self
        }
    }

    /// The dimension of its numbers in a function whose values have this one.
    pub(crate) fn unit_in(&self, values: Dimension) -> Dimension {
        if self.is_of_values {
            values.times(self.unit, 1)
        } else {
            self.unit
        }
    }

    /// What it means.
    pub(crate) const fn doc(self, doc: &'static str) -> Self {
        Self { doc, ..self }
    }

    /// What holds where it is not given.
    pub(crate) const fn or(self, default: fn() -> Value) -> Self {
        Self {
            default: Some(default),
            ..self
        }
    }

    /// Whether a number may stand here.
    pub(crate) fn allows(&self, x: f64) -> bool {
        match self.takes {
            Takes::Number(range) | Takes::Pair(range) => range.contains(x),
            _ => true,
        }
    }
}

/// Its name.
impl From<&Key> for &'static str {
    fn from(key: &Key) -> Self {
        key.name
    }
}
