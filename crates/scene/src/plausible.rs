//! Warnings about numbers that are valid, but are probably typing errors or in a wrong unit. The
//! thresholds are between the values for real machines and the values that result from a wrong
//! unit. To use such a number intentionally, the author of the scene suppresses the warning by its
//! code (`silence`).
//!
//! A check that needs only one value is done when the value is read. `angles` checks angles,
//! `mechanism` contains the checks that need the mechanism, and `forces` checks forces.

pub(crate) mod angles;
pub(crate) mod forces;
mod mechanism;

use model::codes::Code;
use model::space::norm;
use model::words::{quantity, rounded};
use model::{BodyRef, Marker};

use crate::dimension::Dimension;
use crate::expression::units;
use crate::field::Field;

pub(crate) use mechanism::check;

/// Standard gravity of the Earth (m/s²).
const EARTH: f64 = 9.80665;

/// Relative difference up to which a value counts as the gravity of the Earth, because 10 m/s² is
/// also used.
const NEAR_EARTH: f64 = 0.03;

/// Largest plausible gravity (m/s²): twice the gravity of Jupiter, which has the largest gravity of
/// the planets.
const LARGEST_GRAVITY: f64 = 50.0;

/// Warns about a gravity that no planet has, and about the gravity of the Earth in a wrong unit.
pub(crate) fn gravity(field: &Field, gravity: &[f64]) {
    let size = norm(gravity);
    let is_earth = |x: f64| (x / EARTH - 1.0).abs() <= NEAR_EARTH;
    let base = field.language.length_unit();
    let lengths = || units().filter(|(_, unit)| unit.dimension == Some(Dimension::LENGTH));
    let lengths = || lengths().map(|(name, unit)| (name, unit.to_f64()));
    let mut others = lengths().filter(|(_, metres)| *metres != 1.0);
    let own = Some(base.metres).filter(|metres| *metres != 1.0);
    // The number may be in another unit, or in metres although the scene uses another unit.
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
            let meant = gravity.iter().map(|g| rounded(g * factor / base.metres));
            let meant: Vec<String> = meant.collect();
            format!("write `gravity = [{}]`", meant.join(", "))
        }
        None => format!("write it in {}/s²", base.name),
    };
    field.findings.warning(
        const { Code::new(193) },
        field.span(),
        format!(
            "{}: `{}` is {}, {} times that of the Earth: {why}",
            field.subject,
            field.key,
            quantity(size, "m/s²"),
            rounded(size / EARTH)
        ),
        "in another unit?",
        &help,
    );
}

/// Warns about an output step that is longer than the run. A run without duration computes only the
/// initial state and its reactions.
pub(crate) fn output_step(step: &Field, [each, end]: [f64; 2]) {
    if !(each > end && end > 0.0) {
        return;
    }
    step.findings.warning(
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

/// Warns about a measure between two points of one body, which is constant.
pub(crate) fn measure(field: &Field, between: [Option<usize>; 2], markers: &[Marker]) {
    let body = |k: Option<usize>| k.map_or(BodyRef::Ground, |k| markers[k].body);
    let [first, second] = between;
    if first == second || body(first) != body(second) {
        return;
    }
    field.findings.warning(
        const { Code::new(198) },
        field.span(),
        format!(
            "{}: its markers move together, with one body: it never changes",
            field.subject
        ),
        "on one body",
        "name markers of two bodies, or one marker alone to measure it from the ground",
    );
}
