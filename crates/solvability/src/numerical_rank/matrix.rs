//! Constraint matrix C of the intended mechanism. A force or lever arm that is smaller than its
//! uncertainty counts as zero.
//!
//! Forces and levers are compared as vectors. The components of these vectors are never compared,
//! because they depend on the axes. A vector is the block of the force rows or of the moment rows
//! of a joint, in the columns of the translation or of the rotation of one body. Each vector has
//! one scale.

use crate::pose::dimensionless;
use std::ops::Range;

use linalg::{DdMatrix, Matrix, Scaling, equilibrate_blocks};
use model::{ConfigurationAccuracy, Mechanism, Scratch, SpaceKind, System};

/// Dimensionless C, with the uncertainty of its entries.
#[derive(Clone, Debug)]
pub(crate) struct UncertainMatrix {
    /// Matrix of size (m + h) × n_v. Forces and levers that count as zero are set to zero.
    pub(crate) c: Matrix,
    /// Uncertainty of the entries; zero for entries that were set to zero.
    pub(crate) uncertainty: Matrix,
    /// Row and column of the entries that have been set to zero.
    zeros: Vec<(usize, usize)>,
    row_blocks: Vec<usize>,
    col_blocks: Vec<usize>,
}

impl UncertainMatrix {
    /// Evaluates C at the configuration of the scratch, for a mechanism of this size. Φ and C must
    /// have been evaluated in the scratch.
    pub(crate) fn new(
        mechanism: &Mechanism,
        s: &Scratch,
        size: f64,
        known: ConfigurationAccuracy,
    ) -> Self {
        let uncertainty = mechanism
            .layout()
            .dimension_scaling(size)
            .apply(&mechanism.scales(s).uncertainty(size, known));
        Self::of(mechanism, dimensionless(mechanism, s, size), uncertainty)
    }

    /// Starts from the dimensionless C and the uncertainty of its entries.
    pub(crate) fn of(mechanism: &Mechanism, c: Matrix, uncertainty: Matrix) -> Self {
        let mut uncertain = Self {
            col_blocks: (0..c.ncols())
                .map(|j| col_block(mechanism.space(), j))
                .collect(),
            row_blocks: row_blocks(mechanism),
            zeros: Vec::new(),
            c,
            uncertainty,
        };
        let mut first = 0;
        for end in 1..=uncertain.row_blocks.len() {
            if end == uncertain.row_blocks.len()
                || uncertain.row_blocks[end] != uncertain.row_blocks[first]
            {
                uncertain.clear(first..end);
                first = end;
            }
        }
        uncertain
    }

    /// Sets the forces and levers of these rows to zero if they are within their uncertainty. The
    /// rows belong to one block.
    fn clear(&mut self, rows: Range<usize>) {
        let n = self.c.ncols();
        let mut first = 0;
        for end in 1..=n {
            if end < n && self.col_blocks[end] == self.col_blocks[first] {
                continue;
            }
            let size = |of: &Matrix| {
                let mut sum = 0.0;
                for i in rows.clone() {
                    for x in &of.row(i)[first..end] {
                        sum += x * x;
                    }
                }
                sum
            };
            let (force, known) = (size(&self.c), size(&self.uncertainty));
            // For most bodies the block is exactly zero.
            if force <= known && known > 0.0 {
                for i in rows.clone() {
                    for j in (first..end).filter(|&j| self.c[(i, j)] != 0.0) {
                        self.zeros.push((i, j));
                    }
                    self.c.row_mut(i)[first..end].fill(0.0);
                    self.uncertainty.row_mut(i)[first..end].fill(0.0);
                }
            }
            first = end;
        }
    }

    /// Returns a scaling with one factor for the translation of each body, one for the rotation of
    /// each body, one for the force rows of each joint, and one for the moment rows of each joint.
    /// A lever determines the scale of its body only if the lever is far larger than its
    /// uncertainty. Otherwise the rounding of larger terms could be scaled up to norm one. The rank
    /// does not depend on scales.
    pub(crate) fn scaling(&self) -> Scaling {
        let significant = |i: usize, j: usize| match self.c[(i, j)] {
            c if c.abs() > rank::SIGNIFICANT * self.uncertainty[(i, j)] => c,
            _ => 0.0,
        };
        let c = Matrix::from_fn(self.c.nrows(), self.c.ncols(), significant);
        equilibrate_blocks(&c, &self.row_blocks, &self.col_blocks)
    }

    /// Returns the same matrix in double-double. `c` contains all entries in double-double. Entries
    /// that are zero in this matrix are set to zero in the result.
    pub(crate) fn extended(&self, mut c: DdMatrix) -> DdMatrix {
        for &(i, j) in &self.zeros {
            c[(i, j)] = linalg::Dd::ZERO;
        }
        c
    }

    /// Returns whether a force or lever has been set to zero.
    pub(crate) fn has_zeros(&self) -> bool {
        !self.zeros.is_empty()
    }

    /// Selects some of the rows, ascending.
    pub(crate) fn select(&self, rows: &[usize]) -> Self {
        let place = |&(i, j): &(usize, usize)| Some((rows.binary_search(&i).ok()?, j));
        Self {
            c: self.c.select_rows(rows),
            uncertainty: self.uncertainty.select_rows(rows),
            zeros: self.zeros.iter().filter_map(place).collect(),
            row_blocks: rows.iter().map(|&i| self.row_blocks[i]).collect(),
            col_blocks: self.col_blocks.clone(),
        }
    }
}

/// Returns the block of each column, which is the translation or the rotation of a body.
fn col_block(space: SpaceKind, j: usize) -> usize {
    2 * space.body_of(j) + usize::from(space.is_rotation(j))
}

/// Returns the block of each row, which is the force rows or the moment rows of a joint on one
/// level. The rows of a block are adjacent. Rows of the same kind that are not adjacent form
/// different blocks.
fn row_blocks(mechanism: &Mechanism) -> Vec<usize> {
    let layout = mechanism.layout();
    let kind = |row: usize| (layout.owners[row], row < layout.m, layout.is_angular(row));
    let mut blocks = Vec::with_capacity(layout.rows());
    let (mut last, mut next) = (None, 0);
    for row in 0..layout.rows() {
        let own = Some(kind(row));
        next += usize::from(last != own);
        last = own;
        blocks.push(next - 1);
    }
    blocks
}
