//! The part of the hull in which one-sided joints press.
//!
//! The part is computed by a linear program over the averages of the points. The columns of the
//! program are generated. The value of the number at each point is reduced by the conditions with
//! the multipliers of the points known so far. The point with the smallest reduced value is the
//! next column.
//! See G. B. Dantzig and P. Wolfe, Operations Research 8 (1960) 101–111.

use linalg::Matrix;
use linalg::kernels::{dot, max_abs};

use super::block::{Block, Weights};
use super::{Hull, HullError};
use crate::limits::PIVOTS;
use crate::polyhedra::polyhedron::HalfSpace;
use crate::polyhedra::simplex::{Outcome, Program, minimise};

impl Block {
    /// Returns the average with the smallest value of a linear form of the coordinates of the
    /// block.
    fn lowest(&self, along: &[f64]) -> Vec<f64> {
        let values: Vec<f64> = self.points.iter().map(|p| dot(along, &p.y)).collect();
        let Weights::UpTo(factor) = self.weights else {
            let lowest = (0..values.len()).min_by(|&a, &b| values[a].total_cmp(&values[b]));
            return lowest.map_or_else(Vec::new, |k| self.points[k].y.clone());
        };
        let (_, chosen) = self.least(&values);
        let (mut total, mut sum) = (0.0, vec![0.0; self.coordinates.len()]);
        for (k, point) in self.points.iter().enumerate() {
            let factor = if chosen.contains(&k) { factor } else { 1.0 };
            total += factor * point.weight;
            let terms = sum.iter_mut().zip(&point.y);
            terms.for_each(|(sum, y)| *sum += factor * point.weight * y);
        }
        sum.iter().map(|x| x / total).collect()
    }
}

impl Hull {
    /// Returns the average with the smallest value of a linear form, in the coordinates of the
    /// blocks.
    fn lowest(&self, along: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; along.len()];
        for block in &self.blocks {
            let own: Vec<f64> = block.coordinates.iter().map(|&k| along[k]).collect();
            for (&k, x) in block.coordinates.iter().zip(block.lowest(&own)) {
                y[k] = x;
            }
        }
        y
    }

    /// Returns the smallest and the largest value of a linear form of y in the part of the hull in
    /// these half spaces, for loads of this size. Returns `None` if the part is empty.
    ///
    /// # Errors
    /// [`HullError::Free`]; [`HullError::Limits`]: the result is not clear.
    pub(in crate::bounds) fn ends_within(
        &self,
        along: &[f64],
        half_spaces: &[HalfSpace],
        size: f64,
    ) -> Result<Option<[f64; 2]>, HullError> {
        let along = self.in_blocks(along)?;
        // A condition on coordinates that no elastic load determines does not restrict other
        // coordinates.
        let inside = half_spaces.iter();
        let inside = inside.filter_map(|half| {
            let mut row = self.in_blocks(&half.row).ok()?;
            row.iter_mut().for_each(|x| *x /= size);
            let value = half.value / size;
            Some(HalfSpace { row, value })
        });
        let inside: Vec<HalfSpace> = inside.collect();
        let mut ends = [0.0; 2];
        for (end, sign) in ends.iter_mut().zip([1.0, -1.0]) {
            let signed: Vec<f64> = along.iter().map(|x| sign * x / size).collect();
            match self.least_within(&signed, &inside)? {
                Some(value) => *end = sign * size * value,
                None => return Ok(None),
            }
        }
        Ok(Some(ends))
    }

    fn least_within(
        &self,
        along: &[f64],
        half_spaces: &[HalfSpace],
    ) -> Result<Option<f64>, HullError> {
        let n = half_spaces.len();
        let mut right: Vec<f64> = half_spaces.iter().map(|half| -half.value).collect();
        right.push(1.0);
        let mut points = vec![self.lowest(along)];
        for _ in 0..PIVOTS {
            let column = |y: &Vec<f64>| {
                let margins = half_spaces.iter().map(|half| dot(&half.row, y));
                margins.chain([1.0]).collect::<Vec<f64>>()
            };
            let slack = |k: usize| {
                let mut column = vec![0.0; n + 1];
                column[k] = -1.0;
                column
            };
            let all: Vec<Vec<f64>> = points.iter().map(column).chain((0..n).map(slack)).collect();
            let costs = points.iter().map(|y| dot(along, y));
            let costs: Vec<f64> = costs.chain(std::iter::repeat_n(0.0, n)).collect();
            let program = Program {
                columns: &Matrix::from_fn(all.len(), n + 1, |k, i| all[k][i]),
                right: &right,
                cost: &costs,
                cost_size: max_abs(&costs).max(1.0),
            };
            let found = minimise(&program).map_err(|_| HullError::Limits)?;
            let (multipliers, known, value) = match found {
                Outcome::Unbounded => return Err(HullError::Limits),
                Outcome::Infeasible { multipliers } => (multipliers, 0.0, None),
                Outcome::Optimal { x, multipliers } => (multipliers, 1.0, Some(dot(&x, &costs))),
            };
            // The reduced cost of a point. A point with a negative reduced cost enters.
            let mut reduced: Vec<f64> = along.iter().map(|x| known * x).collect();
            for (half, pi) in half_spaces.iter().zip(&multipliers) {
                let terms = reduced.iter_mut().zip(&half.row);
                terms.for_each(|(x, row)| *x -= pi * row);
            }
            let next = self.lowest(&reduced);
            let gain = dot(&reduced, &next) - multipliers[n];
            // A known point has no negative reduced cost, except by rounding.
            if gain >= 0.0 || points.contains(&next) {
                return Ok(value);
            }
            points.push(next);
        }
        Err(HullError::Limits)
    }
}

