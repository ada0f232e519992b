//! The weights of the norms. The tolerance is adapted to an error estimate of order 3 and to the
//! noise of rounding.

use crate::options::Tolerance;

/// If a tolerance is below this fraction of the state, the fraction replaces the tolerance. The
/// reason is that stiff forces amplify the rounding of the state to noise.
const NOISE: f64 = 100.0 * f64::EPSILON;
/// Relative tolerance above which weights are not enlarged.
const LOOSE: f64 = 1e-3;
/// Largest error of Newton's method as a fraction of the permitted error. The error is smaller for
/// small tolerances.
const LARGEST_PART: f64 = 0.03;

/// Writes the weights. Returns the fraction of the weights that is permitted as error of Newton's
/// method.
///
/// If an estimate of order 3 (local error h⁴) is limited to 0.1·ρ^(2/3), the local error h⁶ of the
/// step is about ρ. Therefore the tolerance is multiplied by 0.1·ρ^(−1/3). Here ρ is the smallest
/// relative tolerance of all components. For a component with a larger `rtol`, ρ is this `rtol`.
pub(super) fn set_scale(tolerance: &Tolerance, y0: &[f64], y1: &[f64], scale: &mut [f64]) -> f64 {
    tolerance.scale(y0, y1, scale);
    let mut sharpest = LOOSE;
    for ((scale, y0), y1) in scale.iter_mut().zip(y0).zip(y1) {
        let size = y0.abs().max(y1.abs());
        *scale = scale.max(NOISE * size);
        if size > 0.0 {
            sharpest = sharpest.min(*scale / size);
        }
    }
    for (i, scale) in scale.iter_mut().enumerate() {
        *scale *= stretch(tolerance.rtol(i).max(sharpest));
    }
    (sharpest * stretch(sharpest)).sqrt().min(LARGEST_PART)
}

fn stretch(rtol: f64) -> f64 {
    0.1 * rtol.min(LOOSE).powf(-1.0 / 3.0)
}
