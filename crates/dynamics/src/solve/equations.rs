//! The equations of motion on kept rows.
//!
//! The rank is never decided at a stage: there the state violates the constraints by δ, and a
//! singular value that is exactly zero appears as about δ. Positions and velocities have separate
//! kept rows: a holonomic row may be dropped at velocity level because knife edges imply its
//! velocity, but nothing implies its position, and without it the configuration would drift.

use model::System;

use super::evaluation::Evaluation;
use super::misfits::Misfits;
use super::rows::KeptRows;
use super::{Accelerations, State};
use crate::counts::{WorkKind, note};
use crate::error::MotionFault;

/// A mechanism with its kept rows. All storage is allocated here.
pub(crate) struct KeptEquations<'m> {
    pub(crate) at: Evaluation<'m>,
    /// Independent rows of C.
    pub(crate) velocity: KeptRows,
    /// Independent rows of Φq.
    pub(crate) position: KeptRows,
    /// Rows requested by the user, while they are nearly dependent and others are kept.
    pub(crate) requested_rows: Option<KeptRows>,
    /// Misfits of dropped rows, if a tolerance is stated.
    pub(crate) misfits: Option<Box<Misfits>>,
    /// Scratch: an acceleration, n_v.
    a: Vec<f64>,
}

impl<'m> KeptEquations<'m> {
    pub(crate) fn new(at: Evaluation<'m>, velocity: KeptRows, position: KeptRows) -> Self {
        let a = vec![0.0; at.mechanism.mass().len()];
        Self {
            at,
            velocity,
            position,
            requested_rows: None,
            misfits: None,
            a,
        }
    }

    /// The rows of C whose multipliers are zero by choice.
    pub(crate) fn without_multiplier(&self) -> &[usize] {
        let rows = self.requested_rows.as_ref().unwrap_or(&self.velocity);
        &rows.dropped
    }

    /// Evaluates a configuration and factors the rows of C there.
    pub(crate) fn factor_at(&mut self, t: f64, q: &[f64]) -> Result<(), MotionFault> {
        self.at.pose(t, q);
        self.velocity.factor(&self.at)
    }

    /// Accelerations, if the pose is evaluated and the rows are factored.
    pub(crate) fn solve_factored(&mut self, v: &[f64], a: &mut [f64]) -> Result<(), MotionFault> {
        note(WorkKind::Accelerations);
        self.at.gamma_and_force(v);
        self.velocity.take_rhs(|i| self.at.s.gamma[i]);
        let solved = self.velocity.accelerate(&self.at, a);
        solved.map_err(|fault| self.at.named(fault))
    }

    /// Multipliers of all rows for accelerations a from the last solve; those of dropped rows are
    /// zero. NaN if kept rows are dependent at exactly this instant, because then no multipliers
    /// belong to them.
    pub(crate) fn multipliers_for(
        &mut self,
        a: &[f64],
        lambda: &mut [f64],
    ) -> Result<(), MotionFault> {
        self.velocity.find_multipliers(&self.at, a)?;
        if self.velocity.n_left_out() > 0 {
            lambda.fill(f64::NAN);
            return Ok(());
        }
        lambda.fill(0.0);
        for (&i, &l) in self.velocity.kept.iter().zip(&self.velocity.lambda) {
            lambda[i] = l;
        }
        Ok(())
    }

    /// Accepts the misfits of the state last checked, if there are any: of the end of a step or of
    /// a row of output.
    pub(crate) fn accept_misfits(&mut self, is_end_of_step: bool) {
        if let Some(misfits) = &mut self.misfits {
            misfits.accept(&self.at, is_end_of_step);
        }
    }

    /// Whether dropped rows have missed by more than rounding.
    pub(crate) fn have_missed(&self) -> bool {
        self.misfits.as_ref().is_some_and(|m| !m.found().is_empty())
    }

    /// The kept row with the largest part in the dependency of a dropped row at t = 0 and
    /// coordinates q, among those that are not taken.
    pub(crate) fn partner(
        &mut self,
        q: &[f64],
        dropped: usize,
        taken: &[usize],
    ) -> Result<Option<usize>, MotionFault> {
        self.factor_at(0.0, q)?;
        let at = &self.at;
        let mut z = vec![0.0; at.mechanism.layout().rows()];
        self.velocity.dependency(at, dropped, &mut z)?;
        let kept = (0..z.len()).filter(|i| *i != dropped && !taken.contains(i));
        let part = |i: &usize| z[*i].abs() * at.row_size(*i);
        let largest = kept.max_by(|i, k| part(i).total_cmp(&part(k)));
        Ok(largest.filter(|i| part(i) > 0.0))
    }

    /// Exchanges the kept rows and the requested ones, if others are kept.
    pub(crate) fn swap_requested_rows(&mut self) {
        if let Some(requested) = &mut self.requested_rows {
            std::mem::swap(requested, &mut self.velocity);
        }
    }
}

impl Accelerations for KeptEquations<'_> {
    type Fault = MotionFault;

    fn accelerations(&mut self, state: State<'_>, a: &mut [f64]) -> Result<(), MotionFault> {
        self.factor_at(state.t, state.q)?;
        self.solve_factored(state.v, a)
    }

    /// Multipliers on the requested rows.
    fn multipliers(&mut self, state: State<'_>, lambda: &mut [f64]) -> Result<(), MotionFault> {
        self.swap_requested_rows();
        let mut a = std::mem::take(&mut self.a);
        let solved = self
            .accelerations(state, &mut a)
            .and_then(|()| self.multipliers_for(&a, lambda));
        self.a = a;
        self.swap_requested_rows();
        solved
    }
}
