//! Independent rows of C, with all data for the solution of the rows.
//!
//! The rows are factored in units of the mechanism ([`super::units`]). Otherwise the pivot of a
//! rotation, which is a length, would be compared with the pivot of a translation, which has no
//! dimension. Pivots would become small and determinants would change sign only because of the unit
//! of length. Callers use only SI units.

use linalg::{PivotedQr, SaddleError};
use model::System;
use solvability::{CARRIED_VECTORS, RowDecision};

use super::evaluation::Evaluation;
use super::solver::{Solver, SolverNeeds};
use super::units::{ScaledVectors, is_far, mass_in_units, mass_of_positions, units};
use crate::counts::{WorkKind, note};
use crate::error::MotionFault;
use crate::limits::{PIVOT_SINGULAR, SUMMED_FROM};

/// Independent rows and the factored saddle-point matrix.
#[derive(Clone)]
pub(crate) struct KeptRows {
    /// Rows of C, ascending.
    pub(crate) kept: Vec<usize>,
    /// All rows of the same level except the factored ones.
    pub(crate) dropped: Vec<usize>,
    /// Right-hand side, one value for each independent row.
    pub(crate) rhs: Vec<f64>,
    /// Multipliers of the last solution.
    pub(crate) lambda: Vec<f64>,
    /// Masses, and force and motion of a solution, in units of the mechanism.
    scaled: ScaledVectors,
    /// The rows in these units, and their factors.
    solver: Solver,
    needs: SolverNeeds,
    /// Whether the size of the mechanism is so far from a metre that solutions are refined.
    is_far: bool,
    /// Pivot ratio at the time when these rows were chosen. Later pivot ratios are compared with
    /// this pivot ratio.
    reference_pivot: Option<f64>,
    /// Pivot ratio of the present partition, if there is one.
    partition: Option<PartitionPivot>,
    /// The smallest [`Self::largest_coefficient`] since a search found no better rows. The value is
    /// zero before the first search.
    pub(crate) unavoidable: f64,
}

/// Pivot ratio of a partition at its first factorisation.
#[derive(Clone, Copy)]
struct PartitionPivot(Option<f64>);

impl KeptRows {
    /// Allocates memory for the rows of a decision. Both levels use the same kind of solver.
    pub(crate) fn new(
        at: &Evaluation<'_>,
        rows: &RowDecision,
        needs: SolverNeeds,
    ) -> Result<Self, MotionFault> {
        let units = units(at.mechanism, at.size);
        let solver = Solver::new(at.mechanism, &rows.kept, &units, needs);
        let layout = at.mechanism.layout();
        let mut level = rows.kept.iter().chain(&rows.dropped);
        let mass = if layout.rows() > layout.m && level.all(|&i| i < layout.m) {
            mass_of_positions(at.mechanism, &units)
        } else {
            mass_in_units(at.mechanism, &units)
        };
        let r = rows.kept.len();
        Ok(Self {
            kept: rows.kept.clone(),
            dropped: rows.dropped.clone(),
            rhs: vec![0.0; r],
            lambda: vec![0.0; r],
            solver: solver.map_err(|source| MotionFault::Saddle {
                time: at.s.t,
                source,
            })?,
            needs,
            scaled: ScaledVectors::new(units, mass, at.mechanism.inertia(&at.s).added().clone()),
            is_far: is_far(at.size),
            reference_pivot: None,
            partition: None,
            unavoidable: 0.0,
        })
    }

    /// Returns the rows of another decision at this level.
    pub(crate) fn others(
        &self,
        at: &Evaluation<'_>,
        rows: &RowDecision,
    ) -> Result<Self, MotionFault> {
        Self::new(at, rows, self.needs)
    }

