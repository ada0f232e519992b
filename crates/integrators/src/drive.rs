//! The integration loop of all methods. The loop handles trials, rejections, accepted steps, the
//! intervals between break times, and limits.
//!
//! The `Stepper` of a method contains the formulas of the method. The module `control` contains the
//! step-size control, and the module `sample` contains the output times.

use crate::error::{Cause, Failure, IntegrationError};
use crate::interval::{Interval, Leg};
use crate::method::{End, Ends, Method, Outcome, Start, Stepper, Trial};
use crate::ode::{Delicate, Ode, StepEnd, StepInfo, evaluate, finite};
use crate::options::{InitialStep, Options};
use crate::start::{StartScratch, initial_step};
use crate::statistics::Statistics;
use crate::step::Step;
use std::ops::ControlFlow;

/// A step below this many units in the last place of t counts as collapsed, because the stage times
/// could no longer be distinguished.
const SMALLEST_STEP_IN_EPSILONS: f64 = 16.0;
/// A step is extended to the next break time or to the end of the integration if the distance to it
/// is less than this multiple of the step.
const STRETCH: f64 = 1.01;
/// Distance from an ill-conditioned time at which a step before this time ends. The distance is a
/// fraction of the largest distance that a step of the same size can cross.
const LEFT_TO_PASS: f64 = 0.8;
/// If a step ends before an ill-conditioned time at a distance of at most this multiple of its
/// size, its error may exceed the tolerance by the [`slack`](Delicate::slack) of this time. This
/// range includes a step that leaves nearly its whole size to the next step.
const NEAR: f64 = 2.0;
/// Number of trials between checks of progress.
const STRIDE: u64 = 2000;
/// If a run, at the pace of the last [`STRIDE`] trials, would need this multiple of the permitted
/// steps, the run does not make progress. A transient would have ended long before.
const HOPELESS: f64 = 1e3;
/// Step-size factor after a failed evaluation.
const FACTOR_AFTER_FAILURE: f64 = 0.25;
/// Step-size factor after a rejection by the hook.
const FACTOR_AFTER_HOOK: f64 = 0.5;

