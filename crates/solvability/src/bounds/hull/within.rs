//! The solutions of a block for compliances within a range.

use super::block::{Block, Weights};
use super::points::{HullPoint, monomial};
use crate::limits::{CORNER_POINTS, LARGEST_EXPONENT};

/// Compliances between nominal values and a multiple of them.
#[derive(Clone, Debug)]
pub(in super::super) struct Range<'n> {
    /// The multiple.
    pub(in super::super) factor: f64,
    /// The nominal compliance of each load.
    pub(in super::super) nominal: &'n [f64],
}

impl Block {
    /// Restricts the compliances. If each load has at most one component in each monomial, y is a
    /// ratio of functions that are affine in each compliance. The extremes of y then belong to the
    /// corners of the range. Otherwise the weight of a monomial of degree p varies by the factor to
    /// the power p.
    pub(super) fn restrict(&mut self, range: &Range<'_>, sizes: &[f64]) {
        // Logarithms are used, because products of many compliances leave the range of numbers.
        let nominal = |(load, n): &(usize, u32)| {
            f64::from(*n) * (range.nominal[*load].ln() + 2.0 * sizes[*load].ln())
        };
        for point in &mut self.points {
            point.weight = point.weight.ln() + point.monomial.iter().map(nominal).sum::<f64>();
        }
        let degree = self.coordinates.len();
        let loads: Vec<usize> = self.loads().into_iter().collect();
        let mut monomials = self.points.iter().flat_map(|point| &point.monomial);
        let is_affine = monomials.all(|(_, n)| *n == 1);
        let corners = u32::try_from(loads.len()).ok();
        let corners = corners.and_then(|n| 1_usize.checked_shl(n));
        let corners = corners.filter(|n| n.saturating_mul(self.points.len()) <= CORNER_POINTS);
        match corners {
            _ if degree == 1 => {
                self.exponentiate();
                self.weights = Weights::UpTo(range.factor);
                self.points = [1.0, -1.0].map(|sign| self.end(sign)).into();
                self.weights = Weights::Corners;
            }
            Some(corners) if is_affine => {
                let points = (0..corners).map(|corner| {
                    let is_soft = |load: &usize| {
                        let place = loads.binary_search(load);
                        place.is_ok_and(|k| corner >> k & 1 == 1)
                    };
                    self.average(is_soft, range.factor)
                });
                self.points = points.collect();
                self.weights = Weights::Corners;
            }
            _ => {
                self.exponentiate();
                let exponent = range.factor.ln() * degree as f64;
                // A larger factor does not restrict the averages noticeably.
                if exponent < LARGEST_EXPONENT {
                    self.weights = Weights::UpTo(exponent.exp());
                }
            }
        }
    }

    /// Replaces the logarithms of the weights by weights relative to the largest weight.
    fn exponentiate(&mut self) {
        let weights = self.points.iter().map(|point| point.weight);
        let most = weights.fold(f64::NEG_INFINITY, f64::max);
        for point in &mut self.points {
            point.weight = (point.weight - most).exp();
        }
    }

    /// Returns the smallest y of a block with one coordinate, or the largest y if the sign is −1.
    fn end(&self, sign: f64) -> HullPoint {
        let values = self.points.iter().map(|point| sign * point.y[0]);
        let (least, soft) = self.least(&values.collect::<Vec<f64>>());
        let soft = soft.iter().flat_map(|&k| &self.points[k].monomial);
        HullPoint {
            monomial: monomial(soft.map(|(load, _)| *load)),
            weight: 1.0,
            y: vec![sign * least],
        }
    }

    /// Returns the solution for which the soft loads are softer by a factor.
    fn average(&self, is_soft: impl Fn(&usize) -> bool, factor: f64) -> HullPoint {
        let (mut total, mut y) = (0.0, vec![0.0; self.coordinates.len()]);
        let weight = |point: &HullPoint| {
            let soft = point.monomial.iter().filter(|(load, _)| is_soft(load));
            point.weight + soft.count() as f64 * factor.ln()
        };
        let most = self
            .points
            .iter()
            .map(weight)
            .fold(f64::NEG_INFINITY, f64::max);
        for point in &self.points {
            let weight = (weight(point) - most).exp();
            total += weight;
            y.iter_mut()
                .zip(&point.y)
                .for_each(|(sum, y)| *sum += weight * y);
        }
        HullPoint {
            monomial: self
                .loads()
                .into_iter()
                .filter(is_soft)
                .map(|load| (load, 1))
                .collect(),
            weight: total,
            y: y.iter().map(|y| y / total).collect(),
        }
    }
}
