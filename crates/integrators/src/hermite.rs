//! Dense output from states and derivatives at both ends of a step: a cubic (local error O(h⁴)) for nothing, a quartic (O(h⁵)) with one
//! extra evaluation. Both are continuously differentiable over the steps, projected or not.

use crate::method::Ends;

/// Place of the extra derivative; not ½, where the quartic term has none.
pub(crate) const PLACE: f64 = 0.25;

/// Component `i` of the cubic at θ.
pub(crate) fn cubic(ends: &Ends<'_>, theta: f64, i: usize) -> f64 {
    let (x, rest) = (theta, 1.0 - theta);
    let slopes = x * rest * rest * ends.f0[i] - x * x * rest * ends.f1[i];
    let delta = x * x * (3.0 - 2.0 * x) * (ends.y1[i] - ends.y0[i]);
    ends.y0[i] + (delta + ends.trial.h * slopes)
}

/// Component `i` of the derivative of the cubic at θ, with respect to t.
pub(crate) fn cubic_derivative(ends: &Ends<'_>, theta: f64, i: usize) -> f64 {
    let (x, rest) = (theta, 1.0 - theta);
    let slopes = rest * (1.0 - 3.0 * x) * ends.f0[i] - x * (2.0 - 3.0 * x) * ends.f1[i];
    6.0 * x * rest * (ends.y1[i] - ends.y0[i]) / ends.trial.h + slopes
}

/// The polynomial of degree 4 that vanishes with its derivative at both ends and has the derivative 1 at [`PLACE`].
pub(crate) fn quartic_weight(theta: f64) -> f64 {
    const SLOPE: f64 = 2.0 * PLACE * (1.0 - PLACE) * (1.0 - 2.0 * PLACE);
    let bump = theta * (1.0 - theta);
    bump * bump / SLOPE
}
