//! Projection onto the constraints: positions by Newton's method on the rows of Φq, velocities by
//! one linear solve, both with the smallest correction in the mass metric.

use model::{Mechanism, Scratch, System};

use super::rows::KeptRows;
use super::{Correction, KeptRowMotion};
use crate::counts::{Counted, note};
use crate::error::MotionFault;
use crate::events::Event;
use crate::guards::GUARDED;

/// Corrections of the position per projection; one or two are the rule, more where a tolerance is
/// very loose.
const CORRECTIONS: usize = 20;

/// Corrections of the velocity per projection, at most.
const VELOCITY_PASSES: usize = 3;

/// Kept rows count as satisfied below this many roundings of their terms.
const ROUNDINGS: f64 = 10.0;

/// The same where pivots have fallen below [`WEAK`] of their reference: what kept rows miss by is
/// multiplied in the dropped ones.
const FEW_ROUNDINGS: f64 = 1.0;
const WEAK: f64 = 0.5;

/// The same where a further correction does not help.
const STALLED_ROUNDINGS: f64 = 50.0;

/// Dropped rows count as implied by the kept ones below this share of their own terms and of those
/// of the kept rows, as much as these enter: a row with an arm of 1e30 m says nothing of what an
/// angle may miss by. Rounding of the kept rows is 1e-15; the configuration is off them by as much.
const DROPPED_MISFIT: f64 = 1e-11;

/// The share of the size of the mechanism by which velocities may part in the time of a run,
/// however slow it is: some hundred roundings.
const AT_REST: f64 = 1e-13;

/// A dropped row of Φ never misses by more than this share of its own terms, however far away the
/// places are from which the kept rows imply it.
const POSITION_MISFIT: f64 = 1e-5;

/// Smallest share of the reference pivots that is taken into account there: nearer, rows are left
/// out.
const NEAREST_PIVOT: f64 = 1e-6;

/// Factors of an earlier configuration serve as long as a correction gains a digit: a factorisation
/// costs about ten corrections.
const CONVERGENCE: f64 = 0.1;

/// Which coordinates a correction moves.
#[derive(Clone, Copy)]
pub(super) enum Correct {
    /// All, by the smallest correction in the mass metric.
    AllCoordinates,
    /// Those that the rows have been partitioned to determine.
    DependentCoordinates,
}