    /// Factors the rows with the last evaluated entries of C. Rows that are dependent for an
    /// instant are skipped, except in the first factorisation.
    pub(crate) fn factor(&mut self, at: &Evaluation<'_>) -> Result<(), MotionFault> {
        let reference = self.reference();
        self.factor_above(PIVOT_SINGULAR, at)?;
        if reference.is_some() {
            return Ok(());
        }
        if let Some(k) = (0..self.kept.len()).find(|&k| !self.uses(k)) {
            return Err(MotionFault::RankLost {
                time: at.s.t,
                row: at.label(self.kept[k]),
                pivot: self.pivot_ratio(),
                scale: 1.0,
            });
        }
        let pivot = Some(self.pivot_ratio());
        match &mut self.partition {
            Some(partition) => partition.0 = pivot,
            None => {
                self.reference_pivot = pivot;
                self.solver.keep_shares(self.scaled.inertia());
            }
        }
        Ok(())
    }

    /// Works like [`KeptRows::factor`], but skips the rows whose pivot is below this share of the
    /// reference.
    pub(crate) fn factor_above(
        &mut self,
        share: f64,
        at: &Evaluation<'_>,
    ) -> Result<(), MotionFault> {
        let reference = self.reference().filter(|r| r.is_finite());
        let floor = share * reference.unwrap_or(0.0);
        self.scaled.take_added(at.mechanism.inertia(&at.s).added());
        let mass = self.scaled.inertia();
        let factored = self.solver.factor_above(floor, &at.s.entries, mass);
        factored.map_err(|e| self.fault(at, e))
    }

    /// Chooses the coordinates that these rows determine best with the last evaluated entries of C.
    /// Each coordinate is taken relative to its accuracy. From now on the rows are solved for these
    /// coordinates. The function also factors the rows, and returns the other coordinates,
    /// ascending.
    pub(crate) fn partition(
        &mut self,
        at: &Evaluation<'_>,
        known_to: impl Fn(usize) -> f64,
    ) -> Result<Vec<usize>, MotionFault> {
        self.forget_partition();
        self.factor(at)?;
        let chosen = self.solver.null_space().and_then(|(c, saddle)| {
            let dependent = if saddle.is_graded() {
                saddle.solved_for().to_vec()
            } else {
                let mut c = c.dense();
                for k in 0..c.nrows() {
                    let row = c.row_mut(k).iter_mut().enumerate();
                    row.for_each(|(j, c)| *c *= known_to(j));
                }
                PivotedQr::of_columns(&c).permutation()[..c.nrows()].to_vec()
            };
            saddle.partition(&dependent)?;
            Ok(dependent)
        });
        let dependent = chosen.map_err(|e| self.fault(at, e))?;
        let free = (0..self.scaled.units.len()).filter(|i| !dependent.contains(i));
        let free = free.collect();
        self.partition = Some(PartitionPivot(None));
        self.factor(at)?;
        Ok(free)
    }

    /// Removes the partition. Every factorisation then chooses its coordinates again.
    pub(crate) fn forget_partition(&mut self) {
        if let Ok((_, saddle)) = self.solver.null_space() {
            saddle.forget_partition();
        }
        self.partition = None;
    }

    /// Returns the pivot ratio that the partition had when it was chosen, if there is a partition.
    pub(crate) fn partition_pivot(&self) -> Option<f64> {
        self.partition.and_then(|p| p.0)
    }

    /// Returns the pivot ratio with which present pivot ratios are compared.
    fn reference(&self) -> Option<f64> {
        match self.partition {
            Some(partition) => partition.0,
            None => self.reference_pivot,
        }
    }

    /// Sets the right-hand side. The value for each independent row i of C is `of(i)`.
    pub(crate) fn take_rhs(&mut self, mut of: impl FnMut(usize) -> f64) {
        for (rhs, &i) in self.rhs.iter_mut().zip(&self.kept) {
            *rhs = of(i);
        }
    }

