//! The solved equations of motion on kept rows.
//!
//! The rank is never re-decided at a stage, where the state is off the constraints by δ and a singular value that is
//! exactly zero reads as about δ. The dropped rows are only monitored, at accepted steps: their residual after
//! projection is a free certificate of redundancy. Kept rows may become nearly dependent although the rank stays
//! (an edge turns until it no longer carries what a dropped row carried): then, at an accepted and
//! polished point, other rows are kept, which changes no motion.

use linalg::{KeptRowSaddle, Matrix, RankDecision, SaddleError};
use model::{Mechanism, Scratch, System};

use crate::error::Trip;
use crate::events::{Event, EventKind};
use crate::options::RowChoice;

/// Equations solved for what moves.
pub trait Motion {
    /// `v̇` from `M·v̇ + C_Kᵀ·λ_K = Q`, `C_K·v̇ = Γ_K`.
    ///
    /// # Errors
    /// If the equations have no (unique) solution here.
    fn acceleration(&mut self, t: f64, q: &[f64], v: &[f64], a: &mut [f64]) -> Result<(), Trip>;

    /// Moves q and v onto the constraints by the smallest correction in the mass metric, and checks the dropped rows.
    ///
    /// # Errors
    /// If that fails, or a dropped row is violated.
    fn project(&mut self, t: f64, q: &mut [f64], v: &mut [f64]) -> Result<Correction, Trip>;

    /// Multipliers of all rows; those of dropped rows are zero by decree. NaN where the rows asked for are dependent at
    /// just this instant, so that no finite multipliers belong to them.
    ///
    /// # Errors
    /// As [`Motion::acceleration`].
    fn multipliers(&mut self, t: f64, q: &[f64], v: &[f64], lambda: &mut [f64])
    -> Result<(), Trip>;
}

/// What a projection found and did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Correction {
    /// Corrections of the position made.
    pub iterations: usize,
    /// Largest |Φ| afterwards, all rows.
    pub position_residual: f64,
    /// Largest |C·v − b| afterwards, all rows.
    pub velocity_residual: f64,
}

/// A mechanism on kept rows. All storage is made here; evaluations allocate nothing.
pub struct KeptRowMotion<'a> {
    mechanism: &'a Mechanism,
    kept: Vec<usize>,
    dropped: Vec<usize>,
    /// The rows that reactions are asked for, where they are not the kept ones for a while.
    chosen: Option<Chosen>,
    /// Pivot ratio of the first rows at the start: what later ones are compared with.
    reference_pivot: f64,
    s: Scratch,
    saddle: KeptRowSaddle,
    /// Dense kept rows of C, r × n_v.
    c: Matrix,
    /// Right-hand side of the kept rows, r.
    rhs: Vec<f64>,
    /// Multipliers of the kept rows, r.
    lambda: Vec<f64>,
    /// A correction, n_v.
    delta: Vec<f64>,
    /// No force, n_v.
    zero: Vec<f64>,
}

/// Rows chosen by the user, set aside while they are nearly dependent.
struct Chosen {
    kept: Vec<usize>,
    dropped: Vec<usize>,
}

/// Other rows are kept once the pivots have fallen below this share of those at the start: rounding of the kept rows
/// reaches the dropped ones through the inverse of the pivots.
const PIVOT_LOSS: f64 = 0.1;

/// Rows set aside come back above this share.
const PIVOT_RECOVERY: f64 = 0.2;

/// Corrections of the position per projection; one or two are the rule.
const CORRECTIONS: usize = 6;

/// |Φ| and |C·v − b| of kept rows count as zero below this many roundings of the largest term.
const ROUNDINGS: f64 = 10.0;

/// Residuals allowed after a projection: `max(1e-12, 50·eps·largest |coordinate|)`.
const RESIDUAL_FLOOR: f64 = 1e-12;
const RESIDUAL_ROUNDINGS: f64 = 50.0;

impl<'a> KeptRowMotion<'a> {
    /// The motion of a mechanism on the kept rows of a rank decision.
    ///
    /// # Errors
    /// If more rows are kept than there are velocities.
    pub fn new(mechanism: &'a Mechanism, decision: &RankDecision) -> Result<Self, Trip> {
        let n = mechanism.layout().n_v;
        let r = decision.kept.len();
        let saddle =
            KeptRowSaddle::new(n, r).map_err(|source| Trip::Saddle { time: 0.0, source })?;
        Ok(Self {
            mechanism,
            kept: decision.kept.clone(),
            dropped: decision.dropped.clone(),
            chosen: None,
            reference_pivot: f64::NAN,
            s: mechanism.scratch(),
            saddle,
            c: Matrix::zeros(r, n),
            rhs: vec![0.0; r],
            lambda: vec![0.0; r],
            delta: vec![0.0; n],
            zero: vec![0.0; n],
        })
    }

