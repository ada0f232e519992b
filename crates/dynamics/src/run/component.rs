//! The run of one component of a plan: its integration, its rows, and the reason if it stops.

use std::time::Instant;

use integrators::{Interval, Options, OutputTimes, Rows};
use model::System;
use solvability::{contradicting_drives_along, generic};

use super::caller::{ShowRow, Stop, Watch, named};
use super::equations::RunEquations;
use super::integration::Run;
use super::sample::AtRows;
use super::summary::{Failure, Summary};
use crate::code::SceneCode;
use crate::error::{MotionError, MotionFault};
use crate::motion::KeptRowMotion;
use crate::options::MotionOptions;
use crate::plan::{self, Plan};
use crate::prepare::Prepared;

/// The failure of a run that has not begun.
pub(super) fn not_begun(error: MotionError) -> Box<Failure> {
    let summary = Summary::default();
    Box::new(Failure { error, summary })
}

/// Runs one component of a plan.
pub(super) fn run_component(
    plan: &Plan<'_>,
    component: usize,
    (watch, stop): (&Watch<'_>, &Stop<'_>),
    evaluator: Option<&dyn SceneCode>,
    row: &mut ShowRow<'_>,
) -> Result<Summary, Box<Failure>> {
    if stop() {
        return Ok(Summary::default());
    }
    let component = &plan.components[component];
    let prepared = component.prepared();
    let method = component.decisions.method.value;
    let options = &MotionOptions {
        method,
        ..plan.options().clone()
    };
    drives_agree(prepared, options.t_end).map_err(not_begun)?;
    let begun = KeptRowMotion::evaluated(prepared, options, evaluator).and_then(|mut motion| {
        motion.begin(0.0, &mut prepared.q.clone())?;
        Ok(motion)
    });
    let motion = begun.map_err(|e| not_begun(e.into()))?;
    let wanted = AtRows {
        on_constraints: plan.rows.value != plan::Rows::Interpolated,
        accelerations: plan.accelerations.value,
        reactions: component.decisions.reactions.value.clone(),
    };
    let equations = RunEquations::new(motion, prepared, options, wanted, stop);
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
    let mut run = Run::new(equations, rows, row, watch);
    let clock = Instant::now();
    let outcome = run.go(method, &interval, &y0, &settings);
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
        misfits: run.equations.misfits(),
        ..run.equations.record.summary()
    };
    let error = match (outcome, run.stopped) {
        (_, Some(error)) => error,
        (Ok(_), None) => match run.equations.failed.take() {
            Some(fault) => fault.into(),
            None => return Ok(summary),
        },
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

/// Within a stated tolerance data explain what joints miss where drives move them, so that no
/// dropped row shows during the run that a drive prescribes what joints forbid: it does not begin
/// then.
fn drives_agree(prepared: &Prepared, t_end: f64) -> Result<(), MotionError> {
    if !prepared.may_miss {
        return Ok(());
    }
    let found = contradicting_drives_along(&prepared.mechanism, &prepared.q, t_end);
    match found.unwrap_or_default() {
        Some(contradiction) => Err(contradiction.into()),
        None => Ok(()),
    }
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
