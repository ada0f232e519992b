//! A block of coordinates with its solutions, and their averages.

use std::collections::BTreeSet;
use std::iter;

use super::points::{HullPoint, Monomial, Sums, monomial};
use crate::bounds::separation::is_separated;
use crate::limits::TIED_ENDS;

/// A connected component of the matroid of the elements.
pub(super) struct Block {
    /// The coordinates of the block among those of all blocks.
    pub(super) coordinates: Vec<usize>,
    pub(super) points: Vec<HullPoint>,
    /// Restriction of the weights of the points of the block.
    pub(super) weights: Weights,
}

/// The weights with which the points of a block are averaged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Weights {
    /// Any weights c^m·w_m. A point is reached if its monomial dominates.
    Monomials,
    /// Any weights. Every point is reached.
    Corners,
    /// The points are reached. Other points may lie outside of their hull.
    Samples,
    /// The weight of each point varies between its given value and this multiple of it. More
    /// averages are possible than with any compliances.
    UpTo(f64),
}

impl Block {
    pub(super) fn loads(&self) -> BTreeSet<usize> {
        let monomials = self.points.iter().flat_map(|point| &point.monomial);
        monomials.map(|(load, _)| *load).collect()
    }

    pub(super) fn shares_a_load(&self, other: &Self) -> bool {
        !self.loads().is_disjoint(&other.loads())
    }

    /// Returns whether a point is approached for some compliances, because its monomial dominates
    /// for them.
    fn is_vertex(&self, k: usize) -> bool {
        let own = &self.points[k].monomial;
        let exponent = |of: &Monomial, load: usize| {
            let found = of.iter().find(|(known, _)| *known == load);
            found.map_or(0.0, |(_, n)| f64::from(*n))
        };
        let others = self
            .points
            .iter()
            .enumerate()
            .filter(|(other, _)| *other != k);
        // Loads outside of the monomial are made rigid.
        let others = others.filter(|(_, point)| {
            let is_inside = |(load, _): &(usize, u32)| exponent(own, *load) > 0.0;
            point.monomial.iter().all(is_inside)
        });
        let differences = others.map(|(_, point)| {
            let difference =
                |&(load, n): &(usize, u32)| f64::from(n) - exponent(&point.monomial, load);
            own.iter().map(difference).collect()
        });
        is_separated(&differences.collect::<Vec<Vec<f64>>>())
    }

    /// Returns the block of all coordinates of both blocks.
    pub(super) fn times(&self, other: &Self) -> Self {
        let mut sums = Sums::default();
        for a in &self.points {
            for b in &other.points {
                let both = a.monomial.iter().chain(&b.monomial);
                let loads = both.flat_map(|&(load, n)| iter::repeat_n(load, n as usize));
                sums.add(
                    monomial(loads),
                    a.weight * b.weight,
                    [a.y.as_slice(), &b.y].concat(),
                );
            }
        }
        Self {
            coordinates: [self.coordinates.as_slice(), &other.coordinates].concat(),
            points: sums.points(),
            weights: Weights::Monomials,
        }
    }

    /// Returns the smallest average of these values of the points, and the points with the largest
    /// weights.
    pub(super) fn least(&self, values: &[f64]) -> (f64, Vec<usize>) {
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let Weights::UpTo(factor) = self.weights else {
            let width = values.iter().map(|x| x.abs()).fold(0.0, f64::max);
            let is_tied = |k: &usize| values[*k] <= least + TIED_ENDS * width;
            return (least, (0..values.len()).filter(is_tied).collect());
        };
        let mut order: Vec<usize> = (0..values.len()).collect();
        order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
        let weight = |k: &usize| self.points[*k].weight;
        let moment = |k: &usize| weight(k) * (values[*k] - least);
        let mut total: f64 = order.iter().map(weight).sum();
        let mut sum: f64 = order.iter().map(moment).sum();
        let (mut best, mut most) = (sum / total, 0);
        for (n, k) in order.iter().enumerate() {
            total += (factor - 1.0) * weight(k);
            sum += (factor - 1.0) * moment(k);
            if sum / total < best {
                (best, most) = (sum / total, n + 1);
            }
        }
        order.truncate(most);
        (least + best, order)
    }

    /// Returns a point that some compliances reach, among these points with equal values.
    pub(super) fn reached(&self, tied: &[usize]) -> Option<usize> {
        let mut tied = tied.iter().copied();
        match self.weights {
            Weights::Monomials => tied.find(|&k| self.is_vertex(k)),
            Weights::Corners | Weights::Samples => tied.next(),
            Weights::UpTo(_) => None,
        }
    }
}
