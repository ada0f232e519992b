//! Simulates one component of a plan. The module integrates the equations of the component,
//! computes its output rows, and stores the reason if the simulation stops early.

use std::borrow::Cow;
use std::time::Instant;

use integrators::{IntegrationError, Interval, Options, OutputTimes, Rows};
use model::System;
use solvability::{
    CarriedChoices, Choice, Group, ONE_PART, contradicting_drives_along, decide_dropping,
    drive_limit, generic, no_finite_reactions,
};

use super::caller::{ShowRow, Stop, Watch, named};
use super::equations::RunEquations;
use super::integration::{IntegrationResult, Run};
use super::sample::AtRows;
use super::summary::{Failure, Summary};
use super::verdicts::RunVerdicts;
use crate::code::SceneCode;
use crate::error::{MotionError, MotionFault};
use crate::motion::KeptRowMotion;
use crate::options::MotionOptions;
use crate::plan::{self, ComponentPlan, Plan, Verdicts};
use crate::prepare::PreparedMechanism;

/// Returns the failure of a run that has not started.
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
    check_finite(prepared).map_err(not_begun)?;
    let begun = KeptRowMotion::evaluated(prepared, options, evaluator).and_then(|mut motion| {
        motion.begin(prepared.start_time(), &mut prepared.q.clone())?;
        Ok(motion)
    });
    let motion = begun.map_err(|e| not_begun(e.into()))?;
    let wanted = AtRows {
        on_constraints: plan.rows.value != plan::Rows::Interpolated,
        accelerations: plan.accelerations.value,
        reactions: component.decisions.reactions.value.clone(),
        uniqueness: plan.uniqueness,
    };
    let groups: Vec<Group> = plan
        .groups
        .iter()
        .filter_map(|group| component.share(group))
        .collect();
    // Verdicts refer to the whole mechanism, even if only the reactions of other components are
    // requested.
    let has_verdicts = plan
        .components
        .iter()
        .any(|c| !c.decisions.reactions.value.is_empty());
    let has_verdicts = has_verdicts && plan.verdicts != Verdicts::None;
    let verdicts = has_verdicts
        .then(|| RunVerdicts::new(&motion, prepared, options, (&groups, plan.verdicts)));
    let choices = carried_choices(plan, component, &wanted).map_err(not_begun)?;
    let wanted = (wanted, verdicts);
    let choices = (plan.choices.as_slice(), choices);
    let mut equations = RunEquations::new(motion, prepared, options, wanted, choices, stop);
    let y0 = equations.y0();
    let interval = Interval {
        t0: prepared.start_time(),
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
    let mut run = Run::new(&mut equations, rows, row, watch);
    let clock = Instant::now();
    let outcome = run.go(method, &interval, &y0, &settings);
    let wall_seconds = clock.elapsed().as_secs_f64();
    let (t, y, statistics) = match &outcome {
        Ok(o) => (o.t, o.y.clone(), o.statistics),
        Err(f) => (f.t, f.y.clone(), f.statistics),
    };
    let t = run.ended.unwrap_or(t);
    let stopped = run.stopped.take();
    let (verdicts, dropped) = equations.finish_verdicts(&groups, t).unzip();
    let summary = Summary {
        t,
        verdicts,
        dropped: dropped.unwrap_or_default(),
        method,
        steps: statistics.accepted,
        rejected: statistics.rejected(),
        evaluations: statistics.total_evaluations(),
        projections: statistics.projections,
        factorisations: statistics.factorisations,
        wall_seconds,
        misfits: equations.misfits(),
        ..equations.record.summary()
    };
    let Some(error) = cause(&mut equations, outcome, stopped) else {
        return Ok(summary);
    };
    let error = at_singular_start(prepared, of_drives(prepared, options.t_end, error));
    let error = at_drive_limit(prepared, (t, &y), error);
    Err(Box::new(Failure { error, summary }))
}

/// Returns the reason why an integration ended early, if it did.
pub(super) fn cause(
    equations: &mut RunEquations<'_>,
    outcome: IntegrationResult,
    stopped: Option<MotionError>,
) -> Option<MotionError> {
    match (outcome, stopped) {
        (_, Some(error)) => Some(error),
        (Ok(_), None) => equations.failed.take().map(Into::into),
        (Err(f), None) => Some(match named(f.error) {
            MotionError::Integration(e) => match equations.cause(&e, f.t) {
                Some(fault) => fault.into(),
                None => MotionError::Integration(e),
            },
            error => error,
        }),
    }
}

/// Returns the solver for the additional choices of a plan in one of its components. Returns `None`
/// if no choice or no reaction is requested.
fn carried_choices<'p>(
    plan: &Plan<'_>,
    component: &'p ComponentPlan<'_>,
    wanted: &AtRows,
) -> Result<Option<CarriedChoices<'p>>, MotionError> {
    if plan.choices.is_empty() || wanted.reactions.is_empty() {
        return Ok(None);
    }
    let PreparedMechanism {
        mechanism,
        q,
        decision,
        ..
    } = component.prepared();
    let choices = plan.choices.iter();
    let choices = choices.map(|named| component.share_of_choice(&named.choice));
    let choices: Vec<Choice> = choices.collect();
    let carried = CarriedChoices::new(
        mechanism,
        (mechanism.layout().start_time, q),
        &decision.dropped,
        &choices,
    )?;
    Ok(Some(carried))
}

