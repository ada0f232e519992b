//! `Matrix`: a simple dense, row-major matrix of `f64`.
//!
//! A constraint matrix C is m×n with one contiguous row for each constraint. The algorithms of this
//! crate pivot, drop or keep *rows*, so rows are contiguous. The type has no operators, no views
//! and no decompositions.

use std::ops::{Index, IndexMut};

use crate::kernels;

#[cfg(feature = "approx")]
mod compare;
#[cfg(feature = "nalgebra")]
mod interop;

/// A dense row-major matrix of `f64`.
///
/// ```
/// use pfaff_linalg::Matrix;
/// let c = Matrix::from_rows(&[[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]]);
/// assert_eq!((c.nrows(), c.ncols()), (3, 2));
/// assert_eq!(c[(2, 0)], 5.0);
/// assert_eq!(c.transpose().product(&c)[(0, 1)], 44.0); // 1·2 + 3·4 + 5·6
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Matrix {
    nrows: usize,
    ncols: usize,
    data: Vec<f64>,
}

/// The number of values does not match the requested shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "a {nrows}×{ncols} matrix needs {} values, found {found}",
    nrows.saturating_mul(*ncols)
)]
pub struct ShapeError {
    /// Requested number of rows.
    pub nrows: usize,
    /// Requested number of columns.
    pub ncols: usize,
    /// Number of given values.
    pub found: usize,
}

impl Matrix {
    /// Returns a matrix of zeros.
    pub fn zeros(nrows: usize, ncols: usize) -> Self {
        Self {
            nrows,
            ncols,
            data: vec![0.0; nrows * ncols],
        }
    }

    /// Returns the n×n identity.
    pub fn identity(n: usize) -> Self {
        Self::from_fn(n, n, |i, j| f64::from(u8::from(i == j)))
    }

    /// Returns the matrix with entries (i, j) = `f(i, j)`; the function is called row by row.
    pub fn from_fn(nrows: usize, ncols: usize, mut f: impl FnMut(usize, usize) -> f64) -> Self {
        let mut data = Vec::with_capacity(nrows * ncols);
        for i in 0..nrows {
            data.extend((0..ncols).map(|j| f(i, j)));
        }
        Self { nrows, ncols, data }
    }

    /// Creates a matrix from rows of equal length.
    pub fn from_rows<const N: usize>(rows: &[[f64; N]]) -> Self {
        Self {
            nrows: rows.len(),
            ncols: N,
            data: rows.as_flattened().to_vec(),
        }
    }

    /// Takes ownership of row-major values.
    ///
    /// # Errors
    /// Returns [`ShapeError`] unless `data.len() == nrows * ncols`.
    pub fn from_vec(nrows: usize, ncols: usize, data: Vec<f64>) -> Result<Self, ShapeError> {
        if nrows.checked_mul(ncols) == Some(data.len()) {
            Ok(Self { nrows, ncols, data })
        } else {
            Err(ShapeError {
                nrows,
                ncols,
                found: data.len(),
            })
        }
    }

    /// Returns the number of rows.
    pub fn nrows(&self) -> usize {
        self.nrows
    }

    /// Returns the number of columns.
    pub fn ncols(&self) -> usize {
        self.ncols
    }

    /// Returns row `i` as a slice of length `ncols`.
    ///
    /// # Panics
    /// Panics if `i` is not below `nrows`.
    pub fn row(&self, i: usize) -> &[f64] {
        assert!(i < self.nrows, "row {i} of {} rows", self.nrows);
        &self.data[i * self.ncols..(i + 1) * self.ncols]
    }

    /// Returns row `i` as a mutable slice.
    ///
    /// # Panics
    /// Panics if `i` is not below `nrows`.
    pub fn row_mut(&mut self, i: usize) -> &mut [f64] {
        assert!(i < self.nrows, "row {i} of {} rows", self.nrows);
        &mut self.data[i * self.ncols..(i + 1) * self.ncols]
    }

    /// Returns all values, row by row.
    pub fn as_slice(&self) -> &[f64] {
        &self.data
    }

    /// Returns all values, row by row, as a mutable slice.
    pub fn as_mut_slice(&mut self) -> &mut [f64] {
        &mut self.data
    }

    /// Exchanges two rows.
    ///
    /// # Panics
    /// Panics if an index is not below `nrows`.
    pub fn swap_rows(&mut self, i: usize, j: usize) {
        if i != j {
            let (low, high) = self.two_rows_mut(i.min(j), i.max(j));
            low.swap_with_slice(high);
        }
    }

    /// Returns two rows as mutable slices, where `i < j`.
    pub(crate) fn two_rows_mut(&mut self, i: usize, j: usize) -> (&mut [f64], &mut [f64]) {
        debug_assert!(i < j, "rows {i} and {j}");
        let n = self.ncols;
        let (head, tail) = self.data.split_at_mut(j * n);
        (&mut head[i * n..(i + 1) * n], &mut tail[..n])
    }

    /// Returns the transpose Aᵀ.
    pub fn transpose(&self) -> Self {
        let mut transposed = Self::zeros(self.ncols, self.nrows);
        for i in 0..self.nrows {
            for (j, x) in self.row(i).iter().enumerate() {
                transposed.data[j * self.nrows + i] = *x;
            }
        }
        transposed
    }

