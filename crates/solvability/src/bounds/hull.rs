//! The convex hull of the solutions y_m, for rows of a matrix in groups.

mod axes;
mod block;
mod element;
mod minors;
mod permitted;
mod points;
mod support;
mod within;

use std::collections::BTreeSet;

use linalg::kernels::dot;
use linalg::{DisjointSets, Matrix, PivotedQr, RowBasis};

pub(super) use element::{Element, HullError};
pub(super) use within::Range;

use crate::limits::{ELASTIC_SETS, MERGED_POINTS};
use axes::{principal, span_of};
use block::{Block, Weights};
use element::Zero;
use minors::Minors;

/// The solutions y_m in independent blocks of coordinates.
pub(super) struct Hull {
    /// Factors of the transposed rows of the basis: `y′ = A_B·y` are the coordinates of the blocks.
    basis: PivotedQr,
    blocks: Vec<Block>,
    /// Orthonormal directions of y that change the elements. `None` if all directions of y change
    /// the elements.
    span: Option<Vec<Vec<f64>>>,
    /// Sizes by which the components of each load were divided.
    sizes: Vec<f64>,
    /// Number of sets in all blocks.
    pub(super) sets: u64,
}

impl Hull {
    /// Finds the hull for p coordinates. Coefficients up to the tolerance may be rounding.
    pub(super) fn new(elements: Vec<Element>, p: usize, tolerance: f64) -> Result<Self, HullError> {
        Self::of_sets(elements, p, tolerance, ELASTIC_SETS)
    }

    /// Works like [`Self::new`]. Blocks with at least this number of sets are sampled.
    pub(super) fn of_sets(
        elements: Vec<Element>,
        p: usize,
        tolerance: f64,
        most: u64,
    ) -> Result<Self, HullError> {
        let zero = Zero::new(tolerance);
        let (mut elements, mut p, mut span) = (elements, p, None);
        let mut principal_axes = principal(&elements, p, zero);
        if let Err(HullError::Free { .. }) = principal_axes {
            let directions = span_of(&elements, p, zero);
            for element in &mut elements {
                element.row = directions.iter().map(|d| dot(d, &element.row)).collect();
            }
            p = directions.len();
            span = Some(directions);
            principal_axes = principal(&elements, p, zero);
        }
        let (elements, sizes) = principal_axes?;
        let matrix = Matrix::from_fn(elements.len(), p, |i, j| elements[i].row[j]);
        let basis = RowBasis::most_independent(matrix.clone(), p);
        let outside: Vec<Vec<f64>> = (0..basis.dropped().len())
            .map(|j| {
                let mut t = vec![0.0; p];
                basis.coefficients(j, &mut t);
                t
            })
            .collect();
        let mut sets = DisjointSets::new(p + outside.len());
        for (j, row) in outside.iter().enumerate() {
            for (k, x) in row.iter().enumerate() {
                if !zero.holds(*x, elements[basis.dropped()[j]].group)? {
                    sets.join(k, p + j);
                }
            }
        }
        let mut hull = Self {
            basis: PivotedQr::of_columns(&matrix.select_rows(basis.kept()).transpose()),
            blocks: Vec::new(),
            span,
            sizes,
            sets: 0,
        };
        let of_basis = |k: usize| &elements[basis.kept()[k]];
        for members in sets.sets() {
            let inside: Vec<usize> = members.iter().copied().filter(|&k| k < p).collect();
            if inside.is_empty() {
                continue;
            }
            let others: Vec<usize> = members.iter().filter_map(|k| k.checked_sub(p)).collect();
            let minors = Minors {
                inside: inside.iter().map(|&k| of_basis(k)).collect(),
                outside: others
                    .iter()
                    .map(|&j| &elements[basis.dropped()[j]])
                    .collect(),
                rows: Matrix::from_fn(others.len(), inside.len(), |i, k| {
                    let x = outside[others[i]][inside[k]];
                    if x.abs() <= zero.zero { 0.0 } else { x }
                }),
                zero,
            };
            let is_small = minors.count() <= most.saturating_sub(hull.sets);
            let (points, weights) = if is_small {
                let (points, sets) = minors.points()?;
                hull.sets += sets;
                (points, Weights::Monomials)
            } else {
                (minors.samples()?, Weights::Samples)
            };
            hull.blocks.push(Block {
                coordinates: inside,
                points,
                weights,
            });
        }
        hull.merge();
        Ok(hull)
    }

    /// Merges blocks with a common load, because the compliance of this load is the same in both
    /// blocks.
    fn merge(&mut self) {
        let mut merged: Vec<Block> = Vec::new();
        for mut block in std::mem::take(&mut self.blocks) {
            let mut k = 0;
            while k < merged.len() {
                let is_small = merged[k].points.len() * block.points.len() <= MERGED_POINTS;
                let all = [&merged[k], &block].map(|block| block.weights);
                let is_small = is_small && all == [Weights::Monomials; 2];
                if is_small && merged[k].shares_a_load(&block) {
                    block = merged.swap_remove(k).times(&block);
                    k = 0;
                } else {
                    k += 1;
                }
            }
            merged.push(block);
        }
        self.blocks = merged;
    }

    /// Returns the loads of each independent block.
    pub(super) fn loads(&self) -> impl Iterator<Item = BTreeSet<usize>> + '_ {
        self.blocks.iter().map(Block::loads)
    }

    /// Returns whether some blocks contain only the solutions for some compliances.
    pub(super) fn is_sampled(&self) -> bool {
        let mut blocks = self.blocks.iter();
        blocks.any(|block| block.weights == Weights::Samples)
    }

    /// Restricts the compliances of all loads.
    pub(super) fn restrict(&mut self, range: &Range<'_>) {
        for block in &mut self.blocks {
            block.restrict(range, &self.sizes);
        }
    }
}