    /// Overwrites the dependent entries of x so that `C·x = rhs`. Returns an error if a row was
    /// skipped.
    pub(crate) fn complete(
        &mut self,
        at: &Evaluation<'_>,
        x: &mut [f64],
    ) -> Result<(), MotionFault> {
        if let Some(row) = (0..self.kept.len()).find(|&k| !self.uses(k)) {
            return Err(MotionFault::IndependentCoordinates {
                time: at.s.t,
                row: at.label(self.kept[row]),
                pivot: self.relative_pivot(),
            });
        }
        self.scaled.take_motion(x);
        let (rhs, motion) = (&self.rhs, &mut self.scaled.motion);
        let completed = self.solver.null_space();
        let completed = completed.and_then(|(_, saddle)| saddle.complete(rhs, motion));
        self.written(at, completed, x)
    }

    /// Solves `M·x + Cᵀ·λ = force`, `C·x = rhs` for x with the factored matrix. Without a force, x
    /// is the smallest motion in the mass metric.
    pub(crate) fn solve(
        &mut self,
        at: &Evaluation<'_>,
        force: Option<&[f64]>,
        x: &mut [f64],
    ) -> Result<(), MotionFault> {
        match force {
            Some(force) => self.scaled.take_force(force),
            None => self.scaled.force.fill(0.0),
        }
        let ScaledVectors { force, motion, .. } = &mut self.scaled;
        let (rhs, lambda) = (&self.rhs, &mut self.lambda);
        let solved = self.solver.motion(force, rhs, motion, lambda);
        self.written(at, solved, x)
    }

    /// Computes accelerations from `M·a + Cᵀ·λ = Q`, `C·a = rhs` with the last evaluated Q. The
    /// solution is refined if it would otherwise lose digits.
    pub(super) fn accelerate(
        &mut self,
        at: &Evaluation<'_>,
        a: &mut [f64],
    ) -> Result<(), MotionFault> {
        if !self.are_refined() {
            return self.solve(at, Some(&at.s.force), a);
        }
        self.scaled.take_force(&at.s.force);
        let ScaledVectors { force, motion, .. } = &mut self.scaled;
        let (rhs, lambda) = (&self.rhs, &mut self.lambda);
        let solved = self.solver.refined(force, rhs, motion, lambda);
        self.written(at, solved, a)
    }

    /// Returns whether accelerations and their multipliers are refined with the last factorisation.
    pub(crate) fn are_refined(&self) -> bool {
        self.is_far || self.solver.wants_refinement()
    }

    /// Computes λ for the accelerations a just computed. Refined solutions already include λ.
    pub(super) fn find_multipliers(
        &mut self,
        at: &Evaluation<'_>,
        a: &[f64],
    ) -> Result<(), MotionFault> {
        if self.are_refined() || self.solver.brings_multipliers() {
            return Ok(());
        }
        self.scaled.take_force(&at.s.force);
        self.scaled.take_motion(a);
        self.solve_for_multipliers().map_err(|e| self.fault(at, e))
    }

    /// Returns the multipliers Λ of all rows with `M·change + C_Kᵀ·Λ = 0` for a change of the
    /// velocities by an impulse of the independent rows. The multipliers of other rows are zero.
    /// The rows must be factored.
    pub(crate) fn impulses(
        &mut self,
        at: &Evaluation<'_>,
        change: &[f64],
    ) -> Result<Vec<f64>, MotionFault> {
        let mut momenta = at.mechanism.inertia(&at.s).product(change);
        momenta
            .iter_mut()
            .for_each(|momentum| *momentum = -*momentum);
        self.scaled.take_force(&momenta);
        self.scaled.motion.fill(0.0);
        self.solve_for_multipliers()
            .map_err(|e| self.fault(at, e))?;
        let mut all = vec![0.0; at.mechanism.layout().rows()];
        for (&i, multiplier) in self.kept.iter().zip(&self.lambda) {
            all[i] = *multiplier;
        }
        Ok(all)
    }

    fn solve_for_multipliers(&mut self) -> Result<(), SaddleError> {
        let ScaledVectors { force, motion, .. } = &self.scaled;
        self.solver.multipliers(force, motion, &mut self.lambda)
    }

