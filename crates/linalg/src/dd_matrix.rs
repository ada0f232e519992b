//! `DdMatrix`: a dense, row-major matrix of double-double numbers, for residuals and certificates.
//!
//! The singular values of a constraint matrix are computed in double-double at a refined
//! configuration. Singular values that are exactly zero are then about 1e-30. Factorisations are
//! made in `f64` and corrected by residuals of this type.

use std::ops::{Index, IndexMut};

use crate::{Dd, Matrix, Scaling};

/// A dense row-major matrix of [`Dd`].
///
/// ```
/// use pfaff_linalg::{Dd, DdMatrix, Matrix};
/// let mut c = DdMatrix::from(&Matrix::from_rows(&[[1.0, 2.0], [3.0, 4.0]]));
/// c[(1, 0)] += Dd::from(1e-25);
/// assert_eq!((c.nrows(), c.ncols()), (2, 2));
/// assert_eq!(c.hi(), Matrix::from_rows(&[[1.0, 2.0], [3.0, 4.0]]));
/// assert!((c[(1, 0)] - Dd::from(3.0)).to_f64() > 0.0);
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DdMatrix {
    nrows: usize,
    ncols: usize,
    data: Vec<Dd>,
}

impl DdMatrix {
    /// Returns a matrix with zero entries.
    #[must_use]
    pub fn zeros(nrows: usize, ncols: usize) -> Self {
        Self::from_fn(nrows, ncols, |_, _| Dd::ZERO)
    }

    /// Returns a matrix with the entries (i, j) = `f(i, j)`; the function is called row by row.
    pub fn from_fn(nrows: usize, ncols: usize, mut f: impl FnMut(usize, usize) -> Dd) -> Self {
        let mut data = Vec::with_capacity(nrows * ncols);
        for i in 0..nrows {
            for j in 0..ncols {
                data.push(f(i, j));
            }
        }
        Self { nrows, ncols, data }
    }

    /// Returns the number of rows.
    #[must_use]
    pub fn nrows(&self) -> usize {
        self.nrows
    }

    /// Returns the number of columns.
    #[must_use]
    pub fn ncols(&self) -> usize {
        self.ncols
    }

    /// Returns row `i` as a slice of length `ncols`.
    ///
    /// # Panics
    /// Panics if `i` is not below `nrows`.
    #[must_use]
    pub fn row(&self, i: usize) -> &[Dd] {
        assert!(i < self.nrows, "row {i} of {} rows", self.nrows);
        &self.data[i * self.ncols..(i + 1) * self.ncols]
    }

    /// Returns row `i` as a mutable slice.
    ///
    /// # Panics
    /// Panics if `i` is not below `nrows`.
    pub fn row_mut(&mut self, i: usize) -> &mut [Dd] {
        assert!(i < self.nrows, "row {i} of {} rows", self.nrows);
        &mut self.data[i * self.ncols..(i + 1) * self.ncols]
    }

    /// Returns the rows with the indices `rows`, in that order.
    ///
    /// # Panics
    /// Panics if an index is not below `nrows`.
    #[must_use]
    pub fn select_rows(&self, rows: &[usize]) -> Self {
        Self {
            nrows: rows.len(),
            ncols: self.ncols,
            data: rows.iter().flat_map(|&i| self.row(i)).copied().collect(),
        }
    }

    /// Returns the entries rounded to `f64`.
    #[must_use]
    pub fn hi(&self) -> Matrix {
        let mut hi = Matrix::zeros(self.nrows, self.ncols);
        for (hi, x) in hi.as_mut_slice().iter_mut().zip(&self.data) {
            *hi = x.to_f64();
        }
        hi
    }

    /// Returns `D_r·C·D_c`, which is exact unless an entry leaves the range.
    ///
    /// # Panics
    /// Panics if the scaling has another shape.
    #[must_use]
    pub fn scaled(&self, scaling: &Scaling) -> Self {
        assert_eq!(
            (self.nrows, self.ncols),
            (scaling.rows.len(), scaling.cols.len()),
            "scaling and matrix differ in shape"
        );
        let mut data = Vec::with_capacity(self.data.len());
        for (i, row) in scaling.rows.iter().enumerate() {
            let entries = self.row(i).iter().zip(&scaling.cols);
            data.extend(entries.map(|(x, col)| x.scaled(row + col)));
        }
        Self { data, ..*self }
    }

    /// Returns all entries times 2^exponent.
    #[must_use]
    pub fn times_power(&self, exponent: i32) -> Self {
        Self {
            data: self.data.iter().map(|x| x.scaled(exponent)).collect(),
            ..*self
        }
    }
}

impl From<&Matrix> for DdMatrix {
    fn from(a: &Matrix) -> Self {
        Self::from_fn(a.nrows(), a.ncols(), |i, j| Dd::from(a[(i, j)]))
    }
}

impl Index<(usize, usize)> for DdMatrix {
    type Output = Dd;

    fn index(&self, (i, j): (usize, usize)) -> &Dd {
        &self.row(i)[j]
    }
}

impl IndexMut<(usize, usize)> for DdMatrix {
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut Dd {
        &mut self.row_mut(i)[j]
    }
}
