//! Independent rows of C as a sparse matrix, in units of the mechanism.

use linalg::SparseMatrix;
use model::{Mechanism, System};

/// Independent rows, and the indices of their entries among the entries of C.
#[derive(Clone)]
pub(super) struct KeptMatrix {
    pub(super) c: SparseMatrix,
    /// For each value, its index among the entries of C, and its unit.
    first: Vec<(u32, f64)>,
    /// Further entries that are added to a value, with the index of the value. Such entries exist
    /// because a joint may contribute twice to a coordinate.
    more: Vec<(u32, (u32, f64))>,
}

impl KeptMatrix {
    pub(super) fn new(mechanism: &Mechanism, kept: &[usize], units: &[f64]) -> Self {
        let pattern = &mechanism.layout().pattern;
        let c = pattern_of(mechanism, kept);
        let mut first = vec![(u32::MAX, 0.0); c.nnz()];
        let mut more = Vec::new();
        for (k, &i) in kept.iter().enumerate() {
            let (start, columns) = (c.start(k), c.row(k).0);
            for at in pattern.start[i]..pattern.start[i + 1] {
                let column = pattern.column[at];
                let place = start + columns.partition_point(|&j| j < column);
                let entry = (pattern.entry[at] as u32, units[column]);
                if first[place].0 == u32::MAX {
                    first[place] = entry;
                } else {
                    more.push((place as u32, entry));
                }
            }
        }
        Self { c, first, more }
    }

    /// Copies the values from these entries of C.
    pub(super) fn take(&mut self, entries: &[f64]) {
        let values = self.c.values_mut();
        for (value, &(entry, unit)) in values.iter_mut().zip(&self.first) {
            *value = entries[entry as usize] * unit;
        }
        for &(place, (entry, unit)) in &self.more {
            values[place as usize] += entries[entry as usize] * unit;
        }
    }

    /// Returns the memory for this number of entries (bytes).
    pub(super) fn bytes(entries: usize) -> usize {
        entries * (size_of::<(usize, f64)>() + size_of::<(u32, f64)>())
    }
}

/// Returns the sparsity pattern of the independent rows, with zeros as entries.
pub(super) fn pattern_of(mechanism: &Mechanism, kept: &[usize]) -> SparseMatrix {
    let layout = mechanism.layout();
    let pattern = &layout.pattern;
    let row =
        |&i: &usize| (pattern.start[i]..pattern.start[i + 1]).map(|at| (pattern.column[at], 0.0));
    // The columns of a pattern are always below n_v. Without entries there is no equation to solve.
    SparseMatrix::from_rows(layout.n_v, kept.iter().map(row))
        .unwrap_or_else(|_| unreachable!("columns of a pattern are below {}", layout.n_v))
}
