//! `SparseMatrix`: a matrix whose rows have few entries each. The rows are stored one after the
//! other.

use crate::{Matrix, kernels};

#[cfg(test)]
mod tests;

/// A sparse matrix of `f64` in compressed rows: row i has the columns
/// `column[start[i]..start[i + 1]]`, ascending, each once.
///
/// ```
/// use pfaff_linalg::SparseMatrix;
/// let c = SparseMatrix::from_rows(3, [vec![(2, 1.0), (0, 5.0)], vec![], vec![(1, 2.0), (1, 3.0)]])?;
/// assert_eq!((c.nrows(), c.ncols(), c.nnz()), (3, 3, 3));
/// assert_eq!(c.row(0), (&[0, 2][..], &[5.0, 1.0][..]));
/// assert_eq!(c.row(2), (&[1][..], &[5.0][..])); // 2 + 3
/// # Ok::<(), pfaff_linalg::SparseError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct SparseMatrix {
    nrows: usize,
    ncols: usize,
    start: Vec<usize>,
    column: Vec<usize>,
    value: Vec<f64>,
}

/// The entries do not form a matrix.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SparseError {
    /// The column of an entry does not exist.
    #[error("entry in row {row}, column {column} of a matrix of {ncols} columns")]
    Column {
        /// Row of the entry.
        row: usize,
        /// Column of the entry.
        column: usize,
        /// Number of columns of the matrix.
        ncols: usize,
    },
}

impl SparseMatrix {
    /// Creates a matrix from the entries (column, value) of each row, in any order. Values of the
    /// same column are added. Explicit zeros are kept.
    ///
    /// # Errors
    /// [`SparseError::Column`]: a column is not below `ncols`.
    pub fn from_rows<R: IntoIterator<Item = (usize, f64)>>(
        ncols: usize,
        rows: impl IntoIterator<Item = R>,
    ) -> Result<Self, SparseError> {
        let mut matrix = Self::empty(ncols);
        let mut entries: Vec<(usize, f64)> = Vec::new();
        for row in rows {
            entries.clear();
            entries.extend(row);
            if let Some(&(column, _)) = entries.iter().find(|(column, _)| *column >= ncols) {
                return Err(SparseError::Column {
                    row: matrix.nrows,
                    column,
                    ncols,
                });
            }
            // The sort is stable, so equal columns are added in the given order.
            entries.sort_by_key(|(column, _)| *column);
            matrix.push(&entries);
        }
        Ok(matrix)
    }

    /// Adds a row of entries in ascending order of their columns, all below `ncols`.
    fn push(&mut self, entries: &[(usize, f64)]) {
        let first = self.column.len();
        for &(column, value) in entries {
            if self.column[first..].last() == Some(&column) {
                let last = self.value.len() - 1;
                self.value[last] += value;
            } else {
                self.column.push(column);
                self.value.push(value);
            }
        }
        self.start.push(self.column.len());
        self.nrows += 1;
    }

    /// Creates a matrix from the non-zero entries of a dense matrix.
    pub fn from_dense(dense: &Matrix) -> Self {
        let mut matrix = Self::empty(dense.ncols());
        for i in 0..dense.nrows() {
            let row = dense.row(i).iter().copied().enumerate();
            let entries: Vec<(usize, f64)> = row.filter(|(_, value)| *value != 0.0).collect();
            matrix.push(&entries);
        }
        matrix
    }

    /// Returns the number of rows.
    pub fn nrows(&self) -> usize {
        self.nrows
    }

    /// Returns the number of columns.
    pub fn ncols(&self) -> usize {
        self.ncols
    }

    /// Returns the number of stored entries.
    pub fn nnz(&self) -> usize {
        self.value.len()
    }

    /// Returns the columns, ascending, and values of row `i`.
    ///
    /// # Panics
    /// Panics if `i` is not below `nrows`.
    pub fn row(&self, i: usize) -> (&[usize], &[f64]) {
        assert!(i < self.nrows, "row {i} of {} rows", self.nrows);
        let entries = self.start[i]..self.start[i + 1];
        (&self.column[entries.clone()], &self.value[entries])
    }

    /// Returns the values of all rows, one after the other.
    pub fn values(&self) -> &[f64] {
        &self.value
    }

