//! The directions in which multipliers are free.

use std::borrow::Cow;

use linalg::{Matrix, PivotedQr};

use crate::limits::CHOICE_SOLVES;
use crate::matrices::Solvability;

/// The directions in which multipliers are free.
pub(crate) struct FreeMultipliers<'a> {
    /// Orthonormal basis of the left null space of the equilibrated rows, m × p.
    pub(crate) z: Cow<'a, Matrix>,
    /// Row factors of the equilibration, D_r.
    pub(crate) row_factor: Cow<'a, [f64]>,
    /// Largest coefficient that counts as zero.
    pub(crate) tolerance: f64,
}

impl<'a> FreeMultipliers<'a> {
    /// Returns the free directions of a matrix.
    pub(crate) fn of(solvability: &'a Solvability) -> Self {
        Self {
            z: Cow::Borrowed(solvability.null_space()),
            row_factor: Cow::Borrowed(solvability.row_factors()),
            tolerance: rank::support_tolerance(solvability.decision()),
        }
    }

    /// Returns `λ − Z·(Z_D)⁻¹·λ_D`. The result is the solution that is exactly zero in the rows D,
    /// which determine y.
    pub(crate) fn eliminated(&self, lambda: &[f64], rows: &[usize]) -> Vec<f64> {
        let qr = PivotedQr::of_columns(&self.z.select_rows(rows));
        let mut lambda = lambda.to_vec();
        for _ in 0..CHOICE_SOLVES {
            let own = rows.iter().map(|&i| lambda[i] / self.row_factor[i]);
            let mut y: Vec<f64> = own.collect();
            qr.q_transpose_mul(&mut y);
            qr.solve_r(&mut y);
            self.leave(&mut lambda, qr.permutation(), &y);
        }
        rows.iter().for_each(|&i| lambda[i] = 0.0);
        lambda
    }

    /// Computes `λ − Z·y` for these columns of Z.
    pub(super) fn leave(&self, lambda: &mut [f64], columns: &[usize], y: &[f64]) {
        for (i, l) in lambda.iter_mut().enumerate() {
            let terms = columns.iter().zip(y);
            let change: f64 = terms.map(|(&k, y)| self.z[(i, k)] * y).sum();
            *l -= self.row_factor[i] * change;
        }
    }
}

impl Solvability {
    /// Returns one dependency of the rows of the matrix for each redundant row. A dependency has a
    /// coefficient for each row.
    #[must_use]
    pub fn dependencies(&self) -> Vec<Vec<f64>> {
        let free = FreeMultipliers::of(self);
        let column = |k: usize| {
            let rows = free.row_factor.iter().enumerate();
            rows.map(|(i, factor)| factor * free.z[(i, k)]).collect()
        };
        (0..free.z.ncols()).map(column).collect()
    }
}