/// Checks before the run that no drive prescribes a motion that joints prevent. If a tolerance is
/// stated, the violation of the joints may result from data within the tolerance. The redundant
/// rows would then not show this contradiction during the run.
fn drives_agree(prepared: &PreparedMechanism, t_end: f64) -> Result<(), MotionError> {
    if !prepared.may_miss {
        return Ok(());
    }
    let found = contradicting_drives_along(&prepared.mechanism, &prepared.q, t_end);
    match found.unwrap_or_default() {
        Some(contradiction) => Err(contradiction.into()),
        None => Ok(()),
    }
}

/// Returns an error for a start at which the constraints exclude, at second order, the acceleration
/// that the loads cause.
pub(super) fn check_finite(prepared: &PreparedMechanism) -> Result<(), MotionError> {
    let (mechanism, decision) = (&prepared.mechanism, &prepared.decision);
    let layout = mechanism.layout();
    if decision.redundancy == 0 || decision.rank == layout.n_v || layout.rows() > ONE_PART {
        return Ok(());
    }
    let (t, q, v) = (layout.start_time, &prepared.q, &prepared.v);
    let decision = match prepared.decided.as_ref().and_then(|rows| rows.whole()) {
        Some(certified) => Cow::Borrowed(certified),
        None => {
            let mut s = mechanism.scratch();
            mechanism.pose(t, q, &mut s);
            mechanism.phi(&mut s);
            mechanism.c(&mut s);
            // Rows that are redundant only within a stated tolerance do not count as redundant in
            // this decision.
            match decide_dropping(mechanism, &s, q, &decision.dropped) {
                Ok(decision) => Cow::Owned(decision),
                Err(_) => return Ok(()),
            }
        }
    };
    let found = no_finite_reactions(mechanism, (t, q, v), &decision)?;
    match found.into_iter().find(|found| found.decided) {
        Some(found) => Err(MotionError::NoFiniteReaction(Box::new(found))),
        None => Ok(()),
    }
}

/// If drives contradict each other or prescribe a motion that joints prevent, these drives are
/// reported as the cause of a violated redundant row. This rule applies to any redundant row.
fn of_drives(prepared: &PreparedMechanism, t_end: f64, error: MotionError) -> MotionError {
    let MotionError::Fault(MotionFault::DroppedRow { time, .. }) = &error else {
        return error;
    };
    let mechanism = &prepared.mechanism;
    // Drives whose values barely differ at this time are compared at a later time, at which their
    // values differ clearly.
    match contradicting_drives_along(mechanism, &prepared.q, t_end).unwrap_or_default() {
        Some(contradiction) => MotionFault::Drives {
            time: *time,
            contradiction: Box::new(contradiction),
        }
        .into(),
        None => error,
    }
}

/// If drives prescribe values that no configuration near the last state can reach, these drives are
/// reported as the cause of the stop. This rule applies even if another cause was found first.
fn at_drive_limit(
    prepared: &PreparedMechanism,
    (t, y): (f64, &[f64]),
    error: MotionError,
) -> MotionError {
    let is_of_steps = match &error {
        MotionError::Integration(e) => matches!(**e, IntegrationError::StepSizeCollapsed { .. }),
        MotionError::Fault(fault) => matches!(
            fault,
            MotionFault::SingularPassage { .. }
                | MotionFault::RankLost { .. }
                | MotionFault::OffConstraints { .. }
                | MotionFault::IndependentCoordinates { .. }
                | MotionFault::FarCompletion { .. }
                | MotionFault::NoRows { .. }
        ),
        _ => false,
    };
    let layout = prepared.mechanism.layout();
    if !is_of_steps || !layout.rheonomic || y.len() < layout.n_q + layout.n_v {
        return error;
    }
    let (q, v) = (&y[..layout.n_q], &y[layout.n_q..layout.n_q + layout.n_v]);
    match drive_limit(
        &prepared.mechanism,
        &prepared.position_decision.kept,
        (t, q, v),
    ) {
        Some(limit) => MotionFault::NoConfiguration {
            limit: Box::new(limit),
        }
        .into(),
        None => error,
    }
}

/// Checks whether a violated redundant row is redundant only at the start, because the start is
/// singular.
fn at_singular_start(prepared: &PreparedMechanism, error: MotionError) -> MotionError {
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
    match generic(&prepared.mechanism, prepared.start_time(), &prepared.q) {
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

/// Returns the times of the output rows.
fn output_times(plan: &Plan<'_>) -> OutputTimes {
    let t_end = plan.options().t_end;
    let t0 = plan
        .components
        .first()
        .map_or(0.0, |first| first.prepared().start_time());
    match plan.rows.value {
        // A run of zero duration has one row.
        _ if t_end <= t0 => OutputTimes::At(vec![t0]),
        plan::Rows::Ends => OutputTimes::At(vec![t0, t_end]),
        plan::Rows::Every | plan::Rows::Interpolated => {
            OutputTimes::Every(plan.options().output_step)
        }
    }
}
