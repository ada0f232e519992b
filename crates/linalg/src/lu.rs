//! LU factorisation of small square matrices with partial pivoting, for the linear systems of
//! implicit methods. The factorisation does not determine ranks, and detects only pivots that are
//! exactly zero or not finite.

use crate::kernels::{axpy, dot};

/// Factorisation `P·A = L·U` of an n×n matrix. Storage is allocated once; `factor` and `solve` do
/// not allocate memory.
///
/// ```
/// use pfaff_linalg::Lu;
/// let a = [[0.0, 2.0], [4.0, 1.0]];
/// let mut lu = Lu::new(2);
/// lu.factor(|i, j| a[i][j])?;
/// let mut x = [6.0, 11.0];
/// lu.solve(&mut x);
/// assert_eq!(x, [2.0, 3.0]);
/// # Ok::<(), pfaff_linalg::SingularPivot>(())
/// ```
#[derive(Debug, Clone)]
pub struct Lu {
    n: usize,
    /// The factor L below its unit diagonal, and the factor U on and above the diagonal; row-major.
    factors: Vec<f64>,
    /// Row i of `P·A` is row `permutation[i]` of A.
    permutation: Vec<usize>,
    /// Sign of P.
    parity: f64,
    /// Buffer of `solve`.
    right: Vec<f64>,
}

/// A determinant whose value may overflow or underflow.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Determinant {
    /// Sign: +1, −1, or 0.
    pub sign: f64,
    /// Natural logarithm of the absolute value, −∞ for zero.
    pub log: f64,
}

impl Determinant {
    /// The determinant of a singular matrix.
    pub const ZERO: Self = Self {
        sign: 0.0,
        log: f64::NEG_INFINITY,
    };

    /// Returns the value as an `f64`, which may overflow or underflow.
    pub fn value(self) -> f64 {
        self.sign * self.log.exp()
    }
}

/// A column without a pivot.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("column {column} has the pivot {pivot}, need a finite number that is not zero")]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SingularPivot {
    /// The column.
    pub column: usize,
    /// The largest remaining entry of the column.
    pub pivot: f64,
}

impl Lu {
    /// Allocates storage for n×n matrices. The initial factors are the factors of the identity
    /// matrix.
    pub fn new(n: usize) -> Self {
        let mut lu = Self {
            n,
            factors: vec![0.0; n * n],
            permutation: (0..n).collect(),
            parity: 1.0,
            right: vec![0.0; n],
        };
        for i in 0..n {
            lu.factors[i * n + i] = 1.0;
        }
        lu
    }

    /// Changes the order to n. An n above the order of [`Lu::new`] causes an allocation. The caller
    /// must call `factor` before any other method.
    pub(crate) fn resize(&mut self, n: usize) {
        self.n = n;
        self.factors.resize(n * n, 0.0);
        self.permutation.resize(n, 0);
        self.right.resize(n, 0.0);
    }

    /// Factors the matrix with entries `entry(i, j)`.
    ///
    /// # Errors
    /// [`SingularPivot`]: the matrix has no factors, and the result of `solve` is meaningless.
    pub fn factor(
        &mut self,
        mut entry: impl FnMut(usize, usize) -> f64,
    ) -> Result<(), SingularPivot> {
        let n = self.n;
        self.parity = 1.0;
        for i in 0..n {
            self.permutation[i] = i;
            for j in 0..n {
                self.factors[i * n + j] = entry(i, j);
            }
        }
        for k in 0..n {
            let size = |i: usize| self.factors[i * n + k].abs();
            let at = (k + 1..n).fold(k, |at, i| if size(i) > size(at) { i } else { at });
            let pivot = self.factors[at * n + k];
            if pivot == 0.0 || !pivot.is_finite() {
                return Err(SingularPivot { column: k, pivot });
            }
            self.permutation.swap(k, at);
            let (upper, lower) = self.factors.split_at_mut((k + 1) * n);
            let row_k = &mut upper[k * n..];
            if at != k {
                self.parity = -self.parity;
                row_k.swap_with_slice(&mut lower[(at - k - 1) * n..(at - k) * n]);
            }
            for row in lower.chunks_exact_mut(n) {
                row[k] /= pivot;
                let l = row[k];
                axpy(-l, &row_k[k + 1..], &mut row[k + 1..]);
            }
        }
        Ok(())
    }

    /// Returns the determinant of the last factored matrix.
    ///
    /// ```
    /// let a = [[0.0, 2.0], [4.0, 1.0]];
    /// let mut lu = pfaff_linalg::Lu::new(2);
    /// lu.factor(|i, j| a[i][j])?;
    /// assert!((lu.determinant().value() + 8.0).abs() < 1e-14);
    /// # Ok::<(), pfaff_linalg::SingularPivot>(())
    /// ```
    pub fn determinant(&self) -> Determinant {
        let pivots = (0..self.n).map(|k| self.factors[k * self.n + k]);
        let one = Determinant {
            sign: self.parity,
            log: 0.0,
        };
        pivots.fold(one, |so_far, u| Determinant {
            sign: so_far.sign * u.signum(),
            log: so_far.log + u.abs().ln(),
        })
    }

    /// Computes `x ← A⁻¹·x`.
    ///
    /// # Panics
    /// Panics if `x` is shorter than n.
    pub fn solve(&mut self, x: &mut [f64]) {
        let (n, y) = (self.n, &mut self.right);
        for (i, &row) in self.permutation.iter().enumerate() {
            y[i] = x[row] - dot(&self.factors[i * n..i * n + i], &y[..i]);
        }
        for i in (0..n).rev() {
            let row = &self.factors[i * n..(i + 1) * n];
            x[i] = (y[i] - dot(&row[i + 1..], &x[i + 1..n])) / row[i];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solutions_are_put_back_by_the_matrix() {
        let n = 7;
        let a = |i: usize, j: usize| ((i * 31 + j * 17 + 5) % 23) as f64 - 11.0;
        let mut lu = Lu::new(n);
        lu.factor(a).unwrap();
        let b: Vec<f64> = (0..n).map(|i| i as f64 - 2.5).collect();
        let mut x = b.clone();
        lu.solve(&mut x);
        for (i, b) in b.iter().enumerate() {
            let back: f64 = (0..n).map(|j| a(i, j) * x[j]).sum();
            assert!((back - b).abs() < 1e-12, "row {i}: {back} instead of {b}");
        }
    }

    #[test]
    fn a_column_without_pivot_is_named() {
        let a = [[1.0, 2.0], [2.0, 4.0]];
        let error = Lu::new(2).factor(|i, j| a[i][j]).unwrap_err();
        let expected = "column 1 has the pivot 0, need a finite number that is not zero";
        assert_eq!(error.to_string(), expected);
        assert!(Lu::new(1).factor(|_, _| f64::NAN).is_err());
        Lu::new(0).factor(|_, _| 0.0).unwrap();
    }
}
