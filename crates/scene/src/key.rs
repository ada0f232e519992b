//! The keys of the format, which are used both by the reader and by the schema. The definitions of
//! joints and forces contain their own keys.

use serde_json::Value;

use crate::dimension::Dimension;

/// The key for the name of a definition.
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
    /// Whether the dimension is `unit` times the dimension of the values of a function.
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
    /// The name of an element of the scene.
    Name,
    /// Any text.
    Text,
    /// One of these texts.
    OneOf(fn() -> Vec<&'static str>),
    /// `true` or `false`.
    Flag,
    /// `true` or `false`, or a number. Only the number zero means `false`.
    Switch,
    /// An integer in this range.
    Whole(i64, i64),
    /// A table with the units of bare numbers.
    Units,
    /// A list of codes of warnings.
    Warnings,
    /// One number.
    Number(Interval),
    /// A vector with this number of components.
    Vector(usize, Interval),
    /// A direction with this number of components: the name of an axis, or a vector.
    Direction(usize),
    /// Two directions with this number of components.
    Directions(usize),
    /// An orientation of a body.
    Orientation,
    /// A table with these keys.
    Table(&'static [Key]),
    /// `true` or `false`, or a table with these keys.
    FlagOr(&'static [Key]),
    /// Three numbers, or three rows of three numbers.
    Tensor,
    /// A list of at least this number of numbers.
    Numbers(usize),
    /// A list of at least this number of texts.
    Texts(usize),
    /// `true` for all items, `false` for no item, or a list of names.
    Names,
    /// A list of plots. Each plot is a list of names, or a table with these keys.
    Plots(&'static [Key]),
    /// A list of rows (1-based).
    Rows,
    /// A number or a function of time.
    Function,
    /// A number, or an expression of a joint coordinate, its rate and time.
    Law,
    /// A force, or the name of a joint.
    Load,
    /// A table with one number for each joint coordinate.
    Inertias,
    /// A list of steps of a function of time, at least one.
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

    /// Sets the dimension of the numbers to `unit` times the dimension of the values of a function.
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
