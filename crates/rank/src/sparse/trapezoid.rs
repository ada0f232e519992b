//! R, and triangular solves with its live columns.

use super::reflectors::Lanes;
use crate::limits::REFLECTORS_WIDTH;

/// The rows of R in order of elimination. The first entry of each row is its pivot. The columns of
/// the pivots are the *live* columns, R₁₁, and no row has an entry in the pivot column of an
/// earlier row.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Trapezoid {
    /// Index after the last entry of each row.
    end: Vec<usize>,
    column: Vec<usize>,
    value: Vec<f64>,
}

impl Trapezoid {
    /// Adds a row. The pivot comes first, followed by the other non-zero entries.
    pub(super) fn push(&mut self, entries: impl Iterator<Item = (usize, f64)>) {
        for (column, value) in entries {
            self.column.push(column);
            self.value.push(value);
        }
        self.end.push(self.column.len());
    }

    /// Returns the number of rows, which equals the number of live columns.
    pub(super) fn rank(&self) -> usize {
        self.end.len()
    }

    /// Returns the live columns, in order of elimination.
    pub(super) fn live(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.rank()).map(|i| self.row(i).0[0])
    }

    /// Solves `R₁₁ᵀ·R₁₁·y = x` in place. `x` has a row for each column of C; the rows of dead
    /// columns are zero.
    pub(super) fn solve_normal(&self, x: &mut [Lanes]) {
        for i in 0..self.rank() {
            let (columns, values) = self.row(i);
            let z = &mut x[columns[0]];
            z.iter_mut().for_each(|z| *z /= values[0]);
            let z = *z;
            for (&j, &r_ij) in columns.iter().zip(values).skip(1) {
                for (x, z) in x[j].iter_mut().zip(&z) {
                    *x -= r_ij * z;
                }
            }
        }
        self.clear_dead(x);
        for i in (0..self.rank()).rev() {
            let (columns, values) = self.row(i);
            let mut y = x[columns[0]];
            for (&j, &r_ij) in columns.iter().zip(values).skip(1) {
                for (y, x) in y.iter_mut().zip(&x[j]) {
                    *y -= r_ij * x;
                }
            }
            x[columns[0]] = y.map(|y| y / values[0]);
        }
    }

    /// Sets the rows of dead columns to zero.
    pub(super) fn clear_dead(&self, x: &mut [Lanes]) {
        let mut is_live = vec![false; x.len()];
        self.live().for_each(|j| is_live[j] = true);
        for (x, _) in x.iter_mut().zip(is_live).filter(|(_, live)| !live) {
            *x = [0.0; REFLECTORS_WIDTH];
        }
    }

    /// Returns the entries (column, value) of row i.
    #[cfg(test)]
    pub(super) fn entries(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let (columns, values) = self.row(i);
        columns.iter().copied().zip(values.iter().copied())
    }

    fn row(&self, i: usize) -> (&[usize], &[f64]) {
        let entries = i.checked_sub(1).map_or(0, |i| self.end[i])..self.end[i];
        (&self.column[entries.clone()], &self.value[entries])
    }

    /// Returns the memory (bytes).
    pub(super) fn bytes(&self) -> usize {
        size_of::<usize>() * (self.end.len() + self.column.len())
            + size_of::<f64>() * self.value.len()
    }
}
