//! The run of one component of a plan: its integration, its rows, and the reason if it stops.

use std::ops::ControlFlow;
use std::time::Instant;

use integrators::{
    Cause, Dop853, Dopri5, IntegrationError, Interval, Options, Outcome, OutputTimes, Radau5, Rows,
    Tsit5, integrate,
};
use model::System;
use solvability::{contradicting_drives_along, generic};

use super::equations::RunEquations;
use super::passages;
use super::sample::{AtRows, Sample};
use super::summary::{Failure, Summary};
use crate::error::{MotionError, MotionFault};
use crate::motion::KeptRowMotion;
use crate::options::{Method, MotionOptions};
use crate::plan::{self, Plan};
use crate::prepare::Prepared;

/// Receives each row. A trait object, so that a run is compiled once, here, and not for each
/// caller.
pub(super) type ShowRow<'r> =
    dyn FnMut(&mut Sample<'_, '_>) -> Result<ControlFlow<()>, MotionFault> + 'r;

/// Receives the time (s) of each accepted step of each component, and may end the run.
pub type Watch<'w> = dyn Fn(f64) -> ControlFlow<()> + Sync + 'w;

/// The failure of a run that has not begun.
pub(super) fn not_begun(error: MotionError) -> Box<Failure> {
    let summary = Summary::default();
    Box::new(Failure { error, summary })
}

/// Runs one component of a plan.
pub(super) fn run_component(
    plan: &Plan<'_>,
    component: usize,
    watch: &Watch<'_>,
    row: &mut ShowRow<'_>,
) -> Result<Summary, Box<Failure>> {
    let component = &plan.components[component];
    let prepared = component.prepared();
    let method = component.decisions.method.value;
    let options = &MotionOptions {
        method,
        ..plan.options().clone()
    };
    let begun = KeptRowMotion::with(prepared, options).and_then(|mut motion| {
        motion.begin(0.0, &mut prepared.q.clone())?;
        Ok(motion)
    });
    let motion = begun.map_err(|e| not_begun(e.into()))?;
    let wanted = AtRows {
        on_constraints: plan.rows.value != plan::Rows::Interpolated,
        accelerations: plan.accelerations.value,
        reactions: component.decisions.reactions.value.clone(),
    };
    let equations = RunEquations::new(motion, prepared, options, wanted);
    let y0 = equations.y0();
    let interval = Interval {
        t0: 0.0,
        t_end: options.t_end,
        break_times: &prepared.mechanism.layout().break_times,
    };
    let settings = Options {
        tolerance: equations.tolerance(options),
        max_step: options.max_step,
        max_steps: options.max_steps,
        ..Options::with_tolerance(options.rtol, options.atol)
    };
    let rows = Rows::new(output_times(plan), &interval).map_err(|e| not_begun(named(e)))?;
    let mut run = Run {
        equations,
        rows,
        row,
        watch,
        stopped: None,
    };
    let clock = Instant::now();
    let outcome = match method {
        Method::Dopri5 => run.go(&Dopri5, &interval, &y0, &settings),
        Method::Tsit5 => run.go(&Tsit5, &interval, &y0, &settings),
        Method::Auto | Method::Dop853 => run.go(&Dop853, &interval, &y0, &settings),
        Method::Radau5 => run.go(&Radau5, &interval, &y0, &settings),
    };
    let wall_seconds = clock.elapsed().as_secs_f64();
    let (t, statistics) = match &outcome {
        Ok(o) => (o.t, o.statistics),
        Err(f) => (f.t, f.statistics),
    };
    let summary = Summary {
        t,
        method,
        steps: statistics.accepted,
        rejected: statistics.rejected(),
        evaluations: statistics.total_evaluations(),
        projections: statistics.projections,
        factorisations: statistics.factorisations,
        wall_seconds,
        ..run.equations.record.summary()
    };
    let error = match (outcome, run.stopped) {
        (_, Some(error)) => error,
        (Ok(_), None) => return Ok(summary),
        (Err(f), None) => match named(f.error) {
            MotionError::Integration(e) => match run.equations.cause(&e, f.t) {
                Some(fault) => fault.into(),
                None => MotionError::Integration(e),
            },
            error => error,
        },
    };
    let error = at_singular_start(prepared, of_drives(prepared, options.t_end, error));
    Err(Box::new(Failure { error, summary }))
}

