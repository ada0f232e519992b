//! Random combinations of the left null space, W = Z·Ω, in place of the p columns of Z.
//!
//! The rows of QᵀC that are zero give an orthonormal basis `Z = Q·[0; I]` of the left null space; Z
//! is never formed. Let Ω have k random columns with mean zero and variance 1/k, and
//! `W = Q·[0; Ω]`. For any group J of at most k rows, the following holds with probability one:
//! `W_J = 0` iff `Z_J = 0`, `rank W_J = rank Z_J`, and both have the same left null space. The norm
//! of a row of W estimates the norm of the same row of Z.

use super::factor::SparseQr;
use super::random;
use super::reflectors::Lanes;
use crate::limits::REFLECTORS_WIDTH;
use linalg::Matrix;
use linalg::SparseMatrix;

/// Parameters of the random combinations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sketch {
    /// Number of combinations k. The number of combinations must be at least the number of rows of
    /// the largest analysed group, with a few more so that failures are improbable.
    pub columns: usize,
    /// Seed of the random numbers.
    pub seed: u64,
}

impl Default for Sketch {
    /// The default is eight combinations, for joints of up to four rows.
    fn default() -> Self {
        Self {
            columns: REFLECTORS_WIDTH,
            seed: 1,
        }
    }
}

/// Computes W, and ‖Cᵀ·W‖ in the Frobenius norm, which estimates ‖Cᵀ·Z‖.
pub(super) fn sketch(qr: &SparseQr, c: &SparseMatrix, wanted: Sketch) -> (Matrix, f64) {
    let (m, k) = (c.nrows(), wanted.columns.max(1));
    let mut w = Matrix::zeros(m, k);
    let mut residual = 0.0;
    let scale = (k as f64).sqrt().recip();
    for first in (0..k).step_by(REFLECTORS_WIDTH) {
        let width = REFLECTORS_WIDTH.min(k - first);
        let mut x = random::uniform(m, wanted.seed, first as u64);
        for (x, is_live) in x.iter_mut().zip(&qr.is_live) {
            for (l, x) in x.iter_mut().enumerate() {
                *x *= if *is_live || l >= width { 0.0 } else { scale };
            }
        }
        qr.q.apply(&mut x);
        for (i, x) in x.iter().enumerate() {
            w.row_mut(i)[first..first + width].copy_from_slice(&x[..width]);
        }
        residual += square_of_product(c, &x);
    }
    (w, residual.sqrt())
}

/// Returns ‖Cᵀ·X‖².
fn square_of_product(c: &SparseMatrix, x: &[Lanes]) -> f64 {
    let mut product = vec![[0.0; REFLECTORS_WIDTH]; c.ncols()];
    for (i, x) in x.iter().enumerate() {
        for (j, c_ij) in c.entries(i) {
            for (p, x) in product[j].iter_mut().zip(x) {
                *p += c_ij * x;
            }
        }
    }
    product.as_flattened().iter().map(|p| p * p).sum()
}
