//! A run: integration of q̇ = T·v and the solved accelerations, projection after each step, projected rows of output,
//! and the balance of energy.

use std::ops::ControlFlow;
use std::time::Instant;

mod constrained;
mod energy;
mod equations;
mod passages;
mod span;

use integrators::{
    Cause, Dop853, Dopri5, Gbs, GeneralizedAlpha, Hem4, IntegrationError, Interval, Options,
    Outcome, OutputTimes, Radau5, Rows, Tsit5, integrate,
};
use linalg::ProximalTuning;
use model::{Reaction, System};

use crate::choose;
use crate::error::{MotionError, Trip};
use crate::events::Event;
use crate::motion::{KeptRowMotion, Motion};
use crate::options::{Method, MotionOptions};
use crate::prepare::Prepared;
use equations::Equations;

/// Numbers of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Summary {
    /// Last time reached (s).
    pub t: f64,
    /// The integrator: the one asked for, or the one chosen.
    pub method: Method,
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Evaluations of accelerations: rejected steps, start, projections and output included.
    pub evaluations: u64,
    /// Projections of steps.
    pub projections: u64,
    /// Factorisations of iteration matrices of implicit methods.
    pub factorisations: u64,
    /// Time of the integration alone (s).
    pub wall_seconds: f64,
    /// Largest |Φ| at accepted steps and written rows.
    pub max_position_residual: f64,
    /// Largest |C·v − b| at accepted steps and written rows.
    pub max_velocity_residual: f64,
    /// Largest |E − E₀ − work of drives and applied forces| relative to the largest kinetic energy.
    pub energy_balance: f64,
    /// Smallest pivot ratio of the kept rows at the start and at accepted steps that were interpreted.
    pub min_pivot_ratio: f64,
    /// What happened on the way.
    pub events: Vec<Event>,
    /// The last tuning of proximal iterations, where accelerations come from them.
    pub proximal: Option<ProximalTuning>,
}

/// A run that stopped early, with what was reached.
#[derive(Debug, thiserror::Error)]
#[error("{error}")]
pub struct Failure {
    /// Why it stopped.
    pub error: MotionError,
    /// What was reached.
    pub summary: Summary,
}

/// One row of output: a state on the constraints, and what follows from it on demand.
pub struct Sample<'s, 'm> {
    /// Time (s).
    pub t: f64,
    /// The same, or the last number before a break time.
    t_before: f64,
    /// Coordinates. At a break time all values are those just before.
    pub q: &'s [f64],
    /// Velocities.
    pub v: &'s [f64],
    /// Share of the reference pivots below which reactions are not told.
    blind: f64,
    motion: &'s mut KeptRowMotion<'m>,
}

impl Sample<'_, '_> {
    /// Accelerations; allocates.
    ///
    /// # Errors
    /// If the equations have no unique solution here.
    pub fn acceleration(&mut self) -> Result<Vec<f64>, Trip> {
        let mut a = vec![0.0; self.v.len()];
        self.motion
            .acceleration(self.t_before, self.q, self.v, &mut a)?;
        Ok(a)
    }

    /// Multipliers of all rows as [`Motion::multipliers`] gives them; allocates.
    ///
    /// # Errors
    /// If the equations have no unique solution here.
    pub fn multipliers(&mut self) -> Result<Vec<f64>, Trip> {
        let mut lambda = vec![0.0; self.motion.mechanism().layout().rows()];
        self.motion
            .multipliers(self.t_before, self.q, self.v, &mut lambda)?;
        if self.motion.relative_pivot() < self.blind {
            lambda.fill(f64::NAN);
        }
        Ok(lambda)
    }

    /// Reactions of all joints and drives in the order of their rows. Those of non-unique joints belong to the choice
    /// of this run (its kept rows, or the norm of its formulation) and to no other; allocates.
    ///
    /// # Errors
    /// If the equations have no unique solution here.
    pub fn reactions(&mut self) -> Result<Vec<Reaction>, Trip> {
        let lambda = self.multipliers()?;
        let mechanism = self.motion.mechanism();
        let s = self.motion.scratch();
        Ok(mechanism
            .constraint_ids()
            .map(|id| mechanism.reaction(id, s, &lambda))
            .collect())
    }
}

