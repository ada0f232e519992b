//! Computes the error of the data that a lower rank requires, as a fraction of the uncertainty of
//! the data. Also computes the change of dependencies within the uncertainty.

use std::ops::Range;

use crate::limits::{ENTRY_ROUNDINGS, PAIRS};
use crate::pose::dimensionless;
use linalg::{Matrix, PivotedQr, Scaling};
use model::space::norm;
use model::{DataBlock, DataUnit, Mechanism, ROUNDING, Scratch, System};
use rank::RankDecision;

use super::cone::{Bounds, Equation, least_change};
use super::pose::{Candidate, Forces, Gradient, Pose};

/// A mechanism at a configuration, and the rows to analyse.
pub(crate) struct Question<'a> {
    pub(crate) mechanism: &'a Mechanism,
    /// Scratch in which Φ and C have been evaluated at q.
    pub(crate) s: &'a Scratch,
    pub(crate) q: &'a [f64],
    /// Numbers that the analysed rows have in the mechanism, ascending.
    pub(crate) places: &'a [usize],
    /// Size of the mechanism (m).
    pub(crate) size: f64,
}

/// The tolerance that the scene states.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StatedTolerance {
    /// The largest tolerance of a point or a length (m). If no such tolerance is stated, the
    /// largest tolerance of an angle times the size.
    pub(super) metres: f64,
    /// Whether this value comes from the tolerance of an angle.
    pub(super) by_angles: bool,
}

