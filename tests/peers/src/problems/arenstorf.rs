//! The Arenstorf orbit: restricted three-body problem, Hairer, Nørsett, Wanner, Solving ODEs I,
//! II.0. The orbit is closed.

use crate::problem::Problem;

const MU: f64 = 0.012277471;

/// Initial state `[x, y, x', y']`.
pub const START: [f64; 4] = [0.994, 0.0, 0.0, -2.001_585_106_379_082_5];

/// Period of the orbit.
pub const PERIOD: f64 = 17.065_216_560_157_964;

/// The equations of motion in the rotating frame.
pub struct Arenstorf;

impl Problem<4> for Arenstorf {
    #[inline]
    fn rhs(&self, _t: f64, y: &[f64; 4], dy: &mut [f64; 4]) {
        let (to_earth, to_moon) = (y[0] + MU, y[0] - (1.0 - MU));
        let s1 = to_earth * to_earth + y[1] * y[1];
        let s2 = to_moon * to_moon + y[1] * y[1];
        let (d1, d2) = ((1.0 - MU) / (s1 * s1.sqrt()), MU / (s2 * s2.sqrt()));
        dy[0] = y[2];
        dy[1] = y[3];
        dy[2] = y[0] + 2.0 * y[3] - d1 * to_earth - d2 * to_moon;
        dy[3] = y[1] - 2.0 * y[2] - d1 * y[1] - d2 * y[1];
    }
}

/// Largest distance from the start, to which the exact solution returns.
pub fn error(y: &[f64; 4]) -> f64 {
    let d = y.iter().zip(&START).map(|(a, b)| (a - b).abs());
    d.fold(0.0, f64::max)
}
