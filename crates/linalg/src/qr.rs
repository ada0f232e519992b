//! Householder QR with column pivoting by the largest remaining column *norm*. The columns that are
//! pivoted are stored contiguously.
//!
//! The rows of a row-major C are the columns of Cᵀ. The factorisation `Cᵀ·P = Q·R` therefore pivots
//! the constraints themselves and accesses only contiguous memory. The other form, `C·P = Q·R`, is
//! the same routine on the transposed storage. The crate `rank` decides ranks and tolerances. There
//! is no QR without pivoting, which gives no information about the rank.
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

/// Factorisation `A·P = Q·R` with `|R_00| ≥ |R_11| ≥ …`. The columns of the n×m matrix A are given
/// as m rows.
///
/// Row k of the storage contains column k of R up to and including the diagonal, then the tail of
/// the Householder vector `v_k` (whose first entry is 1). `Q = H_0·H_1·…`,
/// `H_k = I − τ_k·v_k·v_kᵀ`.
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

    /// Factors `[A, δ·I]ᵀ·P = Q·R`. The argument is an m×(n+m) matrix that contains A and zeros
    /// next to it. Only the first n rows of Q belong to columns of A in their order; the other rows
    /// of Q are permuted.
    pub(crate) fn of_damped_rows(beside_zeros: Matrix, damping: f64) -> Self {
        factor::factor_damped(beside_zeros, damping)
    }

    /// Factors `C·P = Q·R`: the *columns* of the m×n matrix `c` are pivoted. The function copies
    /// the matrix.
    pub fn of_columns(c: &Matrix) -> Self {
        factor::factor(c.transpose())
    }

    /// Returns the permutation: position k of `A·P` is column `permutation()[k]` of A.
    pub fn permutation(&self) -> &[usize] {
        &self.permutation
    }

    /// Returns the length of the factored columns, which is the order of Q.
    pub fn dimension(&self) -> usize {
        self.factors.ncols()
    }

    /// Returns the number of Householder steps, `min(n, m)`.
    pub fn steps(&self) -> usize {
        self.tau.len()
    }

    /// Returns `R_kk` for k below [`PivotedQr::steps`]. Signs are arbitrary; absolute values do not
    /// increase.
    pub fn r_diagonal(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.steps()).map(|k| self.factors[(k, k)])
    }

    /// Returns R as an upper trapezoidal matrix, `steps × m`.
    pub fn r(&self) -> Matrix {
        Matrix::from_fn(self.steps(), self.factors.nrows(), |i, j| {
            if i <= j { self.factors[(j, i)] } else { 0.0 }
        })
    }
}
