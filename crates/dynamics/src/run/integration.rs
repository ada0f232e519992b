//! The integration of one component: the method of the component, and another method over singular
//! configurations.
//!
//! Near a singular configuration, accelerations are quotients of two small values. Therefore the
//! step over the configuration must start and end as far away as possible. The method `dop853`
//! makes the longest steps over the configuration. Implicit methods cannot step over the
//! configuration at all, because their coordinates become dependent. Therefore every other method
//! stops before a predicted singular configuration. The method `dop853` steps over the
//! configuration, and the method of the run continues after it.

use std::ops::ControlFlow;

use integrators::{
    Dop853, Dopri5, End, InitialStep, Interval, Ode, Options, Outcome, Radau5, Rows, Statistics,
    Tsit5, integrate,
};

use super::caller::{ShowRow, Watch, named};
use super::contacts::{self, Opening};
use super::equations::{Leader, RunEquations};
use super::passages;
use crate::error::{MotionError, MotionFault};
use crate::options::Method;

/// A run during its integration.
pub(super) struct Run<'r, 'm> {
    pub(super) equations: &'r mut RunEquations<'m>,
    /// Output rows that are not yet passed to the caller.
    rows: Rows,
    row: &'r mut ShowRow<'r>,
    watch: &'r Watch<'r>,
    /// Reason why the run was stopped between two steps.
    pub(super) stopped: Option<MotionError>,
    /// Time at which the run ended within its last step (s).
    pub(super) ended: Option<f64>,
}

pub(super) type IntegrationResult = Result<Outcome, Box<integrators::Failure<MotionFault>>>;

impl<'r, 'm> Run<'r, 'm> {
    /// Creates a run that has not started.
    pub(super) fn new(
        equations: &'r mut RunEquations<'m>,
        rows: Rows,
        row: &'r mut ShowRow<'r>,
        watch: &'r Watch<'r>,
    ) -> Self {
        Self {
            equations,
            rows,
            row,
            watch,
            stopped: None,
            ended: None,
        }
    }

    /// Integrates from `y0` over the interval and passes its output rows to the caller.
    pub(super) fn go(
        &mut self,
        method: Method,
        interval: &Interval<'_>,
        y0: &[f64],
        settings: &Options,
    ) -> IntegrationResult {
        let opening = contacts::opening_at_start(self.equations, (interval.t0, y0));
        let has_ended = self.show_start(y0).is_break();
        if let Ok(Some(fault)) | Err(fault) = opening {
            self.stopped.get_or_insert(fault.into());
        }
        if has_ended || self.stopped.is_some() {
            return Ok(Outcome {
                t: interval.t0,
                y: y0.to_vec(),
                end: End::Stopped,
                next_step: None,
                statistics: Statistics::default(),
            });
        }
        let (mut interval, most) = (*interval, settings.max_steps);
        let mut settings = settings.clone();
        let (mut y, mut spent) = (y0.to_vec(), Statistics::default());
        let alone = matches!(method, Method::Auto | Method::Dop853);
        let mut leader = if alone {
            Leader::Alone
        } else {
            Leader::HandsOver { is_due: false }
        };
        loop {
            self.equations.follow(leader);
            let (run, from) = (&mut *self, (&interval, &y[..], &settings));
            let (hands_over, outcome) = match method {
                _ if leader == Leader::Passes => run.stretch(&Dop853, from),
                Method::Auto | Method::Dop853 => run.stretch(&Dop853, from),
                Method::Dopri5 => run.stretch(&Dopri5, from),
                Method::Tsit5 => run.stretch(&Tsit5, from),
                Method::Radau5 => run.stretch(&Radau5, from),
            };
            let mut outcome = match outcome {
                Ok(outcome) => outcome,
                Err(mut failure) => {
                    failure.statistics = failure.statistics + spent;
                    return Err(failure);
                }
            };
            outcome.statistics = outcome.statistics + spent;
            if !hands_over {
                return Ok(outcome);
            }
            leader = match leader {
                Leader::Passes => Leader::HandsOver { is_due: false },
                Leader::Alone | Leader::HandsOver { .. } => Leader::Passes,
            };
            (interval.t0, y, spent) = (outcome.t, outcome.y, outcome.statistics);
            let steps = spent.accepted + spent.rejected();
            settings.max_steps = most.saturating_sub(steps).max(1);
            let next = outcome.next_step;
            settings.initial_step = next.map_or(InitialStep::Automatic, InitialStep::Given);
        }
    }

