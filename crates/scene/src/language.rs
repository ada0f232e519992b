//! Meaning of the numbers in a file: the format, the units of bare numbers, and the parameters.

pub(crate) mod read;

use std::collections::BTreeMap;
use std::ops::Range;

use model::words::{SceneUnits, rounded};

use crate::expression::{self, Bases, Quantity, Scope};

/// Meaning of the numbers in a file.
pub(crate) struct Language {
    /// Whether texts may be expressions.
    pub(crate) computes: bool,
    bases: Bases,
    /// Names of the units of bare numbers.
    pub(crate) units: Units,
    parameters: BTreeMap<String, ParameterValue>,
    /// Names of parameters that expressions cannot contain; they have been reported.
    unfit: Vec<String>,
}

/// A parameter as expressions use it.
struct ParameterValue {
    /// The value; `None` if the name or the text of the parameter is wrong.
    value: Option<Quantity>,
    /// Position of the name in the file.
    name: Range<usize>,
}

/// The units in which a scene writes lengths and angles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Units {
    /// Unit of lengths, such as `mm`.
    pub length: &'static str,
    /// Unit of angles, such as `deg`.
    pub angle: &'static str,
}

impl Units {
    /// Metres and radians.
    pub const SI: Self = Self {
        length: "m",
        angle: "rad",
    };

    /// Returns these units with their values, for texts and tables.
    #[must_use]
    pub fn printed(self) -> SceneUnits {
        let value = |name: &'static str, si: &str| {
            let (name, unit) = expression::unit(name).filter(|_| name != si)?;
            Some((name, unit.to_f64()))
        };
        SceneUnits {
            length: value(self.length, Self::SI.length),
            angle: value(self.angle, Self::SI.angle),
        }
    }
}

/// The unit of lengths that are written without a unit.
#[derive(Clone, Copy)]
pub(crate) struct LengthUnit {
    pub(crate) name: &'static str,
    pub(crate) metres: f64,
}

impl LengthUnit {
    /// Formats a moment of inertia (kg·m²) for a message.
    pub(crate) fn inertia(self, si: f64) -> String {
        let number = rounded(si / self.metres.powi(2));
        format!("{number} kg·{}²", self.name)
    }
}

/// Metres and radians.
impl Default for Units {
    fn default() -> Self {
        Self::SI
    }
}

impl Scope for Language {
    fn parameter(&self, name: &str) -> Option<Option<Quantity>> {
        self.parameters.get(name).map(|parameter| parameter.value)
    }

    fn bases(&self) -> Bases {
        self.bases
    }
}

impl Language {
    /// Numbers in metres and radians, without expressions and parameters.
    pub(crate) const PLAIN: Self = Self {
        computes: false,
        bases: Bases::SI,
        units: Units::SI,
        parameters: BTreeMap::new(),
        unfit: Vec::new(),
    };

    /// The unit of lengths that are written without a unit.
    pub(crate) fn length_unit(&self) -> LengthUnit {
        LengthUnit {
            name: self.units.length,
            metres: self.bases.length.to_f64(),
        }
    }

    /// All names that may be suggested for an unknown name in an expression.
    pub(crate) fn names(&self) -> impl Iterator<Item = &str> + '_ {
        self.own_names()
            .chain(expression::known_names().map(|name| name as &str))
    }

    /// Position of the name of a parameter in the file.
    pub(crate) fn position(&self, parameter: &str) -> Option<Range<usize>> {
        let parameter = self.parameters.get(parameter);
        parameter.map(|parameter| parameter.name.clone())
    }

    /// Returns whether this part of an expression contains a part of a name that expressions cannot
    /// contain. If so, an error in this part is only a consequence of the name.
    pub(crate) fn is_unfit(&self, text: &str, part: &Range<usize>) -> bool {
        let names = self.unfit.iter().filter(|name| !name.is_empty());
        let mut uses = names.flat_map(|name| {
            let uses = text.match_indices(name.as_str());
            uses.map(|(at, name)| at..at + name.len())
        });
        uses.any(|name| part.start <= name.end && name.start <= part.end)
    }

    /// Names of the parameters.
    pub(crate) fn own_names(&self) -> impl Iterator<Item = &str> {
        self.parameters.keys().map(String::as_str)
    }
}