/// Runs a prepared mechanism from t = 0 and shows rows at 0, every output step and the end.
///
/// # Errors
/// With the summary of what was reached; rows shown before stand.
pub fn simulate(
    prepared: &Prepared,
    options: &MotionOptions,
    mut row: impl FnMut(&mut Sample<'_, '_>) -> Result<ControlFlow<()>, Trip>,
) -> Result<Summary, Box<Failure>> {
    let mechanism = &prepared.mechanism;
    let fail = |error: MotionError| {
        Box::new(Failure {
            error,
            summary: Summary::default(),
        })
    };
    options.check().map_err(fail)?;
    options.check_rows(&prepared.choice).map_err(fail)?;
    let method = choose::method(prepared, options).map_err(|e| fail(e.into()))?;
    let options = &MotionOptions {
        method,
        ..options.clone()
    };
    let motion = KeptRowMotion::with(prepared, options).map_err(|e| fail(e.into()))?;
    let mut equations = Equations::new(motion, prepared, options);
    equations
        .motion
        .begin(0.0, &mut prepared.q.clone())
        .map_err(|e| fail(e.into()))?;
    let y0 = equations.initial_state(&prepared.q, &prepared.v);
    let layout = mechanism.layout();
    let interval = Interval {
        t0: 0.0,
        t_end: options.t_end,
        break_times: &layout.break_times,
    };
    let settings = Options {
        tolerance: equations.tolerance(options),
        max_step: options.max_step,
        ..Options::with_tolerance(options.rtol, options.atol)
    };
    // A run that takes no time has one row.
    let times = match options.t_end > 0.0 {
        true => OutputTimes::Every(options.output_step),
        false => OutputTimes::At(vec![0.0]),
    };
    let rows = Rows::new(times, &interval).map_err(|e| fail(named(e)))?;
    let mut run = Run {
        equations,
        rows,
        row: &mut row,
        stopped: None,
    };
    let clock = Instant::now();
    let outcome = match method {
        Method::Dopri5 => run.go(&Dopri5, &interval, &y0, &settings),
        Method::Tsit5 => run.go(&Tsit5, &interval, &y0, &settings),
        Method::Auto | Method::Dop853 => run.go(&Dop853, &interval, &y0, &settings),
        Method::Gbs => run.go(&Gbs, &interval, &y0, &settings),
        Method::Radau5 => run.go(&Radau5, &interval, &y0, &settings),
        Method::Hem4 => run.go(&Hem4, &interval, &y0, &settings),
        Method::GeneralizedAlpha => run.go(&GeneralizedAlpha::default(), &interval, &y0, &settings),
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
        ..run.equations.summary()
    };
    let error = match (outcome, run.stopped) {
        (_, Some(error)) => error,
        (Ok(_), None) => return Ok(summary),
        (Err(f), None) => named(f.error),
    };
    Err(Box::new(Failure { error, summary }))
}

/// A run on its way: the equations, the rows that are still to be shown, and why it was stopped.
struct Run<'r, 'm, F> {
    equations: Equations<'m>,
    rows: Rows,
    row: &'r mut F,
    stopped: Option<MotionError>,
}

type Integrated = Result<Outcome, Box<integrators::Failure<Trip>>>;

impl<'m, F> Run<'_, 'm, F>
where
    F: FnMut(&mut Sample<'_, '_>) -> Result<ControlFlow<()>, Trip>,
{
    fn go<M: integrators::Method<Equations<'m>>>(
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
            stopped,
        } = self;
        let mut show = |e: &mut Equations<'m>, t: f64, y: &mut [f64]| match e.show(t, y, row) {
            Ok(flow) => flow,
            Err(trip) => {
                *stopped = Some(trip.into());
                ControlFlow::Break(())
            }
        };
        if rows.start(equations, y0, &mut show).is_break() {
            // Nothing is integrated; what follows is the result of no time.
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
            })
        });
        if let Some(error) = refused {
            *stopped = Some(named(error));
        }
        outcome
    }
}

/// The cause behind a collapsed step, if it is ours.
fn named(error: IntegrationError<Trip>) -> MotionError {
    match error {
        IntegrationError::StepSizeCollapsed {
            cause: Cause::Problem(trip),
            ..
        }
        | IntegrationError::StartFailed {
            cause: Cause::Problem(trip),
            ..
        } => MotionError::Trip(trip),
        other => MotionError::Integration(Box::new(other)),
    }
}