impl KeptRowMotion<'_> {
    /// Projects a step that passed its error test, and keeps other rows if the present ones have
    /// become nearly dependent there. What happened is told by [`KeptRowMotion::accept`], once the
    /// step stands.
    ///
    /// # Errors
    /// As [`super::Motion::project`]; also if the step ends nearer to a singular configuration than
    /// `nearest`, a share of the reference pivots.
    pub(crate) fn project_step(
        &mut self,
        t: f64,
        q: &mut [f64],
        v: &mut [f64],
        nearest: f64,
    ) -> Result<Correction, MotionFault> {
        self.complete_row(t, q, v)?;
        let iterations = self.settle(t, q)?;
        if self.velocity.relative_pivot() < nearest {
            return Err(self.no_way_over(t));
        }
        // On a chart rows are exchanged when the next step begins.
        if GUARDED
            && self.chart.is_none()
            && let Some(event) = self.review(q)?
        {
            self.pending = Some(event);
        }
        if std::mem::take(&mut self.is_unsettled) {
            self.settle(t, q)?;
        }
        self.finish(v, iterations)
    }

    /// Moves a stage onto the constraints.
    pub(crate) fn approach(
        &mut self,
        t: f64,
        q: &mut [f64],
        v: &mut [f64],
    ) -> Result<(), MotionFault> {
        self.settle(t, q)?;
        self.project_velocity(v).map(drop)
    }

    /// Whether the step to the state just evaluated may have passed a singular configuration.
    pub(crate) fn may_have_passed(&mut self) -> bool {
        GUARDED && self.passage.is_suspect(&mut self.velocity)
    }

    /// Whether velocities v and accelerations a at the state just evaluated go on from where the
    /// motion came near a singular configuration; as long as it is near, that remains to be seen.
    pub(crate) fn goes_on_smoothly(&self, now: (f64, &[f64], &[f64])) -> bool {
        !GUARDED
            || self.velocity.are_delicate()
            || self.passage.is_continued_by(now, self.mechanism.mass())
    }

    /// Notes an accepted state far from singular configurations.
    pub(crate) fn note_sound(&mut self, now: (f64, &[f64], &[f64])) {
        if GUARDED && !self.velocity.are_delicate() {
            self.passage.enter(now);
        }
    }

    /// Refuses a step over a singular configuration.
    pub(crate) fn no_way_over(&self, t: f64) -> MotionFault {
        MotionFault::SingularPassage {
            from: self.passage.since(),
            to: t,
        }
    }

    /// Takes the state just evaluated as that of an accepted step; what happened since the last
    /// one.
    pub(crate) fn accept(&mut self, t: f64) -> Option<Event> {
        self.review_chart(t);
        self.passage.take(&mut self.velocity, t);
        self.pending.take()
    }

    /// Takes the start as the first accepted state.
    pub(crate) fn begin(&mut self, t: f64, q: &mut [f64]) -> Result<(), MotionFault> {
        self.settle(t, q)?;
        self.passage.take(&mut self.velocity, t);
        Ok(())
    }

    /// Moves q onto the constraints and factors there.
    pub(super) fn settle(&mut self, t: f64, q: &mut [f64]) -> Result<usize, MotionFault> {
        let iterations = self.project_position(t, q, Correct::AllCoordinates)?;
        self.velocity.factor(self.mechanism, &self.s)?;
        Ok(iterations)
    }

    /// Moves v onto the constraints at a settled position and looks at all residuals.
    pub(super) fn finish(
        &mut self,
        v: &mut [f64],
        iterations: usize,
    ) -> Result<Correction, MotionFault> {
        let left = self.project_velocity(v)?;
        self.monitor(v, iterations, left)
    }

    /// Newton's method on the kept rows of Φ.
    pub(super) fn project_position(
        &mut self,
        t: f64,
        q: &mut [f64],
        correct: Correct,
    ) -> Result<usize, MotionFault> {
        let Self {
            mechanism,
            s,
            position,
            delta,
            zero,
            ..
        } = self;
        let enough = match correct {
            Correct::AllCoordinates => enough(position),
            Correct::DependentCoordinates => FEW_ROUNDINGS,
        };
        let mut best = f64::INFINITY;
        let mut iteration = 0;
        loop {
            mechanism.pose(t, q, s);
            mechanism.phi(s);
            mechanism.c(s);
            // The row that misses most, in roundings of its terms.
            let mut worst = (0, 0.0_f64);
            for (k, &i) in position.kept.iter().enumerate() {
                position.rhs[k] = -s.phi[i];
                // A row left out is as good as its dependence allows.
                if s.phi[i] == 0.0 || iteration > 0 && !position.uses(k) {
                    continue;
                }
                let size = mechanism.position_scale(s, i);
                let roundings = s.phi[i].abs() / (f64::EPSILON * size);
                if roundings > worst.1 || roundings.is_nan() {
                    worst = (i, roundings);
                }
            }
            // Rounding may leave a little more: a stalled iteration close to it is done too.
            let stalled = worst.1 >= 0.5 * best && worst.1 <= STALLED_ROUNDINGS;
            if worst.1 <= enough || stalled {
                return Ok(iteration);
            }
            if iteration == CORRECTIONS || worst.1.is_nan() {
                return Err(MotionFault::OffConstraints {
                    time: t,
                    row: mechanism.layout().labels[worst.0].clone(),
                    residual: s.phi[worst.0].abs(),
                    tolerance: ROUNDINGS * f64::EPSILON * mechanism.position_scale(s, worst.0),
                    iterations: iteration,
                });
            }
            let converges = worst.1 <= CONVERGENCE * best;
            best = best.min(worst.1);
            iteration += 1;
            match correct {
                Correct::AllCoordinates => {
                    position.factor(mechanism, s)?;
                    position.solve(mechanism, s, zero, delta)?;
                }
                Correct::DependentCoordinates => {
                    if !converges {
                        position.factor(mechanism, s)?;
                    }
                    delta.fill(0.0);
                    position.complete(mechanism, s, delta)?;
                }
            }
            mechanism.displace(q, delta);
        }
    }

    /// Needs the factorisation of the projected position. Returns what the kept rows miss by at
    /// most.
    fn project_velocity(&mut self, v: &mut [f64]) -> Result<f64, MotionFault> {
        self.evaluate_b();
        let Self {
            mechanism,
            s,
            velocity,
            delta,
            zero,
            ..
        } = self;
        let layout = mechanism.layout();
        let enough = enough(velocity);
        // Further passes remove what rounding left of the first.
        let mut passes = 0;
        loop {
            for (rhs, &i) in velocity.rhs.iter_mut().zip(&velocity.kept) {
                *rhs = -layout.velocity_residual(s, i, v);
            }
            let scale = |&i: &usize| mechanism.velocity_scale(s, i, v);
            let scale = velocity.kept.iter().map(scale).fold(0.0, f64::max);
            let left = largest(&velocity.rhs);
            if left <= enough * f64::EPSILON * scale || passes == VELOCITY_PASSES {
                return Ok(left);
            }
            passes += 1;
            velocity.solve(mechanism, s, zero, delta)?;
            for (v, d) in v.iter_mut().zip(&*delta) {
                *v += d;
            }
        }
    }

    /// Residuals of all rows at a projected state, the kept ones being off by `left`; dropped rows
    /// refused above the limit.
    fn monitor(
        &mut self,
        v: &[f64],
        iterations: usize,
        left: f64,
    ) -> Result<Correction, MotionFault> {
        if !GUARDED {
            return Ok(Correction {
                iterations,
                ..Correction::default()
            });
        }
        let (mechanism, s, size) = (self.mechanism, &self.s, self.size);
        let residual = |i: usize| mechanism.layout().velocity_residual(s, i, v).abs();
        let dropped = self.velocity.dropped.iter();
        let found = Correction {
            iterations,
            position_residual: largest(&s.phi),
            velocity_residual: dropped.fold(left, |a, &i| a.max(residual(i))),
        };
        self.check_positions()?;
        let s = &self.s;
        if !self.velocity.dropped.is_empty() {
            let scale = |i: usize| mechanism.velocity_scale(s, i, v);
            let residual = |i: usize| mechanism.layout().velocity_residual(s, i, v).abs();
            let share = dropped_misfit(&self.velocity);
            // Most rows agree to rounding of their own terms.
            let agrees = |&i: &usize| residual(i) <= share * scale(i);
            if self.velocity.dropped.iter().all(agrees) {
                return Ok(found);
            }
            // Off the constraints by rounding of its coordinates, the rows agree to the same share.
            // Kept rows are solved to rounding of the fastest of them, so that the others are no
            // better.
            let rounding = mechanism.relative_residual(s, size);
            let rows = 0..mechanism.layout().rows();
            let fastest = rows.map(scale).fold(0.0, f64::max);
            let share = share.max(STALLED_ROUNDINGS * rounding);
            let horizon = self.horizon;
            let level = Level {
                name: "velocity",
                share,
                residual,
                scale: |_| fastest,
                most: f64::INFINITY,
                floor: || AT_REST * size_of_rows(mechanism, s, size) / horizon,
            };
            level.check(&mut self.velocity, mechanism, s)?;
        }
        Ok(found)
    }

    /// Dropped rows of Φ at the pose of the scratch, on the kept ones: on another configuration of
    /// these they do not hold.
    pub(super) fn check_positions(&mut self) -> Result<(), MotionFault> {
        if self.position.dropped.is_empty() {
            return Ok(());
        }
        let (mechanism, s) = (self.mechanism, &self.s);
        let level = Level {
            name: "position",
            share: dropped_misfit(&self.position),
            residual: |i: usize| s.phi[i].abs(),
            scale: |i| mechanism.position_scale(s, i),
            most: POSITION_MISFIT,
            floor: || 0.0,
        };
        level.check(&mut self.position, mechanism, s)
    }

    /// Residuals of all rows at a state whose Φ, C and b stand in the scratch.
    pub(super) fn residuals(&self, v: &[f64]) -> Correction {
        let velocity = |i| self.mechanism.layout().velocity_residual(&self.s, i, v);
        Correction {
            iterations: 0,
            position_residual: largest(&self.s.phi),
            velocity_residual: (0..self.mechanism.layout().rows())
                .fold(0.0, |a, i| f64::max(a, velocity(i).abs())),
        }
    }
}

