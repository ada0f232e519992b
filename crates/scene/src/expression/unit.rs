//! The units in expressions, conversions of other units, and the name of the time.

use std::f64::consts::PI;

use crate::dimension::Dimension;

/// The name of the time in force laws and functions of time.
pub(crate) const TIME: &str = "t";

/// Units in expressions, each with its size `times/over` in the units of the format.
pub(super) const UNITS: [Unit; 17] = [
    ("µm", 1.0, 1e6, Dimension::LENGTH),
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
    ("bar", 1e5, 1.0, Dimension::PRESSURE),
    ("MPa", 1e6, 1.0, Dimension::PRESSURE),
    ("kW", 1e3, 1.0, Dimension::POWER),
];

/// A unit: its name, its size and its dimension.
pub(super) type Unit = (&'static str, f64, f64, Dimension);

/// The unit with this name. The prefix micro is U+00B5 on keyboards and U+03BC in Greek; both have
/// the same meaning.
pub(super) fn named(name: &str) -> Option<&'static Unit> {
    let micro = |c| if c == '\u{3bc}' { '\u{b5}' } else { c };
    let mut units = UNITS.iter();
    units.find(|(unit, ..)| unit.chars().eq(name.chars().map(micro)))
}

/// Returns the names of the units of a dimension.
pub(crate) fn names_of(of: Dimension) -> Vec<&'static str> {
    let fitting = UNITS.iter().filter(|(.., dimension)| *dimension == of);
    fitting.map(|(name, ..)| *name).collect()
}

/// Units that expressions do not support, written in supported units.
const OTHERS: [(&str, &str); 14] = [
    ("km", "1e3 m"),
    ("t", "1e3 kg"),
    ("km/h", "1e3 m/(60 min)"),
    ("kNm", "kN*m"),
    ("Nm", "N*m"),
    ("Nmm", "N*mm"),
    ("kgm²", "kg*m²"),
    ("%", "1/100"),
    ("degree", "deg"),
    ("degrees", "deg"),
    ("Hz", "1/s"),
    ("h", "60 min"),
    ("rpm", "2*pi/min"),
    ("1/min", "2*pi/min"),
];

/// A unit that expressions do not support, written in supported units.
pub(crate) fn in_units_here(unit: &str) -> Option<&'static str> {
    let mut known = OTHERS.iter();
    known.find_map(|(name, here)| (*name == unit).then_some(*here))
}
