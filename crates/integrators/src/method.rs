//! What a method is, and what it has to provide for the shared loop.

use crate::control::StepControl;
use crate::error::Cause;
use crate::interval::Leg;
use crate::ode::Ode;
use crate::options::Tolerance;
use crate::statistics::Statistics;

/// A method that can integrate the problem `O`: [`Dopri5`](crate::Dopri5) and its like. A method
/// asks of the problem what it needs: explicit methods are methods of every [`Ode`].
///
/// Sealed: the loop behind [`integrate`](crate::integrate) and the methods are written for each
/// other.
pub trait Method<O: Ode> {
    /// Stages and memory of the method.
    #[doc(hidden)]
    type Stepper: Stepper<O>;

    /// Room for one integration of `ode`.
    #[doc(hidden)]
    fn stepper(&self, ode: &O) -> Self::Stepper;
}

/// How an integration ended without failure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// `t_end` was reached, exactly.
    Reached,
    /// The observer asked to stop.
    Stopped,
}

/// Result of an integration without failure.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Time reached: `t_end`, or the end of the step after which the observer stopped.
    pub t: f64,
    /// State there.
    pub y: Vec<f64>,
    /// Whether `t_end` was reached.
    pub end: End,
    /// Size > 0 of the step that would have been tried next, cut by no end and no break time: the
    /// [`InitialStep::Given`](crate::InitialStep::Given) of an integration that goes on from here.
    /// `None` if there was no step.
    pub next_step: Option<f64>,
    /// Cost.
    pub statistics: Statistics,
}

impl Outcome {
    /// Where no step was made.
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

/// One trial: from t over h to t1 = t + h, inside a leg.
#[derive(Debug, Clone, Copy)]
pub struct Trial<'a> {
    pub(crate) leg: &'a Leg,
    pub(crate) t: f64,
    pub(crate) h: f64,
    pub(crate) t1: f64,
}

impl Trial<'_> {
    /// Time of the stage with node `c`; at break times the neighbouring number inside the leg.
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

/// Both ends of an accepted step: states (after projection) and derivatives there.
#[derive(Debug, Clone, Copy)]
pub struct Ends<'a> {
    pub(crate) trial: Trial<'a>,
    pub(crate) y0: &'a [f64],
    pub(crate) f0: &'a [f64],
    pub(crate) y1: &'a [f64],
    pub(crate) f1: &'a [f64],
}

/// What a step begins with.
#[derive(Debug, Clone, Copy)]
pub struct Start<'a> {
    pub(crate) y0: &'a [f64],
    /// f(t, y0), at a break time from this side.
    pub(crate) f0: &'a [f64],
    pub(crate) tolerance: &'a Tolerance,
}

/// A delicate time lies at most so far into the step that passes it: then it ends farther behind
/// the time than it began before it, so that a place that was far enough to begin is not too near
/// to end.
const AHEAD: f64 = 0.45;

/// A place in the widest gap between nodes, 0 and 1 included: its middle, if a step that passes it
/// there ends farther away than it began.
pub(crate) fn widest_gap(nodes: &[f64]) -> f64 {
    let all = || nodes.iter().copied().chain([0.0, 1.0]);
    let gap = |from: f64| (from, all().filter(|c| *c > from).fold(1.0, f64::min));
    let (from, to) = all().map(gap).fold((0.0, 0.0), |best, g| {
        if g.1 - g.0 > best.1 - best.0 { g } else { best }
    });
    (0.5 * (from + to)).min(AHEAD.max(from))
}

/// What the shared loop needs from a method: a trial step, its error, the derivative at its end,
/// the next step size.
pub trait Stepper<O: Ode>: Dense<O> {
    /// Order of the solution that is carried on.
    fn order(&self) -> i32;

    /// A place in the widest gap between nodes: where in a step f is not looked at.
    fn widest_gap(&self) -> f64 {
        AHEAD
    }

    /// The controller of the step size.
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

    /// Weighted norm of the estimated error of the last trial.
    fn error_norm(
        &mut self,
        ode: &mut O,
        trial: &Trial<'_>,
        start: &Start<'_>,
        scale: &[f64],
        statistics: &mut Statistics,
    ) -> Result<f64, Cause<O::Error>>;

    /// Writes the derivative at the end of the last trial to `f1`, for a state that the hook has
    /// left unchanged.
    fn end_derivative(
        &mut self,
        ode: &mut O,
        trial: &Trial<'_>,
        y1: &[f64],
        f1: &mut [f64],
        statistics: &mut Statistics,
    ) -> Result<(), Cause<O::Error>>;

    /// Forgets the steps before, at the start of a leg.
    fn restart(&mut self) {
        self.control().reset();
    }

    /// Size of the next trial after an accepted step of size h.
    fn after_acceptance(&mut self, h: f64, error_norm: f64) -> f64 {
        self.control().accept(h, error_norm)
    }

    /// Size of the next trial after one of size h whose error was too large.
    fn after_rejection(&mut self, h: f64, error_norm: f64) -> f64 {
        self.control().reject(h, error_norm)
    }

    /// Size of the next trial after one of size h that gave no error estimate or was not wanted;
    /// `factor` is what the loop proposes.
    fn after_failure(&mut self, h: f64, factor: f64) -> f64 {
        self.control().shorten(h, factor)
    }
}

/// What dense output needs from a method; object-safe, so that [`Step`] need not name the method.
pub trait Dense<O: Ode> {
    /// Without further evaluations.
    fn interpolate(&self, ends: &Ends<'_>, theta: f64, out: &mut [f64]);

    /// Extra evaluations for [`Dense::interpolate_accurately`], once in an accepted step.
    fn prepare(
        &mut self,
        ode: &mut O,
        ends: &Ends<'_>,
        evaluations: &mut u64,
    ) -> Result<(), Cause<O::Error>>;

    /// As accurate as the step itself; needs [`Dense::prepare`].
    fn interpolate_accurately(&self, ends: &Ends<'_>, theta: f64, out: &mut [f64]);
}
