//! Independent rows of C with everything that solving on them needs.
//!
//! They are factored in units of the mechanism: lengths in its size, rounded to a power of two, so
//! that scaling rounds nothing. Otherwise a pivot of a rotation, a length, would be compared with
//! one of a translation, which has no unit: pivots would fall and determinants change their signs
//! where nothing happens but that metres are large or small. Callers see their own units only.

mod dense;
mod solver;
mod sparse;

use linalg::{PivotedQr, SaddleError};
use model::{Mechanism, Scratch, System};

use crate::counts::{Counted, note};
use crate::error::MotionFault;
use crate::prepare::Prepared;
use solver::Solver;

/// Kept rows and the factored saddle matrix.
#[derive(Clone)]
pub(super) struct KeptRows {
    /// Rows of C, ascending.
    pub(super) kept: Vec<usize>,
    /// The others of the same level.
    pub(super) dropped: Vec<usize>,
    /// Right-hand side, one value for each kept row.
    pub(super) rhs: Vec<f64>,
    /// Multipliers, as they were found last.
    pub(super) lambda: Vec<f64>,
    /// What coordinates count in those units, and the masses there, n_v each.
    units: Vec<f64>,
    mass: Vec<f64>,
    /// A force and a motion in those units, n_v each.
    force: Vec<f64>,
    motion: Vec<f64>,
    /// The rows in those units, and their factors.
    solver: Solver,
    /// Whether the mechanism is so large or small that solutions are refined.
    is_far: bool,
    /// Pivot ratio when these rows were chosen: what later ones are compared with.
    reference_pivot: Option<f64>,
    /// The same for the present partition, if there is one.
    partition: Option<PartitionPivot>,
}

/// Pivot ratio of a partition at its first factorisation.
#[derive(Clone, Copy)]
struct PartitionPivot(Option<f64>);

/// Other rows are kept once the pivots have fallen below this share of those at the choice:
/// rounding of the kept rows reaches the dropped ones through the inverse of the pivots.
const PIVOT_LOSS: f64 = 0.1;

/// A partition is renewed once its pivots have fallen below this share: steps should not reach
/// those of lost rows.
const PARTITION_WORN: f64 = 0.5;

/// Below this share of the reference pivots rows are delicate.
const DELICATE: f64 = 0.1;

/// Rows below this share are dependent for an instant and left out of the solve.
const PIVOT_SINGULAR: f64 = 1e-6;

/// Rows set aside come back above this share.
const PIVOT_RECOVERY: f64 = 0.2;

/// Rows chosen by themselves are exchanged above this coefficient in a dropped row.
const LARGE_COEFFICIENT: f64 = 10.0;

/// Solutions of mechanisms larger than this (m), or smaller than its inverse, are refined.
const FAR: f64 = 1e5;

impl KeptRows {
    /// Storage for these rows of a mechanism whose lengths are measured by `size`.
    pub(super) fn new(
        mechanism: &Mechanism,
        size: f64,
        kept: &[usize],
        dropped: &[usize],
    ) -> Result<Self, SaddleError> {
        let (n, r) = (mechanism.layout().n_v, kept.len());
        let units = units(mechanism, size);
        Ok(Self {
            kept: kept.to_vec(),
            dropped: dropped.to_vec(),
            rhs: vec![0.0; r],
            lambda: vec![0.0; r],
            solver: Solver::new(mechanism, kept, &units)?,
            mass: mass_in_units(mechanism, &units),
            units,
            force: vec![0.0; n],
            motion: vec![0.0; n],
            is_far: is_far(size),
            reference_pivot: None,
            partition: None,
        })
    }