#[cfg(test)]
mod tests {
    use linalg::kernels::norm;
    use suite::numbers::Numbers;

    use super::super::Element;
    use super::*;
    use crate::limits::CLEAR_MINOR;
    use crate::polyhedra::tests::{Plate, WEIGHT};

    /// A plate on three legs. The force of each leg has one component, so each vertex of the
    /// permitted loads is a point of the hull.
    #[test]
    fn plates_push_with_the_loads_of_plates_on_three_legs() {
        let mut numbers = Numbers::new(5);
        let mut standing = 0;
        for case in 0..300 {
            let plate = Plate::new(&mut numbers);
            let Some(shares) = plate.shares() else {
                continue;
            };
            let halves = plate.half_spaces();
            let p = halves[0].row.len();
            // Unique loads do not belong to the hull.
            let shared = halves.iter().filter(|half| norm(&half.row) > CLEAR_MINOR);
            let elements = shared.enumerate().map(|(group, half)| Element {
                group,
                row: half.row.clone(),
                value: half.value,
            });
            let Ok(hull) = Hull::new(elements.collect(), p, 1e-12) else {
                continue;
            };
            for (half, share) in halves.iter().zip(&shares) {
                let found = hull.ends_within(&half.row, &halves, WEIGHT);
                let found = found.unwrap_or_else(|e| panic!("{case}: {e:?} {halves:?}"));
                let found = found.map(|ends| ends.map(|end| half.value + end));
                match (found, share) {
                    (Some(found), Some(expected)) => {
                        standing += 1;
                        for (found, share) in found.into_iter().zip(expected) {
                            let apart = (found - WEIGHT * share).abs();
                            assert!(apart < 1e-6, "{case}: {found} is not {}", WEIGHT * share);
                        }
                    }
                    (None, None) => {}
                    other => panic!("{case}: {other:?}"),
                }
            }
        }
        assert!(standing > 300, "{standing} legs");
    }

    /// A table on four legs, each of which gives way. Each point of the hull is a table on three
    /// legs. The legs that push are the legs of tables on three legs without pull, computed by
    /// hand.
    #[test]
    fn a_table_pushes_with_the_loads_of_tables_on_three_legs() {
        // In one of the solutions, leg D carries no load, and B pulls.
        let (pushes, z) = ([78.48, -4.905, 44.145, 0.0], [0.5, -0.5, 0.5, -0.5]);
        let legs = || pushes.into_iter().zip(z).enumerate();
        let elements = legs().map(|(group, (value, z))| Element {
            group,
            row: vec![z],
            value,
        });
        let hull = Hull::new(elements.collect(), 1, 1e-12).unwrap();
        let halves = legs().map(|(_, (value, z))| HalfSpace {
            row: vec![z],
            value,
        });
        let halves: Vec<HalfSpace> = halves.collect();
        let expected = [
            [34.335, 73.575],
            [0.0, 39.24],
            [0.0, 39.24],
            [4.905, 44.145],
        ];
        for ((_, (push, z)), expected) in legs().zip(expected) {
            let ends = hull.ends_within(&[z], &halves, 117.72).unwrap().unwrap();
            for (end, expected) in ends.into_iter().zip(expected) {
                let found = push + end;
                assert!((found - expected).abs() < 1e-9, "{found} is not {expected}");
            }
        }
        // None of these tables presses on a leg from below.
        let above = HalfSpace {
            row: vec![0.0],
            value: -1.0,
        };
        let none = hull.ends_within(&[0.5], &[above], 117.72).unwrap();
        assert_eq!(none, None);
    }
}
