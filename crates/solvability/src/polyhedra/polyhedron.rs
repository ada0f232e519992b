//! Points y that satisfy `row·y + value ≥ 0` for several rows, and the range of a number over these
//! points.
//!
//! Both results are computed by linear programs with one variable for each half space. The
//! solutions of the programs are weights that prove the result. Each result is checked with its
//! weights and its point, in double-double arithmetic, before it is returned.
//!
//! Degenerate data are common. For example, if the load is above an edge of a table, the points
//! form a set of width zero. Therefore rounding errors of the values, [`SUPPORT_ROUNDING`] of their
//! size, do not make the set empty.

use linalg::{Dd, Matrix, kernels};

use super::simplex::{Outcome, Program, minimise};
use super::{Unclear, exact_dot, rounding_of_dot};
use crate::limits::{CLEAR_MINOR, CLEAR_SUPPORT, SUPPORT_ROUNDING, ZERO_MINOR};

/// The points y with `row·y + value ≥ 0`.
#[derive(Debug, Clone)]
pub(crate) struct HalfSpace {
    pub(crate) row: Vec<f64>,
    pub(crate) value: f64,
}

/// The intersection of half spaces.
#[derive(Debug)]
pub(crate) struct Polyhedron {
    /// One row for each half space. A row that is zero to within rounding is set to zero.
    rows: Matrix,
    values: Vec<f64>,
    /// Size of the data from which the values were computed.
    size: f64,
    emptiness: Result<Emptiness, Unclear>,
}

/// Whether half spaces have a common point.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Emptiness {
    /// The half spaces have common points.
    Points {
        /// The largest value of the smallest `row·y + value`, if it is bounded. The value is
        /// negative if the points satisfy the half spaces only to within rounding.
        depth: Option<f64>,
    },
    /// There is no common point. Weights w ≥ 0 exist with `Σ w = 1`, `Σ w·row = 0` and `Σ w·value <
    /// 0`.
    Empty {
        /// The weights w, one number for each half space.
        weights: Vec<f64>,
        /// The sum `Σ w·value`, which is the largest value of the smallest `row·y + value`.
        depth: f64,
    },
}

/// Values of `row·y + value` over a polyhedron with points.
#[derive(Debug)]
pub(crate) struct AdmissibleRange {
    /// The lowest and the highest value.
    pub(crate) ends: [Extremum; 2],
    /// Whether both values are equal to within rounding.
    pub(crate) is_point: bool,
}

/// An end of a range.
#[derive(Debug)]
pub(crate) enum Extremum {
    /// The value is attained.
    Finite {
        /// The end of the range.
        value: f64,
        /// A point at which the number has this value.
        at: Vec<f64>,
        /// Weights u ≥ 0, one number for each half space. For the lowest value, `Σ u·row` is the
        /// row of the number, and the end is the value of the number at y = 0 minus `Σ u·value`.
        /// For the highest value, `Σ u·row` is the negative of the row, and `Σ u·value` is added.
        weights: Vec<f64>,
    },
    /// The number changes without limit.
    Infinite {
        /// A direction of the polyhedron along which the number changes without limit.
        ray: Vec<f64>,
    },
}

impl Extremum {
    /// Returns the weights of a finite end, and its value.
    fn finite(&self) -> Option<(f64, &[f64])> {
        match self {
            Self::Finite { value, weights, .. } => Some((*value, weights)),
            Self::Infinite { .. } => None,
        }
    }
}

impl Polyhedron {
    /// Intersects half spaces of points y with p coordinates. The rows are rows of an orthonormal
    /// basis, or combinations of a few such rows. Therefore a row of length [`ZERO_MINOR`] is
    /// rounding. The values are in the unit of `size`, the size of the loads.
    ///
    /// # Panics
    /// Panics if a row does not have p entries.
    pub(crate) fn new(p: usize, half_spaces: &[HalfSpace], size: f64) -> Self {
        let mut rows = Matrix::zeros(half_spaces.len(), p);
        let mut unclear = None;
        for (k, half_space) in half_spaces.iter().enumerate() {
            match without_rounding(&half_space.row) {
                Ok(row) => rows.row_mut(k).copy_from_slice(&row),
                Err(reason) => unclear = Some(reason),
            }
        }
        let mut polyhedron = Self {
            rows,
            values: half_spaces.iter().map(|h| h.value).collect(),
            size,
            emptiness: Err(Unclear::Unproved),
        };
        polyhedron.emptiness = unclear.map_or_else(|| polyhedron.find_depth(), Err);
        polyhedron
    }

