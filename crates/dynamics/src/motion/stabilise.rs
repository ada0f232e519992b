//! What is done about drift off the constraints: projection, or nothing. Without projection states
//! stay as the integrator left them and residuals say so; kept rows are still watched, and
//! redundancy is still checked at projected copies.

use model::System;

use super::{Correction, KeptRowMotion, Motion};
use crate::error::MotionFault;
use crate::options::Stabilisation;

impl KeptRowMotion<'_> {
    /// Whether states are moved onto the constraints. On a chart they always are.
    pub(crate) fn projects(&self) -> bool {
        self.chart.is_some() || self.stabilisation == Stabilisation::Projection
    }

    /// Ends a step that passed its error test, which must not come nearer to a singular
    /// configuration than `nearest`.
    ///
    /// # Errors
    /// As [`KeptRowMotion::project_step`].
    pub(crate) fn end_step(
        &mut self,
        t: f64,
        q: &mut [f64],
        v: &mut [f64],
        nearest: f64,
    ) -> Result<Correction, MotionFault> {
        if self.projects() {
            return self.project_step(t, q, v, nearest);
        }
        let found = self.inspect(t, q, v)?;
        if self.velocity.relative_pivot() < nearest {
            return Err(self.no_way_over(t));
        }
        if !self.wants_review() {
            return Ok(found);
        }
        // Ranks are decided on the constraints only.
        let mut polished = q.to_vec();
        self.settle(t, &mut polished)?;
        self.pending = self.review(&polished)?;
        self.inspect(t, q, v)
    }

    /// Ends a row of output: projects it, or says what it misses. Dropped rows are checked either
    /// way.
    ///
    /// # Errors
    /// As [`Motion::project`].
    pub(crate) fn end_row(
        &mut self,
        t: f64,
        q: &mut [f64],
        v: &mut [f64],
    ) -> Result<Correction, MotionFault> {
        if let Some(found) = self.coded_row(t, q, v) {
            return Ok(found);
        }
        if self.projects() {
            self.complete_row(t, q, v)?;
            let iterations = self.settle(t, q)?;
            return match self.better_for_row(q)? {
                None => self.finish(v, iterations),
                Some(mut rows) => {
                    std::mem::swap(&mut self.velocity, &mut rows);
                    let found = self.finish(v, iterations);
                    std::mem::swap(&mut self.velocity, &mut rows);
                    found
                }
            };
        }
        let (mut polished_q, mut polished_v) = (q.to_vec(), v.to_vec());
        self.project(t, &mut polished_q, &mut polished_v)?;
        let mut a = vec![0.0; v.len()];
        self.acceleration(t, &polished_q, &polished_v, &mut a)?;
        self.inspect(t, q, v)
    }

    /// What a projection would change in [q; v] of a state that is left as it is; allocates.
    ///
    /// # Errors
    /// As [`Motion::project`].
    pub(crate) fn missed_correction(
        &mut self,
        t: f64,
        q: &[f64],
        v: &[f64],
    ) -> Result<Vec<f64>, MotionFault> {
        let (mut polished_q, mut polished_v) = (q.to_vec(), v.to_vec());
        self.project(t, &mut polished_q, &mut polished_v)?;
        self.inspect(t, q, v)?;
        let moved = polished_q.iter().zip(q).chain(polished_v.iter().zip(v));
        Ok(moved.map(|(to, from)| to - from).collect())
    }

    /// Factors at a state as it is, and finds its residuals.
    fn inspect(&mut self, t: f64, q: &[f64], v: &[f64]) -> Result<Correction, MotionFault> {
        let Self {
            mechanism,
            s,
            velocity,
            ..
        } = self;
        mechanism.pose(t, q, s);
        mechanism.phi(s);
        mechanism.c(s);
        velocity.factor(mechanism, s)?;
        self.evaluate_b();
        Ok(self.residuals(v))
    }
}
