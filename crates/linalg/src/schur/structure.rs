//! Everything that depends on the pattern only: an order of elimination, fronts, and the places of
//! all numbers.
//!
//! Rows that touch the same blocks (bodies) are eliminated together. They are the nodes of a graph
//! in which each block joins the rows that touch it, ordered by minimum degree. A front is a dense
//! triangle over the rows that are eliminated in it, its pivots, and the later rows with which they
//! have non-zero entries. `C_b·M_b⁻¹·C_bᵀ` of a block b is added to the front in which the first of
//! its rows is a pivot; the remainder of a front after elimination is added to the front of the
//! first of its other rows, its parent. Fronts that are almost equal to their parent are merged
//! with it.

use std::ops::Range;

use crate::limits::{FRONT_FEW_ZEROS, FRONT_ZEROS};
use crate::{EliminationTree, SparseMatrix};

/// Marks a place without an entry of C.
pub(super) const NONE: u32 = u32::MAX;

/// The pattern of `S = C·M⁻¹·Cᵀ` and of its factor.
///
/// ```
/// use linalg::{SchurStructure, SparseMatrix};
/// // A chain of three rows over four columns: each is a block, and L has no more entries than S.
/// let row = |k: usize| [(k, 1.0), (k + 1, -1.0)];
/// let c = SparseMatrix::from_rows(4, (0..3).map(row))?;
/// let structure = SchurStructure::new(&c, &[0..1, 1..2, 2..3, 3..4]);
/// assert_eq!((structure.n_rows(), structure.n_coordinates()), (3, 4));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct SchurStructure {
    pub(super) rows: Rows,
    /// In the order of elimination; children come before their parents, the last child directly
    /// before.
    pub(super) fronts: Vec<Front>,
    /// Later rows of all fronts, as places in the order.
    pub(super) later: Vec<u32>,
    /// For each later row its index in the parent.
    pub(super) in_parent: Vec<u32>,
    pub(super) elements: Elements,
    pub(super) size: Size,
}

/// C by rows in the order of elimination.
#[derive(Clone, Debug)]
pub(super) struct Rows {
    /// Number of columns of C.
    n: usize,
    /// Number of entries of C.
    pub(super) nnz: usize,
    /// The row at each place of the order of elimination, and the place of each row.
    pub(super) row: Vec<usize>,
    pub(super) place: Vec<usize>,
    /// For each place, the index of its first column in `columns` and of its first value in C; one
    /// more for the end.
    start: Vec<[u32; 2]>,
    /// Columns of all rows.
    columns: Vec<u32>,
}

impl Rows {
    fn new(c: &SparseMatrix, row: Vec<usize>) -> Self {
        let mut place = vec![0; row.len()];
        row.iter().enumerate().for_each(|(k, &i)| place[i] = k);
        let mut start = Vec::with_capacity(row.len() + 1);
        let mut columns = Vec::with_capacity(c.nnz());
        for &row in &row {
            start.push([columns.len() as u32, c.start(row) as u32]);
            columns.extend(c.row(row).0.iter().map(|&j| j as u32));
        }
        start.push([columns.len() as u32, 0]);
        Self {
            n: c.ncols(),
            nnz: c.nnz(),
            row,
            place,
            start,
            columns,
        }
    }

    /// Entries (column, value) of the row at a place, for the values of C.
    pub(super) fn entries_at<'c>(
        &'c self,
        place: usize,
        values: &'c [f64],
    ) -> impl Iterator<Item = (usize, f64)> + 'c {
        let [[first, value], [end, _]] = [self.start[place], self.start[place + 1]];
        let columns = &self.columns[first as usize..end as usize];
        let values = &values[value as usize..][..columns.len()];
        columns
            .iter()
            .map(|&j| j as usize)
            .zip(values.iter().copied())
    }
}

/// Blocks of columns, with the rows that touch them.
#[derive(Clone, Debug, Default)]
pub(super) struct Elements {
    pub(super) of_fronts: Vec<Element>,
    /// Columns of all elements.
    pub(super) columns: Vec<u32>,
    /// For each row of all elements its index in the front.
    pub(super) in_front: Vec<u32>,
    /// For each row and column of all elements the entry of C, or [`NONE`].
    pub(super) entries: Vec<u32>,
}

/// Size and work of a factorisation.
#[derive(Clone, Debug, Default)]
pub(super) struct Size {
    /// Number of entries of L.
    pub(super) entries: usize,
    /// Largest number of values that are stored for their parents.
    pub(super) waiting: usize,
    pub(super) front: usize,
    pub(super) element: usize,
    multiplications: f64,
}

