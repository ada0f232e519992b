//! The table of limits: every number of this crate that somebody chose. Each says what it is, in
//! which unit, what breaks if it is wrong (`Less`: if it were smaller, `More`: if it were larger),
//! and which test fails then. `tests/all/limits.rs` reads it.

/// Cosine of the largest angle, 3 rad, at which there is a value. At half a turn the rotation
/// vector changes its sign.
/// Unit: 1. Less: a step may jump over half a turn, where a force changes its sign unseen. More:
/// bodies are refused that turn less far. Test: `a_bushing_is_refused_at_half_a_turn`.
pub(crate) const LEAST_COSINE: f64 = -0.989_992_496_600_445_4;

/// sin² ½θ up to which the series is summed: beyond it the closed form loses no digits.
/// Unit: 1. Less: cancellation in the closed form. More: time. Test:
/// `series_and_closed_form_agree`.
pub(crate) const SERIES_UP_TO: f64 = 0.25;
