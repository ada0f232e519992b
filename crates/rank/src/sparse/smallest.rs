//! A lower bound on the smallest singular value of the live columns. Heath's rule does not provide
//! such a bound.
//!
//! Let `A = (R₁₁ᵀ·R₁₁)⁻¹`. The largest eigenvalue of A is `1/σ²`, with unit eigenvector u. Any x
//! satisfies `‖A^q·x‖ ≥ σ^(−2q)·|uᵀx|`, hence `σ ≥ (|uᵀx| / ‖A^q·x‖)^(1/2q)`. For a random x the
//! product `uᵀx` is below ε with a probability of at most 0.82·ε. The probability that all vectors
//! of a batch are below ε is the corresponding power, which determines ε.
//!
//! Source: J. D. Dixon, Estimating extremal eigenvalues and condition numbers of matrices, SIAM J.
//! Numer. Anal. 20 (1983) 812–814, here with a bound that does not need the norm of x.

use super::random::{self, DENSITY};
use super::reflectors::Lanes;
use super::trapezoid::Trapezoid;
use crate::limits::{FAILURE, REFLECTORS_WIDTH, SOLVES};

/// A number of a random stream that the sketch does not use.
const STREAM: u64 = u64::MAX;

/// Returns a lower bound on σ_r of R₁₁, with a probability of failure of 10⁻⁹. The bound is
/// infinite for rank 0, and 0 if no bound is found. `n` is the number of columns of the factored
/// matrix.
pub(super) fn smallest_singular_value(r: &Trapezoid, n: usize, seed: u64) -> f64 {
    if r.rank() == 0 {
        return f64::INFINITY;
    }
    let mut x = random::uniform(n, seed, STREAM);
    r.clear_dead(&mut x);
    // The logarithms are summed, because the powers of 1/σ in ‖A^q·x‖ overflow.
    let mut logarithm = [0.0_f64; REFLECTORS_WIDTH];
    for _ in 0..SOLVES {
        r.solve_normal(&mut x);
        let norms = norms(&x);
        for l in 0..REFLECTORS_WIDTH {
            logarithm[l] += norms[l].ln();
        }
        for x in &mut x {
            (0..REFLECTORS_WIDTH).for_each(|l| x[l] /= norms[l]);
        }
    }
    let epsilon = FAILURE.powf(1.0 / REFLECTORS_WIDTH as f64) / DENSITY;
    let largest = logarithm.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let bound = ((epsilon.ln() - largest) / f64::from(2 * SOLVES)).exp();
    if logarithm.iter().all(|l| l.is_finite()) {
        bound
    } else {
        0.0
    }
}

/// Returns the norm of each vector.
pub(super) fn norms(x: &[Lanes]) -> Lanes {
    let mut squares = [0.0; REFLECTORS_WIDTH];
    for x in x {
        (0..REFLECTORS_WIDTH).for_each(|l| squares[l] += x[l] * x[l]);
    }
    squares.map(f64::sqrt)
}
