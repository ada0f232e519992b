//! The equations of motion with independent rows.
//!
//! The rank is never decided at a stage. A stage violates the constraints by some δ, so a singular
//! value that should be zero is about δ. Positions and velocities have separate independent rows. A
//! holonomic row may be redundant at velocity level because knife edges imply its velocity.
//! However, no row implies its position, and without this row the configuration would drift.

use model::System;

use super::evaluation::Evaluation;
use super::misfits::Misfits;
use super::rows::KeptRows;
use super::{Accelerations, State};
use crate::counts::{WorkKind, note};
use crate::error::MotionFault;

/// A mechanism and its independent rows. All memory is allocated when this value is created.
pub(crate) struct KeptEquations<'m> {
    pub(crate) at: Evaluation<'m>,
    /// Independent rows of C.
    pub(crate) velocity: KeptRows,
    /// Independent rows of Φq.
    pub(crate) position: KeptRows,
    /// Rows requested by the user. The rows are stored while they are ill-conditioned and other
    /// rows are used.
    pub(crate) requested_rows: Option<KeptRows>,
    /// Constraint violations of redundant rows, if a tolerance is stated.
    pub(crate) misfits: Option<Box<Misfits>>,
    /// Work memory for an acceleration, n_v values.
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

    /// Returns the rows of C whose multipliers are zero by choice.
    pub(crate) fn without_multiplier(&self) -> &[usize] {
        let rows = self.requested_rows.as_ref().unwrap_or(&self.velocity);
        &rows.dropped
    }

    /// Evaluates a configuration and factors the rows of C at this configuration.
    pub(crate) fn factor_at(&mut self, t: f64, q: &[f64]) -> Result<(), MotionFault> {
        self.at.pose(t, q);
        self.velocity.factor(&self.at)
    }

    /// Computes accelerations. The pose must be evaluated, and the rows must be factored.
    pub(crate) fn solve_factored(&mut self, v: &[f64], a: &mut [f64]) -> Result<(), MotionFault> {
        note(WorkKind::Accelerations);
        self.at.gamma_and_force(v);
        self.velocity.take_rhs(|i| self.at.s.gamma[i]);
        let solved = self.velocity.accelerate(&self.at, a);
        solved.map_err(|fault| self.at.named(fault))
    }

    /// Computes the multipliers of all rows for accelerations a from the last solution. The
    /// multipliers of redundant rows are zero. The multipliers are NaN if independent rows are
    /// dependent at exactly this instant, because the multipliers are then not defined.
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

    /// Accepts the constraint violations of the state last checked, if there are any. The
    /// violations are accepted at the end of a step or at an output row.
    pub(crate) fn accept_misfits(&mut self, is_end_of_step: bool) {
        if let Some(misfits) = &mut self.misfits {
            misfits.accept(&self.at, is_end_of_step);
        }
    }

    /// Returns whether violations of redundant rows were larger than rounding errors.
    pub(crate) fn have_missed(&self) -> bool {
        self.misfits.as_ref().is_some_and(|m| !m.found().is_empty())
    }

    /// Returns the independent row with the largest coefficient in the dependency of a redundant
    /// row at the start time and coordinates q. Only rows that are not yet used are considered.
    pub(crate) fn partner(
        &mut self,
        q: &[f64],
        dropped: usize,
        taken: &[usize],
    ) -> Result<Option<usize>, MotionFault> {
        self.factor_at(self.at.mechanism.layout().start_time, q)?;
        let at = &self.at;
        let mut z = vec![0.0; at.mechanism.layout().rows()];
        self.velocity.dependency(at, dropped, &mut z)?;
        let kept = (0..z.len()).filter(|i| *i != dropped && !taken.contains(i));
        let part = |i: &usize| z[*i].abs() * at.row_size(*i);
        let largest = kept.max_by(|i, k| part(i).total_cmp(&part(k)));
        Ok(largest.filter(|i| part(i) > 0.0))
    }

    /// Exchanges the independent rows and the requested rows if they differ.
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

    /// Computes multipliers on the requested rows.
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