    /// Passes the output row of the initial state to the caller, if this row is requested.
    fn show_start(&mut self, y0: &[f64]) -> ControlFlow<()> {
        let Self {
            equations,
            rows,
            row,
            stopped,
            ..
        } = self;
        rows.start(&mut **equations, y0, |e, t, y| {
            show(e, (t, y), row, stopped)
        })
    }

    /// Integrates until the end, or until another method must continue. Returns whether another
    /// method must continue.
    fn stretch<M: integrators::Method<RunEquations<'m>>>(
        &mut self,
        method: &M,
        (interval, y, settings): (&Interval<'_>, &[f64], &Options),
    ) -> (bool, IntegrationResult) {
        let Self {
            equations,
            rows,
            row,
            watch,
            stopped,
            ended,
        } = self;
        let (mut refused, mut hands_over) = (None, false);
        let mut events = equations.events();
        let outcome = integrate(method, equations, interval, y, settings, |step| {
            let (times, ends) = (
                [step.t0(), step.t1()],
                [step.y0(), step.f0(), step.y1(), step.f1()],
            );
            step.ode().take_step(times, ends);
            let known = events;
            let opening = contacts::opening(step).unwrap_or_else(|fault| {
                *stopped = Some(fault.into());
                None
            });
            if stopped.is_some() {
                return ControlFlow::Break(());
            }
            if opening.is_none() {
                passages::note(step);
                if let Err(fault) = judge_ahead(step, known) {
                    *stopped = Some(fault.into());
                    return ControlFlow::Break(());
                }
            }
            events = step.ode().events();
            let to = opening.as_ref().map_or(times[1], |opening| opening.t);
            let mut shown = None;
            let emitted = rows.emit_until(to, step, |e, t, y| {
                shown = Some(t);
                show(e, (t, y), row, stopped)
            });
            emitted.unwrap_or_else(|error| {
                refused = Some(error);
                ControlFlow::Break(())
            })?;
            if let Some(Opening { t, mut y, fault }) = opening {
                if shown == Some(t) || show(step.ode(), (t, &mut y), row, stopped).is_continue() {
                    *stopped = Some(fault.into());
                    *ended = Some(t);
                }
                return ControlFlow::Break(());
            }
            watch(times[1])?;
            hands_over = step.ode().hands_over(times);
            if hands_over {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        if let Some(error) = refused
            && !equations.is_stopped()
        {
            *stopped = Some(named(error));
        }
        (hands_over, outcome)
    }
}

/// Computes the verdicts at an accepted step, at its ends and between its events. The events of the
/// step are the events from `first_event` on.
fn judge_ahead(
    step: &mut integrators::Step<'_, RunEquations<'_>>,
    first_event: usize,
) -> Result<(), MotionFault> {
    if !step.ode().reads_verdicts() {
        return Ok(());
    }
    let times = [step.t0(), step.t1()];
    for t in step.ode().cut_verdicts(times, first_event) {
        let mut y = step.y0().to_vec();
        // Times after the start are within the step.
        let is_begin = t == times[0];
        if is_begin || step.interpolate_accurately(t, &mut y).is_ok() {
            step.ode().judge_ahead(t, &mut y, is_begin)?;
        }
    }
    if step.ode().reads_verdicts_at_step() {
        let mut y = step.y1().to_vec();
        step.ode().judge_ahead(times[1], &mut y, true)?;
    }
    Ok(())
}

/// Passes a row to the caller. A fault ends the run.
fn show(
    equations: &mut RunEquations<'_>,
    (t, y): (f64, &mut [f64]),
    row: &mut ShowRow<'_>,
    stopped: &mut Option<MotionError>,
) -> ControlFlow<()> {
    equations.show(t, y, row).unwrap_or_else(|fault| {
        *stopped = Some(fault.into());
        ControlFlow::Break(())
    })
}
