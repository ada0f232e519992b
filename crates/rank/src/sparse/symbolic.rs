//! Which fronts a factorisation goes through: from the pattern alone, before any value.
//!
//! A *front* is the small dense matrix of all that touches the bodies eliminated in it: rows of C
//! not met before, and what the fronts below have left over. Its columns are those of its own
//! bodies, the *pivots*, and then those of the bodies that are joined to them by then. The first of
//! these is eliminated in the front above, so fronts form a tree. A small front is put into the one
//! above it: a few zeros cost less than a front.
//!
//! Source: J. W. H. Liu, On general row merging schemes for sparse Givens transformations, SIAM J.
//! Sci. Stat. Comput. 7 (1986) 1190–1211, for the tree; T. A. Davis, Algorithm 915: SuiteSparseQR,
//! ACM Trans. Math. Softw. 38 (2011) 8, for fronts that are factored completely.

use crate::limits::{SMALL_FRONT, WORK_MAX};
use std::ops::Range;

use crate::structure::partition;
use linalg::{EliminationTree, SparseMatrix};

/// Which factor is kept; the other one is not stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Wanted {
    Q,
    R,
}

/// Operations, counted or estimated, when the limit was passed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TooDense {
    pub(super) work: f64,
}

/// The fronts of matrices of one pattern.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Symbolic {
    pub(super) nrows: usize,
    pub(super) ncols: usize,
    /// Consecutive rows that touch the same blocks.
    pub(super) row_blocks: Vec<Range<usize>>,
    /// Rows without entries, which are in no front.
    pub(super) empty_rows: Vec<usize>,
    /// Those below a front come before it; the last ones before it are its children.
    pub(super) fronts: Vec<Front>,
}

/// A front before it has values.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Front {
    /// Ends of the bodies among the pivots.
    pub(super) ends: Vec<usize>,
    /// Columns of C: the pivots, and those that are eliminated later, in that order.
    pub(super) columns: Vec<usize>,
    /// Rows of C that are met here first.
    pub(super) rows: Vec<usize>,
    /// Fronts whose rest is taken over.
    pub(super) children: usize,
}

impl Symbolic {
    /// The fronts of a matrix whose columns come in blocks. Ranges beyond the matrix are cut; a
    /// column in no block is one.
    pub(super) fn new(c: &SparseMatrix, blocks: &[Range<usize>]) -> Result<Self, TooDense> {
        let blocks = partition(c.ncols(), blocks.iter());
        let touched = Touched::new(c, &blocks);
        let mut work = 0.0;
        let admit = |k: usize, order: &[usize], beyond: &[usize]| {
            let size = |k: usize| blocks[order[k]].len();
            let width = size(k) + beyond.iter().map(|&j| size(j)).sum::<usize>();
            work += size(k) as f64 * (width as f64).powi(2);
            if work > WORK_MAX {
                return Err(TooDense { work });
            }
            Ok(())
        };
        let tree = EliminationTree::while_admitted(blocks.len(), &touched.sets, admit)?;
        let block = |k: usize| &blocks[tree.order[k]];
        let supernodes = amalgamate(&tree, |k| block(k).len());
        let columns = |k: &usize| block(*k).iter().copied();
        let mut fronts = Vec::with_capacity(supernodes.len());
        for Supernode {
            pivots,
            top,
            children,
        } in supernodes
        {
            let mut front = Front {
                children,
                ..Front::default()
            };
            for k in &pivots {
                front.columns.extend(columns(k));
                front.ends.push(front.columns.len());
                for &set in &tree.led[*k] {
                    front.rows.extend(touched.rows[set].clone());
                }
            }
            front
                .columns
                .extend(tree.beyond[top].iter().flat_map(columns));
            fronts.push(front);
        }
        let empty_rows = (0..c.nrows()).filter(|&i| c.row(i).0.is_empty()).collect();
        Ok(Self {
            nrows: c.nrows(),
            ncols: c.ncols(),
            row_blocks: touched.rows,
            empty_rows,
            fronts,
        })
    }
}

