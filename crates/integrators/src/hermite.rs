//! Dense output from states and derivatives at both ends of a step: a cubic (local error O(h⁴)) for nothing, continuously differentiable over
//! the steps, projected or not.

use crate::method::Ends;

/// Component `i` of the cubic at θ.
pub(crate) fn cubic(ends: &Ends<'_>, theta: f64, i: usize) -> f64 {
    let (x, rest) = (theta, 1.0 - theta);
    let slopes = x * rest * rest * ends.f0[i] - x * x * rest * ends.f1[i];
    let delta = x * x * (3.0 - 2.0 * x) * (ends.y1[i] - ends.y0[i]);
    ends.y0[i] + (delta + ends.trial.h * slopes)
}
