//! Data that depend only on the pattern of the rows: an order of elimination, fronts, and the
//! positions of all entries.
//!
//! Rows that touch the same blocks (bodies) are eliminated together. Each set of such rows is a
//! node of a graph. In this graph, each block connects the nodes that touch it. The nodes are
//! ordered by minimum degree. A front is a dense triangular matrix. The rows of a front are its
//! pivots, which are eliminated in the front, and the later rows with which the pivots have
//! non-zero entries. The product `C_b·M_b⁻¹·C_bᵀ` of a block b is added to the front whose pivots
//! include the first row of the block. After elimination, the remainder of a front is added to its
//! parent. The parent is the front that has the first of the later rows as a pivot. A front is
//! merged with its parent if this does not increase the number of [tiles](super::tiles) of L.

use std::ops::Range;

use super::added::extended;
use super::tiles::{Lane, SIDE, diagonal, lanes, triangle};
use crate::{AddedMass, EliminationTree, SparseMatrix};

/// The pattern of `S = C·M⁻¹·Cᵀ` and of the factor of S.
///
/// ```
/// use pfaff_linalg::{SchurStructure, SparseMatrix};
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
    /// Fronts in the order of elimination. Children come before their parents, and the last child
    /// comes directly before its parent.
    pub(super) fronts: Vec<Front>,
    /// Later rows of all fronts, as positions in the order.
    pub(super) later: Vec<u32>,
    /// The position of each later row in the parent front.
    pub(super) in_parent: Vec<InParent>,
    pub(super) elements: Elements,
    pub(super) size: Size,
    /// Number of rows of C. The other rows are rows of the mass matrix.
    pub(super) rows_of_c: usize,
    /// The pattern of the rows of C and of the mass matrix, if the mass matrix has rows.
    pub(super) extended: Option<Box<SparseMatrix>>,
}

/// The rows of C and the order of their elimination. The positions of the pivots of a front begin
/// with a new group of four. The positions that complete the last group of a front belong to no
/// row.
#[derive(Clone, Debug)]
pub(super) struct Rows {
    /// Number of columns of C.
    n: usize,
    /// The position of each row in the order of elimination.
    pub(super) place: Vec<usize>,
    /// Number of groups of four for all positions.
    pub(super) lanes: usize,
}

/// Blocks of columns, with the rows that touch them.
#[derive(Clone, Debug, Default)]
pub(super) struct Elements {
    pub(super) of_fronts: Vec<Element>,
    /// Columns of all elements.
    pub(super) columns: Vec<u32>,
    pub(super) rows: Vec<RowsOfLane>,
    /// For each value of C, its index among the values of all elements.
    pub(super) index: Vec<u32>,
    /// Number of groups of four values of all elements.
    pub(super) n_lanes: usize,
}

/// Rows of an element that are in the same group of four of its front.
#[derive(Clone, Copy, Debug)]
pub(super) struct RowsOfLane {
    /// The group of four in the front.
    pub(super) lane: u32,
    /// The position of each row in the order; padding has a position after all rows.
    pub(super) places: [u32; SIDE],
}

impl RowsOfLane {
    /// Returns the values of the rows from x; padding repeats the last value of x.
    #[inline(always)]
    pub(super) fn take_from(&self, x: &[f64]) -> Lane {
        self.places.map(|place| x[place as usize])
    }

    /// Adds the values of the rows to x; padding is ignored.
    #[inline(always)]
    pub(super) fn add_to(&self, x: &mut [f64], values: &Lane) {
        for (&place, value) in self.places.iter().zip(values) {
            x[place as usize] += value;
        }
    }
}

/// Size and work of a factorisation.
#[derive(Clone, Debug, Default)]
pub(super) struct Size {
    /// Number of entries of L.
    entries: usize,
    /// Number of tiles of L.
    pub(super) tiles: usize,
    /// Largest number of tiles that are stored at the same time for parents.
    pub(super) waiting: usize,
    /// Largest number of row groups in a front.
    pub(super) front: usize,
    multiplications: f64,
}

/// Position of a row and its column in a front, as two offsets. The sum of the offsets is an index
/// of the values of the front. Tiles of the same columns follow each other.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct InParent {
    /// Start of the column, counted as if there were tiles above the diagonal.
    pub(super) column: u32,
    /// Offset of the row from this start.
    pub(super) row: u32,
}