/// A dense triangle.
#[derive(Clone, Debug)]
pub(super) struct Front {
    /// Places of its pivots.
    pub(super) pivots: Range<usize>,
    /// Its other rows in `later` and `in_parent`.
    pub(super) rest: Range<usize>,
    /// Blocks that are added to it, in `elements`.
    pub(super) elements: Range<usize>,
    /// Fronts whose parent it is, the last one first.
    pub(super) children: Vec<usize>,
    /// Index of its first column of L, below the unit diagonal.
    pub(super) l: usize,
}

impl Front {
    pub(super) fn order(&self) -> usize {
        self.pivots.len() + self.rest.len()
    }
}

/// A block of columns, with the rows that touch it.
#[derive(Clone, Debug)]
pub(super) struct Element {
    /// In the columns of all elements.
    pub(super) columns: Range<usize>,
    /// In `in_front` of all elements.
    pub(super) rows: Range<usize>,
    /// Index of its first entry in `entries`, row by row.
    pub(super) entries: usize,
}

impl SchurStructure {
    /// The structure for rows with this pattern, whose values are not used, and blocks of columns.
    /// A column in no block is a block of its own, and a column in several belongs to the first.
    #[must_use]
    pub fn new(c: &SparseMatrix, blocks: &[Range<usize>]) -> Self {
        let blocks = Blocks::new(c, blocks);
        let nodes = Nodes::new(c, &blocks);
        let tree = Tree::new(&nodes);
        tree.into_structure(c, &blocks, &nodes)
    }

    /// Number of coordinates n.
    #[must_use]
    pub fn n_coordinates(&self) -> usize {
        self.rows.n
    }

    /// Number of rows r.
    #[must_use]
    pub fn n_rows(&self) -> usize {
        self.rows.row.len()
    }

    /// Number of stored entries of L, below its diagonal.
    #[must_use]
    pub fn n_entries(&self) -> usize {
        self.size.entries
    }

    /// Approximate number of multiplications of a factorisation.
    #[must_use]
    pub fn multiplications(&self) -> f64 {
        self.size.multiplications
    }

    /// Memory of a [`SchurSaddle`](crate::SchurSaddle) with this structure, in bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let Size {
            entries,
            waiting,
            front,
            ..
        } = self.size;
        let numbers =
            entries + waiting + front * (front + 1) + 5 * self.n_rows() + 3 * self.n_coordinates();
        let indices = 2 * (self.later.len() + self.rows.start.len())
            + self.rows.columns.len()
            + self.elements.columns.len()
            + self.elements.in_front.len()
            + self.elements.entries.len();
        let records = self.fronts.len() * size_of::<Front>()
            + self.elements.of_fronts.len() * size_of::<Element>();
        8 * numbers + 4 * indices + records
    }
}

/// Blocks of columns, and the blocks that each row touches.
struct Blocks {
    columns: Vec<Vec<usize>>,
    of_column: Vec<usize>,
}

impl Blocks {
    fn new(c: &SparseMatrix, ranges: &[Range<usize>]) -> Self {
        let free = usize::MAX;
        let mut of_column = vec![free; c.ncols()];
        let mut columns: Vec<Vec<usize>> = Vec::with_capacity(ranges.len());
        let single = |j: usize| j..j + 1;
        for range in ranges.iter().cloned().chain((0..c.ncols()).map(single)) {
            let cut = range.start.min(c.ncols())..range.end.min(c.ncols());
            let own: Vec<usize> = cut.filter(|&j| of_column[j] == free).collect();
            if own.is_empty() {
                continue;
            }
            own.iter().for_each(|&j| of_column[j] = columns.len());
            columns.push(own);
        }
        Self { columns, of_column }
    }

    /// Blocks that a row touches, ascending.
    fn of_row(&self, c: &SparseMatrix, row: usize, out: &mut Vec<usize>) {
        out.clear();
        out.extend(c.row(row).0.iter().map(|&j| self.of_column[j]));
        out.sort_unstable();
        out.dedup();
    }
}

/// Rows that touch the same blocks.
struct Nodes {
    rows: Vec<Vec<usize>>,
    /// Nodes that touch each block.
    touching: Vec<Vec<usize>>,
}

