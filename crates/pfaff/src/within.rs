//! Starts with small constraint violations, and the stated tolerance that would explain them.

use dynamics::{MotionError, RowChoice, prepare};
use model::start::{Misfit, scene_size};
use model::{Mechanism, StartError, System, Tolerance};
use scene::Scene;
use solvability::{ConstraintLevel, ONE_PART};

/// Largest violation of an inaccurate start, as a fraction of the size. A start with a larger
/// violation is wrong.
const SMALL: f64 = 1e-2;

/// Tolerances that are tried, as multiples of the violation. Data of several joints may contribute
/// to the violation, and levers may amplify errors of the data.
const TRIED: [f64; 4] = [1.0, 3.0, 10.0, 30.0];

/// Returns the largest of these violations (m), with angles multiplied by the size of the
/// mechanism.
pub(crate) fn missed(misfits: &[Misfit], size: f64) -> f64 {
    let each = misfits.iter().map(|m| m.distance.max(m.angle * size));
    each.fold(0.0, f64::max)
}

/// Returns a copy of the mechanism. Tolerances are tried with the copy if the mechanism cannot be
/// prepared. Returns `None` if the mechanism states a tolerance, or if it is so large that the
/// trials take long.
pub(crate) fn spare(mechanism: &Mechanism) -> Option<Mechanism> {
    let is_tried = !mechanism.has_tolerances() && mechanism.layout().rows() <= ONE_PART;
    is_tried.then(|| mechanism.clone())
}

/// Returns the advice to state a tolerance, if rows have small violations and the mechanism can be
/// prepared with one of the tried tolerances.
pub(crate) fn advice(
    spare: Option<&Mechanism>,
    scene: &Scene,
    rows: &RowChoice,
    error: &MotionError,
) -> Option<String> {
    let spare = spare?;
    let (described, _) = spare.described_state();
    let size = scene_size(spare, &described);
    let missed = match error {
        MotionError::Start(StartError::NoAssembly { misfits, .. }) => missed(misfits, size),
        MotionError::Contradiction(c) if c.level == ConstraintLevel::Position => match c.unit {
            "rad" => c.size * size,
            _ => c.size,
        },
        _ => return None,
    };
    let tried = TRIED.into_iter().map(|factor| rounded_up(factor * missed));
    let small = tried.filter(|length| *length > 0.0 && *length <= SMALL * size);
    let mut works = small.filter_map(|length| {
        let mut mechanism = spare.clone();
        let stated = Tolerance {
            length: Some(length),
            angle: None,
        };
        mechanism.set_tolerance(stated).ok()?;
        let prepared = prepare(mechanism, &scene.start, rows).ok()?;
        let mobility = prepared.mechanism.layout().n_v - prepared.decision.rank;
        Some((length, prepared.decision.redundancy, mobility))
    });
    let (length, redundancy, mobility) = works.next()?;
    Some(format!(
        "if the dimensions are not more accurate: with `tolerance = {length:e}` (m) in `[scene]`, or `--tolerance {length:e}`, \
         the mechanism can be assembled, with redundancy {redundancy} and mobility {mobility}"
    ))
}

/// Rounds a length up to one digit: 1, 2 or 5.
fn rounded_up(length: f64) -> f64 {
    let ten = 10.0_f64.powf(length.log10().floor());
    let digit = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .find(|d| d * ten >= length);
    let text = format!("{:.0e}", digit.unwrap_or(10.0) * ten);
    text.parse().unwrap_or(length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tolerances_have_one_digit() {
        for (length, expected) in [(3.1e-4, 5e-4), (1e-3, 1e-3), (7e-9, 1e-8), (2.5, 5.0)] {
            assert_eq!(rounded_up(length), expected);
        }
    }
}