impl InParent {
    fn new(lanes: usize, index: usize) -> Self {
        let (lane, within) = (index / SIDE, index % SIDE);
        Self {
            column: (((diagonal(lanes, lane) - lane) * SIDE + within) * SIDE) as u32,
            row: (lane * SIDE * SIDE + within) as u32,
        }
    }
}

/// A dense triangle. The pivots of the triangle are padded to complete groups of four. The later
/// rows are also padded.
#[derive(Clone, Debug)]
pub(super) struct Front {
    /// Number of pivots, and the groups of the positions of the pivots.
    pub(super) n_pivots: usize,
    pub(super) pivots: Range<usize>,
    /// Range of the later rows of the front in `later` and `in_parent`.
    pub(super) rest: Range<usize>,
    /// Range of the blocks that are added to the front, in `elements`.
    pub(super) elements: Range<usize>,
    /// Fronts that have this front as parent, in reverse order of elimination.
    pub(super) children: Vec<usize>,
    /// Index of the first tile of L of this front.
    pub(super) l: usize,
}

impl Front {
    /// Returns the number of groups of the pivots, and of the later rows.
    pub(super) fn lanes(&self) -> [usize; 2] {
        [self.pivots.len(), lanes(self.rest.len())]
    }

    /// Returns the number of tiles that remain for the parent after elimination of the pivots.
    pub(super) fn n_update(&self) -> usize {
        triangle(lanes(self.rest.len()))
    }
}

/// A block of columns, and the rows that touch it.
#[derive(Clone, Debug)]
pub(super) struct Element {
    /// Range in the columns of all elements.
    pub(super) columns: Range<usize>,
    /// Range in the rows of all elements.
    pub(super) rows: Range<usize>,
    /// Groups of values of the element, with one group of values for each column. All columns for
    /// the first group of rows come first, followed by all columns for the next group.
    pub(super) values: Range<usize>,
}

impl SchurStructure {
    /// Creates the structure for blocks of columns and rows with this pattern. The values of the
    /// rows are not used. A column outside all blocks is a separate block, and a column in several
    /// blocks belongs to the first.
    #[must_use]
    pub fn new(c: &SparseMatrix, blocks: &[Range<usize>]) -> Self {
        let blocks = Blocks::new(c, blocks);
        let nodes = Nodes::new(c, &blocks);
        let tree = Tree::new(&nodes);
        tree.into_structure(c, &blocks, &nodes)
    }

    /// Works like [`SchurStructure::new`], for a mass matrix with these rows. The values of the
    /// rows are not used.
    #[must_use]
    pub fn with_added(c: &SparseMatrix, blocks: &[Range<usize>], added: &AddedMass) -> Self {
        let Some(extended) = extended(c, added) else {
            return Self::new(c, blocks);
        };
        Self {
            rows_of_c: c.nrows(),
            extended: Some(Box::new(extended.clone())),
            ..Self::new(&extended, blocks)
        }
    }

    /// Returns the number of coordinates n.
    #[must_use]
    pub fn n_coordinates(&self) -> usize {
        self.rows.n
    }

    /// Returns the number of rows r.
    #[must_use]
    pub fn n_rows(&self) -> usize {
        self.rows.place.len()
    }

    /// Returns the number of stored entries of L, below its diagonal.
    #[must_use]
    pub fn n_entries(&self) -> usize {
        self.size.entries
    }

    /// Returns the approximate number of multiplications of a factorisation.
    #[must_use]
    pub fn multiplications(&self) -> f64 {
        self.size.multiplications
    }

    /// Returns the memory of a [`SchurSaddle`](crate::SchurSaddle) with this structure, in bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let Size {
            tiles,
            waiting,
            front,
            ..
        } = self.size;
        let of_tiles = SIDE * SIDE * (tiles + waiting + triangle(front));
        let of_lanes = SIDE * (self.elements.n_lanes + front);
        let numbers = of_tiles + of_lanes + 8 * self.n_rows() + 5 * self.n_coordinates();
        let indices =
            3 * self.later.len() + self.elements.columns.len() + self.elements.index.len();
        let records = self.fronts.len() * size_of::<Front>()
            + self.elements.of_fronts.len() * size_of::<Element>()
            + self.elements.rows.len() * size_of::<RowsOfLane>();
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
            // Rows without entries are not grouped.
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