/// Integrates y' = f(t, y), y(t0) = `y0` over `interval` and calls `observe` with each accepted
/// step.
///
/// Memory is allocated only before the first step. If t0 = t_end, the function neither evaluates f
/// nor calls `observe`.
///
/// # Errors
///
/// Returns a [`Failure`] with the last good state, its time and the statistics. Steps that
/// `observe` has received stay valid. The `error` of the failure is one of [`DimensionMismatch`],
/// [`NonFiniteInitialState`], [`InvalidTime`], [`InvalidOption`], [`ToleranceLength`] (before the
/// first evaluation), [`StartFailed`], [`StepSizeCollapsed`], [`TooManySteps`].
///
/// [`DimensionMismatch`]: crate::IntegrationError::DimensionMismatch
/// [`NonFiniteInitialState`]: crate::IntegrationError::NonFiniteInitialState
/// [`InvalidTime`]: crate::IntegrationError::InvalidTime
/// [`InvalidOption`]: crate::IntegrationError::InvalidOption
/// [`ToleranceLength`]: crate::IntegrationError::ToleranceLength
/// [`StartFailed`]: crate::IntegrationError::StartFailed
/// [`StepSizeCollapsed`]: crate::IntegrationError::StepSizeCollapsed
/// [`TooManySteps`]: crate::IntegrationError::TooManySteps
///
/// # Examples
///
/// y' = 2t from y(0) = 0 gives y(3) = 9.
///
/// ```
/// use pfaff_integrators::{Dopri5, Function, Interval, Options, integrate};
/// use std::ops::ControlFlow;
///
/// let mut ode = Function::new(1, |t, _y: &[f64], dy: &mut [f64]| dy[0] = 2.0 * t);
/// let end = integrate(&Dopri5, &mut ode, &Interval::new(0.0, 3.0), &[0.0], &Options::default(), |_step| {
///     ControlFlow::Continue(())
/// })?;
/// assert!((end.y[0] - 9.0).abs() < 1e-13);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn integrate<O, M, F>(
    method: &M,
    ode: &mut O,
    interval: &Interval<'_>,
    y0: &[f64],
    options: &Options,
    mut observe: F,
) -> Result<Outcome, Box<Failure<O::Error>>>
where
    O: Ode,
    M: Method<O>,
    F: FnMut(&mut Step<'_, O>) -> ControlFlow<()>,
{
    let stepper = &mut method.stepper(ode);
    let legs = match check(ode, interval, y0, options) {
        Ok(legs) => legs,
        Err(error) => return Err(refuse(error, interval.t0, y0)),
    };
    let mut run = Run::new(interval.t0, y0, options);
    for leg in &legs {
        if let Err(error) = run.start(ode, stepper, leg) {
            if ode.is_stopped() {
                return Ok(run.finish(End::Stopped));
            }
            return Err(run.fail(error));
        }
        while run.t != leg.end {
            if ode.is_stopped() {
                return Ok(run.finish(End::Stopped));
            }
            match ode.delicate_time() {
                Some(delicate) => run.step_over(delicate, stepper.widest_gap(), stepper.order()),
                None => run.noise = Noise::None,
            }
            let trial = match run.next_trial(leg) {
                Ok(trial) => trial,
                Err(error) => return Err(run.fail(error)),
            };
            match run.attempt(ode, stepper, &trial) {
                Ok(()) => {
                    let flow = observe(&mut run.accepted(ode, stepper, trial));
                    run.advance(stepper, &trial);
                    if flow.is_break() {
                        return Ok(run.finish(End::Stopped));
                    }
                }
                Err(cause) => run.reject(stepper, &trial, cause),
            }
        }
    }
    Ok(run.finish(End::Reached))
}

/// Checks all conditions that can be checked before the first evaluation.
pub(crate) fn check<O: Ode>(
    ode: &O,
    interval: &Interval<'_>,
    y0: &[f64],
    options: &Options,
) -> Result<Vec<Leg>, IntegrationError<O::Error>> {
    if y0.len() != ode.dim() {
        return Err(IntegrationError::DimensionMismatch {
            expected: ode.dim(),
            found: y0.len(),
        });
    }
    if let Err(component) = finite(y0) {
        return Err(IntegrationError::NonFiniteInitialState {
            component,
            value: y0[component],
        });
    }
    options.check(y0.len())?;
    interval.legs()
}

/// Returns whether a step crosses an ill-conditioned time, or ends before it at a distance of at
/// most [`NEAR`] times its size.
fn is_near(delicate: &Delicate, trial: &Trial<'_>) -> bool {
    let ahead = |t: f64| (delicate.t - t) / trial.h;
    ahead(trial.t) > 0.0 && ahead(trial.t1) < NEAR
}

/// Returns a failure before the first evaluation.
pub(crate) fn refuse<E: std::error::Error>(
    error: IntegrationError<E>,
    t: f64,
    y0: &[f64],
) -> Box<Failure<E>> {
    Box::new(Failure {
        error,
        t,
        y: y0.to_vec(),
        statistics: Statistics::default(),
    })
}

/// Whether error control has failed near an ill-conditioned time. Smaller steps would not improve
/// the result.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Noise {
    None,
    /// Error control failed in the last trial. The same size is tried once more with the larger
    /// permitted error.
    Found,
    Known,
}

/// States of a trial with their derivatives, and weights of the error of the trial. Index 0 is the
/// start of the step, and index 1 is its end.
struct States {
    y0: Vec<f64>,
    f0: Vec<f64>,
    y1: Vec<f64>,
    f1: Vec<f64>,
    scale: Vec<f64>,
}

