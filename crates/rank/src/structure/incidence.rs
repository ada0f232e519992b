//! The blocks that rows and groups touch, and the rows that are not settled yet.

use std::ops::Range;

use linalg::Matrix;

/// Rows that belong together, such as those of a joint.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RowGroup {
    /// Rows of C in this group.
    pub rows: Vec<usize>,
    /// Whether the group acts between its blocks and the ground, not only among its blocks.
    ///
    /// With `false`, the caller guarantees that the rows vanish on every common rigid motion of the
    /// blocks, and that a rigid motion of one block has as many degrees of freedom as the block has
    /// columns. Without this guarantee the caller must use `true`; fewer bridges are then found.
    pub ground: bool,
}

/// Blocks and groups that are independent of all other blocks and groups.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Part {
    /// Groups, ascending.
    pub groups: Vec<usize>,
    /// Rows of these groups that are to be analysed together, ascending.
    pub rows: Vec<usize>,
    /// Blocks that these rows touch, ascending.
    pub blocks: Vec<usize>,
}

/// Rows, groups and blocks, and the rows that are not settled yet.
pub(super) struct Incidence {
    /// The equilibrated matrix.
    pub(super) c: Matrix,
    /// Columns of each block.
    pub(super) blocks: Vec<Vec<usize>>,
    /// The given groups, followed by one group for each row outside all groups.
    pub(super) groups: Vec<Group>,
    /// Blocks that each row touches, ascending.
    pub(super) touches: Vec<Vec<usize>>,
    /// Whether each row is not settled yet.
    pub(super) active: Vec<bool>,
}

pub(super) struct Group {
    pub(super) rows: Vec<usize>,
    pub(super) ground: bool,
}

impl Incidence {
    pub(super) fn new(c: Matrix, groups: &[RowGroup], blocks: &[Range<usize>]) -> Self {
        let grouped = groups.iter().map(|g| g.rows.iter().copied());
        let rows_of = partition(c.nrows(), grouped);
        let ground = |k: usize| groups.get(k).is_none_or(|g| g.ground);
        let blocks = partition(c.ncols(), within(c.ncols(), blocks));
        let mut block_of = vec![0; c.ncols()];
        for (b, columns) in blocks.iter().enumerate() {
            columns.iter().for_each(|&column| block_of[column] = b);
        }
        let touches = |i: usize| {
            let entries = c.row(i).iter().zip(&block_of);
            let mut touched: Vec<usize> = entries
                .filter(|(entry, _)| **entry != 0.0)
                .map(|(_, b)| *b)
                .collect();
            touched.sort_unstable();
            touched.dedup();
            touched
        };
        let touches = (0..c.nrows()).map(touches).collect();
        Self {
            active: vec![true; c.nrows()],
            c,
            blocks,
            groups: rows_of
                .into_iter()
                .enumerate()
                .map(|(k, rows)| Group {
                    rows,
                    ground: ground(k),
                })
                .collect(),
            touches,
        }
    }

    /// Returns the rows of a group that are not settled yet.
    pub(super) fn remaining(&self, group: usize) -> Vec<usize> {
        let rows = self.groups[group].rows.iter().copied();
        rows.filter(|&row| self.active[row]).collect()
    }

    /// Returns the blocks that the remaining rows of a group touch, ascending.
    pub(super) fn blocks_of(&self, group: usize) -> Vec<usize> {
        let rows = self.remaining(group);
        let mut blocks: Vec<usize> = rows
            .iter()
            .flat_map(|&row| self.touches[row].iter().copied())
            .collect();
        blocks.sort_unstable();
        blocks.dedup();
        blocks
    }
}

/// Returns the ranges, truncated at `n`.
pub(crate) fn within(n: usize, ranges: &[Range<usize>]) -> impl Iterator<Item = Range<usize>> {
    ranges.iter().map(move |r| r.start.min(n)..r.end.min(n))
}

/// Splits `0..n` by sets. An index belongs to the first set that contains it. The result ends with
/// one set for each index outside all sets.
pub(crate) fn partition(
    n: usize,
    given: impl Iterator<Item = impl IntoIterator<Item = usize>>,
) -> Vec<Vec<usize>> {
    let mut free = vec![true; n];
    let mut sets = Vec::new();
    for set in given {
        let mut is_free = |k: &usize| free.get_mut(*k).is_some_and(std::mem::take);
        sets.push(set.into_iter().filter(&mut is_free).collect());
    }
    sets.extend((0..n).filter(|&k| free[k]).map(|k| vec![k]));
    sets
}
