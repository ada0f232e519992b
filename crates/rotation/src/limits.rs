//! Table of limits: all values in this crate that its authors chose. Each comment states the
//! meaning, the unit, the effects of a value that is too small or too large, and the test that
//! fails then. The test file `tests/all/limits.rs` reads this table.

/// Cosine of the largest angle, 3 rad, for which the function returns a value. At half a revolution
/// the rotation vector changes its sign. Unit: 1. Too small: a step may jump over half a
/// revolution, and a change of sign of the force is not detected. Too large: bodies are rejected at
/// smaller rotations. Test: `a_bushing_is_refused_at_half_a_turn`.
pub(crate) const LEAST_COSINE: f64 = -0.989_992_496_600_445_4;

/// Largest sin² ½θ for which the series is used; above it the closed form loses no digits. Unit: 1.
/// Too small: the closed form suffers from cancellation. Too large: the computation takes longer.
/// Test: `series_and_closed_form_agree`.
pub(crate) const SERIES_UP_TO: f64 = 0.25;