    /// Returns the product A·B. Zeros of A are skipped, so B should be finite.
    ///
    /// # Panics
    /// Panics if the inner dimensions differ.
    pub fn product(&self, b: &Self) -> Self {
        assert_eq!(
            self.ncols, b.nrows,
            "product of {}×{} and {}×{}",
            self.nrows, self.ncols, b.nrows, b.ncols
        );
        let mut out = Self::zeros(self.nrows, b.ncols);
        kernels::vectorised(
            #[inline(always)]
            || {
                for i in 0..self.nrows {
                    let terms = self.row(i).iter().enumerate();
                    for (k, &a_ik) in terms.filter(|(_, a_ik)| **a_ik != 0.0) {
                        kernels::axpy(a_ik, b.row(k), out.row_mut(i));
                    }
                }
            },
        );
        out
    }

    /// Returns A·x. The function allocates memory.
    ///
    /// # Panics
    /// Panics if the length of `x` is not `ncols`.
    pub fn times(&self, x: &[f64]) -> Vec<f64> {
        assert_eq!(self.ncols, x.len(), "A·x with {} columns", self.ncols);
        (0..self.nrows)
            .map(|i| kernels::dot(self.row(i), x))
            .collect()
    }

    /// Returns Aᵀ·y. The function allocates memory.
    ///
    /// # Panics
    /// Panics if the length of `y` is not `nrows`.
    pub fn transpose_times(&self, y: &[f64]) -> Vec<f64> {
        assert_eq!(self.nrows, y.len(), "Aᵀ·y with {} rows", self.nrows);
        let mut out = vec![0.0; self.ncols];
        for (i, &y_i) in y.iter().enumerate() {
            kernels::axpy(y_i, self.row(i), &mut out);
        }
        out
    }

    /// Returns the rows with the indices `rows`, in that order.
    ///
    /// # Panics
    /// Panics if an index is not below `nrows`.
    pub fn select_rows(&self, rows: &[usize]) -> Self {
        let mut data = Vec::with_capacity(rows.len() * self.ncols);
        for &i in rows {
            data.extend_from_slice(self.row(i));
        }
        Self {
            nrows: rows.len(),
            ncols: self.ncols,
            data,
        }
    }

    /// Returns the largest absolute entry, or 0 for an empty matrix.
    pub fn max_abs(&self) -> f64 {
        kernels::max_abs(&self.data)
    }

    /// Frobenius norm, without overflow.
    pub fn frobenius_norm(&self) -> f64 {
        kernels::norm(&self.data)
    }

    /// Returns the position and value of the first entry that is NaN or infinite.
    pub fn first_non_finite(&self) -> Option<(usize, usize, f64)> {
        let at = self.data.iter().position(|a| !a.is_finite())?;
        Some((at / self.ncols, at % self.ncols, self.data[at]))
    }
}

/// A matrix is serialised as a list of rows.
#[cfg(feature = "serde")]
impl serde::Serialize for Matrix {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq((0..self.nrows).map(|i| self.row(i)))
    }
}

impl Index<(usize, usize)> for Matrix {
    type Output = f64;

    fn index(&self, (i, j): (usize, usize)) -> &f64 {
        &self.row(i)[j]
    }
}

impl IndexMut<(usize, usize)> for Matrix {
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut f64 {
        &mut self.row_mut(i)[j]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrong_shape_is_named() {
        let error = Matrix::from_vec(2, 3, vec![0.0; 5]).unwrap_err();
        assert_eq!(error.to_string(), "a 2×3 matrix needs 6 values, found 5");
        let huge = Matrix::from_vec(usize::MAX, 2, Vec::new()).unwrap_err();
        assert_eq!(huge.found, 0);
    }

    #[test]
    fn rows_swap_and_select() {
        let mut a = Matrix::from_rows(&[[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]]);
        a.swap_rows(2, 0);
        assert_eq!(a.row(0), [5.0, 6.0]);
        assert_eq!(
            a.select_rows(&[2, 1]),
            Matrix::from_rows(&[[1.0, 2.0], [3.0, 4.0]])
        );
        assert_eq!(a.times(&[1.0, 1.0]), [11.0, 7.0, 3.0]);
        assert_eq!(a.transpose_times(&[1.0, 0.0, 1.0]), [6.0, 8.0]);
    }

    #[test]
    fn empty_shapes_are_legal() {
        let a = Matrix::zeros(0, 3);
        assert_eq!(a.transpose().product(&a), Matrix::zeros(3, 3));
        assert_eq!(a.max_abs(), 0.0);
        assert_eq!(a.first_non_finite(), None);
    }

    #[test]
    fn non_finite_entry_is_located() {
        let a = Matrix::from_rows(&[[1.0, 2.0], [f64::NEG_INFINITY, f64::NAN]]);
        assert_eq!(a.first_non_finite(), Some((1, 0, f64::NEG_INFINITY)));
    }

    #[test]
    fn approx_compares_shape_and_entries() {
        let a = Matrix::identity(2);
        let mut b = a.clone();
        b[(0, 1)] = 1e-9;
        approx::assert_abs_diff_eq!(a, b, epsilon = 1e-8);
        approx::assert_abs_diff_ne!(a, b, epsilon = 1e-10);
        approx::assert_abs_diff_ne!(a, Matrix::zeros(1, 4), epsilon = 10.0);
    }
}