/// If drives contradict each other or prescribe what joints forbid, names these drives as the cause
/// of a violated dropped row, whichever row was dropped.
fn of_drives(prepared: &Prepared, t_end: f64, error: MotionError) -> MotionError {
    let MotionError::Fault(MotionFault::DroppedRow { time, .. }) = &error else {
        return error;
    };
    let mechanism = &prepared.mechanism;
    // Drives that barely differ at this time are compared at a later one, where they differ
    // clearly.
    match contradicting_drives_along(mechanism, &prepared.q, t_end).unwrap_or_default() {
        Some(contradiction) => MotionFault::Drives {
            time: *time,
            contradiction: Box::new(contradiction),
        }
        .into(),
        None => error,
    }
}

/// Checks whether a violated dropped row is redundant at the start only; then it does not
/// contradict any other row.
fn at_singular_start(prepared: &Prepared, error: MotionError) -> MotionError {
    let MotionError::Fault(MotionFault::DroppedRow {
        time,
        row,
        residual,
        ..
    }) = &error
    else {
        return error;
    };
    let redundancy = prepared.decision.redundancy;
    match generic(&prepared.mechanism, 0.0, &prepared.q) {
        Some(found) if found.redundancy < redundancy => MotionFault::SingularStart {
            redundancy,
            elsewhere: found.redundancy,
            time: *time,
            row: row.clone(),
            residual: *residual,
        }
        .into(),
        _ => error,
    }
}

/// The times of the rows.
fn output_times(plan: &Plan<'_>) -> OutputTimes {
    let t_end = plan.options().t_end;
    match plan.rows.value {
        // A run of zero duration has one row.
        _ if t_end <= 0.0 => OutputTimes::At(vec![0.0]),
        plan::Rows::Ends => OutputTimes::At(vec![0.0, t_end]),
        plan::Rows::Every | plan::Rows::Interpolated => {
            OutputTimes::Every(plan.options().output_step)
        }
    }
}

/// A run in progress: the equations, the remaining rows, and the error if it has been stopped.
struct Run<'r, 'm> {
    equations: RunEquations<'m>,
    rows: Rows,
    row: &'r mut ShowRow<'r>,
    watch: &'r Watch<'r>,
    stopped: Option<MotionError>,
}

type Integrated = Result<Outcome, Box<integrators::Failure<MotionFault>>>;

impl<'m> Run<'_, 'm> {
    fn go<M: integrators::Method<RunEquations<'m>>>(
        &mut self,
        method: &M,
        interval: &Interval<'_>,
        y0: &[f64],
        settings: &Options,
    ) -> Integrated {
        let Self {
            equations,
            rows,
            row,
            watch,
            stopped,
        } = self;
        let mut show = |e: &mut RunEquations<'m>, t: f64, y: &mut [f64]| match e.show(t, y, row) {
            Ok(flow) => flow,
            Err(fault) => {
                *stopped = Some(fault.into());
                ControlFlow::Break(())
            }
        };
        if rows.start(equations, y0, &mut show).is_break() {
            // No time is integrated; the rest is the result at the start.
            let nowhere = Interval::new(interval.t0, interval.t0);
            return integrate(method, equations, &nowhere, y0, settings, |_| {
                ControlFlow::Break(())
            });
        }
        let mut refused = None;
        let outcome = integrate(method, equations, interval, y0, settings, |step| {
            passages::note(step);
            let (times, ends) = (
                [step.t0(), step.t1()],
                [step.y0(), step.f0(), step.y1(), step.f1()],
            );
            step.ode().take_step(times, ends);
            rows.emit(step, &mut show).unwrap_or_else(|error| {
                refused = Some(error);
                ControlFlow::Break(())
            })?;
            watch(step.t1())
        });
        if let Some(error) = refused {
            *stopped = Some(named(error));
        }
        outcome
    }
}

/// The fault behind a collapsed step, if it comes from the equations.
fn named(error: IntegrationError<MotionFault>) -> MotionError {
    match error {
        IntegrationError::StepSizeCollapsed {
            cause: Cause::Problem(fault),
            ..
        }
        | IntegrationError::StartFailed {
            cause: Cause::Problem(fault),
            ..
        } => MotionError::Fault(fault),
        other => MotionError::Integration(Box::new(other)),
    }
}
