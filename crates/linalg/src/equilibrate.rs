//! Row and column equilibration by powers of two.
//!
//! Rank decisions compare singular values, which depend on the units of the entries, for example of
//! lengths and angles, or of lengths of 1e-8 m and 1e8 m. Equilibration replaces C by `D_r·C·D_c`
//! with all row and column maxima near one. The factors are powers of two, so scaling is exact and
//! the rank does not change. The scaling is not intended for solving linear systems: the condition
//! number is not considered.
//!
//! Source of the iteration: D. Ruiz, A scaling algorithm to equilibrate both rows and columns norms
//! in matrices, RAL-TR-2001-034 (2001), with the maximum norm.

use crate::limits::EQUILIBRATION_SWEEPS;
use crate::powers::{STEP, exponent, power, scale};
use crate::{Matrix, SparseMatrix};

/// The diagonal matrices `D_r = diag(2^rows)` and `D_c = diag(2^cols)` of an equilibration.
///
/// Exponents are stored in place of factors, so that the scaling is exact by construction.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Scaling {
    /// Exponents of the row factors, length m.
    pub rows: Vec<i32>,
    /// Exponents of the column factors, length n.
    pub cols: Vec<i32>,
}

/// Returns the Ruiz scaling of `c`. In `D_r·C·D_c` the largest entry of each row and column is in
/// [½, 4), unless the pattern of zeros makes this impossible. In that case, rows and columns are
/// balanced as far as the sweeps permit. Rows and columns of zeros keep the factor 1. Non-finite
/// entries are ignored.
///
/// ```
/// use pfaff_linalg::{Matrix, equilibrate};
/// let c = Matrix::from_rows(&[[1e8, 2.0e8], [3e-8, 0.0]]);
/// let scaled = equilibrate(&c).apply(&c);
/// assert!(scaled.max_abs() < 4.0 && scaled[(1, 0)] >= 0.5);
/// ```
pub fn equilibrate(c: &Matrix) -> Scaling {
    let (m, n) = (c.nrows(), c.ncols());
    ruiz((m, n), dense_exponents(c))
}

/// Works like [`equilibrate`], but with one factor for each block of rows and for each block of
/// columns. The choice of axes of a body or of a joint must not affect the scaling of its
/// components. `row_blocks` and `col_blocks` contain the index of the block of each row and column.
///
/// ```
/// use pfaff_linalg::{Matrix, equilibrate_blocks};
/// let c = Matrix::from_rows(&[[4.0, 0.0], [0.0, 4096.0]]);
/// let scaling = equilibrate_blocks(&c, &[0, 1], &[0, 0]); // both columns belong to one force
/// assert_eq!(scaling.cols[0], scaling.cols[1]);
/// assert_ne!(scaling.rows[0], scaling.rows[1]);
/// ```
///
/// # Panics
/// Panics if the length of `row_blocks` or `col_blocks` is not the number of rows or columns.
pub fn equilibrate_blocks(c: &Matrix, row_blocks: &[usize], col_blocks: &[usize]) -> Scaling {
    assert_eq!(
        (c.nrows(), c.ncols()),
        (row_blocks.len(), col_blocks.len()),
        "one block for each row and column"
    );
    let count = |blocks: &[usize]| blocks.iter().max().map_or(0, |&last| last + 1);
    let entries = dense_exponents(c).map(|(i, j, e)| (row_blocks[i], col_blocks[j], e));
    let of_blocks = ruiz((count(row_blocks), count(col_blocks)), entries);
    let spread =
        |of_blocks: &[i32], blocks: &[usize]| blocks.iter().map(|&b| of_blocks[b]).collect();
    Scaling {
        rows: spread(&of_blocks.rows, row_blocks),
        cols: spread(&of_blocks.cols, col_blocks),
    }
}

/// Works like [`equilibrate`], for a sparse matrix.
pub fn equilibrate_sparse(c: &SparseMatrix) -> Scaling {
    let entries = (0..c.nrows()).flat_map(|i| {
        c.entries(i)
            .filter_map(move |(j, c_ij)| Some((i, j, exponent(c_ij)?)))
    });
    ruiz((c.nrows(), c.ncols()), entries)
}

/// Returns the row, column and exponent of the non-zero entries.
fn dense_exponents(c: &Matrix) -> impl Iterator<Item = (usize, usize, i32)> + '_ {
    (0..c.nrows()).flat_map(|i| {
        let row = c.row(i).iter().enumerate();
        row.filter_map(move |(j, &c_ij)| Some((i, j, exponent(c_ij)?)))
    })
}

fn ruiz((m, n): (usize, usize), entries: impl Iterator<Item = (usize, usize, i32)>) -> Scaling {
    let mut scaling = Scaling::identity(m, n);
    // Most entries are zero, so the nonzero entries are collected once.
    let entries: Vec<(usize, usize, i32)> = entries.collect();
    let mut row_top = vec![None; m];
    let mut col_top = vec![None; n];
    for _ in 0..EQUILIBRATION_SWEEPS {
        row_top.fill(None);
        col_top.fill(None);
        for &(i, j, e) in &entries {
            let top = Some(e + scaling.rows[i] + scaling.cols[j]);
            // The value `None` is less than any exponent.
            row_top[i] = top.max(row_top[i]);
            col_top[j] = top.max(col_top[j]);
        }
        let moved_rows = half_step(&mut scaling.rows, &row_top);
        let moved_cols = half_step(&mut scaling.cols, &col_top);
        if !moved_rows && !moved_cols {
            break;
        }
    }
    scaling
}