    /// Returns whether the polyhedron has points.
    pub(crate) fn emptiness(&self) -> Result<&Emptiness, Unclear> {
        self.emptiness.as_ref().map_err(|reason| *reason)
    }

    /// Returns the range of `row·y + value` over the points if there are any points.
    pub(crate) fn range(
        &self,
        row: &[f64],
        value: f64,
    ) -> Result<Option<AdmissibleRange>, Unclear> {
        let Emptiness::Points { depth } = *self.emptiness()? else {
            return Ok(None);
        };
        let row = without_rounding(row)?;
        let end = |sign| {
            let end = self.end(&row, value, sign)?;
            // The half spaces contradict each other only by rounding.
            end.ok_or_else(|| depth.map_or(Unclear::Unproved, Unclear::Depth))
        };
        let ends = [end(1.0)?, end(-1.0)?];
        let is_point = match ends.each_ref().map(Extremum::finite) {
            [Some((lowest, below)), Some((highest, above))] => {
                let weights: f64 = below.iter().chain(above).sum();
                let rounding = SUPPORT_ROUNDING * self.size * (1.0 + weights);
                let width = highest - lowest;
                if width < -rounding || (width > rounding && width < CLEAR_SUPPORT * self.size) {
                    return Err(Unclear::Width(width));
                }
                width <= rounding
            }
            _ => false,
        };
        Ok(Some(AdmissibleRange { ends, is_point }))
    }

    /// Finds the largest value of the smallest `row·y + value`. The value is the least `Σ w·value`
    /// with w ≥ 0, `Σ w·row = 0` and `Σ w = 1`.
    fn find_depth(&self) -> Result<Emptiness, Unclear> {
        let p = self.rows.ncols();
        let columns = Matrix::from_fn(self.rows.nrows(), p + 1, |k, i| {
            if i < p { self.rows[(k, i)] } else { 1.0 }
        });
        let mut right = vec![0.0; p + 1];
        right[p] = 1.0;
        let program = Program {
            columns: &columns,
            right: &right,
            cost: &self.values,
            cost_size: self.size,
        };
        match minimise(&program)? {
            Outcome::Unbounded => Err(Unclear::Unproved),
            Outcome::Infeasible { multipliers } => {
                let ray = negative(&multipliers[..p]);
                let goes_in = |k| {
                    let row = self.rows.row(k);
                    exact_dot(row, &ray).to_f64() > rounding_of_dot(row, &ray)
                };
                let rises = (0..self.values.len()).all(goes_in);
                proved(rises, Emptiness::Points { depth: None })
            }
            Outcome::Optimal { x, multipliers } => {
                let depth = exact_dot(&x, &self.values).to_f64();
                let at = negative(&multipliers[..p]);
                let zero = SUPPORT_ROUNDING * self.size;
                let ok = self.balances(&x, &vec![0.0; p])
                    && (x.iter().sum::<f64>() - 1.0).abs() <= SUPPORT_ROUNDING
                    && self.is_above(&at, depth);
                if depth >= -zero {
                    proved(ok, Emptiness::Points { depth: Some(depth) })
                } else if depth > -CLEAR_SUPPORT * self.size {
                    Err(Unclear::Depth(depth))
                } else {
                    proved(ok, Emptiness::Empty { weights: x, depth })
                }
            }
        }
    }

    /// Returns the lowest value of `row·y + value` for the sign 1, and the highest value for the
    /// sign −1. There is no end if the half spaces contradict each other.
    fn end(&self, row: &[f64], value: f64, sign: f64) -> Result<Option<Extremum>, Unclear> {
        let right: Vec<f64> = row.iter().map(|x| sign * x).collect();
        let program = Program {
            columns: &self.rows,
            right: &right,
            cost: &self.values,
            cost_size: self.size,
        };
        match minimise(&program)? {
            Outcome::Unbounded => Ok(None),
            Outcome::Infeasible { multipliers } => {
                let ray = negative(&multipliers);
                let length = kernels::norm(&ray);
                let stays = |k: usize| {
                    let row = self.rows.row(k);
                    let zero = SUPPORT_ROUNDING * kernels::norm(row) * length;
                    exact_dot(row, &ray).to_f64() >= -2.0 * zero
                };
                let falls = exact_dot(&right, &ray).to_f64();
                let ok = falls <= -ZERO_MINOR * kernels::norm(&right) * length
                    && (0..self.values.len()).all(stays);
                proved(ok, Some(Extremum::Infinite { ray }))
            }
            Outcome::Optimal { x, multipliers } => {
                let at = negative(&multipliers);
                let moved = exact_dot(&x, &self.values);
                let weights: f64 = x.iter().sum();
                let gap = (moved + exact_dot(&right, &at)).to_f64().abs();
                let rounding =
                    SUPPORT_ROUNDING * self.size * (1.0 + weights) + rounding_of_dot(&right, &at);
                let ok = self.balances(&x, &right) && self.is_above(&at, 0.0) && gap <= rounding;
                let value = (Dd::from(value) - moved * sign).to_f64();
                let weights = x;
                proved(ok, Some(Extremum::Finite { value, at, weights }))
            }
        }
    }