    /// The mechanism.
    #[must_use]
    pub fn mechanism(&self) -> &'a Mechanism {
        self.mechanism
    }

    /// Results of the last evaluation: poses, forces, …
    #[must_use]
    pub fn scratch(&self) -> &Scratch {
        &self.s
    }

    /// Smallest pivot of the last factorisation relative to its row: small near singular configurations.
    #[must_use]
    pub fn pivot_ratio(&self) -> f64 {
        self.saddle.pivot_ratio()
    }

    /// Projects an accepted step, and keeps other rows if the present ones have become nearly dependent there. Rows that
    /// the user chose are only set aside, and come back.
    ///
    /// # Errors
    /// As [`Motion::project`]; also if the rank itself changes here, or cannot be decided.
    pub(crate) fn project_step(
        &mut self,
        t: f64,
        q: &mut [f64],
        v: &mut [f64],
        choice: &RowChoice,
    ) -> Result<(Correction, Option<Event>), Trip> {
        let mut iterations = self.settle(t, q)?;
        let event = self.review(choice)?;
        if event.is_some() {
            iterations += self.settle(t, q)?;
        }
        Ok((self.finish(q, v, iterations)?, event))
    }

    /// Moves q onto the constraints and factors there.
    fn settle(&mut self, t: f64, q: &mut [f64]) -> Result<usize, Trip> {
        let iterations = self.project_position(t, q)?;
        self.factor()?;
        Ok(iterations)
    }

    /// Moves v onto the constraints at a settled position and looks at all residuals.
    fn finish(&mut self, q: &[f64], v: &mut [f64], iterations: usize) -> Result<Correction, Trip> {
        self.project_velocity(v)?;
        self.monitor(q, v, iterations)
    }

    /// Looks at the pivots of a settled position.
    fn review(&mut self, choice: &RowChoice) -> Result<Option<Event>, Trip> {
        if self.reference_pivot.is_nan() {
            self.reference_pivot = self.pivot_ratio();
        }
        if let Some(chosen) = self.chosen.take() {
            let aside = self.exchange(chosen);
            if self.factor().is_ok() && self.pivot_ratio() > PIVOT_RECOVERY * self.reference_pivot {
                return Ok(Some(
                    self.event("the rows asked for are independent again and kept again"),
                ));
            }
            self.chosen = Some(self.exchange(aside));
            self.factor()?;
        }
        if self.pivot_ratio() > PIVOT_LOSS * self.reference_pivot {
            return Ok(None);
        }
        let time = self.s.t;
        let undecided = |what: String| Trip::NoRows { time, what };
        let decision =
            solvability::certify(self.mechanism, &self.s).map_err(|e| undecided(e.to_string()))?;
        if let linalg::RankStatus::Undecided(doubt) = decision.status {
            return Err(undecided(doubt.to_string()));
        }
        if decision.rank != self.kept.len() {
            return Err(undecided(format!(
                "the rank changes from {} to {}",
                self.kept.len(),
                decision.rank
            )));
        }
        if decision.kept == self.kept {
            return Ok(None);
        }
        let aside = self.exchange(Chosen {
            kept: decision.kept,
            dropped: decision.dropped,
        });
        self.factor()?;
        match choice {
            RowChoice::Automatic => self.reference_pivot = self.pivot_ratio(),
            RowChoice::Drop(_) => self.chosen = self.chosen.take().or(Some(aside)),
        }
        Ok(Some(self.event("the kept rows became nearly dependent")))
    }

    /// Keeps other rows; returns the present ones.
    fn exchange(&mut self, rows: Chosen) -> Chosen {
        Chosen {
            kept: std::mem::replace(&mut self.kept, rows.kept),
            dropped: std::mem::replace(&mut self.dropped, rows.dropped),
        }
    }

    fn event(&self, why: &str) -> Event {
        let dropped: Vec<String> = self.dropped.iter().map(|i| (i + 1).to_string()).collect();
        Event {
            time: self.s.t,
            kind: EventKind::RowsExchanged,
            redundancy_before: self.dropped.len(),
            redundancy_after: self.dropped.len(),
            text: format!(
                "{why}; now dropped: {}. The motion is the same.",
                dropped.join(", ")
            ),
        }
    }

    /// b at the pose of the scratch.
    pub(crate) fn evaluate_b(&mut self) {
        if self.mechanism.layout().rheonomic {
            self.mechanism.b(&mut self.s);
        }
    }

    /// Power of the constraint forces at the last evaluated acceleration: `−λᵀ·C·v = −λᵀ·b` (W).
    pub(crate) fn constraint_power(&self) -> f64 {
        self.kept
            .iter()
            .zip(&self.lambda)
            .map(|(&i, l)| -l * self.s.b[i])
            .sum()
    }

    /// Factors the saddle matrix at the pose of the scratch.
    fn factor(&mut self) -> Result<(), Trip> {
        self.mechanism.c(&mut self.s);
        for (k, &i) in self.kept.iter().enumerate() {
            self.mechanism
                .layout()
                .scatter_row(&self.s, i, self.c.row_mut(k));
        }
        let c = &self.c;
        self.saddle
            .factor(|k| c.row(k), self.mechanism.mass())
            .map_err(|e| self.trip(e))
    }

    /// Solves for accelerations and multipliers of the kept rows at the factored pose.
    fn solve(&mut self, v: &[f64], a: &mut [f64]) -> Result<(), Trip> {
        self.mechanism.twist(v, &mut self.s);
        self.mechanism.gamma(&mut self.s);
        self.mechanism.force(&mut self.s);
        for (rhs, &i) in self.rhs.iter_mut().zip(&self.kept) {
            *rhs = self.s.gamma[i];
        }
        self.saddle
            .solve(&self.s.force, &self.rhs, a, &mut self.lambda)
            .map_err(|e| self.trip(e))
    }

    /// The correction with `C_K·δ = −rhs` that is smallest in the mass metric, into `delta`.
    fn correct(&mut self) -> Result<(), Trip> {
        for rhs in &mut self.rhs {
            *rhs = -*rhs;
        }
        self.saddle
            .solve(&self.zero, &self.rhs, &mut self.delta, &mut self.lambda)
            .map_err(|e| self.trip(e))
    }

    fn pose(&mut self, t: f64, q: &[f64]) {
        self.mechanism.pose(t, q, &mut self.s);
    }

    fn project_position(&mut self, t: f64, q: &mut [f64]) -> Result<usize, Trip> {
        let m = self.mechanism.layout().m;
        let mut best = f64::INFINITY;
        for iteration in 0..=CORRECTIONS {
            self.pose(t, q);
            self.mechanism.phi(&mut self.s);
            let mut worst = (0, 0.0_f64);
            for (rhs, &i) in self.rhs.iter_mut().zip(&self.kept) {
                *rhs = if i < m { self.s.phi[i] } else { 0.0 };
                if rhs.abs() > worst.1 || rhs.is_nan() {
                    worst = (i, rhs.abs());
                }
            }
            let tolerance = ROUNDINGS * f64::EPSILON * largest(q).max(1.0);
            let done = worst.1 <= tolerance;
            // Rounding may leave a little more: a stalled iteration close to it is done too.
            let stalled = worst.1 >= 0.5 * best && worst.1 <= residual_limit(q);
            if done || stalled {
                return Ok(iteration);
            }
            if iteration == CORRECTIONS || worst.1.is_nan() {
                return Err(Trip::OffConstraints {
                    time: t,
                    row: self.mechanism.layout().labels[worst.0].clone(),
                    residual: worst.1,
                    tolerance,
                    iterations: iteration,
                });
            }
            best = best.min(worst.1);
            self.factor()?;
            self.correct()?;
            for (q, d) in q.iter_mut().zip(&self.delta) {
                *q += d;
            }
        }
        unreachable!("the last iteration returns")
    }

    /// Needs the factorisation of the projected position.
    fn project_velocity(&mut self, v: &mut [f64]) -> Result<(), Trip> {
        self.evaluate_b();
        let layout = self.mechanism.layout();
        // The second pass removes what rounding left of the first.
        for _ in 0..2 {
            for (rhs, &i) in self.rhs.iter_mut().zip(&self.kept) {
                *rhs = layout.velocity_residual(&self.s, i, v);
            }
            if largest(&self.rhs) <= ROUNDINGS * f64::EPSILON * largest(v).max(1.0) {
                break;
            }
            self.correct()?;
            for (v, d) in v.iter_mut().zip(&self.delta) {
                *v += d;
            }
        }
        Ok(())
    }

    /// Residuals of all rows at a projected state, dropped rows refused above the limit.
    fn monitor(&self, q: &[f64], v: &[f64], iterations: usize) -> Result<Correction, Trip> {
        let layout = self.mechanism.layout();
        let mut found = Correction {
            iterations,
            ..Correction::default()
        };
        for i in self.kept.iter().copied() {
            if i < layout.m {
                found.position_residual = found.position_residual.max(self.s.phi[i].abs());
            }
            let velocity = layout.velocity_residual(&self.s, i, v).abs();
            found.velocity_residual = found.velocity_residual.max(velocity);
        }
        for &i in &self.dropped {
            let position = if i < layout.m {
                self.s.phi[i].abs()
            } else {
                0.0
            };
            let velocity = layout.velocity_residual(&self.s, i, v).abs();
            let checks = [
                ("position", position, residual_limit(q)),
                (
                    "velocity",
                    velocity,
                    residual_limit(q).max(residual_limit(v)),
                ),
            ];
            for (level, residual, tolerance) in checks {
                if residual > tolerance || residual.is_nan() {
                    let row = layout.labels[i].clone();
                    return Err(Trip::DroppedRow {
                        time: self.s.t,
                        row,
                        level,
                        residual,
                        tolerance,
                    });
                }
            }
            found.position_residual = found.position_residual.max(position);
            found.velocity_residual = found.velocity_residual.max(velocity);
        }
        Ok(found)
    }

    fn trip(&self, e: SaddleError) -> Trip {
        let time = self.s.t;
        let layout = self.mechanism.layout();
        match e {
            SaddleError::RankLost { row, pivot, scale } => {
                let row = layout.labels[self.kept[row]].clone();
                Trip::RankLost {
                    time,
                    row,
                    pivot,
                    scale,
                }
            }
            SaddleError::MasslessMotion { motion, .. } => {
                let worst = (0..motion.len()).fold(0, |a, b| {
                    if motion[b].abs() > motion[a].abs() {
                        b
                    } else {
                        a
                    }
                });
                let body = self.mechanism.bodies()[worst / 3].name.clone();
                Trip::Massless {
                    time,
                    body,
                    coordinate: ["x", "y", "angle"][worst % 3],
                }
            }
            SaddleError::NonFinite {
                argument,
                index,
                value,
            } => {
                let what = format!("{argument}[{index}] = {value}");
                Trip::NotFinite { time, what }
            }
            source => Trip::Saddle { time, source },
        }
    }
}