/// Subtracts from each exponent half of the largest exponent in its row or column, rounded towards
/// zero. Returns `false` if nothing changed.
fn half_step(exponents: &mut [i32], top: &[Option<i32>]) -> bool {
    let mut moved = false;
    for (e, top) in exponents.iter_mut().zip(top) {
        let step = top.map_or(0, |t| t / 2);
        *e -= step;
        moved |= step != 0;
    }
    moved
}

impl Scaling {
    /// Returns the scaling of an m×n matrix with all factors 1.
    pub fn identity(m: usize, n: usize) -> Self {
        Self {
            rows: vec![0; m],
            cols: vec![0; n],
        }
    }

    /// Returns `D_r·C·D_c`.
    ///
    /// # Panics
    /// Panics if the shape of `c` differs from the shape of the scaling.
    pub fn apply(&self, c: &Matrix) -> Matrix {
        self.map(c, 1)
    }

    /// Returns `D_r·C·D_c` of a sparse matrix.
    ///
    /// # Panics
    /// Panics if the shape of `c` differs from the shape of the scaling.
    pub fn apply_sparse(&self, c: &SparseMatrix) -> SparseMatrix {
        self.check(c.nrows(), c.ncols());
        c.map(|i, j, c_ij| scale(c_ij, self.rows[i] + self.cols[j]))
    }

    /// Returns `D_r⁻¹·C·D_c⁻¹`, the inverse of [`Scaling::apply`].
    ///
    /// # Panics
    /// Panics if the shape of `c` differs from the shape of the scaling.
    pub fn undo(&self, c: &Matrix) -> Matrix {
        self.map(c, -1)
    }

    fn map(&self, c: &Matrix, sign: i32) -> Matrix {
        self.check(c.nrows(), c.ncols());
        let largest = |of: &[i32]| of.iter().map(|e| e.unsigned_abs()).max().unwrap_or(0);
        let has_factors = largest(&self.rows) + largest(&self.cols) <= STEP.unsigned_abs();
        let mut scaled = c.clone();
        for (i, row) in self.rows.iter().enumerate() {
            let entries = scaled.row_mut(i).iter_mut().zip(&self.cols);
            if has_factors {
                entries.for_each(|(c, col)| *c *= power(sign * (row + col)));
            } else {
                entries.for_each(|(c, col)| *c = scale(*c, sign * (row + col)));
            }
        }
        scaled
    }

    fn check(&self, m: usize, n: usize) {
        assert_eq!(
            (m, n),
            (self.rows.len(), self.cols.len()),
            "scaling and matrix differ in shape"
        );
    }

    /// Returns the row factor `2^rows[i]`.
    ///
    /// # Panics
    /// Panics if `i` is not below m.
    pub fn row_factor(&self, i: usize) -> f64 {
        scale(1.0, self.rows[i])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Factors outside the range of `f64` are applied in several parts.
    #[test]
    fn factors_beyond_the_range_of_numbers() {
        let scaling = Scaling {
            rows: vec![1000, -1000],
            cols: vec![1000, -20],
        };
        let c = Matrix::from_rows(&[[f64::from_bits(1), 3.0], [5.0, f64::MAX]]);
        let scaled = scaling.apply(&c);
        let last = f64::MAX * 2f64.powi(-1020);
        assert_eq!(
            scaled.as_slice(),
            [2f64.powi(926), 3.0 * 2f64.powi(980), 5.0, last]
        );
    }

    #[test]
    fn undo_is_exact() {
        let c = Matrix::from_rows(&[[1.1e8, -2.3e-3, 0.0], [7.7e-8, 0.0, 3.1e-12]]);
        let scaling = equilibrate(&c);
        assert_eq!(scaling.undo(&scaling.apply(&c)), c);
    }

    #[test]
    fn row_and_column_maxima_are_near_one() {
        let c = Matrix::from_fn(7, 5, |i, j| {
            (1.0 + (3 * i + 5 * j) as f64).sin() * 10f64.powi(4 * i as i32 - 7 * j as i32)
        });
        let scaled = equilibrate(&c).apply(&c);
        for a in [&scaled, &scaled.transpose()] {
            for i in 0..a.nrows() {
                let top = crate::kernels::max_abs(a.row(i));
                assert!((0.5..4.0).contains(&top), "row {i}: {top}");
            }
        }
    }

    #[test]
    fn zero_rows_and_columns_are_left_alone() {
        let c = Matrix::from_rows(&[[0.0, 0.0], [0.0, 1024.0]]);
        let scaling = equilibrate(&c);
        assert_eq!((scaling.rows[0], scaling.cols[0]), (0, 0));
        assert!(scaling.apply(&c)[(1, 1)] < 4.0);
    }
}