impl Question<'_> {
    /// Returns the change that the rank `lower` requires at this configuration. The change is that
    /// of the most changed datum, as a fraction of the rounding of this datum. `scaled` is the
    /// dimensionless C of this question, scaled by `scaling`.
    pub(super) fn share_of_rounding(
        &self,
        scaled: &Matrix,
        scaling: &Scaling,
        lower: usize,
    ) -> Bounds {
        let dimensions = self.mechanism.layout().dimension_scaling(self.size);
        let candidate = Candidate::of_rank(scaled, lower);
        let pose = Pose::new(
            self.mechanism,
            self.s,
            self.places,
            (scaled, &dimensions, scaling),
            candidate,
        );
        let blocks = self.mechanism.data().blocks(self.s);
        let known: Vec<f64> = blocks.iter().map(|b| ROUNDING * b.scale).collect();
        let noise = rounding(scaled);
        let mut equations = Vec::new();
        for at in pairs(&pose) {
            let (target, gradient) = pose.entry(at.0, at.1);
            let mut equation = equation(target, &gradient.data, (&blocks, &known), noise);
            equation.parts.extend(self.by_start(&gradient.pose));
            equations.push(equation);
        }
        least_change(&equations)
    }

    /// Returns coefficients of an entry with respect to the position and rotation of each body, for
    /// changes of this length (m).
    pub(super) fn by_place(&self, gradient: &[f64], length: f64, by_angles: bool) -> Vec<[f64; 3]> {
        let place = if by_angles { 0.0 } else { length };
        let turn = length / self.size;
        let bodies = gradient.chunks_exact(self.mechanism.space().n_v());
        bodies.flat_map(|by| self.parts(by, place, turn)).collect()
    }

    /// Returns coefficients with respect to the position and rotation of each body at the start,
    /// for changes that are as large as their rounding.
    fn by_start(&self, gradient: &[f64]) -> Vec<[f64; 3]> {
        let columns = self.mechanism.space().n_v();
        let (reach, at) = (|body| self.mechanism.reach(body), &self.s.bodies);
        let bodies = gradient.chunks_exact(columns).enumerate();
        let of_body = bodies.flat_map(|(body, by)| {
            let place = ROUNDING * norm(&at.origin(body)).max(reach(body));
            let turn = ROUNDING * at.angle(body).abs().max(1.0);
            self.parts(by, place, turn)
        });
        of_body.collect()
    }

    /// Returns coefficients of the translation and of the rotation of a body, for changes of this
    /// size.
    fn parts(&self, by: &[f64], place: f64, turn: f64) -> [[f64; 3]; 2] {
        let (by_place, by_turn) = by.split_at(self.mechanism.space().n_translations());
        let scaled = |by: &[f64], unit: f64| -> [f64; 3] {
            std::array::from_fn(|k| by.get(k).map_or(0.0, |x| x * unit))
        };
        [scaled(by_place, place), scaled(by_turn, turn)]
    }

    /// Returns the largest tolerance that the scene states for a point or a length. If the scene
    /// states tolerances only for angles, the function returns the largest tolerance of an angle,
    /// and lengths are uncertain by rounding.
    pub(crate) fn tolerance(&self) -> Option<StatedTolerance> {
        let blocks = self.mechanism.data().blocks(self.s);
        let largest = |unit: DataUnit| {
            let of_unit = blocks.iter().filter(|b| b.unit == unit);
            of_unit.filter_map(|b| b.tolerance).reduce(f64::max)
        };
        let stated = |metres, by_angles| StatedTolerance { metres, by_angles };
        match largest(DataUnit::Length) {
            Some(length) => Some(stated(length, false)),
            None => largest(DataUnit::Angle).map(|angle| stated(angle * self.size, true)),
        }
    }

    /// Returns the change of some rows of the left null space of the scaled C within the
    /// uncertainty of the data, at fixed rank: `δz_i = −(C⁺·e_i)ᵀ·δCᵀ·Z`. The change is computed
    /// for an orthonormal basis Z, and for the dependency of each dropped row relative to its
    /// largest coefficient. The result has one value for each row. The value is zero for rows that
    /// are not in `asked`.
    pub(crate) fn rows_within_data(
        &self,
        scaled: &Matrix,
        decision: &RankDecision,
        asked: &[usize],
    ) -> Vec<f64> {
        let (rank, scaling) = (decision.rank, &decision.scaling);
        let dimensions = self.mechanism.layout().dimension_scaling(self.size);
        let candidate = Candidate::of_rank(scaled, rank);
        let kept = candidate.kept.clone();
        let factored = candidate.factored.clone();
        let matrices = (scaled, &dimensions, scaling);
        let pose = Pose::new(self.mechanism, self.s, self.places, matrices, candidate);
        let blocks = self.mechanism.data().blocks(self.s);
        let z = rank::orthonormal(decision).transpose();
        let forces: Vec<Forces> = (0..z.nrows()).map(|k| pose.forces(z.row(k))).collect();
        // The separate dependencies in this basis. Gradients are linear in the dependencies.
        let single = single(decision).transpose().product(&z.transpose());
        let mut known = vec![0.0; scaled.nrows()];
        for &i in asked {
            // Computes C⁺·e_i as the smallest solution of the kept rows of C·y = e_i − Z·Zᵀ·e_i.
            let mut y = vec![0.0; scaled.ncols()];
            for (y, &k) in y.iter_mut().zip(factored.permutation()) {
                let own = if kept[k] == i { 1.0 } else { 0.0 };
                let beyond: f64 = (0..z.nrows()).map(|j| z[(j, i)] * z[(j, kept[k])]).sum();
                *y = own - beyond;
            }
            factored.solve_r_transpose(&mut y[..kept.len()]);
            factored.q_mul(&mut y);
            let change = |gradient: &Gradient| {
                let changes = blocks
                    .iter()
                    .map(|b| b.change(&gradient.data, b.known_to()));
                let by_start = self.by_start(&gradient.pose);
                let by_start = by_start.iter().map(|[x, y, z]| x.hypot(*y).hypot(*z));
                changes.chain(by_start).sum::<f64>()
            };
            let at_y = |forces| pose.gradient_at(forces, &y);
            let gradients: Vec<Gradient> = forces.iter().map(at_y).collect();
            let all = gradients.iter().map(change).fold(0.0, f64::hypot);
            let each = (0..single.nrows()).map(|j| Gradient::sum(&gradients, single.row(j)));
            known[i] = each.map(|gradient| change(&gradient)).fold(all, f64::max);
        }
        known
    }

    /// Returns, for each row, the angle by which its force rotates within the uncertainty of the
    /// data. The angle includes the effect of the resulting change of the configuration. The second
    /// value is the length by which the line of action of the force shifts; two points determine
    /// this line. A row without a force has a couple. In space, a couple also rotates within its
    /// body and together with its body.
    pub(crate) fn turns(&self, scaled: &Matrix, decision: &RankDecision) -> Vec<[f64; 2]> {
        let dimensions = self.mechanism.layout().dimension_scaling(self.size);
        let candidate = Candidate::of_rank(scaled, decision.rank);
        let matrices = (scaled, &dimensions, &decision.scaling);
        let pose = Pose::new(self.mechanism, self.s, self.places, matrices, candidate);
        let blocks = self.mechanism.data().blocks(self.s);
        let space = self.mechanism.space();
        let stated = self.tolerance();
        let of_columns = |i: usize, columns: &dyn Fn(usize) -> Range<usize>| {
            let row = scaled.row(i);
            let bodies = (0..row.len() / space.n_v()).map(columns);
            let size = |columns: &Range<usize>| norm(&row[columns.clone()]);
            let columns = bodies.max_by(|a, b| size(a).total_cmp(&size(b)))?;
            let size = size(&columns);
            if size == 0.0 {
                return None;
            }
            let mut own = vec![0.0; scaled.nrows()];
            own[i] = 1.0;
            // Unit vectors perpendicular to the force: one in the plane, two in space.
            let n = columns.len();
            let vector = Matrix::from_fn(n, 1, |k, _| row[columns.start + k]);
            let directions = PivotedQr::of_columns(&vector).q_columns(1..n);
            let turns = (0..n - 1).map(|j| {
                let mut across = vec![0.0; scaled.ncols()];
                for (k, x) in across[columns.clone()].iter_mut().enumerate() {
                    *x = directions[(k, j)];
                }
                let gradient = pose.gradient_between(&own, &across).data;
                let changes = blocks.iter().map(|b| b.change(&gradient, b.known_to()));
                changes.sum::<f64>() / size
            });
            Some(turns.fold(0.0, f64::hypot))
        };
        let with_body = match space.n_rotations() {
            1 => 0.0,
            _ => stated.map_or(0.0, |stated| stated.metres / self.size),
        };
        let of_row = |i: usize| {
            let force = of_columns(i, &|body| space.translations_of(body));
            let couple = || Some(of_columns(i, &|body| space.rotations_of(body))? + with_body);
            force.or_else(couple).unwrap_or(0.0)
        };
        let lengths = stated.filter(|stated| !stated.by_angles);
        let shift = 2.0 * lengths.map_or(0.0, |stated| stated.metres);
        (0..scaled.nrows()).map(|i| [of_row(i), shift]).collect()
    }

    /// Returns C with one unit for all lengths. The largest entry of each row is near one.
    pub(super) fn uniform(&self, s: &Scratch) -> (Matrix, Scaling) {
        let c = self.dimensionless(s);
        let mut scaling = Scaling::identity(c.nrows(), c.ncols());
        for (i, e) in scaling.rows.iter_mut().enumerate() {
            let largest = c.row(i).iter().fold(0.0_f64, |a, x| a.max(x.abs()));
            let exponent = largest.log2().floor();
            if exponent.is_finite() {
                *e = -(exponent as i32);
            }
        }
        (scaling.apply(&c), scaling)
    }

    pub(super) fn dimensionless(&self, s: &Scratch) -> Matrix {
        dimensionless(self.mechanism, s, self.size).select_rows(self.places)
    }

    /// Returns the change of a block that corresponds to one metre. For an angle, it is the angle
    /// that moves a point at the size of the mechanism by one metre. If a tolerance (m) is given,
    /// the result is the tolerance of the block relative to this tolerance. A block without a
    /// tolerance changes by its rounding.
    pub(super) fn unit(&self, block: &DataBlock, tolerance: Option<f64>) -> f64 {
        match (tolerance, block.unit) {
            (Some(tolerance), _) => block.known_to() / tolerance,
            (None, DataUnit::Length) => 1.0,
            (None, DataUnit::Angle) => 1.0 / self.size,
        }
    }
}