    /// Returns whether `Σ w·row` is equal to this row.
    fn balances(&self, weights: &[f64], row: &[f64]) -> bool {
        let shares = weights.iter().enumerate();
        let shares = shares.map(|(k, w)| w * kernels::norm(self.rows.row(k)));
        let size = kernels::norm(row) + shares.sum::<f64>();
        (0..row.len()).all(|i| {
            let column: Vec<f64> = (0..weights.len()).map(|k| self.rows[(k, i)]).collect();
            let left = exact_dot(weights, &column) - Dd::from(row[i]);
            left.to_f64().abs() <= SUPPORT_ROUNDING * size
        }) && weights.iter().all(|w| *w >= 0.0)
    }

    /// Returns whether `row·y + value` is at least this number for each half space.
    fn is_above(&self, y: &[f64], least: f64) -> bool {
        self.values.iter().enumerate().all(|(k, value)| {
            let row = self.rows.row(k);
            let above = (exact_dot(row, y) + Dd::from(*value) - Dd::from(least)).to_f64();
            above >= -2.0 * (SUPPORT_ROUNDING * self.size + rounding_of_dot(row, y))
        })
    }
}

/// Returns the answer if its proof is correct.
fn proved<T>(ok: bool, answer: T) -> Result<T, Unclear> {
    if ok {
        Ok(answer)
    } else {
        Err(Unclear::Unproved)
    }
}

fn negative(x: &[f64]) -> Vec<f64> {
    x.iter().map(|x| -x).collect()
}

