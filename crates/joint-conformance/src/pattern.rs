//! Tests of sparsity patterns: entries are in range, occur only once, and are nonzero in some case.

use crate::block::Block;
use crate::failure::{Failure, Property, fact};

/// An entry counts as nonzero if it exceeds this fraction of the largest entry of its block. The
/// rounding error of a sum that is identically zero is smaller than this fraction.
const ALIVE: f64 = 1e-10;

/// A pattern, and its entries that were nonzero in some case.
pub(crate) struct Pattern {
    block: &'static str,
    entries: Vec<[usize; 2]>,
    alive: Vec<bool>,
}

impl Pattern {
    /// Creates the pattern of a block of this shape.
    ///
    /// # Errors
    /// Returns an error if an entry is outside the block or occurs twice.
    pub(crate) fn new(
        definition: &'static str,
        block: &'static str,
        shape: [usize; 2],
        entries: Vec<[usize; 2]>,
    ) -> Result<Self, Failure> {
        for (k, &[row, column]) in entries.iter().enumerate() {
            let entry = || format!("entry ({row}, {column}) of the pattern of {block}");
            if row >= shape[0] || column >= shape[1] {
                let entry = format!("{}, outside {} × {}", entry(), shape[0], shape[1]);
                return Err(fact(definition, Property::Pattern, entry, [1.0, 0.0], None));
            }
            let times = entries[..=k]
                .iter()
                .filter(|e| **e == [row, column])
                .count();
            if times > 1 {
                let counts = [times as f64, 1.0];
                return Err(fact(definition, Property::Pattern, entry(), counts, None));
            }
        }
        Ok(Self {
            block,
            alive: vec![false; entries.len()],
            entries,
        })
    }

    /// Records the nonzero entries of one block.
    pub(crate) fn see(&mut self, block: &Block) {
        let least = ALIVE * block.largest();
        for (&[row, column], alive) in self.entries.iter().zip(&mut self.alive) {
            *alive |= block.get(row, column).abs() > least;
        }
    }

    /// Checks that every entry was nonzero in some case.
    pub(crate) fn all_alive(&self, definition: &'static str) -> Result<(), Failure> {
        match self.alive.iter().position(|alive| !alive) {
            Some(k) => {
                let [row, column] = self.entries[k];
                let entry = format!(
                    "entry ({row}, {column}) of the pattern of {}, zero in every case",
                    self.block
                );
                Err(fact(definition, Property::Pattern, entry, [0.0, 1.0], None))
            }
            None => Ok(()),
        }
    }
}
