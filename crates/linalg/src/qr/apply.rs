//! Uses of the factors: products with Q and Qᵀ, explicit columns of Q, and triangular solves with
//! leading blocks of R.

use super::{PivotedQr, factor};
use crate::{Matrix, kernels};

impl PivotedQr {
    /// Computes `x ← Q·x`.
    ///
    /// # Panics
    /// Panics if the length of `x` is not [`PivotedQr::dimension`].
    #[inline(always)]
    pub fn q_mul(&self, x: &mut [f64]) {
        self.assert_dimension(x);
        for k in (0..self.steps()).rev() {
            factor::apply(self.tau[k], &self.factors.row(k)[k..], &mut x[k..]);
        }
    }

    /// Computes `x ← Qᵀ·x`.
    ///
    /// # Panics
    /// Panics if the length of `x` is not [`PivotedQr::dimension`].
    pub fn q_transpose_mul(&self, x: &mut [f64]) {
        self.assert_dimension(x);
        for k in 0..self.steps() {
            factor::apply(self.tau[k], &self.factors.row(k)[k..], &mut x[k..]);
        }
    }

    /// Returns Q as an n×n matrix.
    pub fn q(&self) -> Matrix {
        self.q_columns(0..self.dimension())
    }

    /// Returns the columns `range` of Q. The first r columns of Q span range(A), and the last n − r
    /// columns span its complement.
    ///
    /// # Panics
    /// Panics if the range ends beyond [`PivotedQr::dimension`].
    pub fn q_columns(&self, range: std::ops::Range<usize>) -> Matrix {
        let n = self.dimension();
        assert!(range.end <= n, "columns {range:?} of a Q of order {n}");
        let mut columns = Matrix::zeros(range.len(), n);
        for (l, k) in range.enumerate() {
            columns[(l, k)] = 1.0;
            self.q_mul(columns.row_mut(l));
        }
        columns.transpose()
    }

    /// Computes `x ← R₁₁⁻¹·x` with the leading block of R of order `x.len()`. Zero pivots give
    /// infinities.
    ///
    /// # Panics
    /// Panics if `x` is longer than [`PivotedQr::steps`].
    pub fn solve_r(&self, x: &mut [f64]) {
        self.assert_leading(x);
        for k in (0..x.len()).rev() {
            let column = self.factors.row(k);
            x[k] /= column[k];
            let x_k = x[k];
            if x_k != 0.0 {
                kernels::axpy(-x_k, &column[..k], &mut x[..k]);
            }
        }
    }

    /// Computes `x ← R₁₁⁻ᵀ·x` with the leading block of R of order `x.len()`. Zero pivots give
    /// infinities.
    ///
    /// # Panics
    /// Panics if `x` is longer than [`PivotedQr::steps`].
    pub fn solve_r_transpose(&self, x: &mut [f64]) {
        self.assert_leading(x);
        self.solve_r_transpose_from(0, x);
    }

    /// Works like [`Self::solve_r_transpose`], if the entries of x before `first` are zero.
    #[inline(always)]
    fn solve_r_transpose_from(&self, first: usize, x: &mut [f64]) {
        for k in first..x.len() {
            let column = self.factors.row(k);
            x[k] = (x[k] - kernels::dot(&column[first..k], &x[first..k])) / column[k];
        }
    }

    fn assert_dimension(&self, x: &[f64]) {
        assert_eq!(x.len(), self.dimension(), "vector for a Q of this order");
    }

    fn assert_leading(&self, x: &[f64]) {
        assert!(
            x.len() <= self.steps(),
            "leading block of order {} of an R with {} rows",
            x.len(),
            self.steps()
        );
    }

    /// Returns `(C⁺)ᵀ` (r×n) of independent rows C (r×n, r ≤ n) factored by [`PivotedQr::of_rows`]:
    /// `C⁺ = Q·R⁻ᵀ·Pᵀ`, so that `C⁺·b` is the smallest solution of `C·x = b`. Row i is `C⁺·e_i`.
    ///
    /// ```
    /// use pfaff_linalg::{Matrix, PivotedQr};
    /// let qr = PivotedQr::of_rows(Matrix::from_rows(&[[3.0, 4.0]]));
    /// let inverse = qr.transposed_pseudo_inverse();
    /// assert!((inverse[(0, 0)] - 0.12).abs() < 1e-16 && (inverse[(0, 1)] - 0.16).abs() < 1e-16);
    /// ```
    #[must_use]
    pub fn transposed_pseudo_inverse(&self) -> Matrix {
        let (n, r) = (self.dimension(), self.steps());
        let mut inverse = Matrix::zeros(r, n);
        kernels::vectorised(
            #[inline(always)]
            || {
                for (k, &row) in self.permutation().iter().take(r).enumerate() {
                    let x = inverse.row_mut(row);
                    // R⁻ᵀ·e_k is zero before entry k.
                    x[k] = 1.0;
                    self.solve_r_transpose_from(k, &mut x[..r]);
                    self.q_mul(x);
                }
            },
        );
        inverse
    }

    /// Returns `‖R₁₁⁻¹‖` (Frobenius norm), which is `‖C⁺‖` of independent rows C. The inverse of
    /// the result is a lower bound on the smallest singular value of C. The result is infinite for
    /// rows with a zero pivot.
    ///
    /// ```
    /// use pfaff_linalg::{Matrix, PivotedQr};
    /// let qr = PivotedQr::of_rows(Matrix::from_rows(&[[2.0, 0.0], [0.0, 0.5]]));
    /// assert!((qr.inverse_norm() - 0.5_f64.hypot(2.0)).abs() < 1e-15);
    /// ```
    #[must_use]
    pub fn inverse_norm(&self) -> f64 {
        let r = self.steps();
        let mut x = vec![0.0; r];
        let mut sum = 0.0;
        for k in 0..r {
            x.fill(0.0);
            x[k] = 1.0;
            self.solve_r_transpose_from(k, &mut x);
            sum += kernels::dot(&x[k..], &x[k..]);
        }
        if sum.is_nan() {
            f64::INFINITY
        } else {
            sum.sqrt()
        }
    }
}
