//! The dense solver of kept rows, with the places of their entries.

use linalg::{KeptRowSaddle, Matrix, Refinement, SaddleError};
use model::{Mechanism, System};

/// Kept rows in units of the mechanism, and their factors.
#[derive(Clone)]
pub(super) struct Dense {
    pub(super) c: Matrix,
    gather: Gather,
    pub(super) saddle: KeptRowSaddle,
    pub(super) refinement: Refinement,
}

impl Dense {
    pub(super) fn new(
        mechanism: &Mechanism,
        kept: &[usize],
        units: &[f64],
    ) -> Result<Self, SaddleError> {
        let (n, r) = (mechanism.layout().n_v, kept.len());
        let gather = Gather::new(mechanism, kept, units);
        let columns = gather.columns(r, n);
        Ok(Self {
            c: Matrix::zeros(r, n),
            gather,
            saddle: KeptRowSaddle::with_columns(n, &columns)?,
            refinement: Refinement::new(n, r),
        })
    }

    /// Factors the rows with these entries of C; rows whose relative pivots are at most `floor` are
    /// skipped.
    pub(super) fn factor_above(
        &mut self,
        floor: f64,
        entries: &[f64],
        mass: &[f64],
    ) -> Result<(), SaddleError> {
        self.gather.take(entries, &mut self.c);
        let c = &self.c;
        self.saddle.factor_above(floor, |k| c.row(k), mass)
    }
}

/// The places to which the entries of kept rows are written, and the units by which they are
/// multiplied.
#[derive(Clone)]
struct Gather {
    /// Entries that are written first to their place.
    first: Vec<Entry>,
    /// Entries that are added to a place: a joint may contribute twice to a coordinate.
    more: Vec<Entry>,
}

#[derive(Clone, Copy)]
struct Entry {
    /// Index in the matrix of kept rows, row-major.
    place: usize,
    /// Index among the entries of C.
    entry: usize,
    unit: f64,
}

impl Gather {
    fn new(mechanism: &Mechanism, kept: &[usize], units: &[f64]) -> Self {
        let (n, pattern) = (mechanism.layout().n_v, &mechanism.layout().pattern);
        let mut is_taken = vec![false; kept.len() * n];
        let entries = kept.iter().enumerate().flat_map(|(k, &i)| {
            let entry = move |at: usize| Entry {
                place: k * n + pattern.column[at],
                entry: pattern.entry[at],
                unit: units[pattern.column[at]],
            };
            (pattern.start[i]..pattern.start[i + 1]).map(entry)
        });
        let (first, more) =
            entries.partition(|entry| !std::mem::replace(&mut is_taken[entry.place], true));
        Self { first, more }
    }

    /// Columns in which each row has entries.
    fn columns(&self, r: usize, n: usize) -> Vec<Vec<usize>> {
        let mut columns = vec![Vec::new(); r];
        for entry in &self.first {
            columns[entry.place / n].push(entry.place % n);
        }
        columns
    }

    /// Writes the rows from the entries of C; other places stay zero.
    fn take(&self, entries: &[f64], c: &mut Matrix) {
        let c = c.as_mut_slice();
        for entry in &self.first {
            c[entry.place] = entries[entry.entry] * entry.unit;
        }
        for entry in &self.more {
            c[entry.place] += entries[entry.entry] * entry.unit;
        }
    }
}
