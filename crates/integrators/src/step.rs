//! An accepted step as passed to the observer. The step contains both ends, and the solution
//! between them.

use crate::error::Cause;
use crate::method::{Dense, Ends};
use crate::ode::Ode;
use crate::statistics::Statistics;
use std::error::Error;
use thiserror::Error;

/// Reason why the dense output of a step has no value.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum OutputError<E: Error + 'static> {
    /// The requested time is outside the step; dense output does not extrapolate.
    #[error("t = {t} lies outside the step from {t0} to {t1}")]
    OutsideStep {
        /// Requested time.
        t: f64,
        /// Start of the step.
        t0: f64,
        /// End of the step.
        t1: f64,
    },
    /// `out` does not have the length of the state.
    #[error("the buffer has {found} components, the state has {expected}")]
    Length {
        /// Length of the state, n.
        expected: usize,
        /// Length of `out`.
        found: usize,
    },
    /// An extra evaluation failed.
    #[error("extra evaluation for output: {0}")]
    Evaluation(#[source] Cause<E>),
}

/// An accepted step from (t0, y0) to (t1, y1); y1 is the state after projection by the hook.
///
/// The dense outputs of all methods equal y0 at t0 and y1 at t1. The derivatives of the dense
/// outputs at the ends are f(t0, y0) and f(t1, y1). Therefore the outputs with and without extra
/// evaluations are continuously differentiable over all steps between two break times, with and
/// without projection. (The outputs of [`Radau5`](crate::Radau5) are continuous, and their
/// derivatives are correct up to the error of the output.) Between the ends of a step, the outputs
/// do not satisfy constraints. Therefore project rows before you write them.
pub struct Step<'a, O: Ode> {
    ode: &'a mut O,
    dense: &'a mut dyn Dense<O>,
    ends: Ends<'a>,
    error_norm: f64,
    statistics: &'a mut Statistics,
    is_prepared: bool,
}

impl<'a, O: Ode> Step<'a, O> {
    pub(crate) fn new(
        ode: &'a mut O,
        dense: &'a mut dyn Dense<O>,
        ends: Ends<'a>,
        error_norm: f64,
        statistics: &'a mut Statistics,
    ) -> Self {
        Self {
            ode,
            dense,
            ends,
            error_norm,
            statistics,
            is_prepared: false,
        }
    }

    /// Returns the time at the start.
    #[must_use]
    pub fn t0(&self) -> f64 {
        self.ends.trial.t
    }

    /// Returns the time at the end.
    #[must_use]
    pub fn t1(&self) -> f64 {
        self.ends.trial.t1
    }

    /// Returns the state at the start.
    #[must_use]
    pub fn y0(&self) -> &'a [f64] {
        self.ends.y0
    }

    /// Returns the state at the end, after projection.
    #[must_use]
    pub fn y1(&self) -> &'a [f64] {
        self.ends.y1
    }

    /// Returns the derivative at the start. At a break time it is the limit from within the step.
    #[must_use]
    pub fn f0(&self) -> &'a [f64] {
        self.ends.f0
    }

    /// Returns the derivative of the projected state at the end. At a break time it is the limit
    /// from within the step.
    #[must_use]
    pub fn f1(&self) -> &'a [f64] {
        self.ends.f1
    }

    /// Returns the weighted norm of the estimated local error. The norm is at most 1.
    #[must_use]
    pub fn error_norm(&self) -> f64 {
        self.error_norm
    }

    /// Returns the counts so far, including this step.
    #[must_use]
    pub fn statistics(&self) -> &Statistics {
        self.statistics
    }

    /// Returns the differential equations of this integration. An observer can thus evaluate them.
    pub fn ode(&mut self) -> &mut O {
        self.ode
    }

    /// Writes y(t) to `out` (length n) without evaluating f. The interpolated state is less
    /// accurate than the states at the ends of steps. The documentation of each method states its
    /// order. The interpolated state is suitable for drawings and for locating events
    /// approximately.
    ///
    /// # Errors
    ///
    /// [`OutputError::OutsideStep`], [`OutputError::Length`]: invalid arguments.
    pub fn interpolate(&self, t: f64, out: &mut [f64]) -> Result<(), OutputError<O::Error>> {
        self.check(t, out)?;
        self.write_cheaply(t, out);
        Ok(())
    }

    /// Works like [`Step::interpolate`]. The time t must be within the step.
    pub(crate) fn write_cheaply(&self, t: f64, out: &mut [f64]) {
        match self.place(t) {
            Place::Start => out.copy_from_slice(self.ends.y0),
            Place::End => out.copy_from_slice(self.ends.y1),
            Place::Inside { theta } => self.dense.interpolate(&self.ends, theta, out),
        }
    }

    /// Writes y(t) to `out` (length n), with the same global order as the steps. The first call
    /// within a step makes extra evaluations of f. Further calls in the same step, and calls at the
    /// ends of the step, make no evaluations.
    ///
    /// # Errors
    ///
    /// [`OutputError::OutsideStep`], [`OutputError::Length`]: invalid arguments.
    /// [`OutputError::Evaluation`]: f fails.
    pub fn interpolate_accurately(
        &mut self,
        t: f64,
        out: &mut [f64],
    ) -> Result<(), OutputError<O::Error>> {
        self.check(t, out)?;
        self.write_accurately(t, out)
            .map_err(OutputError::Evaluation)
    }

    /// Works like [`Step::interpolate_accurately`]. The time t must be within the step.
    pub(crate) fn write_accurately(
        &mut self,
        t: f64,
        out: &mut [f64],
    ) -> Result<(), Cause<O::Error>> {
        match self.place(t) {
            Place::Start => out.copy_from_slice(self.ends.y0),
            Place::End => out.copy_from_slice(self.ends.y1),
            Place::Inside { theta } => {
                if !self.is_prepared {
                    let count = &mut self.statistics.output_evaluations;
                    self.dense.prepare(self.ode, &self.ends, count)?;
                    self.is_prepared = true;
                }
                self.dense.interpolate_accurately(&self.ends, theta, out);
            }
        }
        Ok(())
    }

    fn check(&self, t: f64, out: &[f64]) -> Result<(), OutputError<O::Error>> {
        let (t0, t1) = (self.t0(), self.t1());
        if out.len() != self.ends.y0.len() {
            return Err(OutputError::Length {
                expected: self.ends.y0.len(),
                found: out.len(),
            });
        }
        if t0.min(t1) <= t && t <= t0.max(t1) {
            return Ok(());
        }
        Err(OutputError::OutsideStep { t, t0, t1 })
    }

    fn place(&self, t: f64) -> Place {
        if t == self.t0() {
            Place::Start
        } else if t == self.t1() {
            Place::End
        } else {
            Place::Inside {
                theta: (t - self.t0()) / self.ends.trial.h,
            }
        }
    }
}

enum Place {
    Start,
    Inside { theta: f64 },
    End,
}
