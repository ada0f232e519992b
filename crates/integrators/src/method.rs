//! The definition of a method, and its interface to the shared loop.

use crate::control::StepControl;
use crate::error::Cause;
use crate::interval::Leg;
use crate::ode::Ode;
use crate::options::Tolerance;
use crate::statistics::Statistics;

/// A method that can integrate the problem `O`, such as [`Dopri5`](crate::Dopri5). The trait bounds
/// of a method state its requirements on the problem. For example, explicit methods work for every
/// [`Ode`].
///
/// The trait is sealed, because the loop of [`integrate`](crate::integrate) and the methods depend
/// on each other.
pub trait Method<O: Ode> {
    /// Stages and memory of the method.
    #[doc(hidden)]
    type Stepper: Stepper<O>;

    /// Allocates storage for one integration of `ode`.
    #[doc(hidden)]
    fn stepper(&self, ode: &O) -> Self::Stepper;
}

/// Reason for the end of an integration without failure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum End {
    /// The integration reached `t_end` exactly.
    Reached,
    /// The observer requested a stop.
    Stopped,
}

/// Result of an integration without failure.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Outcome {
    /// Time reached: `t_end`, or the end of the step after which the observer stopped.
    pub t: f64,
    /// State at this time.
    pub y: Vec<f64>,
    /// Whether `t_end` was reached.
    pub end: End,
    /// Size > 0 of the next step, before the step is shortened because of an end or a break time.
    /// Use this value for [`InitialStep::Given`](crate::InitialStep::Given) of an integration that
    /// continues from this state. `None` if no step was made.
    pub next_step: Option<f64>,
    /// Cost of the integration.
    pub statistics: Statistics,
}

impl Outcome {
    /// Returns the outcome if no step was made.
    pub(crate) fn unmoved(t: f64, y0: &[f64], end: End) -> Self {
        Self {
            t,
            y: y0.to_vec(),
            end,
            next_step: None,
            statistics: Statistics::default(),
        }
    }
}

/// A trial step of size h from t to t1 = t + h, between two neighbouring break times.
#[derive(Debug, Clone, Copy)]
pub struct Trial<'a> {
    pub(crate) leg: &'a Leg,
    pub(crate) t: f64,
    pub(crate) h: f64,
    pub(crate) t1: f64,
}

impl Trial<'_> {
    /// Returns the time of the stage with node `c`. At a break time, the stage time is the
    /// neighbouring floating-point number within the interval of the step.
    #[inline]
    pub(crate) fn stage_time(&self, c: f64) -> f64 {
        let t = if c == 1.0 {
            self.t1
        } else {
            self.t + c * self.h
        };
        self.leg.evaluation_time(t)
    }
}

/// Both ends of an accepted step: the states (after projection) and the derivatives at these
/// states.
#[derive(Debug, Clone, Copy)]
pub struct Ends<'a> {
    pub(crate) trial: Trial<'a>,
    pub(crate) y0: &'a [f64],
    pub(crate) f0: &'a [f64],
    pub(crate) y1: &'a [f64],
    pub(crate) f1: &'a [f64],
}

/// State and derivative at the beginning of a step.
#[derive(Debug, Clone, Copy)]
pub struct Start<'a> {
    pub(crate) y0: &'a [f64],
    /// Derivative f(t, y0). At a break time it is the limit from within the step.
    pub(crate) f0: &'a [f64],
    pub(crate) tolerance: &'a Tolerance,
}

/// Largest relative position that an ill-conditioned time may have in the step that crosses it. The
/// step therefore ends farther from the time than it began. A distance that was sufficient at the
/// beginning is also sufficient at the end.
const AHEAD: f64 = 0.45;

/// Returns a relative position in the widest gap between nodes, where 0 and 1 also count as nodes.
/// The result is the middle of the gap or `AHEAD`, whichever is smaller, but never less than the
/// lower end of the gap. If the result is at most `AHEAD`, the step ends farther from the
/// ill-conditioned time than it began.
pub(crate) fn widest_gap(nodes: &[f64]) -> f64 {
    let all = || nodes.iter().copied().chain([0.0, 1.0]);
    let gap = |from: f64| (from, all().filter(|c| *c > from).fold(1.0, f64::min));
    let (from, to) = all().map(gap).fold((0.0, 0.0), |best, g| {
        if g.1 - g.0 > best.1 - best.0 { g } else { best }
    });
    (0.5 * (from + to)).min(AHEAD.max(from))
}

/// The interface of a method to the shared loop. The method provides a trial step, the error of the
/// step, the derivative at the end of the step, and the next step size.
pub trait Stepper<O: Ode>: Dense<O> {
    /// Returns the order of the propagated solution.
    fn order(&self) -> i32;

    /// Returns a relative position in the widest gap between nodes, at which f is not evaluated.
    fn widest_gap(&self) -> f64 {
        AHEAD
    }

    /// Returns the controller of the step size.
    fn control(&mut self) -> &mut dyn StepControl;

    /// Computes the stages and the new state `y1`.
    fn trial(
        &mut self,
        ode: &mut O,
        trial: &Trial<'_>,
        start: &Start<'_>,
        y1: &mut [f64],
        statistics: &mut Statistics,
    ) -> Result<(), Cause<O::Error>>;

    /// Returns the weighted norm of the estimated error of the last trial.
    fn error_norm(
        &mut self,
        ode: &mut O,
        trial: &Trial<'_>,
        start: &Start<'_>,
        scale: &[f64],
        statistics: &mut Statistics,
    ) -> Result<f64, Cause<O::Error>>;

    /// Writes the derivative at the end of the last trial to `f1`, for a state that the hook has
    /// not changed.
    fn end_derivative(
        &mut self,
        ode: &mut O,
        trial: &Trial<'_>,
        y1: &[f64],
        f1: &mut [f64],
        statistics: &mut Statistics,
    ) -> Result<(), Cause<O::Error>>;

    /// Resets the memory of earlier steps, at the start of an interval between two break times.
    fn restart(&mut self) {
        self.control().reset();
    }

    /// Returns the size of the next trial after an accepted step of size h.
    fn after_acceptance(&mut self, h: f64, error_norm: f64) -> f64 {
        self.control().accept(h, error_norm)
    }

    /// Returns the size of the next trial after a trial of size h whose error was too large.
    fn after_rejection(&mut self, h: f64, error_norm: f64) -> f64 {
        self.control().reject(h, error_norm)
    }

    /// Returns the size of the next trial after a trial of size h that gave no error estimate or
    /// was rejected. `factor` is the step-size factor that the integration loop proposes.
    fn after_failure(&mut self, h: f64, factor: f64) -> f64 {
        self.control().shorten(h, factor)
    }
}

/// The interface of a method for dense output. The trait is object-safe. Therefore `Step` does not
/// depend on the method.
pub trait Dense<O: Ode> {
    /// Writes the dense output without further evaluations.
    fn interpolate(&self, ends: &Ends<'_>, theta: f64, out: &mut [f64]);

    /// Performs extra evaluations for [`Dense::interpolate_accurately`], once in each accepted
    /// step.
    fn prepare(
        &mut self,
        ode: &mut O,
        ends: &Ends<'_>,
        evaluations: &mut u64,
    ) -> Result<(), Cause<O::Error>>;

    /// Writes a dense output as accurate as the step itself; it requires [`Dense::prepare`].
    fn interpolate_accurately(&self, ends: &Ends<'_>, theta: f64, out: &mut [f64]);
}