/// Returns the number of tiles of L in the columns of this number of pivots, if there are `rest`
/// other rows.
fn tiles(pivots: usize, rest: usize) -> usize {
    let rest = lanes(rest);
    triangle(lanes(pivots) + rest) - triangle(rest)
}

/// Nodes in the order of elimination, with their later neighbours.
struct Tree {
    /// Nodes in the order of elimination.
    order: Vec<usize>,
    /// For each position: the later neighbours of its node, ascending, and the number of previous
    /// positions that are merged with it.
    meets: Vec<Vec<usize>>,
    merged: Vec<usize>,
}

impl Tree {
    fn new(nodes: &Nodes) -> Self {
        let n = nodes.rows.len();
        let (order, meets) = postordered(EliminationTree::new(n, &nodes.touching));
        let width = |k: usize| nodes.rows[order[k]].len();
        // Number of other rows of a front, and number of its columns so far.
        let rows_of = |k: usize| meets[k].iter().map(|&j| width(j)).sum::<usize>();
        let mut merged = vec![0; n];
        let mut columns: Vec<usize> = (0..n).map(width).collect();
        for k in 1..n {
            loop {
                let last = k - merged[k];
                // The directly preceding front, if this front is its parent.
                let is_child =
                    |c: &usize| meets[*c].first().is_some_and(|j| (last..=k).contains(j));
                let Some(child) = last.checked_sub(1).filter(is_child) else {
                    break;
                };
                let total = columns[child] + columns[k];
                let apart = tiles(columns[child], rows_of(child)) + tiles(columns[k], rows_of(k));
                if tiles(total, rows_of(k)) > apart {
                    break;
                }
                merged[k] += 1 + merged[child];
                columns[k] = total;
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
        // A node is the last node of a front, unless a later node has been merged with it.
        let mut end = n;
        let mut ends = Vec::new();
        while end > 0 {
            ends.push(end - 1);
            end -= 1 + self.merged[end - 1];
        }
        ends.reverse();
        // The first position of each node; the last entry is the end of all positions.
        let mut first = vec![0; n + 1];
        let mut place = vec![0; c.nrows()];
        let (mut from, mut next) = (0, 0);
        for &last in &ends {
            for k in from..=last {
                first[k] = next;
                for &row in &nodes.rows[self.order[k]] {
                    place[row] = next;
                    next += 1;
                }
            }
            next = SIDE * lanes(next);
            from = last + 1;
        }
        first[n] = next;
        let places_of = |k: usize| first[k]..first[k] + nodes.rows[self.order[k]].len();
        let mut s = SchurStructure {
            rows: Rows {
                n: c.ncols(),
                place,
                lanes: lanes(next),
            },
            fronts: Vec::new(),
            later: Vec::new(),
            in_parent: Vec::new(),
            elements: Elements {
                index: vec![0; c.nnz()],
                ..Elements::default()
            },
            size: Size::default(),
            rows_of_c: c.nrows(),
            extended: None,
        };
        let mut place_of_node = vec![0; n];
        self.order
            .iter()
            .enumerate()
            .for_each(|(k, &node)| place_of_node[node] = k);
        // The position at which the first node of a block is eliminated.
        let mut blocks_at: Vec<Vec<usize>> = vec![Vec::new(); n];
        for (block, touching) in nodes.touching.iter().enumerate() {
            if let Some(k) = touching.iter().map(|&node| place_of_node[node]).min() {
                blocks_at[k].push(block);
            }
        }
        let mut front_of = vec![usize::MAX; n];
        let mut local = vec![0_u32; next];
        let mut from = 0;
        for last in ends {
            let index = s.fronts.len();
            let pivots = first[from]..places_of(last).end;
            let rest = s.later.len();
            for &j in &self.meets[last] {
                s.later.extend(places_of(j).map(|p| p as u32));
            }
            let rest = rest..s.later.len();
            s.in_parent.resize(s.later.len(), InParent::default());
            (from..=last).for_each(|k| front_of[k] = index);
            let order = pivots.len() + rest.len();
            pivots
                .clone()
                .enumerate()
                .for_each(|(k, p)| local[p] = k as u32);
            let filled = SIDE * lanes(pivots.len());
            for (k, at) in rest.clone().enumerate() {
                local[s.later[at] as usize] = (filled + k) as u32;
            }
            let elements = s.elements.of_fronts.len();
            for k in from..=last {
                for &block in &blocks_at[k] {
                    s.add_element(c, blocks, nodes, block, &local);
                }
            }
            let front = Front {
                elements: elements..s.elements.of_fronts.len(),
                children: Vec::new(),
                l: s.size.tiles,
                n_pivots: pivots.len(),
                pivots: lanes(pivots.start)..lanes(pivots.end),
                rest,
            };
            let all = front.lanes().iter().sum();
            s.size.tiles += triangle(all) - front.n_update();
            s.size.front = s.size.front.max(all);
            s.fronts.push(front);
            s.size.entries += (0..pivots.len()).map(|k| order - 1 - k).sum::<usize>();
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
        let touching = nodes.touching[block].iter();
        let mut of_block: Vec<usize> = touching
            .flat_map(|&node| nodes.rows[node].iter().copied())
            .collect();
        of_block.sort_unstable_by_key(|&row| self.rows.place[row]);
        // The columns of a body remain grouped, in space and in the plane.
        let width = if matches!(own.len(), 3 | 6) {
            own.len()
        } else {
            1
        };
        for own in own.chunks(width) {
            self.add_columns(c, own, &of_block, local);
        }
    }

    fn add_columns(&mut self, c: &SparseMatrix, own: &[usize], rows: &[usize], local: &[u32]) {
        let none = (SIDE * self.rows.lanes) as u32;
        let to = &mut self.elements;
        let (columns, first, values) = (to.columns.len(), to.rows.len(), to.n_lanes);
        to.columns.extend(own.iter().map(|&j| j as u32));
        for &row in rows {
            let (start, of_row) = (c.start(row), c.row(row).0);
            let place = self.rows.place[row];
            let (lane, within) = (local[place] / SIDE as u32, local[place] as usize % SIDE);
            for (k, j) in own.iter().enumerate() {
                let Ok(at) = of_row.binary_search(j) else {
                    continue;
                };
                if to.rows[first..].last().is_none_or(|last| last.lane != lane) {
                    to.n_lanes += own.len();
                    let places = [none; SIDE];
                    to.rows.push(RowsOfLane { lane, places });
                }
                let last = to.rows.len() - 1;
                to.rows[last].places[within] = place as u32;
                let value = values + (last - first) * own.len() + k;
                to.index[start + at] = (SIDE * value + within) as u32;
            }
        }
        to.of_fronts.push(Element {
            columns: columns..to.columns.len(),
            rows: first..to.rows.len(),
            values: values..to.n_lanes,
        });
    }

    /// Connects fronts with their parents, and counts the values that are stored for the parents.
    fn join(&mut self, front_of: &[usize], first: &[usize]) {
        let node_of = |place: usize| first.partition_point(|&f| f <= place) - 1;
        let mut waiting = 0;
        for k in 0..self.fronts.len() {
            let children = self.fronts[k].children.iter();
            waiting -= children.map(|&c| self.fronts[c].n_update()).sum::<usize>();
            let rest = self.fronts[k].rest.clone();
            let Some(at) = rest.clone().next() else {
                continue;
            };
            let parent = front_of[node_of(self.later[at] as usize)];
            waiting += self.fronts[k].n_update();
            self.size.waiting = self.size.waiting.max(waiting);
            let to = &self.fronts[parent];
            let (pivots, later) = (to.pivots.clone(), to.rest.clone());
            let (own, filled) = (SIDE * pivots.start, SIDE * pivots.len());
            let all = to.lanes().iter().sum();
            let mut next = later.start;
            for at in rest {
                let p = self.later[at] as usize;
                let index = if p < SIDE * pivots.end {
                    p - own
                } else {
                    while self.later[next] as usize != p {
                        next += 1;
                    }
                    filled + next - later.start
                };
                self.in_parent[at] = InParent::new(all, index);
            }
            // The last child is on top of the stack.
            self.fronts[parent].children.insert(0, k);
        }
    }
}

/// Returns positions and their later neighbours, renumbered so that children come directly before
/// their parents. The child with the widest front comes last.
fn postordered(tree: EliminationTree) -> (Vec<usize>, Vec<Vec<usize>>) {
    let EliminationTree {
        order,
        beyond,
        mut children,
        ..
    } = tree;
    // The search is depth-first from the roots, without recursion.
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