    /// Returns the largest coefficient of an independent row in a redundant row, with the last
    /// evaluated entries of C. The rows must be factored at these entries. In the redundant rows,
    /// the rounding error of the independent rows is multiplied by this coefficient.
    pub(crate) fn largest_coefficient(&mut self, at: &Evaluation<'_>) -> f64 {
        note(WorkKind::Coefficients);
        // Large mechanisms have thousands of redundant rows, each of which is implied by a few
        // rows. Two sums of the redundant rows with random weights are used instead of all
        // redundant rows.
        let are_summed = self.kept.len() >= SUMMED_FROM;
        let samples = if are_summed { 2 } else { self.dropped.len() };
        let mut largest = 0.0_f64;
        for k in 0..samples {
            let implied = if are_summed {
                self.imply_sum(at, 1 + k as u64)
            } else {
                self.imply(at, self.dropped[k])
            };
            largest = match implied {
                Ok(()) => self.lambda.iter().fold(largest, |a, l| a.max(l.abs())),
                Err(_) => f64::INFINITY,
            };
        }
        largest
    }

    /// Returns the size of the redundant row i and of the contributions of the independent rows to
    /// this row. For `c_i = Σ T_ik·c_k`, the size is the sum of `scale(i)` and of all
    /// `|T_ik|·scale(k)`. The residual of the row may be as large as the rounding error of these
    /// terms. The rows must be factored with the last evaluated entries of C.
    pub(crate) fn implied_scale(
        &mut self,
        at: &Evaluation<'_>,
        i: usize,
        scale: impl Fn(usize) -> f64,
    ) -> Result<f64, MotionFault> {
        self.imply(at, i).map_err(|e| self.fault(at, e))?;
        let terms = self.kept.iter().zip(&self.lambda);
        let terms = terms.map(|(&k, coefficient)| coefficient.abs() * scale(k));
        Ok(scale(i) + terms.sum::<f64>())
    }

    /// Writes the dependency of a redundant row on the independent rows as a combination of all
    /// rows. The combination is 1 at the redundant row, and minus the coefficients at the
    /// independent rows. The rows must be factored.
    pub(crate) fn dependency(
        &mut self,
        at: &Evaluation<'_>,
        dropped: usize,
        z: &mut [f64],
    ) -> Result<(), MotionFault> {
        self.imply(at, dropped).map_err(|e| self.fault(at, e))?;
        z.fill(0.0);
        z[dropped] = 1.0;
        for (&k, coefficient) in self.kept.iter().zip(&self.lambda) {
            z[k] = -coefficient;
        }
        Ok(())
    }

    /// Writes the dependency of each redundant row on the independent rows, like
    /// [`Self::dependency`]. The rows must be factored.
    pub(crate) fn all_dependencies(
        &mut self,
        at: &Evaluation<'_>,
        z: &mut Vec<Vec<f64>>,
    ) -> Result<(), MotionFault> {
        z.resize(self.dropped.len(), vec![0.0; at.mechanism.layout().rows()]);
        for (k, z) in z.iter_mut().enumerate() {
            self.dependency(at, self.dropped[k], z)?;
            self.refine(at, z)?;
        }
        Ok(())
    }

    /// Works like [`Self::all_dependencies`]. If there are many redundant rows, the function
    /// instead writes the dependencies of sums of all redundant rows with random weights.
    pub(crate) fn dependencies(
        &mut self,
        at: &Evaluation<'_>,
        z: &mut Vec<Vec<f64>>,
    ) -> Result<(), MotionFault> {
        if self.dropped.len() <= CARRIED_VECTORS {
            return self.all_dependencies(at, z);
        }
        z.resize(CARRIED_VECTORS, vec![0.0; at.mechanism.layout().rows()]);
        for (seed, z) in (1..).zip(z.iter_mut()) {
            self.imply_sum(at, seed).map_err(|e| self.fault(at, e))?;
            for (k, &i) in self.dropped.iter().enumerate() {
                z[i] = weight_of(k, seed);
            }
            for (&i, coefficient) in self.kept.iter().zip(&self.lambda) {
                z[i] = -coefficient;
            }
            self.refine(at, z)?;
        }
        Ok(())
    }

