//! The sparse solver of kept rows, for large mechanisms.

use linalg::{SaddleError, SchurSaddle, SchurStructure, SparseMatrix};
use model::{Mechanism, System};

/// Kept rows in units of the mechanism, and the factors of their Schur complement.
#[derive(Clone)]
pub(super) struct Sparse {
    pub(super) c: SparseMatrix,
    /// For each value: its index among the entries of C, and its unit.
    first: Vec<(u32, f64)>,
    /// Entries that are added to a value, with its index: a joint may contribute twice to a
    /// coordinate.
    more: Vec<(u32, (u32, f64))>,
    pub(super) saddle: SchurSaddle,
}

impl Sparse {
    pub(super) fn new(mechanism: &Mechanism, kept: &[usize], units: &[f64]) -> Self {
        let pattern = &mechanism.layout().pattern;
        let c = rows_of(mechanism, kept);
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
        Self {
            saddle: SchurSaddle::new(structure(mechanism, &c)),
            c,
            first,
            more,
        }
    }

    /// Factors the rows with these entries of C; rows whose relative pivots are at most `floor` are
    /// skipped.
    pub(super) fn factor_above(
        &mut self,
        floor: f64,
        entries: &[f64],
        mass: &[f64],
    ) -> Result<(), SaddleError> {
        let values = self.c.values_mut();
        for (value, &(entry, unit)) in values.iter_mut().zip(&self.first) {
            *value = entries[entry as usize] * unit;
        }
        for &(place, (entry, unit)) in &self.more {
            values[place as usize] += entries[entry as usize] * unit;
        }
        self.saddle.factor_above(floor, &self.c, mass)
    }
}

/// The sparsity pattern of the kept rows, with zeros as entries.
fn rows_of(mechanism: &Mechanism, kept: &[usize]) -> SparseMatrix {
    let layout = mechanism.layout();
    let pattern = &layout.pattern;
    let row =
        |&i: &usize| (pattern.start[i]..pattern.start[i + 1]).map(|at| (pattern.column[at], 0.0));
    // The columns of a pattern are always below n_v; without entries there is nothing to solve.
    SparseMatrix::from_rows(layout.n_v, kept.iter().map(row))
        .unwrap_or_else(|_| unreachable!("columns of a pattern are below {}", layout.n_v))
}

fn structure(mechanism: &Mechanism, c: &SparseMatrix) -> SchurStructure {
    let bodies = 0..mechanism.bodies().len();
    let blocks: Vec<_> = bodies.map(|b| mechanism.layout().columns(b)).collect();
    SchurStructure::new(c, &blocks)
}

/// Memory of the solver of these rows (bytes).
pub(super) fn memory(mechanism: &Mechanism, kept: &[usize]) -> usize {
    let c = rows_of(mechanism, kept);
    let entries = c.nnz() * (size_of::<(usize, f64)>() + size_of::<(u32, f64)>());
    structure(mechanism, &c).bytes() + entries
}
