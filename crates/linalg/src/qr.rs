//! Householder QR with column pivoting by largest remaining column *norm*, for matrices stored by
//! the columns that are pivoted.
//!
//! The rows of a row-major C are the columns of Cᵀ. Factoring `Cᵀ·P = Q·R` therefore pivots the
//! constraints themselves and touches contiguous memory only; the other form, `C·P = Q·R`, is the
//! same routine on the transposed storage. Ranks and tolerances are in the crate `rank`. There is
//! no QR without pivoting, which gives no information about the rank.
//!
//! Source: P. Businger, G. H. Golub, Linear least squares solutions by Householder transformations,
//! Numer. Math. 7 (1965) 269–276; norm downdating after Z. Drmač, Z. Bujanović, On the failure of
//! rank-revealing QR factorization software, ACM TOMS 35 (2008) 12.

mod apply;
mod basis;
mod factor;
#[cfg(test)]
mod tests;

use crate::Matrix;

pub use basis::RowBasis;
pub(crate) use factor::reflect;

/// `A·P = Q·R` with `|R_00| ≥ |R_11| ≥ …`, the columns of the n×m matrix A given as m rows.
///
/// Storage: row k holds column k of R up to and with the diagonal, then the tail of the Householder
/// vector `v_k` (whose first entry is 1). `Q = H_0·H_1·…`, `H_k = I − τ_k·v_k·v_kᵀ`.
///
/// ```
/// use pfaff_linalg::{Matrix, PivotedQr};
/// // Two parallel constraints and a longer one: the longest comes first.
/// let c = Matrix::from_rows(&[[1.0, 0.0], [2.0, 0.0], [0.0, 5.0]]);
/// let qr = PivotedQr::of_rows(c);
/// assert_eq!(qr.permutation(), [2, 1, 0]);
/// assert_eq!(qr.r_diagonal().map(f64::abs).collect::<Vec<_>>(), [5.0, 2.0]);
/// ```
#[derive(Debug, Clone)]
pub struct PivotedQr {
    factors: Matrix,
    tau: Vec<f64>,
    permutation: Vec<usize>,
}

impl PivotedQr {
    /// Factors `Cᵀ·P = Q·R`: the *rows* of the m×n matrix `c` are pivoted. Takes ownership of the
    /// storage.
    pub fn of_rows(c: Matrix) -> Self {
        factor::factor(c)
    }

    /// Factors `[A, δ·I]ᵀ·P = Q·R` for an m×(n+m) matrix that holds A and, beside it, zeros. Only
    /// the first n rows of Q belong to columns of A in their order; the others are permuted.
    pub(crate) fn of_damped_rows(beside_zeros: Matrix, damping: f64) -> Self {
        factor::factor_damped(beside_zeros, damping)
    }

    /// Factors `C·P = Q·R`: the *columns* of the m×n matrix `c` are pivoted. Copies.
    pub fn of_columns(c: &Matrix) -> Self {
        factor::factor(c.transpose())
    }

    /// Position k of `A·P` is column `permutation()[k]` of A.
    pub fn permutation(&self) -> &[usize] {
        &self.permutation
    }

    /// Length of the factored columns, the order of Q.
    pub fn dimension(&self) -> usize {
        self.factors.ncols()
    }

    /// Number of Householder steps, `min(n, m)`.
    pub fn steps(&self) -> usize {
        self.tau.len()
    }

    /// `R_kk` for k below [`PivotedQr::steps`]. Signs are arbitrary; absolute values do not
    /// increase.
    pub fn r_diagonal(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.steps()).map(|k| self.factors[(k, k)])
    }

    /// R as an upper trapezoidal matrix, `steps × m`.
    pub fn r(&self) -> Matrix {
        Matrix::from_fn(self.steps(), self.factors.nrows(), |i, j| {
            if i <= j { self.factors[(j, i)] } else { 0.0 }
        })
    }
}