    /// Corrects a dependency once by the residual `Cᵀ·z`.
    fn refine(&mut self, at: &Evaluation<'_>, z: &mut [f64]) -> Result<(), MotionFault> {
        let scaled = &mut self.scaled;
        scaled.motion.fill(0.0);
        scaled.force.fill(0.0);
        for (i, z) in z.iter().enumerate().filter(|(_, z)| **z != 0.0) {
            for (j, c) in at.mechanism.layout().row(&at.s, i) {
                scaled.force[j] += z * c * scaled.units[j];
            }
        }
        self.solve_for_multipliers()
            .map_err(|e| self.fault(at, e))?;
        for (&i, correction) in self.kept.iter().zip(&self.lambda) {
            z[i] -= correction;
        }
        Ok(())
    }

    /// Stores the coefficients of the independent rows in a redundant row as multipliers. If a row
    /// that the independent rows imply is applied as a force, it causes no acceleration: `M·0 +
    /// C_Kᵀ·λ = c_Dᵀ`.
    fn imply(&mut self, at: &Evaluation<'_>, dropped: usize) -> Result<(), SaddleError> {
        let scaled = &mut self.scaled;
        scaled.motion.fill(0.0);
        at.mechanism
            .layout()
            .scatter_row(&at.s, dropped, &mut scaled.force);
        for (entry, unit) in scaled.force.iter_mut().zip(&scaled.units) {
            *entry *= unit;
        }
        self.solve_for_multipliers()
    }

    /// Works like [`Self::imply`], for the sum of all redundant rows with random weights.
    fn imply_sum(&mut self, at: &Evaluation<'_>, seed: u64) -> Result<(), SaddleError> {
        let scaled = &mut self.scaled;
        scaled.motion.fill(0.0);
        scaled.force.fill(0.0);
        for (k, &i) in self.dropped.iter().enumerate() {
            let weight = weight_of(k, seed);
            for (j, c) in at.mechanism.layout().row(&at.s, i) {
                scaled.force[j] += weight * c * scaled.units[j];
            }
        }
        self.solve_for_multipliers()
    }

    /// Returns whether the rows of the last factorisation imply each redundant row, except for this
    /// share of the redundant row. For large mechanisms, two sums of the redundant rows are
    /// examined instead, as in [`Self::largest_coefficient`].
    pub(crate) fn imply_dropped(&mut self, at: &Evaluation<'_>, share: f64) -> bool {
        let are_summed = self.kept.len() >= SUMMED_FROM;
        let (samples, rows) = match self.dropped.len() {
            all if are_summed => (2, all.max(1) as f64),
            all => (all, 1.0),
        };
        (0..samples).all(|k| {
            let implied = if are_summed {
                self.imply_sum(at, 1 + k as u64)
            } else {
                self.imply(at, self.dropped[k])
            };
            let ScaledVectors { force, units, .. } = &mut self.scaled;
            let size = force.iter().map(|x| x * x / rows).sum::<f64>();
            for (&i, coefficient) in self.kept.iter().zip(&self.lambda) {
                for (j, c) in at.mechanism.layout().row(&at.s, i) {
                    force[j] -= coefficient * c * units[j];
                }
            }
            let left = force.iter().map(|x| x * x).sum::<f64>();
            implied.is_ok() && left <= share * share * size
        })
    }

    /// Uses the reference pivot of other rows, because the current configuration may be singular.
    pub(crate) fn compare_as(&mut self, others: &Self) {
        self.reference_pivot = others.reference_pivot;
    }

    /// Returns the number of rows that were dependent for an instant and skipped in the last
    /// factorisation.
    pub(crate) fn n_left_out(&self) -> usize {
        self.solver.n_left_out()
    }

