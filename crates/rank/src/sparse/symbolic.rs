//! The sequence of fronts of a factorisation, determined from the pattern alone.
//!
//! A *front* is a small dense matrix of all entries that involve the bodies eliminated in it. A
//! front consists of rows of C that have not occurred before, and of the remainders of the fronts
//! below. The columns of a front are the columns of its own bodies, the *pivots*, followed by the
//! columns of the bodies connected to the pivots at that time. The first of these connected bodies
//! is eliminated in the front above, so fronts a separate front.
//!
//! Source: J. W. H. Liu, On general row merging schemes for sparse Givens transformations, SIAM J.
//! Sci. Stat. Comput. 7 (1986) 1190–1211, for the tree; T. A. Davis, Algorithm 915: SuiteSparseQR,
//! ACM Trans. Math. Softw. 38 (2011) 8, for fronts that are factored completely.

use crate::limits::{SMALL_FRONT, WORK_MAX};
use std::ops::Range;

use crate::structure::{partition, within};
use linalg::{EliminationTree, SparseMatrix};

/// The factor that is stored; the other factor is not stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum KeptFactor {
    Q,
    R,
}

/// Number of operations, counted or estimated, when the limit was exceeded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TooDense {
    pub(super) work: f64,
}

/// The fronts of matrices with one pattern.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Symbolic {
    pub(super) nrows: usize,
    pub(super) ncols: usize,
    /// Consecutive rows with entries in the same blocks.
    pub(super) row_blocks: Vec<Range<usize>>,
    /// Rows without entries, which belong to no front.
    pub(super) empty_rows: Vec<usize>,
    /// The fronts. Each front comes after all fronts below it, and the children of a front come
    /// directly before it, together with their descendants.
    pub(super) fronts: Vec<Front>,
}

/// A front without the values of its entries.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Front {
    /// Index after the last column of each body among the pivots.
    pub(super) ends: Vec<usize>,
    /// Columns of C: first the pivots, then the columns that are eliminated later.
    pub(super) columns: Vec<usize>,
    /// Rows of C that first occur in this front.
    pub(super) rows: Vec<usize>,
    /// Number of fronts whose remainders are assembled in this front.
    pub(super) children: usize,
}

impl Symbolic {
    /// Determines the fronts of a matrix whose columns form blocks. Ranges beyond the matrix are
    /// truncated, and a column outside all blocks is a separate block.
    pub(super) fn new(c: &SparseMatrix, blocks: &[Range<usize>]) -> Result<Self, TooDense> {
        let blocks = partition(c.ncols(), within(c.ncols(), blocks));
        let touched = BlockSets::new(c, &blocks);
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
    /// Returns the upper bound (bytes) on the memory of a factorisation: the stored factor, and the
    /// current front with the stored remainders. The bound assumes fronts of full rank; dependent
    /// columns add little memory.
    pub(super) fn bytes(&self, wanted: KeptFactor) -> usize {
        let (mut factor, mut waiting, mut most) = (0, 0, 0);
        // Numbers of rows and columns of the stored remainders.
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
                    // Reflections of all columns, including those after the pivots.
                    KeptFactor::Q => rank * rows - rank * rank.saturating_sub(1) / 2,
                    KeptFactor::R => {
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

/// Bytes of a value, and of a value with its index.
const NUMBER: usize = size_of::<f64>();
const ENTRY: usize = NUMBER + size_of::<usize>();

/// The blocks in which rows have entries. Consecutive rows with the same blocks form one set.
struct BlockSets {
    sets: Vec<Vec<usize>>,
    /// Rows of each set.
    rows: Vec<Range<usize>>,
}

impl BlockSets {
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
    /// Pivot nodes, ascending along every path to the root.
    pivots: Vec<usize>,
    /// The last pivot node.
    top: usize,
    children: usize,
}

/// Merges small fronts, and fronts that fit exactly, into their parents. Returns the fronts in an
/// order in which the children of each front come directly before the front, with their
/// descendants.
fn amalgamate(tree: &EliminationTree, size: impl Fn(usize) -> usize) -> Vec<Supernode> {
    let n = tree.order.len();
    // Numbers of columns that are eliminated in the front of a node, and numbers of all columns of
    // the front.
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
    // Parents come first, and the last child comes first. After reversal, children come directly
    // before their parents.
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

/// Returns a node, after all nodes that were merged into it.
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
