//! The null-space method: the solutions of `C·a = γ` are `a = a_p + Z·w` with C·Z = 0, and
//! `(Zᵀ·M·Z)·w = Zᵀ·(f − M·a_p)` contains no multipliers.
//!
//! With the pivoted decomposition `Cᵀ·P = [Q₁ Q₂]·R` of fixed rank r, Z = Q₂, and a_p is the
//! solution of minimum norm of the first r pivoted rows. Source: S. S. Kim, M. J. Vanderploeg, QR
//! decomposition for state space representation of constrained mechanical dynamic systems, J. Mech.
//! Trans. Autom. Des. 108 (1986) 183–188, DOI 10.1115/1.3260800.

use linalg::{Lu, Matrix, PivotedQr};

use super::{Fault, Saddle, Solver, dot};

/// Pivots below this fraction of the first pivot count as rounding errors.
const LOST: f64 = 1e-14;

/// A solver for all rows, with a fixed rank; multipliers of rows that the pivoting does not select
/// are zero.
pub struct NullSpace {
    rank: usize,
}

impl NullSpace {
    /// Creates a solver for rows of this rank.
    #[must_use]
    pub fn new(rank: usize) -> Self {
        Self { rank }
    }
}

/// Factors `Cᵀ·P = Q·R` with the fixed rank.
///
/// # Errors
/// [`Fault::RankLost`].
pub(super) fn factored(c: &Matrix, rank: usize) -> Result<PivotedQr, Fault> {
    let qr = PivotedQr::of_rows(c.clone());
    let pivot = |k: usize| qr.r_diagonal().nth(k).map_or(0.0, f64::abs);
    match rank.checked_sub(1) {
        Some(last) if pivot(last) <= LOST * pivot(0) => Err(Fault::RankLost { rank }),
        _ => Ok(qr),
    }
}

/// Updates `a ← a + Z·w` with `(Zᵀ·M·Z)·w = Zᵀ·(f − M·a)`; Z contains the last columns of Q.
///
/// # Errors
/// [`Fault::Massless`].
pub(super) fn move_freely(
    qr: &PivotedQr,
    rank: usize,
    at: &Saddle<'_>,
    a: &mut [f64],
) -> Result<(), Fault> {
    let n = a.len();
    let z = qr.q_columns(rank..n).transpose();
    let free = n - rank;
    let reduced = |i: usize, j: usize| {
        let terms = z.row(i).iter().zip(z.row(j)).zip(at.mass);
        terms.map(|((x, y), m)| x * m * y).sum::<f64>()
    };
    let mut lu = Lu::new(free);
    lu.factor(reduced).map_err(|_| Fault::Massless)?;
    let left: Vec<f64> = (0..n).map(|i| at.force[i] - at.mass[i] * a[i]).collect();
    let mut w: Vec<f64> = (0..free).map(|i| dot(z.row(i), &left)).collect();
    lu.solve(&mut w);
    for (i, w) in w.iter().enumerate() {
        for (a, z) in a.iter_mut().zip(z.row(i)) {
            *a += w * z;
        }
    }
    Ok(())
}

impl Solver for NullSpace {
    fn solve(&mut self, at: &Saddle<'_>, a: &mut [f64], lambda: &mut [f64]) -> Result<(), Fault> {
        let (rank, qr) = (self.rank, factored(at.c, self.rank)?);
        let rows = &qr.permutation()[..rank];
        // Solves R₁ᵀ·y = γ for the first rows, and computes a_p = Q₁·y.
        let mut y: Vec<f64> = rows.iter().map(|&i| at.gamma[i]).collect();
        qr.solve_r_transpose(&mut y);
        a.fill(0.0);
        a[..rank].copy_from_slice(&y);
        qr.q_mul(a);
        move_freely(&qr, rank, at, a)?;
        // Solves R₁·λ = Q₁ᵀ·(f − M·a).
        let mut left: Vec<f64> = (0..a.len())
            .map(|i| at.force[i] - at.mass[i] * a[i])
            .collect();
        qr.q_transpose_mul(&mut left);
        left.truncate(rank);
        qr.solve_r(&mut left);
        lambda.fill(0.0);
        for (&i, l) in rows.iter().zip(&left) {
            lambda[i] = *l;
        }
        Ok(())
    }
}
