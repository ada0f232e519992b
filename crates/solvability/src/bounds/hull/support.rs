//! The ends of linear forms over the hull, and the largest norm of vectors.

use linalg::kernels::{dot, norm};

use super::Hull;
use super::block::Weights;
use super::element::HullError;
use super::minors::solved;
use super::points::HullPoint;
use crate::limits::{CLEAR_MINOR, MAGNITUDE_POINTS, ZERO_MINOR};

/// One end of the range of a linear form.
pub(in super::super) struct RangeEnd {
    pub(in super::super) value: f64,
    /// The loads of the joints that give way at this end.
    pub(in super::super) groups: Vec<usize>,
    pub(in super::super) is_reached: bool,
    /// Whether no compliances give a value beyond this end.
    pub(in super::super) is_bound: bool,
}

impl Hull {
    /// Returns the coefficients of a linear form of y in the coordinates of the blocks. Returns an
    /// error if the form depends on directions of y that change no element.
    pub(super) fn in_blocks(&self, along: &[f64]) -> Result<Vec<f64>, HullError> {
        let Some(span) = &self.span else {
            return Ok(solved(&self.basis, along.to_vec()));
        };
        let own: Vec<f64> = span.iter().map(|d| dot(d, along)).collect();
        let mut rest = along.to_vec();
        for (d, x) in span.iter().zip(&own) {
            rest.iter_mut().zip(d).for_each(|(r, d)| *r -= x * d);
        }
        if norm(&rest) > CLEAR_MINOR * norm(along) {
            let free = along.len() - span.len();
            return Err(HullError::Free { free });
        }
        Ok(solved(&self.basis, own))
    }

    /// Returns the smallest and the largest value of a linear form of y.
    ///
    /// # Errors
    /// [`HullError::Free`]
    pub(in super::super) fn ends(&self, along: &[f64]) -> Result<[RangeEnd; 2], HullError> {
        let along = self.in_blocks(along)?;
        Ok([1.0, -1.0].map(|sign| {
            let (mut value, mut chosen) = (0.0, Vec::new());
            for block in &self.blocks {
                let own: Vec<f64> = block.coordinates.iter().map(|&k| along[k]).collect();
                let largest = own.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
                if largest <= ZERO_MINOR * norm(&along) {
                    continue;
                }
                let values = block.points.iter().map(|point| sign * dot(&own, &point.y));
                let (least, points) = block.least(&values.collect::<Vec<f64>>());
                value += sign * least;
                let reached = block.reached(&points);
                let point = reached.or(points.first().copied());
                chosen.push((block, point, reached.is_some()));
            }
            let soft = chosen
                .iter()
                .filter_map(|(block, point, _)| match block.weights {
                    Weights::Monomials | Weights::Corners => Some(&block.points[(*point)?]),
                    Weights::UpTo(_) | Weights::Samples => None,
                });
            let monomials = soft.flat_map(|point| &point.monomial);
            let mut groups: Vec<usize> = monomials.map(|(group, _)| *group).collect();
            groups.sort_unstable();
            groups.dedup();
            // Blocks that were not merged may have a common load.
            let mut loads: Vec<usize> = chosen.iter().flat_map(|(b, ..)| b.loads()).collect();
            let all = loads.len();
            loads.sort_unstable();
            loads.dedup();
            let is_reached = loads.len() == all && chosen.iter().all(|(.., reached)| *reached);
            let mut blocks = chosen.iter().map(|(block, ..)| block);
            RangeEnd {
                value,
                groups,
                is_reached,
                is_bound: !blocks.any(|block| block.weights == Weights::Samples),
            }
        }))
    }

    /// Returns the largest norm of vectors whose components are linear in y.
    ///
    /// # Errors
    /// [`HullError::Free`]; [`HullError::Many`]: there is a range, but no bound.
    pub(in super::super) fn largest_norm(
        &self,
        terms: &[(f64, Vec<f64>)],
    ) -> Result<f64, HullError> {
        let rows = terms.iter().map(|(_, along)| self.in_blocks(along));
        let rows: Vec<Vec<f64>> = rows.collect::<Result<_, _>>()?;
        let mut sums = vec![terms.iter().map(|(value, _)| *value).collect::<Vec<f64>>()];
        for block in &self.blocks {
            let change = |point: &HullPoint| -> Vec<f64> {
                let own = |row: &Vec<f64>| {
                    let pairs = block.coordinates.iter().zip(&point.y);
                    pairs.map(|(&k, y)| row[k] * y).sum()
                };
                rows.iter().map(own).collect()
            };
            let changes: Vec<Vec<f64>> = block.points.iter().map(change).collect();
            if changes.iter().flatten().all(|x| *x == 0.0) {
                continue;
            }
            if block.weights == Weights::Samples {
                return Err(HullError::Many);
            }
            let is_restricted = matches!(block.weights, Weights::UpTo(_));
            if is_restricted || sums.len() * changes.len() > MAGNITUDE_POINTS {
                return self.norm_of_ends(terms);
            }
            let add = |sum: &Vec<f64>, change: &Vec<f64>| -> Vec<f64> {
                sum.iter().zip(change).map(|(a, b)| a + b).collect()
            };
            let pairs = sums
                .iter()
                .flat_map(|sum| changes.iter().map(move |c| (sum, c)));
            sums = pairs.map(|(sum, change)| add(sum, change)).collect();
        }
        Ok(sums.iter().map(|x| norm(x)).fold(0.0, f64::max))
    }

    /// Returns the norm of the largest absolute values of the components.
    fn norm_of_ends(&self, terms: &[(f64, Vec<f64>)]) -> Result<f64, HullError> {
        let largest = terms.iter().map(|(value, along)| {
            let ends = self.ends(along)?.map(|end| (value + end.value).abs());
            Ok(ends[0].max(ends[1]))
        });
        Ok(norm(&largest.collect::<Result<Vec<f64>, _>>()?))
    }
}
