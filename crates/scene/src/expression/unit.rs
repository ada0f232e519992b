//! The units of expressions.

use std::f64::consts::PI;

use crate::dimension::Dimension;

/// Units of expressions, as `times/over` in those of the format.
pub(super) const UNITS: [(&str, f64, f64, Dimension); 13] = [
    ("mm", 1.0, 1e3, Dimension::LENGTH),
    ("cm", 1.0, 1e2, Dimension::LENGTH),
    ("m", 1.0, 1.0, Dimension::LENGTH),
    ("in", 254.0, 1e4, Dimension::LENGTH),
    ("deg", PI, 180.0, Dimension::ANGLE),
    ("rad", 1.0, 1.0, Dimension::ANGLE),
    ("g", 1.0, 1e3, Dimension::MASS),
    ("kg", 1.0, 1.0, Dimension::MASS),
    ("ms", 1.0, 1e3, Dimension::TIME),
    ("s", 1.0, 1.0, Dimension::TIME),
    ("min", 60.0, 1.0, Dimension::TIME),
    ("N", 1.0, 1.0, Dimension::FORCE),
    ("kN", 1e3, 1.0, Dimension::FORCE),
];

/// Whether a unit has this name.
pub(super) fn is_unit(name: &str) -> bool {
    UNITS.iter().any(|(unit, ..)| *unit == name)
}

/// The units of a dimension by name.
pub(crate) fn names_of(of: Dimension) -> Vec<&'static str> {
    let fitting = UNITS.iter().filter(|(.., dimension)| *dimension == of);
    fitting.map(|(name, ..)| *name).collect()
}
