//! The problem y' = f(t, y), with a hook at the end of each step.
//!
//! The module `options` contains tolerances and limits. The module `interval` contains the interval
//! and its break times.

use crate::error::Cause;
use std::convert::Infallible;
use std::error::Error;

/// An ordinary differential equation `y' = f(t, y)`, y ∈ ℝⁿ.
pub trait Ode {
    /// Error of f or of the hook. A trial step with an error is rejected and repeated with a
    /// smaller step size. The caller receives the error only if smaller steps also fail.
    type Error: Error + 'static;

    /// Returns the number n of components of y.
    fn dim(&self) -> usize;

    /// Writes f(t, y) to `dy`; `y` and `dy` have length n.
    ///
    /// # Errors
    ///
    /// Returns errors of the problem. Non-finite values need no error: they are detected and
    /// treated in the same way.
    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), Self::Error>;

    /// The hook is called after a trial step has passed the error test, before it is accepted. The
    /// hook may move `y` onto a manifold.
    ///
    /// | argument | length | meaning |
    /// | --- | --- | --- |
    /// | `step` | – | beginning and end of the step, its estimated error and the error weights |
    /// | `y` | n | on entry the result of the step; may be changed if [`StepEnd::Projected`] is returned |
    /// | `dy` | n | on entry unspecified; must contain f([`StepInfo::t_rhs`], `y`) if `Projected` is returned |
    ///
    /// # Errors
    ///
    /// Returns errors of the problem. The trial step is then rejected.
    fn end_of_step(
        &mut self,
        step: &StepInfo<'_>,
        y: &mut [f64],
        dy: &mut [f64],
    ) -> Result<StepEnd, Self::Error> {
        let _ = (step, y, dy);
        Ok(StepEnd::Unchanged)
    }

    /// Returns a later time near which f should not be evaluated, if there is such a time. An
    /// example is a removable singularity, near which the values are mostly rounding errors. The
    /// steps are chosen such that this time is between two stages, as far from both stages as the
    /// method permits.
    fn delicate_time(&self) -> Option<Delicate> {
        None
    }

    /// Returns whether the caller requests the end of the integration. The function is called
    /// before each trial step. The integration then ends at the last accepted step, with
    /// [`End::Stopped`](crate::End::Stopped). An error of f then does not count as a failure.
    /// Therefore f need not complete an evaluation that is no longer required.
    fn is_stopped(&self) -> bool {
        false
    }

    /// Changes the state at a break time. The function is called at each break time inside the
    /// interval, before f is evaluated after this time. `t` is the time just after the break time.
    /// The function may change `y` (length n), so that the solution jumps.
    ///
    /// # Errors
    ///
    /// Returns errors of the problem. The integration then ends at the break time.
    fn at_break(&mut self, t: f64, y: &mut [f64]) -> Result<(), Self::Error> {
        let _ = (t, y);
        Ok(())
    }
}

/// A time near which the values of f are mostly rounding errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Delicate {
    /// The time.
    pub t: f64,
    /// Factor ≥ 1 by which the error of a step over the time may exceed the tolerance. The reason
    /// is that smaller steps would come closer to the time and be less accurate. If error control
    /// has failed within one step before the time, steps up to the time may exceed the tolerance as
    /// well, for the same reason.
    pub slack: f64,
    /// Smallest weight of a component in the norm of a step that may exceed the tolerance. The
    /// weight is needed because the rounding error of a component does not decrease if the
    /// component is near zero.
    pub least_scale: f64,
}

/// Information for [`Ode::end_of_step`] about the step.
#[derive(Debug, Clone, Copy)]
pub struct StepInfo<'a> {
    /// Time at the start of the step.
    pub t0: f64,
    /// Time at the end of the step.
    pub t: f64,
    /// Time at which f must be evaluated at the end of the step. The time is `t`, except at a break
    /// time. At a break time it is the neighbouring floating-point number within the step.
    /// Therefore f has its one-sided limit.
    pub t_rhs: f64,
    /// Estimated local error in the weighted norm. The error is at most 1, or at most the slack of
    /// an ill-conditioned time.
    pub error_norm: f64,
    /// Weights of the norm, `atol + rtol·max(|y0|, |y1|)` per component, length n.
    pub scale: &'a [f64],
}

impl StepInfo<'_> {
    /// Returns the weighted root mean square `√(1/n · Σ (d_i / scale_i)²)`. The result is the norm
    /// in which the local error must stay below 1. A projection whose correction is of the order 1
    /// in this norm is as large as the permitted error.
    #[must_use]
    pub fn norm(&self, d: &[f64]) -> f64 {
        crate::control::weighted_rms(d, self.scale)
    }
}

/// Result of [`Ode::end_of_step`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StepEnd {
    /// `y` was not changed.
    Unchanged,
    /// `y` was changed and `dy` contains f at the new `y`.
    Projected {
        /// Size of the change in the norm of [`StepInfo::norm`]. The statistics contain the largest
        /// change.
        correction: f64,
        /// Number of evaluations of f in the hook, usually 1. This number is added to
        /// `Statistics::hook_evaluations`.
        evaluations: u64,
    },
    /// The step is not reliable, for example because the correction is large relative to the
    /// permitted error. The step is repeated with half the size.
    Reject,
}

/// An [`Ode`] without errors and without hook, made from a closure `f(t, y, dy)`.
#[derive(Debug, Clone)]
pub struct Function<F> {
    dim: usize,
    f: F,
}

impl<F: FnMut(f64, &[f64], &mut [f64])> Function<F> {
    /// Creates a problem with `dim` components; `f` writes f(t, y) to its third argument.
    pub fn new(dim: usize, f: F) -> Self {
        Self { dim, f }
    }
}

impl<F: FnMut(f64, &[f64], &mut [f64])> Ode for Function<F> {
    type Error = Infallible;

    fn dim(&self) -> usize {
        self.dim
    }

    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), Infallible> {
        (self.f)(t, y, dy);
        Ok(())
    }
}

/// Evaluates f, counts the evaluation, and converts values that are not finite into a [`Cause`].
#[inline]
pub(crate) fn evaluate<O: Ode>(
    ode: &mut O,
    t: f64,
    y: &[f64],
    dy: &mut [f64],
    count: &mut u64,
) -> Result<(), Cause<O::Error>> {
    *count += 1;
    ode.rhs(t, y, dy).map_err(Cause::Problem)?;
    finite(dy).map_err(|component| Cause::NonFinite { component })
}

/// Returns `Err` with the first component that is not finite.
#[inline]
pub(crate) fn finite(v: &[f64]) -> Result<(), usize> {
    v.iter().position(|x| !x.is_finite()).map_or(Ok(()), Err)
}