impl Nodes {
    fn new(c: &SparseMatrix, blocks: &Blocks) -> Self {
        let mut touched = Vec::new();
        let mut keyed: Vec<(Vec<usize>, usize)> = (0..c.nrows())
            .map(|row| {
                blocks.of_row(c, row, &mut touched);
                (touched.clone(), row)
            })
            .collect();
        keyed.sort();
        let mut nodes = Self {
            rows: Vec::new(),
            touching: vec![Vec::new(); blocks.columns.len()],
        };
        let mut last = None;
        for (key, row) in keyed {
            // Rows without entries do not belong together.
            let is_same = !key.is_empty() && last.as_ref() == Some(&key);
            if !is_same {
                for &block in &key {
                    nodes.touching[block].push(nodes.rows.len());
                }
                nodes.rows.push(Vec::new());
                last = Some(key);
            }
            if let Some(rows) = nodes.rows.last_mut() {
                rows.push(row);
            }
        }
        nodes
    }
}

/// Nodes in the order of elimination, with their later neighbours.
struct Tree {
    /// Nodes in this order.
    order: Vec<usize>,
    /// For each place: its later neighbours, ascending, and the number of places before it that are
    /// merged with it.
    meets: Vec<Vec<usize>>,
    merged: Vec<usize>,
}

impl Tree {
    fn new(nodes: &Nodes) -> Self {
        let n = nodes.rows.len();
        let (order, meets) = postordered(EliminationTree::new(n, &nodes.touching));
        let width = |k: usize| nodes.rows[order[k]].len();
        // Rows of a front, its columns, and the zeros among their entries so far.
        let rows_of = |k: usize| meets[k].iter().map(|&j| width(j)).sum::<usize>();
        let mut merged = vec![0; n];
        let mut columns: Vec<usize> = (0..n).map(width).collect();
        let mut zeros = vec![0; n];
        for k in 1..n {
            loop {
                let last = k - merged[k];
                // The front directly before, if this one is its parent.
                let is_child =
                    |c: &usize| meets[*c].first().is_some_and(|j| (last..=k).contains(j));
                let Some(child) = last.checked_sub(1).filter(is_child) else {
                    break;
                };
                let (rest, own) = (rows_of(k), columns[k]);
                let missing = columns[child] * ((rest + own).saturating_sub(rows_of(child)));
                let all = zeros[k] + zeros[child] + missing;
                let total = columns[child] + own;
                let entries = total * (total + 1) / 2 + total * rest;
                if all > FRONT_FEW_ZEROS && all as f64 > FRONT_ZEROS * entries as f64 {
                    break;
                }
                merged[k] += 1 + merged[child];
                columns[k] = total;
                zeros[k] = all;
            }
        }
        Self {
            order,
            meets,
            merged,
        }
    }

    fn into_structure(self, c: &SparseMatrix, blocks: &Blocks, nodes: &Nodes) -> SchurStructure {
        let n = self.order.len();
        let row: Vec<usize> = self
            .order
            .iter()
            .flat_map(|&node| nodes.rows[node].iter().copied())
            .collect();
        // First place of each node, and the front of each.
        let mut first = vec![0; n + 1];
        for k in 0..n {
            first[k + 1] = first[k] + nodes.rows[self.order[k]].len();
        }
        let mut s = SchurStructure {
            rows: Rows::new(c, row),
            fronts: Vec::new(),
            later: Vec::new(),
            in_parent: Vec::new(),
            elements: Elements::default(),
            size: Size::default(),
        };
        let mut place_of_node = vec![0; n];
        self.order
            .iter()
            .enumerate()
            .for_each(|(k, &node)| place_of_node[node] = k);
        // The place at which the first node of a block is eliminated.
        let mut blocks_at: Vec<Vec<usize>> = vec![Vec::new(); n];
        for (block, touching) in nodes.touching.iter().enumerate() {
            if let Some(k) = touching.iter().map(|&node| place_of_node[node]).min() {
                blocks_at[k].push(block);
            }
        }
        // A place is the end of a front unless a later one has been merged with it.
        let mut front_of = vec![usize::MAX; n];
        let mut end = n;
        let mut ends = Vec::new();
        while end > 0 {
            ends.push(end - 1);
            end -= 1 + self.merged[end - 1];
        }
        ends.reverse();
        let mut local = vec![0_u32; s.n_rows()];
        let mut from = 0;
        for last in ends {
            let index = s.fronts.len();
            let pivots = first[from]..first[last + 1];
            let rest = s.later.len();
            for &j in &self.meets[last] {
                s.later.extend((first[j]..first[j + 1]).map(|p| p as u32));
            }
            let rest = rest..s.later.len();
            s.in_parent.resize(s.later.len(), 0);
            (from..=last).for_each(|k| front_of[k] = index);
            let order = pivots.len() + rest.len();
            pivots
                .clone()
                .enumerate()
                .for_each(|(k, p)| local[p] = k as u32);
            for (k, at) in rest.clone().enumerate() {
                local[s.later[at] as usize] = (pivots.len() + k) as u32;
            }
            let elements = s.elements.of_fronts.len();
            for k in from..=last {
                for &block in &blocks_at[k] {
                    s.add_element(c, blocks, nodes, block, &local);
                }
            }
            s.fronts.push(Front {
                elements: elements..s.elements.of_fronts.len(),
                children: Vec::new(),
                l: s.size.entries,
                pivots: pivots.clone(),
                rest,
            });
            s.size.entries += (0..pivots.len()).map(|k| order - 1 - k).sum::<usize>();
            s.size.front = s.size.front.max(order);
            s.size.multiplications += (0..pivots.len())
                .map(|k| 0.5 * ((order - k) * (order - k)) as f64)
                .sum::<f64>();
            from = last + 1;
        }
        s.join(&front_of, &first);
        s
    }
}