    /// Returns the values of all rows as a mutable slice, with the same pattern.
    pub fn values_mut(&mut self) -> &mut [f64] {
        &mut self.value
    }

    /// Returns the index of the first value of row `i`.
    ///
    /// # Panics
    /// Panics if `i` is above `nrows`.
    pub fn start(&self, i: usize) -> usize {
        self.start[i]
    }

    /// Returns the entries (column, value) of row `i`.
    pub fn entries(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let (columns, values) = self.row(i);
        columns.iter().copied().zip(values.iter().copied())
    }

    /// Returns the rows listed in `rows`, in that order.
    ///
    /// # Panics
    /// Panics if an index is not below `nrows`.
    pub fn select_rows(&self, rows: &[usize]) -> Self {
        let mut selected = Self::empty(self.ncols);
        for &i in rows {
            let (columns, values) = self.row(i);
            selected.column.extend_from_slice(columns);
            selected.value.extend_from_slice(values);
            selected.start.push(selected.column.len());
        }
        selected.nrows = rows.len();
        selected
    }

    /// Returns the dense matrix, including all zeros.
    pub fn dense(&self) -> Matrix {
        let mut dense = Matrix::zeros(self.nrows, self.ncols);
        for i in 0..self.nrows {
            for (j, value) in self.entries(i) {
                dense[(i, j)] = value;
            }
        }
        dense
    }

    /// Returns the position and value of the first entry that is NaN or infinite.
    pub fn first_non_finite(&self) -> Option<(usize, usize, f64)> {
        let at = self.value.iter().position(|a| !a.is_finite())?;
        let row = self.start.partition_point(|&start| start <= at) - 1;
        Some((row, self.column[at], self.value[at]))
    }

    /// Returns the transpose Aᵀ.
    pub fn transpose(&self) -> Self {
        let mut start = vec![0; self.ncols + 1];
        for &j in &self.column {
            start[j + 1] += 1;
        }
        for j in 0..self.ncols {
            start[j + 1] += start[j];
        }
        let mut next = start.clone();
        let mut column = vec![0; self.nnz()];
        let mut value = vec![0.0; self.nnz()];
        for i in 0..self.nrows {
            for (j, a_ij) in self.entries(i) {
                column[next[j]] = i;
                value[next[j]] = a_ij;
                next[j] += 1;
            }
        }
        Self {
            nrows: self.ncols,
            ncols: self.nrows,
            start,
            column,
            value,
        }
    }

    /// Computes `out ← A·x`, with `x` of length `ncols` and `out` of length `nrows`.
    ///
    /// # Panics
    /// Panics if a length differs.
    pub fn times(&self, x: &[f64], out: &mut [f64]) {
        let shape = (self.ncols, self.nrows);
        assert_eq!((x.len(), out.len()), shape, "A·x: columns and rows");
        for (i, out) in out.iter_mut().enumerate() {
            *out = self.entries(i).map(|(j, a_ij)| a_ij * x[j]).sum();
        }
    }

    /// Computes `out ← Aᵀ·y`, with `y` of length `nrows` and `out` of length `ncols`.
    ///
    /// # Panics
    /// Panics if a length differs.
    pub fn transposed_times(&self, y: &[f64], out: &mut [f64]) {
        let shape = (self.nrows, self.ncols);
        assert_eq!((y.len(), out.len()), shape, "Aᵀ·y: rows and columns");
        out.fill(0.0);
        for (i, &y_i) in y.iter().enumerate() {
            for (j, a_ij) in self.entries(i) {
                out[j] += a_ij * y_i;
            }
        }
    }

    /// Frobenius norm, without overflow.
    #[must_use]
    pub fn norm(&self) -> f64 {
        kernels::norm(&self.value)
    }

    /// Returns a matrix in which each entry a at (i, j) is replaced by `f(i, j, a)`.
    #[must_use]
    pub fn map(&self, f: impl Fn(usize, usize, f64) -> f64) -> Self {
        let mut mapped = self.clone();
        for i in 0..self.nrows {
            for at in self.start[i]..self.start[i + 1] {
                mapped.value[at] = f(i, self.column[at], self.value[at]);
            }
        }
        mapped
    }

    fn empty(ncols: usize) -> Self {
        Self {
            nrows: 0,
            ncols,
            start: vec![0],
            column: Vec::new(),
            value: Vec::new(),
        }
    }
}