impl Motion for KeptRowMotion<'_> {
    fn acceleration(&mut self, t: f64, q: &[f64], v: &[f64], a: &mut [f64]) -> Result<(), Trip> {
        self.pose(t, q);
        self.factor()?;
        self.solve(v, a)
    }

    fn project(&mut self, t: f64, q: &mut [f64], v: &mut [f64]) -> Result<Correction, Trip> {
        let iterations = self.settle(t, q)?;
        self.finish(q, v, iterations)
    }

    fn multipliers(
        &mut self,
        t: f64,
        q: &[f64],
        v: &[f64],
        lambda: &mut [f64],
    ) -> Result<(), Trip> {
        let aside = self.chosen.take().map(|chosen| self.exchange(chosen));
        let asked = aside.is_some();
        let solved = self.multipliers_of_kept(t, q, v, lambda);
        if let Some(rows) = aside {
            self.chosen = Some(self.exchange(rows));
        }
        match solved {
            Err(Trip::RankLost { .. }) if asked => {
                lambda.fill(f64::NAN);
                Ok(())
            }
            other => other,
        }
    }
}

impl KeptRowMotion<'_> {
    fn multipliers_of_kept(
        &mut self,
        t: f64,
        q: &[f64],
        v: &[f64],
        lambda: &mut [f64],
    ) -> Result<(), Trip> {
        let mut a = std::mem::take(&mut self.delta);
        let solved = self.acceleration(t, q, v, &mut a);
        self.delta = a;
        solved?;
        lambda.fill(0.0);
        for (&i, &l) in self.kept.iter().zip(&self.lambda) {
            lambda[i] = l;
        }
        Ok(())
    }
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |a: f64, x| a.max(x.abs()))
}

/// What a residual may be after a projection.
fn residual_limit(x: &[f64]) -> f64 {
    (RESIDUAL_ROUNDINGS * f64::EPSILON * largest(x)).max(RESIDUAL_FLOOR)
}