/// Returns the row, or a row of zeros if the row is zero to within rounding.
fn without_rounding(row: &[f64]) -> Result<Vec<f64>, Unclear> {
    let length = kernels::norm(row);
    if length >= CLEAR_MINOR {
        Ok(row.to_vec())
    } else if length <= ZERO_MINOR {
        Ok(vec![0.0; row.len()])
    } else {
        Err(Unclear::Row(length))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Weight of the table (N).
    const WEIGHT: f64 = 117.72;

    fn half_space(row: &[f64], value: f64) -> HalfSpace {
        HalfSpace {
            row: row.to_vec(),
            value,
        }
    }

    /// A table with pushes of its legs and a self-stress.
    fn table(pushes: [f64; 4], self_stress: [f64; 4]) -> Polyhedron {
        let legs = pushes.iter().zip(self_stress);
        let legs: Vec<HalfSpace> = legs.map(|(f, z)| half_space(&[z], *f)).collect();
        Polyhedron::new(1, &legs, WEIGHT)
    }

    fn finite(range: &AdmissibleRange) -> [f64; 2] {
        range.ends.each_ref().map(|end| match end.finite() {
            Some((value, _)) => value,
            None => panic!("{range:?}"),
        })
    }

    /// Compares with tables on three legs without pull, computed from the moments about the edges.
    #[test]
    fn pushes_of_a_table_are_those_on_three_legs() {
        let (pushes, z) = ([53.955, 19.62, 19.62, 24.525], [0.5, -0.5, 0.5, -0.5]);
        let table = table(pushes, z);
        let expected = [
            [34.335, 73.575],
            [0.0, 39.24],
            [0.0, 39.24],
            [4.905, 44.145],
        ];
        for ((push, z), expected) in pushes.into_iter().zip(z).zip(expected) {
            let range = table.range(&[z], push).unwrap().unwrap();
            for (found, expected) in finite(&range).into_iter().zip(expected) {
                assert!(
                    (found - expected).abs() < 1e-12,
                    "{found} is not {expected}"
                );
            }
            assert!(!range.is_point);
        }
        // The sum of the pushes does not depend on y.
        assert!(table.range(&[0.0], WEIGHT).unwrap().unwrap().is_point);
    }

    #[test]
    fn a_load_above_an_edge_is_not_outside() {
        // Legs C and D carry no load if the load is above the edge AB. If it is beyond the edge,
        // they carry `outside`.
        let pushes = |outside: f64| [88.29, 29.43, -outside * WEIGHT, -outside * WEIGHT];
        let at = |outside| table(pushes(outside), [0.5, -0.5, 0.5, -0.5]);
        for outside in [0.0, 1e-14, -1e-14] {
            let range = at(outside).range(&[0.5], 88.29).unwrap().unwrap();
            assert!(range.is_point, "{range:?}");
            assert!(finite(&range).iter().all(|a| (a - 88.29).abs() < 1e-10));
        }
        let doubt = |outside| at(outside).range(&[0.5], 88.29).err();
        assert!(matches!(doubt(1e-10), Some(Unclear::Depth(_))));
        assert!(matches!(doubt(-1e-10), Some(Unclear::Width(_))));
        for (outside, is_empty) in [(1e-6, true), (-1e-6, false)] {
            let table = at(outside);
            assert_eq!(
                matches!(table.emptiness().unwrap(), Emptiness::Empty { .. }),
                is_empty
            );
            let range = table.range(&[0.5], 88.29).unwrap();
            assert_eq!(
                range.map(|range| range.is_point),
                (!is_empty).then_some(false)
            );
        }
    }

    #[test]
    fn without_freedom_half_spaces_are_numbers() {
        let of = |values: &[f64]| {
            let half_spaces: Vec<_> = values.iter().map(|v| half_space(&[], *v)).collect();
            Polyhedron::new(0, &half_spaces, 1.0)
        };
        let range = of(&[2.0, 0.0]).range(&[], 3.0).unwrap().unwrap();
        assert!(range.is_point && finite(&range) == [3.0, 3.0]);
        let empty = Emptiness::Empty {
            weights: vec![0.0, 1.0],
            depth: -1.0,
        };
        assert_eq!(of(&[2.0, -1.0]).emptiness(), Ok(&empty));
        let depth = |values| of(values).emptiness().cloned();
        assert_eq!(
            depth(&[2.0, 1.0]),
            Ok(Emptiness::Points { depth: Some(1.0) })
        );
        assert_eq!(depth(&[]), Ok(Emptiness::Points { depth: None }));
    }

    #[test]
    fn without_half_spaces_ranges_are_lines() {
        let space = Polyhedron::new(2, &[], 1.0);
        let range = space.range(&[0.0, -0.3], 1.0).unwrap().unwrap();
        let rays = range.ends.each_ref().map(|end| match end {
            Extremum::Infinite { ray } => ray[1],
            Extremum::Finite { .. } => 0.0,
        });
        assert!(rays[0] > 0.0 && rays[1] < 0.0, "{rays:?}");
        assert!(space.range(&[0.0, 0.0], 1.0).unwrap().unwrap().is_point);
    }

    /// The feet of a see-saw carry a moment. The levers of the feet differ by a factor of 1e6. One
    /// number does not depend on y except for rounding.
    #[test]
    fn rows_of_very_different_size_are_decided() {
        let of = |small: f64| {
            let rows = [(1.0, 1.0), (-small, 1.0), (1e-17, 0.5)];
            let half_spaces = rows.map(|(row, value)| half_space(&[row], value));
            Polyhedron::new(1, &half_spaces, 1.0)
        };
        let range = of(1e-6).range(&[1.0], 0.0).unwrap().unwrap();
        let [lowest, highest] = finite(&range);
        assert!((lowest + 1.0).abs() < 1e-12 && (highest * 1e-6 - 1.0).abs() < 1e-12);
        assert_eq!(of(1e-8).emptiness().err(), Some(Unclear::Row(1e-8)));
        let ends = of(1e-12).range(&[1.0], 0.0).unwrap().unwrap().ends;
        assert!(matches!(
            ends,
            [Extremum::Finite { .. }, Extremum::Infinite { .. }]
        ));
    }

    #[test]
    fn numbers_out_of_range_are_undecided() {
        for huge in [1e300, f64::MAX, f64::INFINITY, f64::NAN] {
            let rows = [(1.0, huge), (-huge, 1.0), (huge, -huge)];
            let half_spaces = rows.map(|(row, value)| half_space(&[row, 1.0], value));
            for size in [0.0, 1.0, huge] {
                let polyhedron = Polyhedron::new(2, &half_spaces, size);
                if let Ok(Some(range)) = polyhedron.range(&[1.0, huge], huge) {
                    let ends = range.ends.each_ref().map(Extremum::finite);
                    let mut values = ends.iter().flatten().map(|(value, _)| value);
                    assert!(values.all(|value| value.is_finite()), "{range:?}");
                }
            }
        }
    }
}