/// What rows dropped from these may miss by, as share of their terms: rounding of the kept rows
/// reaches them through the inverse of the pivots, near a singular configuration more than
/// elsewhere.
fn dropped_misfit(rows: &KeptRows) -> f64 {
    DROPPED_MISFIT / rows.relative_pivot().clamp(NEAREST_PIVOT, 1.0)
}

/// The largest row of C for motions of the size of the mechanism.
fn size_of_rows(mechanism: &Mechanism, s: &Scratch, size: f64) -> f64 {
    let layout = mechanism.layout();
    let of_row = |i: usize| {
        let row = layout.row(s, i);
        row.map(|(j, c)| c.abs() * mechanism.unit(j, size)).sum()
    };
    (0..layout.rows()).map(of_row).fold(0.0, f64::max)
}

/// Positions or velocities of rows: what row i misses by, and the size of its terms.
struct Level<R, S, F> {
    name: &'static str,
    /// What dropped rows may miss by, as share of the terms.
    share: f64,
    residual: R,
    scale: S,
    /// The same share whatever rounding of the kept rows explains: beyond it the row is not known
    /// to hold.
    most: f64,
    /// What they may miss by however small the terms are: as positions may, velocities may part by
    /// what moves the mechanism by no more than a small share of its size while the run lasts,
    /// however slow the motion is.
    floor: F,
}

