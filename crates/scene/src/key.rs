//! The keys of the format, used both by the reader and by the schema. The definitions of joints and
//! forces contain their own keys.

use serde_json::Value;

use crate::dimension::Dimension;

/// The key that names a definition.
pub(crate) const TYPE: &str = "type";

/// A key of a table.
#[derive(Clone, Copy)]
pub(crate) struct Key {
    pub(crate) name: &'static str,
    /// The expected value, as stated in messages.
    pub(crate) expected: &'static str,
    pub(crate) takes: Takes,
    /// Dimension of the numbers.
    pub(crate) unit: Dimension,
    /// Whether `unit` is multiplied by the dimension of a function's values.
    is_of_values: bool,
    /// Meaning of the key.
    pub(crate) doc: &'static str,
    pub(crate) is_required: bool,
    /// The default value.
    pub(crate) default: Option<fn() -> Value>,
}

/// Kind of value of a key.
#[derive(Clone, Copy)]
pub(crate) enum Takes {
    /// The name of something.
    Name,
    /// Any text.
    Text,
    /// One of these texts.
    OneOf(fn() -> Vec<&'static str>),
    /// `true` or `false`.
    Flag,
    /// `true` or `false`, or a number, of which only zero means `false`.
    Switch,
    /// An integer in this range.
    Whole(i64, i64),
    /// Units of bare numbers.
    Units,
    /// Codes of warnings.
    Warnings,
    /// One number.
    Number(Interval),
    /// A vector of this number of components.
    Vector(usize, Interval),
    /// An orientation of a body.
    Orientation,
    /// A table with these keys.
    Table(&'static [Key]),
    /// Three moments of inertia, or a symmetric tensor.
    Tensor,
    /// At least this number of numbers.
    Numbers(usize),
    /// At least this number of texts.
    Texts(usize),
    /// All, none, or the names of some items.
    Names,
    /// Rows, counted from 1.
    Rows,
    /// A number or a function of time.
    Function,
    /// A number or an expression of a measure, its rate and time.
    Law,
    /// Steps of a function of time, at least one.
    Steps,
}

/// Range of allowed numbers.
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
    /// A key that is required.
    pub(crate) const fn required(name: &'static str, expected: &'static str, takes: Takes) -> Self {
        Self {
            is_required: true,
            ..Self::optional(name, expected, takes)
        }
    }

    /// An optional vector of the plane.
    pub(crate) const fn pair(name: &'static str) -> Self {
        Self::optional(name, "a pair [x, y]", Takes::Vector(2, Interval::Any))
    }

    /// An optional vector of space.
    pub(crate) const fn triple(name: &'static str) -> Self {
        Self::optional(name, "a vector [x, y, z]", Takes::Vector(3, Interval::Any))
    }

    /// An optional key.
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

    /// Replaces the description of the expected value.
    pub(crate) const fn expecting(self, expected: &'static str) -> Self {
        Self { expected, ..self }
    }

    /// Makes the key required.
    pub(crate) const fn needed(self) -> Self {
        Self {
            is_required: true,
            ..self
        }
    }

    /// Sets the dimension of the numbers.
    pub(crate) const fn unit(self, unit: Dimension) -> Self {
        Self { unit, ..self }
    }

    /// Sets the dimension of the numbers to the dimension of a function's values times `unit`.
    pub(crate) const fn of_values(self) -> Self {
        Self {
            is_of_values: true,
            ..self
        }
    }

    /// The dimension of the numbers of this key in a function with values of dimension `values`.
    pub(crate) fn unit_in(&self, values: Dimension) -> Dimension {
        if self.is_of_values {
            values.times(self.unit, 1)
        } else {
            self.unit
        }
    }

    /// Sets the meaning of the key.
    pub(crate) const fn doc(self, doc: &'static str) -> Self {
        Self { doc, ..self }
    }

    /// Sets the default value.
    pub(crate) const fn or(self, default: fn() -> Value) -> Self {
        Self {
            default: Some(default),
            ..self
        }
    }

    /// Whether a number is in the allowed range.
    pub(crate) fn allows(&self, x: f64) -> bool {
        match self.takes {
            Takes::Number(range) | Takes::Vector(_, range) => range.contains(x),
            _ => true,
        }
    }
}

/// Name of the key.
impl From<&Key> for &'static str {
    fn from(key: &Key) -> Self {
        key.name
    }
}
