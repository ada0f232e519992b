//! Solves with all rows by a complete orthogonal decomposition of fixed rank. The accelerations
//! satisfy contradicting rows in the sense of least squares, and the multipliers have minimum norm.
//!
//! With `Cᵀ·P = [Q₁ Q₂]·[R; ≈0]`, R r × m, and `Rᵀ·P' = Q'·R'`, the pseudo-inverse is
//! `C⁺ = Q₁·P'·R'⁻¹·Q'ᵀ·Pᵀ`. Source: G. H. Golub, C. F. Van Loan, Matrix Computations, section
//! 5.4.7; F. E. Udwadia, R. E. Kalaba, Proc. R. Soc. A 439 (1992) 407–410, DOI
//! 10.1098/rspa.1992.0158.

use linalg::{Matrix, PivotedQr};

use super::null_space::{factored, move_freely};
use super::{Fault, Saddle, Solver};

/// A solver for all rows, with a fixed rank.
pub struct MinimumNorm {
    rank: usize,
}

impl MinimumNorm {
    /// Creates a solver for rows of this rank.
    #[must_use]
    pub fn new(rank: usize) -> Self {
        Self { rank }
    }
}

impl Solver for MinimumNorm {
    fn solve(&mut self, at: &Saddle<'_>, a: &mut [f64], lambda: &mut [f64]) -> Result<(), Fault> {
        let (rank, qr) = (self.rank, factored(at.c, self.rank)?);
        let (m, r) = (at.c.nrows(), qr.r());
        let rows = Matrix::from_fn(m, rank, |i, j| r[(j, i)]);
        let second = PivotedQr::of_columns(&rows);

        // Solves R'·y = Q'ᵀ·Pᵀ·γ and a_p = Q₁·P'·y.
        let mut y: Vec<f64> = qr.permutation().iter().map(|&i| at.gamma[i]).collect();
        second.q_transpose_mul(&mut y);
        y.truncate(rank);
        second.solve_r(&mut y);
        a.fill(0.0);
        for (&k, y) in second.permutation().iter().zip(&y) {
            a[k] = *y;
        }
        qr.q_mul(a);
        move_freely(&qr, rank, at, a)?;

        // Solves R'ᵀ·w = P'ᵀ·Q₁ᵀ·(f − M·a) and λ = P·Q'·w.
        let mut left: Vec<f64> = (0..a.len())
            .map(|i| at.force[i] - at.mass[i] * a[i])
            .collect();
        qr.q_transpose_mul(&mut left);
        let mut w: Vec<f64> = second.permutation().iter().map(|&k| left[k]).collect();
        second.solve_r_transpose(&mut w);
        w.resize(m, 0.0);
        second.q_mul(&mut w);
        for (&i, w) in qr.permutation().iter().zip(&w) {
            lambda[i] = *w;
        }
        Ok(())
    }
}
