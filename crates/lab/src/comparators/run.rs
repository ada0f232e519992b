//! Runs a prepared mechanism by a reference method, with output rows at given times.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use dynamics::PreparedMechanism;
use integrators::{
    Cause, Dop853, Dopri5, IntegrationError, Interval, Ode, Options, OutputTimes, Tsit5, sample,
};
use model::{Reaction, System};

use super::equations::Equations;
use super::gbs::Gbs;
use super::generalized_alpha::GeneralizedAlpha;
use super::stepping::{Limits, Stepper, Steps, drive};
use super::way::{Comparator, Formulation, Method};
use super::{Fault, KeptRows, MinimumNorm, NullSpace, Proximal, Solver};

/// A state of a run, with its accelerations and reactions.
#[derive(Clone, Debug)]
pub struct Row {
    /// Time (s).
    pub t: f64,
    /// Coordinates, velocities and accelerations.
    pub q: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
    /// Accelerations.
    pub a: Vec<f64>,
    /// Reactions of all joints and drives. Reactions that are not unique depend on the formulation.
    pub reactions: Vec<Reaction>,
}

/// A finished run.
#[derive(Clone, Debug, Default)]
pub struct Run {
    /// One row for each requested time.
    pub rows: Vec<Row>,
    /// Accepted and rejected steps.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Number of solves for accelerations, including the solves for output rows.
    pub evaluations: u64,
    /// Number of projected states.
    pub projections: u64,
    /// Run time (s).
    pub seconds: f64,
}

/// Largest number of steps of a run.
const MOST_STEPS: u64 = 1_000_000;

/// Simulates a prepared mechanism from t = 0 to the last of `times` (s; ascending and > 0), with a
/// tolerance that is both relative and absolute.
///
/// # Errors
/// Returns the reason why the run did not reach the end.
pub fn run(
    prepared: &PreparedMechanism,
    way: Comparator,
    tolerance: f64,
    times: &[f64],
) -> Result<Run, Fault> {
    run_within(prepared, way, tolerance, times, Duration::MAX)
}

/// Like [`run`], but stops with [`Fault::TooLong`] once the run exceeds `budget`.
///
/// # Errors
/// Returns the errors of [`run`].
pub fn run_within(
    prepared: &PreparedMechanism,
    way: Comparator,
    tolerance: f64,
    times: &[f64],
    budget: Duration,
) -> Result<Run, Fault> {
    let rank = prepared.decision.rank;
    let kept = &prepared.decision.kept;
    let n = prepared.mechanism.layout().n_v;
    let mut equations = Equations::new(prepared, way.drift, |c, mass| {
        Ok(match way.formulation {
            Formulation::KeptRows => Box::new(KeptRows::new(n, kept)?) as Box<dyn Solver>,
            Formulation::NullSpace => Box::new(NullSpace::new(rank)),
            Formulation::MinimumNorm => Box::new(MinimumNorm::new(rank)),
            Formulation::Proximal => Box::new(Proximal::new(c, mass, rank, tolerance)?),
        })
    })?;
    let clock = Instant::now();
    equations.deadline = clock.checked_add(budget);
    let y0 = [prepared.q.as_slice(), &prepared.v].concat();
    let limits = Limits {
        tolerance,
        steps: MOST_STEPS,
    };
    let mut rows = Vec::with_capacity(times.len());
    let show = |equations: &mut Equations<'_>, t: f64, y: &[f64]| {
        let mut row = observed(equations, t, y)?;
        row.t = times.get(rows.len()).copied().unwrap_or(t);
        rows.push(row);
        Ok(())
    };
    let dim = equations.dim();
    let mut own: Box<dyn Stepper + '_> = match way.method {
        Method::Gbs => Box::new(Gbs::new(dim, tolerance)),
        _ => Box::new(GeneralizedAlpha::new(&prepared.mechanism, kept)?),
    };
    let steps = match way.method {
        Method::Dop853 => integrated(&Dop853, &mut equations, &y0, times, &limits, show)?,
        Method::Dopri5 => integrated(&Dopri5, &mut equations, &y0, times, &limits, show)?,
        Method::Tsit5 => integrated(&Tsit5, &mut equations, &y0, times, &limits, show)?,
        Method::Gbs | Method::GeneralizedAlpha => {
            drive(&mut *own, &mut equations, y0, times, &limits, show)?
        }
    };
    Ok(Run {
        rows,
        steps: steps.accepted + steps.rejected,
        rejected: steps.rejected,
        evaluations: equations.evaluations,
        projections: equations.projections,
        seconds: clock.elapsed().as_secs_f64(),
    })
}

/// Returns the output row of a state. The state is projected if the method uses projection.
fn observed(equations: &mut Equations<'_>, t: f64, y: &[f64]) -> Result<Row, Fault> {
    let mut y = y.to_vec();
    equations.end(t, &mut y)?;
    let (q, v) = y.split_at(equations.sizes()[0]);
    let (a, reactions) = equations.observe(t, q, v)?;
    Ok(Row {
        t,
        q: q.to_vec(),
        v: v.to_vec(),
        a,
        reactions,
    })
}

/// Runs a method of `integrators`.
fn integrated<'a, M: integrators::Method<Equations<'a>>>(
    method: &M,
    equations: &mut Equations<'a>,
    y0: &[f64],
    times: &[f64],
    limits: &Limits,
    mut show: impl FnMut(&mut Equations<'a>, f64, &[f64]) -> Result<(), Fault>,
) -> Result<Steps, Fault> {
    let mechanism = equations.mechanism();
    let breaks = &mechanism.layout().break_times;
    let interval = Interval {
        t0: 0.0,
        t_end: times.last().copied().unwrap_or(0.0),
        break_times: breaks,
    };
    let options = Options {
        max_steps: limits.steps,
        ..Options::with_tolerance(limits.tolerance, limits.tolerance)
    };
    let mut refused = None;
    let wanted = OutputTimes::At(times.to_vec());
    let outcome = sample(
        method,
        equations,
        &interval,
        y0,
        &options,
        &wanted,
        |e, t, y| {
            // A row at a break time contains the state just before this time.
            let t = if breaks.contains(&t) {
                t.next_down()
            } else {
                t
            };
            let shown = show(e, t, y);
            match shown {
                Ok(()) => ControlFlow::Continue(()),
                Err(fault) => {
                    refused = Some(fault);
                    ControlFlow::Break(())
                }
            }
        },
    );
    match (refused, outcome) {
        (Some(fault), _) => Err(fault),
        (None, Ok(outcome)) => Ok(Steps {
            accepted: outcome.statistics.accepted,
            rejected: outcome.statistics.rejected(),
        }),
        (None, Err(failure)) => Err(match failure.error {
            IntegrationError::StepSizeCollapsed {
                cause: Cause::Problem(fault),
                ..
            } => fault,
            other => Fault::Integration(other.to_string()),
        }),
    }
}
