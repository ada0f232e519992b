//! Projection onto the constraints: positions by Newton's method on the rows of Φq, velocities by one linear solve,
//! both with the smallest correction in the mass metric.

use model::System;

use super::{Correction, KeptRowMotion};
use crate::error::Trip;
use crate::events::Event;

/// Corrections of the position per projection; one or two are the rule.
const CORRECTIONS: usize = 6;

/// |Φ| and |C·v − b| of kept rows count as zero below this many roundings of the largest term.
const ROUNDINGS: f64 = 10.0;

/// Residuals allowed after a projection: `max(1e-12, 50·eps·largest |coordinate|)`.
const RESIDUAL_FLOOR: f64 = 1e-12;
const RESIDUAL_ROUNDINGS: f64 = 50.0;

impl KeptRowMotion<'_> {
    /// Projects an accepted step, and keeps other rows if the present ones have become nearly dependent there.
    ///
    /// # Errors
    /// As [`super::Motion::project`]; also if the rank itself changes here, or cannot be decided.
    pub(crate) fn project_step(
        &mut self,
        t: f64,
        q: &mut [f64],
        v: &mut [f64],
    ) -> Result<(Correction, Option<Event>), Trip> {
        let iterations = self.settle(t, q)?;
        let event = self.review()?;
        Ok((self.finish(q, v, iterations)?, event))
    }

    /// Moves q onto the constraints and factors there.
    pub(super) fn settle(&mut self, t: f64, q: &mut [f64]) -> Result<usize, Trip> {
        let iterations = self.project_position(t, q)?;
        self.mechanism.c(&mut self.s);
        self.velocity.factor(self.mechanism, &self.s)?;
        Ok(iterations)
    }

    /// Moves v onto the constraints at a settled position and looks at all residuals.
    pub(super) fn finish(
        &mut self,
        q: &[f64],
        v: &mut [f64],
        iterations: usize,
    ) -> Result<Correction, Trip> {
        self.project_velocity(v)?;
        self.monitor(q, v, iterations)
    }

    fn project_position(&mut self, t: f64, q: &mut [f64]) -> Result<usize, Trip> {
        let Self {
            mechanism,
            s,
            position,
            delta,
            zero,
            ..
        } = self;
        let mut best = f64::INFINITY;
        for iteration in 0..=CORRECTIONS {
            mechanism.pose(t, q, s);
            mechanism.phi(s);
            let mut worst = (0, 0.0_f64);
            for (rhs, &i) in position.rhs.iter_mut().zip(&position.kept) {
                *rhs = -s.phi[i];
                if rhs.abs() > worst.1 || rhs.is_nan() {
                    worst = (i, rhs.abs());
                }
            }
            let tolerance = ROUNDINGS * f64::EPSILON * largest(q).max(1.0);
            // Rounding may leave a little more: a stalled iteration close to it is done too.
            let stalled = worst.1 >= 0.5 * best && worst.1 <= residual_limit(q);
            if worst.1 <= tolerance || stalled {
                return Ok(iteration);
            }
            if iteration == CORRECTIONS || worst.1.is_nan() {
                return Err(Trip::OffConstraints {
                    time: t,
                    row: mechanism.layout().labels[worst.0].clone(),
                    residual: worst.1,
                    tolerance,
                    iterations: iteration,
                });
            }
            best = best.min(worst.1);
            mechanism.c(s);
            position.factor(mechanism, s)?;
            position.solve(mechanism, s, zero, delta)?;
            for (q, d) in q.iter_mut().zip(&*delta) {
                *q += d;
            }
        }
        unreachable!("the last iteration returns")
    }

    /// Needs the factorisation of the projected position.
    fn project_velocity(&mut self, v: &mut [f64]) -> Result<(), Trip> {
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
        // The second pass removes what rounding left of the first.
        for _ in 0..2 {
            for (rhs, &i) in velocity.rhs.iter_mut().zip(&velocity.kept) {
                *rhs = -layout.velocity_residual(s, i, v);
            }
            if largest(&velocity.rhs) <= ROUNDINGS * f64::EPSILON * largest(v).max(1.0) {
                break;
            }
            velocity.solve(mechanism, s, zero, delta)?;
            for (v, d) in v.iter_mut().zip(&*delta) {
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
        for i in 0..layout.rows() {
            let velocity = layout.velocity_residual(&self.s, i, v).abs();
            found.velocity_residual = found.velocity_residual.max(velocity);
            if i < layout.m {
                found.position_residual = found.position_residual.max(self.s.phi[i].abs());
            }
        }
        let limit = residual_limit(q);
        for &i in &self.position.dropped {
            self.check_dropped(i, "position", self.s.phi[i].abs(), limit)?;
        }
        let limit = limit.max(residual_limit(v));
        for &i in &self.velocity.dropped {
            let velocity = layout.velocity_residual(&self.s, i, v).abs();
            self.check_dropped(i, "velocity", velocity, limit)?;
        }
        Ok(found)
    }

    fn check_dropped(
        &self,
        i: usize,
        level: &'static str,
        residual: f64,
        tolerance: f64,
    ) -> Result<(), Trip> {
        if residual <= tolerance {
            return Ok(());
        }
        let row = self.mechanism.layout().labels[i].clone();
        Err(Trip::DroppedRow {
            time: self.s.t,
            row,
            level,
            residual,
            tolerance,
        })
    }
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |a: f64, x| a.max(x.abs()))
}

/// What a residual may be after a projection.
fn residual_limit(x: &[f64]) -> f64 {
    (RESIDUAL_ROUNDINGS * f64::EPSILON * largest(x)).max(RESIDUAL_FLOOR)
}