impl SchurStructure {
    fn add_element(
        &mut self,
        c: &SparseMatrix,
        blocks: &Blocks,
        nodes: &Nodes,
        block: usize,
        local: &[u32],
    ) {
        let own = &blocks.columns[block];
        let to = &mut self.elements;
        let (columns, rows, entries) = (to.columns.len(), to.in_front.len(), to.entries.len());
        to.columns.extend(own.iter().map(|&j| j as u32));
        let touching = nodes.touching[block].iter();
        let mut of_block: Vec<usize> = touching
            .flat_map(|&node| nodes.rows[node].iter().copied())
            .collect();
        of_block.sort_unstable_by_key(|&row| self.rows.place[row]);
        for row in of_block {
            to.in_front.push(local[self.rows.place[row]]);
            let (start, of_row) = (c.start(row), c.row(row).0);
            let entry = |j| of_row.binary_search(j).map_or(NONE, |k| (start + k) as u32);
            to.entries.extend(own.iter().map(entry));
        }
        let rows = rows..to.in_front.len();
        self.size.element = self.size.element.max(rows.len() * own.len());
        to.of_fronts.push(Element {
            columns: columns..to.columns.len(),
            rows,
            entries,
        });
    }

    /// Connects fronts with their parents, and counts the values stored for them.
    fn join(&mut self, front_of: &[usize], first: &[usize]) {
        let node_of = |place: usize| first.partition_point(|&f| f <= place) - 1;
        let mut waiting = 0;
        let triangle = |front: &Front| front.rest.len() * (front.rest.len() + 1) / 2;
        for k in 0..self.fronts.len() {
            let children = self.fronts[k].children.iter();
            waiting -= children.map(|&c| triangle(&self.fronts[c])).sum::<usize>();
            let rest = self.fronts[k].rest.clone();
            let Some(at) = rest.clone().next() else {
                continue;
            };
            let parent = front_of[node_of(self.later[at] as usize)];
            waiting += triangle(&self.fronts[k]);
            self.size.waiting = self.size.waiting.max(waiting);
            let to = &self.fronts[parent];
            let (pivots, later) = (to.pivots.clone(), to.rest.clone());
            let mut next = later.start;
            for at in rest {
                let p = self.later[at] as usize;
                self.in_parent[at] = if pivots.contains(&p) {
                    p - pivots.start
                } else {
                    while self.later[next] as usize != p {
                        next += 1;
                    }
                    pivots.len() + next - later.start
                } as u32;
            }
            // The last child is on top of the stack.
            self.fronts[parent].children.insert(0, k);
        }
    }
}

/// Places and their later neighbours, renumbered so that children come directly before their
/// parents, the one with the widest front last.
fn postordered(tree: EliminationTree) -> (Vec<usize>, Vec<Vec<usize>>) {
    let EliminationTree {
        order,
        beyond,
        mut children,
        ..
    } = tree;
    // Depth first from the roots, without recursion.
    let n = order.len();
    let mut renumbered = Vec::with_capacity(n);
    for root in (0..n).filter(|&k| beyond[k].is_empty()) {
        let mut stack = vec![(root, false)];
        while let Some((k, is_done)) = stack.pop() {
            if is_done {
                renumbered.push(k);
                continue;
            }
            stack.push((k, true));
            children[k].sort_by_key(|&c| beyond[c].len());
            stack.extend(children[k].iter().rev().map(|&c| (c, false)));
        }
    }
    let mut now = vec![0; n];
    for (new, &old) in renumbered.iter().enumerate() {
        now[old] = new;
    }
    let order = renumbered.iter().map(|&old| order[old]).collect();
    let meets = renumbered.iter().map(|&old| {
        let mut met: Vec<usize> = beyond[old].iter().map(|&j| now[j]).collect();
        met.sort_unstable();
        met
    });
    (order, meets.collect())
}