    /// Returns whether the last factorisation uses the k-th independent row.
    pub(crate) fn uses(&self, k: usize) -> bool {
        self.solver.uses(k)
    }

    /// Returns the smallest pivot of the last factorisation relative to its row.
    pub(crate) fn pivot_ratio(&self) -> f64 {
        self.solver.pivot_ratio()
    }

    /// Returns the smallest pivot relative to its value when the rows were chosen. The result
    /// applies to any coordinates of the solution, and is infinite without rows.
    pub(crate) fn relative_pivot(&self) -> f64 {
        match self.reference_pivot {
            Some(reference) if reference.is_finite() => self.pivot_ratio() / reference,
            _ => f64::INFINITY,
        }
    }

    /// Writes a basis of the motions that the factored rows allow, in units of the mechanism.
    pub(crate) fn null_frame(&self, frame: &mut Vec<f64>) {
        self.solver.null_frame(frame);
    }

    /// Returns the sign of the determinant of the factored rows bordered by a basis of motions, or
    /// 0 if the sign is unknown.
    pub(crate) fn orientation(&mut self, frame: &[f64]) -> f64 {
        self.solver.orientation(frame)
    }

    /// Writes the motion just computed.
    fn written(
        &self,
        at: &Evaluation<'_>,
        solved: Result<(), SaddleError>,
        x: &mut [f64],
    ) -> Result<(), MotionFault> {
        solved.map_err(|e| self.fault(at, e))?;
        self.scaled.write_motion(x);
        Ok(())
    }

    /// Returns the fault for a failed solution at the last evaluated time.
    fn fault(&self, at: &Evaluation<'_>, e: SaddleError) -> MotionFault {
        let time = at.s.t;
        match e {
            SaddleError::RankLost { row, pivot, scale } => MotionFault::RankLost {
                time,
                row: at.label(self.kept[row]),
                pivot,
                scale,
            },
            SaddleError::MasslessMotion { motion, .. } => {
                let further = |a: usize, b: usize| {
                    if motion[b].abs() > motion[a].abs() {
                        b
                    } else {
                        a
                    }
                };
                let (body, coordinate) =
                    at.mechanism.coordinate((0..motion.len()).fold(0, further));
                let body = body.to_owned();
                MotionFault::Massless {
                    time,
                    body,
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
}

/// Returns a pseudo-random weight of a row in a sum, between 1 and 2 in absolute value. Random
/// signs alone would not be sufficient, because two rows with equal coefficients would cancel in
/// one of two sums.
fn weight_of(k: usize, seed: u64) -> f64 {
    let mut mixed = (k as u64).wrapping_add(seed << 40);
    for odd in [0x9e37_79b9_7f4a_7c15, 0xbf58_476d_1ce4_e5b9] {
        mixed = mixed.wrapping_mul(odd).rotate_left(31);
    }
    // The number has 52 random bits as its fraction, and a random sign.
    let size = f64::from_bits(1.0_f64.to_bits() | mixed >> 12);
    size.copysign(if mixed & 1 == 0 { 1.0 } else { -1.0 })
}

#[cfg(test)]
mod tests {
    use super::weight_of;

    /// No two rows cancel in a sum, and each row has a significant weight.
    #[test]
    fn weights_of_rows_differ_in_size() {
        for seed in 1..=8 {
            let mut sizes: Vec<f64> = (0..300).map(|k| weight_of(k, seed).abs()).collect();
            sizes.sort_by(f64::total_cmp);
            assert!(sizes[0] >= 1.0 && sizes[299] < 2.0, "{sizes:?}");
            let apart = sizes.windows(2).map(|pair| pair[1] - pair[0]);
            assert!(apart.fold(1.0, f64::min) > 1e-8, "seed {seed}: {sizes:?}");
            let negative = (0..300).filter(|&k| weight_of(k, seed) < 0.0).count();
            assert!((100..200).contains(&negative), "seed {seed}: {negative}");
        }
    }
}
