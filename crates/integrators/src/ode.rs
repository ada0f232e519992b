//! The problem y' = f(t, y), with a hook at the end of each step.
//!
//! Tolerances and limits are in `options`, the interval and its break times in `interval`.

use crate::error::Cause;
use std::convert::Infallible;
use std::error::Error;

/// An ordinary differential equation `y' = f(t, y)`, y ∈ ℝⁿ.
pub trait Ode {
    /// Error of f or of the hook. A trial step with an error is rejected and repeated with a
    /// smaller step size; the error is returned to the caller only if this does not help.
    type Error: Error + 'static;

    /// Number n of components of y.
    fn dim(&self) -> usize;

    /// Writes f(t, y) to `dy`; `y` and `dy` have length n.
    ///
    /// # Errors
    ///
    /// Errors of the problem. Non-finite values need no error: they are detected and treated in the
    /// same way.
    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), Self::Error>;

    /// Called after a trial step has passed the error test, before it is accepted. May move `y`
    /// onto a manifold.
    ///
    /// | argument | length | meaning |
    /// | --- | --- | --- |
    /// | `step` | – | beginning and end of the step, its estimated error and the error weights |
    /// | `y` | n | on entry the result of the step; may be changed if [`StepEnd::Projected`] is returned |
    /// | `dy` | n | on entry unspecified; must hold f([`StepInfo::t_rhs`], `y`) if `Projected` is returned |
    ///
    /// # Errors
    ///
    /// Errors of the problem; the trial step is then rejected.
    fn end_of_step(
        &mut self,
        step: &StepInfo<'_>,
        y: &mut [f64],
        dy: &mut [f64],
    ) -> Result<StepEnd, Self::Error> {
        let _ = (step, y, dy);
        Ok(StepEnd::Unchanged)
    }

    /// A later time near which f should not be evaluated, if one is known: a removable singularity,
    /// near which values are mostly rounding. Steps are then chosen such that it lies between two
    /// stages, as far from both as the method allows.
    fn delicate_time(&self) -> Option<Delicate> {
        None
    }

    /// Whether the caller wants the integration to end: asked before each trial step. It then ends
    /// at the last accepted step, with [`End::Stopped`](crate::End::Stopped); an error of f is no
    /// failure then, so that f need not finish what nobody waits for.
    fn is_stopped(&self) -> bool {
        false
    }

    /// Called at each break time inside the interval, before the first evaluation after it, with
    /// the time just after it. May change `y` (length n), so that the solution jumps.
    ///
    /// # Errors
    ///
    /// Errors of the problem; the integration then ends at the break time.
    fn at_break(&mut self, t: f64, y: &mut [f64]) -> Result<(), Self::Error> {
        let _ = (t, y);
        Ok(())
    }
}

/// A time near which f is mostly rounding.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Delicate {
    /// The time.
    pub t: f64,
    /// Factor ≥ 1 by which the error of a step over it may exceed the tolerance: smaller steps
    /// would come closer to it and be less accurate. For the same reason, once error control has
    /// failed within one step before it, steps up to it may exceed the tolerance as well.
    pub slack: f64,
    /// Least weight of a component in the norm of a step that may exceed the tolerance: rounding
    /// does not become less where a component is near zero.
    pub least_scale: f64,
}

/// Information for [`Ode::end_of_step`] about the step.
#[derive(Debug, Clone, Copy)]
pub struct StepInfo<'a> {
    /// Time at the start of the step.
    pub t0: f64,
    /// Time at the end of the step.
    pub t: f64,
    /// Time at which to evaluate f at the end of the step: `t`, except at a break time, at which it
    /// is the neighbouring floating-point number within the step, so that f has its limit from this
    /// side.
    pub t_rhs: f64,
    /// Estimated local error in the weighted norm; at most 1, or the slack of a delicate time.
    pub error_norm: f64,
    /// Weights of the norm, `atol + rtol·max(|y0|, |y1|)` per component, length n.
    pub scale: &'a [f64],
}

impl StepInfo<'_> {
    /// Weighted root mean square `√(1/n · Σ (d_i / scale_i)²)`: the norm in which the local error
    /// must stay below 1. A projection whose correction is of the order 1 in this norm is as large
    /// as the permitted error.
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
    /// `y` was changed and `dy` holds f at the new `y`.
    Projected {
        /// Size of the change in the norm of [`StepInfo::norm`]; the largest one is kept in the
        /// statistics.
        correction: f64,
        /// Evaluations of f spent, usually 1; added to `Statistics::hook_evaluations`.
        evaluations: u64,
    },
    /// The step is not reliable, for instance because the correction is large relative to the
    /// permitted error; it is repeated with half the size.
    Reject,
}

/// An [`Ode`] without errors and without hook, made from a closure `f(t, y, dy)`.
#[derive(Debug, Clone)]
pub struct Function<F> {
    dim: usize,
    f: F,
}

impl<F: FnMut(f64, &[f64], &mut [f64])> Function<F> {
    /// `dim` components; `f` writes f(t, y) to its third argument.
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

/// Evaluates f, counts, and turns values that are not finite into a [`Cause`].
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

/// `Err` with the first component that is not finite.
#[inline]
pub(crate) fn finite(v: &[f64]) -> Result<(), usize> {
    v.iter().position(|x| !x.is_finite()).map_or(Ok(()), Err)
}