impl<R, S, F> Level<R, S, F>
where
    R: Fn(usize) -> f64,
    S: Fn(usize) -> f64,
    F: Fn() -> f64,
{
    /// Refuses the first dropped row that the kept ones do not imply.
    fn check(
        &self,
        rows: &mut KeptRows,
        mechanism: &Mechanism,
        s: &Scratch,
    ) -> Result<(), MotionFault> {
        for k in 0..rows.dropped.len() {
            note(Counted::Monitors);
            let i = rows.dropped[k];
            let residual = (self.residual)(i);
            // Most rows agree to rounding of their own terms.
            if residual <= self.share * (self.scale)(i) {
                continue;
            }
            rows.factor(mechanism, s)?;
            let implied = self.share * rows.implied_scale(mechanism, s, i, &self.scale)?;
            let implied = implied.min(self.most * (self.scale)(i));
            let tolerance = if residual > implied {
                implied.max((self.floor)())
            } else {
                implied
            };
            if residual > tolerance || residual.is_nan() || tolerance.is_nan() {
                return Err(MotionFault::DroppedRow {
                    time: s.t,
                    row: mechanism.layout().labels[i].clone(),
                    level: self.name,
                    residual,
                    tolerance,
                });
            }
        }
        Ok(())
    }
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |a: f64, x| a.max(x.abs()))
}

/// Roundings below which rows count as satisfied.
fn enough(rows: &KeptRows) -> f64 {
    match rows.relative_pivot() < WEAK {
        true => FEW_ROUNDINGS,
        false => ROUNDINGS,
    }
}
