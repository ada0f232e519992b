//! Finds angles without a unit that were probably intended in degrees.

use std::f64::consts::TAU;

use linalg::Dd;
use model::words::rounded;

use crate::dimension::Dimension;
use crate::expression::Quantity;
use crate::language::Language;

/// Angles in degrees are usually multiples of this number. Angles in radians are multiples of this
/// number only by chance.
const ROUND_DEGREES: f64 = 5.0;

/// Smallest number that counts as degrees; smaller numbers may be angles in radians within about
/// one revolution, 2π = 6.28.
const LEAST_DEGREES: f64 = 10.0;

/// Largest number that counts as degrees: one revolution. Motions over many revolutions have larger
/// values.
const MOST_DEGREES: f64 = 360.0;

/// A number as read from the text.
#[derive(Clone, Copy)]
pub(crate) struct Number {
    pub(crate) value: f64,
    /// Whether the number is an angle without a unit that is read in radians.
    is_bare_angle: bool,
}

impl Number {
    pub(crate) fn new(value: f64, written: &Quantity, of: Dimension, angle: Dd) -> Self {
        let is_bare = written.dimension.is_none() && angle == Dd::ONE;
        Self {
            value,
            is_bare_angle: is_bare && of == Dimension::ANGLE,
        }
    }
}

/// Warning about an angle that is probably in degrees, with the suggested text.
pub(crate) struct Degrees {
    /// Index of the angle in the list.
    pub(crate) at: usize,
    /// The message of the warning.
    pub(crate) message: String,
    pub(crate) help: String,
}

/// Angles without a unit are probably in degrees if all of them are multiples of five and not all
/// are within ±2π. All numbers of a list are checked together.
pub(crate) fn degrees(numbers: &[Number], language: &Language) -> Option<Degrees> {
    let angles = || numbers.iter().enumerate().filter(|(_, n)| n.is_bare_angle);
    let is_round = |x: f64| x.abs() <= MOST_DEGREES && x % ROUND_DEGREES == 0.0;
    if !angles().all(|(_, number)| is_round(number.value)) {
        return None;
    }
    let (at, number) = angles().find(|(_, number)| number.value.abs() >= LEAST_DEGREES)?;
    let degrees = number.value;
    let turns = rounded(degrees / TAU);
    let help = if language.computes {
        format!("write `\"{degrees} deg\"`, or `\"{degrees} rad\"` for radians")
    } else {
        let radians = degrees.to_radians();
        format!("write `{radians}`, or `\"{degrees} deg\"` with `format = 2` in `[scene]`")
    };
    Some(Degrees {
        at,
        message: format!("is {degrees} rad, which is {turns} turns: it looks like degrees"),
        help,
    })
}
