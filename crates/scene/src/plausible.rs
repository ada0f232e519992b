//! Warnings of numbers with which everything can be computed, but which were probably meant in
//! another unit, or are a slip. The thresholds lie between what is built and what a wrong unit
//! makes of it; whoever means such a number silences the warning by its code (`silence`).
//!
//! What one value shows is judged where it is read; what needs the mechanism is in `mechanism`.

mod mechanism;

use std::f64::consts::TAU;

use linalg::Dd;
use model::codes::Code;

use crate::dimension::Dimension;
use crate::expression::{Quantity, units};
use crate::field::Field;
use crate::findings::Findings;

pub(crate) use mechanism::check;

/// Degrees are written in multiples of this; an angle in radians is a multiple of it only by
/// chance.
const ROUND_DEGREES: f64 = 5.0;

/// Least number that looks like degrees: below it are the angles within a turn, 2π = 6.28.
const LEAST_DEGREES: f64 = 10.0;

/// Largest number that looks like degrees: one turn. Motions of many turns are beyond it.
const MOST_DEGREES: f64 = 360.0;

/// Acceleration of free fall on the Earth (m/s²): the standard value.
const EARTH: f64 = 9.80665;

/// Share by which a gravity of the Earth may differ from it: 10 m/s² is written, too.
const NEAR_EARTH: f64 = 0.03;

/// Largest gravity that is meant (m/s²): twice that of Jupiter, the largest of a planet.
const LARGEST_GRAVITY: f64 = 50.0;

/// A number as it was read.
#[derive(Clone, Copy)]
pub(crate) struct Number {
    pub(crate) value: f64,
    /// Whether it is an angle that has no unit and counts in radians.
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

/// Warns of angles without a unit that look like degrees: multiples of five, not all of them within
/// ±2π. Numbers of one list are judged together.
pub(crate) fn degrees(fields: &[Field], numbers: &[Number], findings: &mut Findings) {
    let angles = || {
        let read = fields.iter().zip(numbers);
        read.filter(|(_, number)| number.is_bare_angle)
    };
    let is_round = |x: f64| x.abs() <= MOST_DEGREES && x % ROUND_DEGREES == 0.0;
    if !angles().all(|(_, number)| is_round(number.value)) {
        return;
    }
    let Some((field, number)) = angles().find(|(_, number)| number.value.abs() >= LEAST_DEGREES)
    else {
        return;
    };
    let degrees = number.value;
    let help = if field.language.computes {
        format!("write `\"{degrees} deg\"`, or `\"{degrees} rad\"` for radians")
    } else {
        let radians = degrees.to_radians();
        format!("write `{radians}`, or `\"{degrees} deg\"` with `format = 2` in `[scene]`")
    };
    findings.warning(
        const { Code::new(192) },
        field.span(),
        format!(
            "{}: `{}` is {degrees} rad, which is {} turns: it looks like degrees",
            field.subject,
            field.key,
            short(degrees / TAU)
        ),
        "in radians",
        &help,
    );
}

/// Warns of a gravity that no planet has, and of one that is that of the Earth in another unit.
pub(crate) fn gravity(field: &Field, gravity: [f64; 2], findings: &mut Findings) {
    let size = gravity[0].hypot(gravity[1]);
    let is_earth = |x: f64| (x / EARTH - 1.0).abs() <= NEAR_EARTH;
    let base = field.language.length_unit();
    let lengths = || units().filter(|(_, unit)| unit.dimension == Some(Dimension::LENGTH));
    let lengths = || lengths().map(|(name, unit)| (name, unit.to_f64()));
    let mut others = lengths().filter(|(_, metres)| *metres != 1.0);
    let own = Some(base.metres).filter(|metres| *metres != 1.0);
    // In another unit, or in metres where bare numbers are in another one.
    let (meant, why) = if let Some((name, metres)) = others.find(|(_, u)| is_earth(size * u)) {
        (Some(metres), format!("it looks like {name}/s²"))
    } else if let Some(metres) = own.filter(|metres| is_earth(size / metres)) {
        let why = format!("numbers without a unit are in {}/s² here", base.name);
        (Some(1.0 / metres), why)
    } else if size > LARGEST_GRAVITY {
        (None, "more than on any planet".to_owned())
    } else {
        return;
    };
    let help = match meant {
        Some(factor) => {
            let [x, y] = gravity.map(|g| short(g * factor / base.metres));
            format!("write `gravity = [{x}, {y}]`")
        }
        None => format!("write it in {}/s²", base.name),
    };
    findings.warning(
        const { Code::new(193) },
        field.span(),
        format!(
            "{}: `{}` is {} m/s², {} times that of the Earth: {why}",
            field.subject,
            field.key,
            short(size),
            short(size / EARTH)
        ),
        "in another unit?",
        &help,
    );
}

/// Warns of rows that are farther apart than the run is long. A run of no time is a start with its
/// reactions.
pub(crate) fn output_step(step: &Field, [each, end]: [f64; 2], findings: &mut Findings) {
    if !(each > end && end > 0.0) {
        return;
    }
    findings.warning(
        const { Code::new(197) },
        step.span(),
        format!(
            "{}: `{}` is {each} s, and the run ends after {end} s: only its start and its end are written",
            step.subject, step.key
        ),
        "longer than the run",
        "write a shorter one, or leave it out for 200 steps",
    );
}

/// The unit of lengths without one.
#[derive(Clone, Copy)]
pub(crate) struct LengthUnit {
    pub(crate) name: &'static str,
    pub(crate) metres: f64,
}

impl LengthUnit {
    /// A moment of inertia, given in kg·m².
    fn inertia(self, si: f64) -> String {
        let number = short(si / self.metres.powi(2));
        format!("{number} kg·{}²", self.name)
    }
}

/// A number with four digits, as it is written in a file.
fn short(x: f64) -> String {
    let rounded: f64 = format!("{x:.3e}").parse().unwrap_or(x);
    if rounded == 0.0 || (1e-4..1e6).contains(&rounded.abs()) {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (x, expected) in [
            (0.5, "0.5"),
            (-9.80694, "-9.807"),
            (1000.0, "1000"),
            (123_456.0, "123500"),
            (1e30, "1e30"),
            (1.0 / 3.0, "0.3333"),
            (-2e-11, "-2e-11"),
            (0.0, "0"),
        ] {
            assert_eq!(short(x), expected);
        }
    }
}