/// Returns the dependency of each dropped row in terms of the scaled rows. The largest coefficient
/// of each dependency is 1.
fn single(decision: &RankDecision) -> Matrix {
    let t = decision.equilibrated_dependence();
    let mut z = Matrix::zeros(decision.rank + decision.redundancy, decision.redundancy);
    for (j, &dropped) in decision.dropped.iter().enumerate() {
        let largest = t.row(j).iter().fold(1.0_f64, |a, x| a.max(x.abs()));
        z[(dropped, j)] = largest.recip();
        for (t, &kept) in t.row(j).iter().zip(&decision.kept) {
            z[(kept, j)] = -t / largest;
        }
    }
    z
}

/// Returns the pairs of directions whose entries must vanish.
pub(super) fn pairs(pose: &Pose<'_>) -> impl Iterator<Item = (usize, usize)> {
    let (left, right) = (pose.left.nrows().min(PAIRS), pose.right.nrows().min(PAIRS));
    (0..left).flat_map(move |a| (0..right).map(move |b| (a, b)))
}

pub(super) fn rounding(scaled: &Matrix) -> f64 {
    ENTRY_ROUNDINGS * f64::EPSILON * (scaled.nrows() as f64 * scaled.ncols() as f64).sqrt()
}

/// Returns the equation for a value that must vanish. The coefficients of the equation belong to
/// changes of blocks by the uncertainty of the blocks.
pub(super) fn equation(
    target: f64,
    gradient: &[f64],
    (blocks, known): (&[DataBlock], &[f64]),
    rounding: f64,
) -> Equation {
    let parts = blocks
        .iter()
        .zip(known)
        .map(|(block, known)| block.part(gradient).map(|x| x * known));
    Equation {
        target,
        rounding,
        parts: parts.collect(),
    }
}