/// State of an integration.
struct Run<'a, E: std::error::Error + 'static> {
    options: &'a Options,
    statistics: Statistics,
    t: f64,
    /// Signed size of the next trial.
    h: f64,
    /// Size of the next trial before it was changed for a reason other than the estimated error.
    uncut: Option<f64>,
    noise: Noise,
    states: States,
    /// Error norm of the last trial that had an error estimate.
    error_norm: Option<f64>,
    /// Number of rejections since the last accepted step.
    failures: u32,
    last_rejection: Option<Cause<E>>,
    is_first_leg: bool,
    /// Number of trials and time of the last check of progress.
    looked_at: (u64, f64),
}

impl<'a, E: std::error::Error + 'static> Run<'a, E> {
    fn new(t: f64, y0: &[f64], options: &'a Options) -> Self {
        let zeros = || vec![0.0; y0.len()];
        Self {
            options,
            statistics: Statistics::default(),
            t,
            h: 0.0,
            uncut: None,
            noise: Noise::None,
            states: States {
                y0: y0.to_vec(),
                f0: zeros(),
                y1: zeros(),
                f1: zeros(),
                scale: zeros(),
            },
            error_norm: None,
            failures: 0,
            last_rejection: None,
            is_first_leg: true,
            looked_at: (0, t),
        }
    }

    /// Computes the derivative and the first step size at the start of an interval between two
    /// break times.
    fn start<O: Ode<Error = E>, S: Stepper<O>>(
        &mut self,
        ode: &mut O,
        stepper: &mut S,
        leg: &Leg,
    ) -> Result<(), IntegrationError<E>> {
        let t = leg.evaluation_time(leg.start);
        if !self.is_first_leg {
            self.cross_break(ode, leg.start, t)?;
        }
        evaluate(
            ode,
            t,
            &self.states.y0,
            &mut self.states.f0,
            &mut self.statistics.evaluations,
        )
        .map_err(|cause| IntegrationError::StartFailed {
            t: leg.start,
            cause,
        })?;
        stepper.restart();
        let h_max = self.options.max_step.min((leg.end - leg.start).abs());
        self.h = match self.options.initial_step {
            InitialStep::Given(h) if self.is_first_leg => {
                h.min(h_max).copysign(leg.end - leg.start)
            }
            _ => {
                self.options.tolerance.scale(
                    &self.states.y0,
                    &self.states.y0,
                    &mut self.states.scale,
                );
                let scratch = StartScratch {
                    y: &mut self.states.y1,
                    f: &mut self.states.f1,
                };
                let start = (
                    &self.states.y0[..],
                    &self.states.f0[..],
                    &self.states.scale[..],
                );
                initial_step(
                    ode,
                    leg,
                    stepper.order(),
                    start,
                    h_max,
                    scratch,
                    &mut self.statistics,
                )
            }
        };
        self.is_first_leg = false;
        Ok(())
    }

    /// Calls the problem, which may change the state at a break time.
    fn cross_break<O: Ode<Error = E>>(
        &mut self,
        ode: &mut O,
        t: f64,
        t_rhs: f64,
    ) -> Result<(), IntegrationError<E>> {
        let failed = |cause| IntegrationError::StartFailed { t, cause };
        ode.at_break(t_rhs, &mut self.states.y0)
            .map_err(|e| failed(Cause::Problem(e)))?;
        finite(&self.states.y0).map_err(|component| failed(Cause::NonFinite { component }))
    }

    /// Changes a step that would reach an ill-conditioned time. This step or the next step then
    /// crosses this time, which lies in the widest gap between the nodes of the step. If smaller
    /// steps would not improve the result, the step crosses the time from as far away as the slack
    /// permits.
    fn step_over(&mut self, delicate: Delicate, gap: f64, order: i32) {
        let longest = match self.noise {
            Noise::None => 1.0,
            Noise::Found | Noise::Known => delicate.slack.powf(1.0 / f64::from(order + 1)),
        };
        let longest = longest.min(self.options.max_step / self.h.abs());
        let (distance, reach) = ((delicate.t - self.t) / self.h, gap * longest);
        if distance <= 0.0 || distance >= 1.0 + reach {
            return;
        }
        // Sizes are in units of h. This step crosses the time if it can be long enough. Otherwise
        // it ends at a distance that is slightly shorter than the next step can cross.
        let share = if distance <= reach {
            distance / gap
        } else {
            (distance - LEFT_TO_PASS * reach).min(1.0)
        };
        self.uncut = Some(self.h);
        self.h *= share;
    }

    /// Returns the next trial. A trial that reaches the next break time or the end of the
    /// integration ends exactly at this time.
    fn next_trial<'l>(&mut self, leg: &'l Leg) -> Result<Trial<'l>, IntegrationError<E>> {
        let (t, h) = (self.t, self.h);
        let steps = self.statistics.accepted + self.statistics.rejected();
        if steps >= self.options.max_steps {
            return Err(IntegrationError::TooManySteps { t, steps, h });
        }
        let remaining = leg.end - t;
        let stands_still = self.stands_still(steps, remaining);
        let reaches_end = STRETCH * h.abs() >= remaining.abs();
        let too_small =
            h.abs() < SMALLEST_STEP_IN_EPSILONS * f64::EPSILON * t.abs() && !reaches_end;
        if stands_still || too_small || self.failures > self.options.max_failures || t + h == t {
            let norm = self.error_norm.unwrap_or(f64::NAN);
            return Err(IntegrationError::StepSizeCollapsed {
                t,
                h,
                failures: self.failures,
                last_error_norm: self.error_norm,
                cause: self
                    .last_rejection
                    .take()
                    .unwrap_or(Cause::ErrorTest { norm }),
            });
        }
        let t1 = if reaches_end { leg.end } else { t + h };
        // The size is the difference of the rounded times. Therefore the integrated interval is the
        // reported interval.
        Ok(Trial {
            leg,
            t,
            h: t1 - t,
            t1,
        })
    }

    /// Returns whether the progress of the last trials is too small to reach the next break time or
    /// the end.
    fn stands_still(&mut self, steps: u64, remaining: f64) -> bool {
        let (before, since) = self.looked_at;
        if steps < before + STRIDE {
            return false;
        }
        self.looked_at = (steps, self.t);
        let pace = (self.t - since).abs() / STRIDE as f64;
        remaining.abs() > HOPELESS * self.options.max_steps as f64 * pace
    }

    /// Performs stages, error test and hook. On success, `y1`, `f1` and `error_norm` describe an
    /// accepted step.
    fn attempt<O: Ode<Error = E>, S: Stepper<O>>(
        &mut self,
        ode: &mut O,
        stepper: &mut S,
        trial: &Trial<'_>,
    ) -> Result<(), Cause<E>> {
        let non_finite = |component| Cause::NonFinite { component };
        let statistics = &mut self.statistics;
        let start = Start {
            y0: &self.states.y0,
            f0: &self.states.f0,
            tolerance: &self.options.tolerance,
        };
        stepper.trial(ode, trial, &start, &mut self.states.y1, statistics)?;
        finite(&self.states.y1).map_err(non_finite)?;
        start
            .tolerance
            .scale(&self.states.y0, &self.states.y1, &mut self.states.scale);
        let near = ode.delicate_time().filter(|d| is_near(d, trial));
        let is_over = |d: &Delicate| (trial.t1 - d.t) / trial.h > 0.0;
        let may_exceed = |d: &Delicate| d.slack > 1.0 && (is_over(d) || self.noise == Noise::Known);
        let permitted = near.filter(may_exceed).map_or(1.0, |delicate| {
            let scale = self.states.scale.iter_mut();
            scale.for_each(|weight| *weight = weight.max(delicate.least_scale));
            delicate.slack
        });
        let norm = stepper.error_norm(ode, trial, &start, &self.states.scale, statistics)?;
        self.error_norm = Some(norm);
        if norm.is_nan() || norm > permitted {
            if self.noise == Noise::None && near.is_some_and(|d| d.slack > 1.0) {
                self.noise = Noise::Found;
            }
            return Err(Cause::ErrorTest { norm });
        }
        let info = StepInfo {
            t0: trial.t,
            t: trial.t1,
            t_rhs: trial.stage_time(1.0),
            error_norm: norm,
            scale: &self.states.scale,
        };
        match ode
            .end_of_step(&info, &mut self.states.y1, &mut self.states.f1)
            .map_err(Cause::Problem)?
        {
            StepEnd::Unchanged => {
                stepper.end_derivative(ode, trial, &self.states.y1, &mut self.states.f1, statistics)
            }
            StepEnd::Projected {
                correction,
                evaluations,
            } => {
                statistics.hook_evaluations += evaluations;
                finite(&self.states.y1)
                    .and(finite(&self.states.f1))
                    .map_err(non_finite)?;
                statistics.projections += 1;
                statistics.largest_correction = statistics.largest_correction.max(correction);
                Ok(())
            }
            StepEnd::Reject => Err(Cause::RejectedByHook),
        }
    }

    /// Returns the last accepted step, for the observer.
    fn accepted<'s, O: Ode<Error = E>, S: Stepper<O>>(
        &'s mut self,
        ode: &'s mut O,
        stepper: &'s mut S,
        trial: Trial<'s>,
    ) -> Step<'s, O> {
        self.statistics.accepted += 1;
        let ends = Ends {
            trial,
            y0: &self.states.y0,
            f0: &self.states.f0,
            y1: &self.states.y1,
            f1: &self.states.f1,
        };
        let error_norm = self.error_norm.unwrap_or(0.0);
        Step::new(ode, stepper, ends, error_norm, &mut self.statistics)
    }

    /// Continues from the end of the last accepted step.
    fn advance<O: Ode<Error = E>, S: Stepper<O>>(&mut self, stepper: &mut S, trial: &Trial<'_>) {
        std::mem::swap(&mut self.states.y0, &mut self.states.y1);
        std::mem::swap(&mut self.states.f0, &mut self.states.f1);
        self.t = trial.t1;
        self.failures = 0;
        self.last_rejection = None;
        // A step may have been shortened to end at a break time or before an ill-conditioned time.
        // Such a step does not reduce the size of later steps.
        let is_cut = trial.t1 == trial.leg.end || self.uncut.is_some();
        let wanted = self.uncut.take().unwrap_or(self.h);
        let mut h = stepper.after_acceptance(trial.h, self.error_norm.unwrap_or(0.0));
        if is_cut && h.abs() < wanted.abs() {
            h = wanted;
        }
        self.h = h.clamp(-self.options.max_step, self.options.max_step);
    }

    /// Counts a rejected trial and shortens the step.
    fn reject<O: Ode<Error = E>, S: Stepper<O>>(
        &mut self,
        stepper: &mut S,
        trial: &Trial<'_>,
        cause: Cause<E>,
    ) {
        self.failures += 1;
        let uncut = self.uncut.take();
        let statistics = &mut self.statistics;
        self.h = match cause {
            Cause::ErrorTest { norm } if !norm.is_nan() => {
                statistics.rejected_by_error += 1;
                let shorter = stepper.after_rejection(trial.h, norm);
                match self.noise {
                    Noise::Found => {
                        self.noise = Noise::Known;
                        uncut.unwrap_or(trial.h)
                    }
                    Noise::None | Noise::Known => shorter,
                }
            }
            Cause::RejectedByHook => {
                statistics.rejected_by_hook += 1;
                stepper.after_failure(trial.h, FACTOR_AFTER_HOOK)
            }
            _ => {
                statistics.rejected_by_failure += 1;
                stepper.after_failure(trial.h, FACTOR_AFTER_FAILURE)
            }
        };
        self.last_rejection = Some(cause);
    }

    fn finish(self, end: End) -> Outcome {
        Outcome {
            t: self.t,
            y: self.states.y0,
            end,
            next_step: (self.statistics.accepted > 0).then_some(self.h.abs()),
            statistics: self.statistics,
        }
    }

    fn fail(self, error: IntegrationError<E>) -> Box<Failure<E>> {
        Box::new(Failure {
            error,
            t: self.t,
            y: self.states.y0,
            statistics: self.statistics,
        })
    }
}