impl Symbolic {
    /// Bytes that a factorisation holds at most: the factor that is kept, and the front in work
    /// with the rests that wait. For fronts of full rank; what dependent columns leave besides is
    /// little.
    pub(super) fn bytes(&self, wanted: Wanted) -> usize {
        let (mut factor, mut waiting, mut most) = (0, 0, 0);
        // Rows and columns of the rests that wait.
        let mut rests: Vec<[usize; 2]> = Vec::new();
        for front in &self.fronts {
            let width = front.columns.len();
            let taken = rests.split_off(rests.len().saturating_sub(front.children));
            let rows = front.rows.len() + taken.iter().map(|[rows, _]| rows).sum::<usize>();
            most = most.max(factor + NUMBER * (waiting + rows * width));
            waiting -= taken
                .iter()
                .map(|[rows, columns]| rows * columns)
                .sum::<usize>();
            let pivots = front.ends.last().map_or(0, |end| *end);
            let rank = rows.min(width);
            factor += ENTRY
                * match wanted {
                    // Reflections of all columns, those beyond the pivots included.
                    Wanted::Q => rank * rows - rank * rank.saturating_sub(1) / 2,
                    Wanted::R => {
                        let own = rank.min(pivots);
                        own * width - own * own.saturating_sub(1) / 2
                    }
                };
            if pivots < width {
                let rest = [rows.min(width).saturating_sub(pivots), width - pivots];
                waiting += rest[0] * rest[1];
                rests.push(rest);
            }
            most = most.max(factor + NUMBER * waiting);
        }
        most
    }
}

/// Bytes of a number, and of a number with its place.
const NUMBER: usize = size_of::<f64>();
const ENTRY: usize = NUMBER + size_of::<usize>();

/// The blocks that rows touch; consecutive rows of the same blocks are one set.
struct Touched {
    sets: Vec<Vec<usize>>,
    /// Rows of each set.
    rows: Vec<Range<usize>>,
}

impl Touched {
    fn new(c: &SparseMatrix, blocks: &[Vec<usize>]) -> Self {
        let mut block_of = vec![0; c.ncols()];
        for (b, columns) in blocks.iter().enumerate() {
            columns.iter().for_each(|&column| block_of[column] = b);
        }
        let (mut sets, mut rows): (Vec<Vec<usize>>, Vec<Range<usize>>) = Default::default();
        let mut set = Vec::new();
        for i in 0..c.nrows() {
            set.clear();
            set.extend(c.row(i).0.iter().map(|&j| block_of[j]));
            set.sort_unstable();
            set.dedup();
            if set.is_empty() {
                continue;
            }
            match (sets.last(), rows.last_mut()) {
                (Some(last), Some(range)) if *last == set && range.end == i => range.end = i + 1,
                _ => {
                    sets.push(set.clone());
                    rows.push(i..i + 1);
                }
            }
        }
        Self { sets, rows }
    }
}

/// Nodes that are eliminated in one front.
struct Supernode {
    /// Ascending along every path to the root.
    pivots: Vec<usize>,
    /// The last of them.
    top: usize,
    children: usize,
}

/// Puts small fronts, and those that fit exactly, into their parents; the fronts in an order in
/// which the children of each come right before it, with their descendants.
fn amalgamate(tree: &EliminationTree, size: impl Fn(usize) -> usize) -> Vec<Supernode> {
    let n = tree.order.len();
    // Columns that are eliminated in the front of a node, and columns of the front.
    let mut pivots: Vec<usize> = (0..n).map(&size).collect();
    let mut width: Vec<usize> = (0..n)
        .map(|k| pivots[k] + tree.beyond[k].iter().map(|&j| size(j)).sum::<usize>())
        .collect();
    let mut children = tree.children.clone();
    let mut merged = vec![Vec::new(); n];
    for k in 0..n {
        let mut apart = Vec::new();
        for child in std::mem::take(&mut children[k]) {
            let together = pivots[child] + width[k];
            if together == width[child] || together <= SMALL_FRONT {
                pivots[k] += pivots[child];
                width[k] = together;
                merged[k].push(child);
                let own = std::mem::take(&mut children[child]);
                apart.extend(own);
            } else {
                apart.push(child);
            }
        }
        children[k] = apart;
    }
    // Parents first, last child first; turned round, children come right before their parents.
    let mut reversed = Vec::with_capacity(n);
    let mut open: Vec<usize> = (0..n).filter(|&k| tree.beyond[k].is_empty()).collect();
    while let Some(k) = open.pop() {
        reversed.push(Supernode {
            pivots: with_merged(k, &merged),
            top: k,
            children: children[k].len(),
        });
        open.extend(&children[k]);
    }
    reversed.reverse();
    reversed
}

/// A node after all that were merged into it.
fn with_merged(top: usize, merged: &[Vec<usize>]) -> Vec<usize> {
    let mut reversed = Vec::new();
    let mut open = vec![top];
    while let Some(k) = open.pop() {
        reversed.push(k);
        open.extend(&merged[k]);
    }
    reversed.reverse();
    reversed
}
