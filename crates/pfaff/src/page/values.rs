//! Values of reactions at the frames, if the model determines them.

use model::ConstraintId;
use report::Frame;
use solvability::Value;

use super::run_page::RunPage;

/// A force below this fraction of the largest force counts as rounding.
const NOISE: f64 = 1e-12;

/// Returns the values of a component, or of the named component, at the frames. Values that are not
/// determined are NaN.
pub(super) fn determined(page: &RunPage<'_>, id: ConstraintId, name: &'static str) -> Vec<f64> {
    let own = page.stretches.and_then(|s| s.reactions.get(id.0));
    let space = page.mechanism.space();
    let frames = page.recording.frames.iter();
    let values = frames.map(|frame| {
        let number = frame.reactions.get(id.0);
        let number = number.map_or(f64::NAN, |own| report::reaction_component(own, space, name));
        let value = own.map_or_else(
            || Value::unique(number),
            |own| own.value(name, frame.t, number),
        );
        value.determined().unwrap_or(f64::NAN)
    });
    values.collect()
}

/// Returns the size of a force that counts as rounding (N). Torques about reference points are
/// compared with the same number.
pub(super) fn noise(frames: &[Frame]) -> f64 {
    NOISE * largest_force(frames)
}

fn largest_force(frames: &[Frame]) -> f64 {
    let all = frames.iter().flat_map(|f| &f.reactions);
    largest(all.flat_map(|r| r.force).filter(|x| x.is_finite()))
}

/// Returns the largest absolute value. Returns zero if there are no values.
pub(super) fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |a, x| if x.abs() > a { x.abs() } else { a })
}