    /// Factors at the entries of C in the scratch. Rows that are dependent for an instant are left
    /// out, but not at the first time.
    pub(super) fn factor(&mut self, mechanism: &Mechanism, s: &Scratch) -> Result<(), MotionFault> {
        let reference = self.reference();
        self.factor_above(PIVOT_SINGULAR, mechanism, s)?;
        match (reference, self.solver.n_left_out()) {
            (None, 1..) => Err(self.rank_lost(mechanism, s)),
            (None, 0) => {
                let pivot = Some(self.solver.pivot_ratio());
                match &mut self.partition {
                    Some(partition) => partition.0 = pivot,
                    None => {
                        self.reference_pivot = pivot;
                        self.solver.keep_order();
                    }
                }
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// Solves from now on for the coordinates that these rows determine best at the entries of C in
    /// the scratch, as multiples of what each is known to; factors there, and returns the others,
    /// ascending.
    pub(super) fn partition(
        &mut self,
        mechanism: &Mechanism,
        s: &Scratch,
        known_to: impl Fn(usize) -> f64,
    ) -> Result<Vec<usize>, MotionFault> {
        self.forget_partition();
        self.factor(mechanism, s)?;
        let chosen = self.solver.dense().and_then(|it| {
            let dependent = match it.saddle.is_graded() {
                // Heavy coordinates are independent, whatever the rows would determine best.
                true => it.saddle.solved_for().to_vec(),
                false => {
                    let mut c = it.c.clone();
                    for k in 0..c.nrows() {
                        let row = c.row_mut(k).iter_mut().enumerate();
                        row.for_each(|(j, c)| *c *= known_to(j));
                    }
                    PivotedQr::of_columns(&c).permutation()[..c.nrows()].to_vec()
                }
            };
            it.saddle.partition(&dependent)?;
            Ok(dependent)
        });
        let dependent = chosen.map_err(|e| self.fault(mechanism, s, e))?;
        let free = (0..self.units.len()).filter(|i| !dependent.contains(i));
        let free = free.collect();
        self.partition = Some(PartitionPivot(None));
        self.factor(mechanism, s)?;
        Ok(free)
    }

    /// Every factorisation chooses again what it solves for.
    pub(super) fn forget_partition(&mut self) {
        if let Ok(it) = self.solver.dense() {
            it.saddle.forget_partition();
        }
        self.partition = None;
    }

    /// Whether another partition is due.
    pub(super) fn are_worn(&self) -> bool {
        let worn = |chosen: f64| self.pivot_ratio() < PARTITION_WORN * chosen;
        self.partition.and_then(|p| p.0).is_some_and(worn)
    }

    /// Pivot ratio that the present ones are compared with.
    fn reference(&self) -> Option<f64> {
        match self.partition {
            Some(partition) => partition.0,
            None => self.reference_pivot,
        }
    }

    /// Overwrites the dependent entries of x so that `C·x = rhs`; of a row left out there would be
    /// none.
    pub(super) fn complete(
        &mut self,
        mechanism: &Mechanism,
        s: &Scratch,
        x: &mut [f64],
    ) -> Result<(), MotionFault> {
        if let Some(row) = (0..self.kept.len()).find(|&k| !self.solver.uses(k)) {
            return Err(MotionFault::Chart {
                time: s.t,
                row: mechanism.layout().labels[self.kept[row]].clone(),
                pivot: self.relative_pivot(),
            });
        }
        self.take_motion(x);
        let (rhs, motion) = (&self.rhs, &mut self.motion);
        match self
            .solver
            .dense()
            .and_then(|it| it.saddle.complete(rhs, motion))
        {
            Ok(()) => {
                self.write_motion(x);
                Ok(())
            }
            Err(e) => Err(self.fault(mechanism, s, e)),
        }
    }

    /// As [`KeptRows::factor`], leaving out rows whose pivot is below this share of the reference.
    pub(super) fn factor_above(
        &mut self,
        share: f64,
        mechanism: &Mechanism,
        s: &Scratch,
    ) -> Result<(), MotionFault> {
        let reference = self.reference().filter(|r| r.is_finite());
        let floor = share * reference.unwrap_or(0.0);
        match self.solver.factor_above(floor, &s.entries, &self.mass) {
            Ok(()) => Ok(()),
            Err(e) => Err(self.fault(mechanism, s, e)),
        }
    }

    /// Rows of the last factorisation that are dependent for an instant and were left out: their
    /// number.
    pub(super) fn n_left_out(&self) -> usize {
        self.solver.n_left_out()
    }

    /// Whether the last factorisation uses the k-th kept row.
    pub(super) fn uses(&self, k: usize) -> bool {
        self.solver.uses(k)
    }

    /// Smallest pivot relative to that when the rows were chosen, whatever they are solved for;
    /// infinite without rows.
    pub(super) fn relative_pivot(&self) -> f64 {
        match self.reference_pivot {
            Some(reference) if reference.is_finite() => self.pivot_ratio() / reference,
            _ => f64::INFINITY,
        }
    }

    /// Whether rounding of these rows is felt many times over in what depends on them.
    pub(super) fn are_delicate(&self) -> bool {
        self.relative_pivot() < DELICATE
    }

    /// The largest coefficient by which a kept row enters a dropped one, at the entries of C in the
    /// scratch where the rows are freshly factored: rounding of the kept rows reaches the dropped
    /// ones multiplied by it.
    pub(super) fn largest_coefficient(&mut self, mechanism: &Mechanism, s: &Scratch) -> f64 {
        note(Counted::Coefficients);
        if self.solver.brings_multipliers() {
            return self.sampled_coefficient(mechanism, s);
        }
        let mut largest = 0.0_f64;
        for k in 0..self.dropped.len() {
            largest = match self.imply(mechanism, s, self.dropped[k]) {
                Ok(()) => self.lambda.iter().fold(largest, |a, l| a.max(l.abs())),
                Err(_) => f64::INFINITY,
            };
        }
        largest
    }

    /// The same from two sums of all dropped rows with random signs: large mechanisms have
    /// thousands, each implied by a few rows of its own.
    fn sampled_coefficient(&mut self, mechanism: &Mechanism, s: &Scratch) -> f64 {
        let mut largest = 0.0_f64;
        for seed in [1, 2] {
            self.motion.fill(0.0);
            self.force.fill(0.0);
            for (k, &i) in self.dropped.iter().enumerate() {
                let sign = sign_of(k, seed);
                for (j, c) in mechanism.layout().row(s, i) {
                    self.force[j] += sign * c * self.units[j];
                }
            }
            let solved = self
                .solver
                .multipliers(&self.force, &self.motion, &mut self.lambda);
            largest = match solved {
                Ok(()) => self.lambda.iter().fold(largest, |a, l| a.max(l.abs())),
                Err(_) => f64::INFINITY,
            };
        }
        largest
    }

    /// Size of row i, a dropped one, and of what the kept rows contribute to it: with
    /// `c_i = Σ T_ik·c_k` the sum of `scale(i)` and `|T_ik|·scale(k)`. Rounding of these terms is
    /// what such a row may miss by. Needs the factorisation at the entries of C in the scratch.
    pub(super) fn implied_scale(
        &mut self,
        mechanism: &Mechanism,
        s: &Scratch,
        i: usize,
        scale: impl Fn(usize) -> f64,
    ) -> Result<f64, MotionFault> {
        if let Err(e) = self.imply(mechanism, s, i) {
            return Err(self.fault(mechanism, s, e));
        }
        let terms = self.kept.iter().zip(&self.lambda);
        let terms = terms.map(|(&k, coefficient)| coefficient.abs() * scale(k));
        Ok(scale(i) + terms.sum::<f64>())
    }

    /// Leaves the coefficients of the kept rows in a dropped one as multipliers.
    fn imply(
        &mut self,
        mechanism: &Mechanism,
        s: &Scratch,
        dropped: usize,
    ) -> Result<(), SaddleError> {
        // A row that the kept ones imply, as a force, moves nothing: M·0 + C_Kᵀ·λ = c_Dᵀ.
        self.motion.fill(0.0);
        mechanism.layout().scatter_row(s, dropped, &mut self.force);
        for (entry, unit) in self.force.iter_mut().zip(&self.units) {
            *entry *= unit;
        }
        self.solver
            .multipliers(&self.force, &self.motion, &mut self.lambda)
    }

    /// Compares pivots from now on with what those of other rows were compared with: this place may
    /// be a singular one.
    pub(super) fn compare_as(&mut self, others: &Self) {
        self.reference_pivot = others.reference_pivot;
    }

    /// Solves `M·x + Cᵀ·λ = force`, `C·x = rhs` for x with the factored matrix.
    pub(super) fn solve(
        &mut self,
        mechanism: &Mechanism,
        s: &Scratch,
        force: &[f64],
        x: &mut [f64],
    ) -> Result<(), MotionFault> {
        self.take_force(force);
        let (force, rhs) = (&self.force, &self.rhs);
        match self
            .solver
            .motion(force, rhs, &mut self.motion, &mut self.lambda)
        {
            Ok(()) => {
                self.write_motion(x);
                Ok(())
            }
            Err(e) => Err(self.fault(mechanism, s, e)),
        }
    }

    /// Whether accelerations and their multipliers are refined at the last factorisation.
    pub(super) fn are_refined(&self) -> bool {
        self.is_far || self.solver.wants_refinement()
    }

    /// Accelerations from `M·a + Cᵀ·λ = Q`, `C·a = rhs` with Q of the scratch, refined where plain
    /// ones may miss digits.
    pub(super) fn accelerate(
        &mut self,
        mechanism: &Mechanism,
        s: &Scratch,
        a: &mut [f64],
    ) -> Result<(), MotionFault> {
        self.take_force(&s.force);
        let is_refined = self.are_refined();
        let (force, rhs) = (&self.force, &self.rhs);
        let (x, lambda) = (&mut self.motion, &mut self.lambda);
        let solved = match is_refined {
            false => self.solver.motion(force, rhs, x, lambda),
            true => self.solver.refined(force, rhs, x, lambda),
        };
        match solved {
            Ok(()) => {
                self.write_motion(a);
                Ok(())
            }
            Err(e) => Err(self.fault(mechanism, s, e)),
        }
    }

    /// The λ that belongs to the accelerations a just found by [`KeptRows::accelerate`]; refined,
    /// they have come with them.
    pub(super) fn find_multipliers(
        &mut self,
        mechanism: &Mechanism,
        s: &Scratch,
        a: &[f64],
    ) -> Result<(), MotionFault> {
        if self.are_refined() || self.solver.brings_multipliers() {
            return Ok(());
        }
        self.take_force(&s.force);
        self.take_motion(a);
        match self
            .solver
            .multipliers(&self.force, &self.motion, &mut self.lambda)
        {
            Ok(()) => Ok(()),
            Err(e) => Err(self.fault(mechanism, s, e)),
        }
    }

    fn take_force(&mut self, force: &[f64]) {
        for ((scaled, f), unit) in self.force.iter_mut().zip(force).zip(&self.units) {
            *scaled = f * unit;
        }
    }

    fn take_motion(&mut self, x: &[f64]) {
        for ((scaled, x), unit) in self.motion.iter_mut().zip(x).zip(&self.units) {
            *scaled = x / unit;
        }
    }

    fn write_motion(&self, x: &mut [f64]) {
        for ((x, scaled), unit) in x.iter_mut().zip(&self.motion).zip(&self.units) {
            *x = scaled * unit;
        }
    }

    /// Smallest pivot of the last factorisation relative to its row.
    pub(super) fn pivot_ratio(&self) -> f64 {
        self.solver.pivot_ratio()
    }

    /// Writes a frame of the motions that the factored rows allow, in units of the mechanism.
    pub(super) fn null_frame(&self, frame: &mut Vec<f64>) {
        self.solver.null_frame(frame);
    }

    /// Sign of the determinant of the factored rows bordered by a frame, 0 where that is not known.
    pub(super) fn orientation(&mut self, frame: &[f64]) -> f64 {
        self.solver.orientation(frame)
    }

    /// Whether the rows have become nearly dependent since they were chosen, and there are others.
    pub(super) fn are_lost(&self) -> bool {
        !self.dropped.is_empty() && self.relative_pivot() < PIVOT_LOSS
    }

    /// Whether the rows imply the dropped ones by large coefficients, at the entries of C in the
    /// scratch, where they are freshly factored.
    pub(super) fn are_poor(&mut self, mechanism: &Mechanism, s: &Scratch) -> bool {
        !self.dropped.is_empty() && self.largest_coefficient(mechanism, s) > LARGE_COEFFICIENT
    }

    /// Whether rows that were lost are as independent as before.
    pub(super) fn are_recovered(&self) -> bool {
        self.relative_pivot() > PIVOT_RECOVERY
    }

    fn rank_lost(&self, mechanism: &Mechanism, s: &Scratch) -> MotionFault {
        let dependent = (0..self.kept.len()).find(|&k| !self.solver.uses(k));
        MotionFault::RankLost {
            time: s.t,
            row: mechanism.layout().labels[self.kept[dependent.unwrap_or(0)]].clone(),
            pivot: self.solver.pivot_ratio(),
            scale: 1.0,
        }
    }

    fn fault(&self, mechanism: &Mechanism, s: &Scratch, e: SaddleError) -> MotionFault {
        fault(mechanism, s, e, |row| self.kept[row])
    }
}

/// A sign, as good as random.
fn sign_of(k: usize, seed: u64) -> f64 {
    let mixed = (k as u64)
        .wrapping_add(seed << 40)
        .wrapping_mul(0x9e37_79b9_7f4a_7c15);
    if mixed.rotate_left(31).wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 63 == 0 {
        1.0
    } else {
        -1.0
    }
}

/// What coordinates count in units of a mechanism of this size.
pub(super) fn units(mechanism: &Mechanism, size: f64) -> Vec<f64> {
    let exponents = mechanism.dimension_scaling(size).cols;
    exponents.iter().map(|&e| f64::from(e).exp2()).collect()
}

/// Masses and moments of inertia in those units.
pub(super) fn mass_in_units(mechanism: &Mechanism, units: &[f64]) -> Vec<f64> {
    let mass = units.iter().zip(mechanism.mass());
    mass.map(|(unit, m)| unit * m * unit).collect()
}

/// Whether a mechanism of this size (m) is far larger or smaller than those of people: what is
/// added up then, weights and centrifugal terms, differs by many powers of ten as well.
pub(crate) fn is_far(size: f64) -> bool {
    !(1.0 / FAR..=FAR).contains(&size)
}

/// Bytes that a motion of a prepared mechanism takes at most, about: solvers for velocities and for
/// positions, stages, and rows of output.
pub(crate) fn memory(prepared: &Prepared) -> usize {
    let mechanism = &prepared.mechanism;
    let units = units(mechanism, prepared.assembly.size);
    let kept = [&prepared.decision.kept, &prepared.position_decision.kept];
    let solvers: usize = kept
        .iter()
        .map(|kept| solver::memory(mechanism, kept, &units))
        .sum();
    let layout = mechanism.layout();
    solvers + VECTORS * size_of::<f64>() * (layout.n_q + layout.n_v + layout.rows())
}

/// Vectors of all coordinates, velocities and rows that a run holds.
const VECTORS: usize = 60;

/// Whether the kept rows of a mechanism are solved sparsely.
pub(crate) fn is_sparse(prepared: &Prepared) -> bool {
    let units = units(&prepared.mechanism, prepared.assembly.size);
    solver::is_sparse(&prepared.mechanism, &units, prepared.decision.kept.len())
}

/// The largest mass divided by the smallest that is not zero, moments of inertia divided by the
/// square of the mechanism's size: the spread that decides whether solutions are refined.
pub(crate) fn mass_spread(prepared: &Prepared) -> f64 {
    let units = units(&prepared.mechanism, prepared.assembly.size);
    linalg::mass_spread(&mass_in_units(&prepared.mechanism, &units))
}

/// Why a solve at the instant of the scratch failed; `row_of` tells which row of C a row of the
/// solver is.
pub(super) fn fault(
    mechanism: &Mechanism,
    s: &Scratch,
    e: SaddleError,
    row_of: impl Fn(usize) -> usize,
) -> MotionFault {
    let time = s.t;
    match e {
        SaddleError::RankLost { row, pivot, scale } => {
            let row = mechanism.layout().labels[row_of(row)].clone();
            MotionFault::RankLost {
                time,
                row,
                pivot,
                scale,
            }
        }
        SaddleError::MasslessMotion { motion, .. } => {
            let larger = |a: usize, b: usize| {
                if motion[b].abs() > motion[a].abs() {
                    b
                } else {
                    a
                }
            };
            let (body, coordinate) = mechanism.coordinate((0..motion.len()).fold(0, larger));
            MotionFault::Massless {
                time,
                body: body.to_owned(),
                coordinate,
            }
        }
        SaddleError::NonFinite {
            argument,
            index,
            value,
        } => MotionFault::NotFinite {
            time,
            what: format!("{argument}[{index}] = {value}"),
        },
        source => MotionFault::Saddle { time, source },
    }
}
