//! Assembles one front at a time from rows of C and the remainders of the fronts below. The
//! remainder of the assembled front is passed to the front above.
//!
//! The module `factor` performs the operations on a front.

use super::symbolic::{Front, Symbolic};
use linalg::SparseMatrix;

/// Marks columns that are not in the front.
const OUTSIDE: usize = usize::MAX;

/// The current front, and the remainders of other fronts that have not been used yet.
pub(super) struct Assembly {
    /// The columns of C in the front, in the order of the front.
    pub(super) columns: Vec<usize>,
    /// For each row of the front, the original row of C.
    pub(super) rows: Vec<usize>,
    /// Values, row by row.
    pub(super) values: Vec<f64>,
    /// Index in the front of each column of C.
    position: Vec<usize>,
    /// Remainders of fronts that have not been used yet, the latest remainder at the end.
    waiting: Vec<Rest>,
    waiting_rows: Vec<usize>,
    waiting_columns: Vec<usize>,
    waiting_values: Vec<f64>,
}

/// Remainder of a front: its numbers of rows and columns.
struct Rest {
    rows: usize,
    columns: usize,
}

/// The matrix has an entry outside the pattern.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct OutsidePattern {
    pub(super) row: usize,
    pub(super) column: usize,
}

impl Assembly {
    pub(super) fn new(symbolic: &Symbolic) -> Self {
        Self {
            columns: Vec::new(),
            rows: Vec::new(),
            values: Vec::new(),
            position: vec![OUTSIDE; symbolic.ncols],
            waiting: Vec::new(),
            waiting_rows: Vec::new(),
            waiting_columns: Vec::new(),
            waiting_values: Vec::new(),
        }
    }

    pub(super) fn width(&self) -> usize {
        self.columns.len()
    }

    /// Assembles the rows of C that first occur in this front, and the remainders of the children.
    pub(super) fn assemble(
        &mut self,
        front: &Front,
        c: &SparseMatrix,
    ) -> Result<(), OutsidePattern> {
        self.columns.clone_from(&front.columns);
        for (at, &column) in self.columns.iter().enumerate() {
            self.position[column] = at;
        }
        let width = self.width();
        self.rows.clear();
        self.values.clear();
        for &row in &front.rows {
            let base = self.values.len();
            self.values.resize(base + width, 0.0);
            self.rows.push(row);
            for (column, value) in c.entries(row) {
                match self.position[column] {
                    OUTSIDE => return Err(OutsidePattern { row, column }),
                    at => self.values[base + at] = value,
                }
            }
        }
        for _ in 0..front.children {
            if let Some(rest) = self.waiting.pop() {
                self.take_over(&rest);
            }
        }
        for &column in &self.columns {
            self.position[column] = OUTSIDE;
        }
        Ok(())
    }

    /// Adds the rows of the last remainder.
    fn take_over(&mut self, rest: &Rest) {
        let width = self.width();
        let columns = self.waiting_columns.len() - rest.columns;
        let rows = self.waiting_rows.len() - rest.rows;
        let values = self.waiting_values.len() - rest.rows * rest.columns;
        let places = &mut self.waiting_columns[columns..];
        places.iter_mut().for_each(|j| *j = self.position[*j]);
        for k in 0..rest.rows {
            let base = self.values.len();
            self.values.resize(base + width, 0.0);
            let from = &self.waiting_values[values + k * rest.columns..][..rest.columns];
            for (&at, &value) in places.iter().zip(from) {
                self.values[base + at] = value;
            }
        }
        self.rows.extend_from_slice(&self.waiting_rows[rows..]);
        self.waiting_columns.truncate(columns);
        self.waiting_rows.truncate(rows);
        self.waiting_values.truncate(values);
    }

    /// Passes these rows, without the pivots, to the front above. If there is a front above, an
    /// empty remainder is also passed.
    pub(super) fn leave(&mut self, pivots: usize, rows: impl Iterator<Item = usize>) {
        let width = self.width();
        if pivots == width {
            return;
        }
        let before = self.waiting_rows.len();
        for i in rows {
            self.waiting_rows.push(self.rows[i]);
            let row = &self.values[i * width..][pivots..width];
            self.waiting_values.extend_from_slice(row);
        }
        self.waiting_columns
            .extend_from_slice(&self.columns[pivots..]);
        self.waiting.push(Rest {
            rows: self.waiting_rows.len() - before,
            columns: width - pivots,
        });
    }

    /// Exchanges rows `top` and `i`, where `top ≤ i`.
    pub(super) fn swap_rows(&mut self, top: usize, i: usize) {
        if i != top {
            let width = self.width();
            let (upper, lower) = self.values.split_at_mut(i * width);
            upper[top * width..][..width].swap_with_slice(&mut lower[..width]);
            self.rows.swap(top, i);
        }
    }

    /// Exchanges columns from row `top` onwards.
    pub(super) fn swap_columns(&mut self, top: usize, at: usize, j: usize) {
        if j != at {
            let width = self.width();
            self.columns.swap(at, j);
            for row in self.values[top * width..].chunks_exact_mut(width) {
                row.swap(at, j);
            }
        }
    }
}
