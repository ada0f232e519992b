//! A run: integration of q̇ = T·v and the solved accelerations, projection after each step, projected rows of output,
//! and the balance of energy.

use std::ops::ControlFlow;
use std::time::Instant;

use integrators::{
    Cause, IntegrationError, Interval, Ode, Options, OutputTimes, StepEnd, StepInfo, Tolerance,
    sample,
};
use model::{Reaction, System};

use crate::error::{MotionError, Trip};
use crate::events::Event;
use crate::motion::{Correction, KeptRowMotion, Motion};
use crate::options::{Method, MotionOptions};
use crate::prepare::Prepared;

/// Numbers of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Summary {
    /// Last time reached (s).
    pub t: f64,
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Evaluations of accelerations: rejected steps, start, projections and output included.
    pub evaluations: u64,
    /// Projections of steps.
    pub projections: u64,
    /// Time of the integration alone (s).
    pub wall_seconds: f64,
    /// Largest |Φ| at accepted steps and written rows.
    pub max_position_residual: f64,
    /// Largest |C·v − b| at accepted steps and written rows.
    pub max_velocity_residual: f64,
    /// Largest |E − E₀ − work of drives and applied forces| relative to the largest kinetic energy.
    pub energy_balance: f64,
    /// Smallest pivot ratio of the kept rows at accepted steps.
    pub min_pivot_ratio: f64,
    /// What happened on the way.
    pub events: Vec<Event>,
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
    /// Coordinates.
    pub q: &'s [f64],
    /// Velocities.
    pub v: &'s [f64],
    motion: &'s mut KeptRowMotion<'m>,
}

impl Sample<'_, '_> {
    /// Accelerations; allocates.
    ///
    /// # Errors
    /// If the equations have no unique solution here.
    pub fn acceleration(&mut self) -> Result<Vec<f64>, Trip> {
        let mut a = vec![0.0; self.v.len()];
        self.motion.acceleration(self.t, self.q, self.v, &mut a)?;
        Ok(a)
    }

    /// Multipliers of all rows, those of dropped rows zero by decree; allocates.
    ///
    /// # Errors
    /// If the equations have no unique solution here.
    pub fn multipliers(&mut self) -> Result<Vec<f64>, Trip> {
        let mut lambda = vec![0.0; self.motion.mechanism().layout().rows()];
        self.motion
            .multipliers(self.t, self.q, self.v, &mut lambda)?;
        Ok(lambda)
    }

    /// Reactions of all joints and drives in the order of their rows. Those of non-unique joints belong to the kept
    /// rows of this run and to no other; allocates.
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
    let motion = KeptRowMotion::new(prepared).map_err(|e| fail(e.into()))?;
    let mut equations = Equations::new(motion, prepared);
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
        ..Options::with_tolerance(options.rtol, options.atol)
    };
    let method = match options.method {
        Method::Dopri5 => integrators::Dopri5,
    };
    // A run that takes no time has one row.
    let times = match options.t_end > 0.0 {
        true => OutputTimes::Every(options.output_step),
        false => OutputTimes::At(vec![0.0]),
    };
    let mut tripped = None;
    let clock = Instant::now();
    let outcome = sample(
        &method,
        &mut equations,
        &interval,
        &y0,
        &settings,
        &times,
        |e, t, y| match e.show(t, y, &mut row) {
            Ok(flow) => flow,
            Err(trip) => {
                tripped = Some(trip);
                ControlFlow::Break(())
            }
        },
    );
    let wall_seconds = clock.elapsed().as_secs_f64();
    let (t, statistics) = match &outcome {
        Ok(o) => (o.t, o.statistics),
        Err(f) => (f.t, f.statistics),
    };
    let summary = Summary {
        t,
        steps: statistics.accepted,
        rejected: statistics.rejected(),
        evaluations: statistics.total_evaluations(),
        projections: statistics.projections,
        wall_seconds,
        ..equations.summary()
    };
    match (outcome, tripped) {
        (_, Some(trip)) => Err(Box::new(Failure {
            error: trip.into(),
            summary,
        })),
        (Ok(_), None) => Ok(summary),
        (Err(f), None) => Err(Box::new(Failure {
            error: named(f.error),
            summary,
        })),
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

/// The differential equation of a run: y = [q; v], and the work of drives and applied forces where there are any.
struct Equations<'m> {
    motion: KeptRowMotion<'m>,
    n_q: usize,
    n_v: usize,
    /// Whether y carries the work.
    works: bool,
    energy: EnergyBalance,
    max_position_residual: f64,
    max_velocity_residual: f64,
    min_pivot_ratio: f64,
    events: Vec<Event>,
    /// The state before a projection.
    before: Vec<f64>,
}

#[derive(Clone, Copy, Debug)]
struct EnergyBalance {
    start: f64,
    largest_kinetic: f64,
    largest_gap: f64,
}

impl<'m> Equations<'m> {
    fn new(motion: KeptRowMotion<'m>, prepared: &Prepared) -> Self {
        let (q, v) = (&prepared.q, &prepared.v);
        let mechanism = motion.mechanism();
        let layout = mechanism.layout();
        let works = layout.rheonomic || mechanism.has_applied_forces();
        let kinetic = mechanism.kinetic_energy(v);
        Self {
            n_q: layout.n_q,
            n_v: layout.n_v,
            works,
            energy: EnergyBalance {
                start: kinetic + mechanism.potential_energy(q),
                largest_kinetic: kinetic,
                largest_gap: 0.0,
            },
            max_position_residual: 0.0,
            max_velocity_residual: 0.0,
            min_pivot_ratio: f64::INFINITY,
            events: Vec::new(),
            before: Vec::new(),
            motion,
        }
    }

    fn initial_state(&mut self, q: &[f64], v: &[f64]) -> Vec<f64> {
        let mut y = [q, v].concat();
        y.extend(self.works.then_some(0.0));
        self.before = y.clone();
        y
    }

    /// The work is measured, not controlled: its error has no weight. It still counts as a component of the mean, which makes the
    /// control looser by the factor √((n + 1)/n).
    fn tolerance(&self, options: &MotionOptions) -> Tolerance {
        if !self.works {
            return Tolerance::Uniform {
                rtol: options.rtol,
                atol: options.atol,
            };
        }
        let mut rtol = vec![options.rtol; self.n_q + self.n_v];
        let mut atol = vec![options.atol; self.n_q + self.n_v];
        rtol.push(0.0);
        atol.push(f64::MAX);
        Tolerance::PerComponent { rtol, atol }
    }

    fn derivative(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), Trip> {
        let (q, v) = (&y[..self.n_q], &y[self.n_q..self.n_q + self.n_v]);
        let (qd, rest) = dy.split_at_mut(self.n_q);
        let (a, work) = rest.split_at_mut(self.n_v);
        self.motion.mechanism().rate(q, v, qd);
        self.motion.acceleration(t, q, v, a)?;
        self.motion.same_side(t)?;
        if let Some(work) = work.first_mut() {
            *work = self.motion.power(v);
        }
        Ok(())
    }

    /// Projects a row of output.
    fn project_row(&mut self, t: f64, y: &mut [f64]) -> Result<(), Trip> {
        let (q, rest) = y.split_at_mut(self.n_q);
        let found = self.motion.project(t, q, &mut rest[..self.n_v])?;
        self.note(y, found);
        Ok(())
    }

    /// Notes residuals and energy of a projected state.
    fn note(&mut self, y: &[f64], found: Correction) {
        self.max_position_residual = self.max_position_residual.max(found.position_residual);
        self.max_velocity_residual = self.max_velocity_residual.max(found.velocity_residual);
        let (q, v) = (&y[..self.n_q], &y[self.n_q..self.n_q + self.n_v]);
        let work = y.get(self.n_q + self.n_v).copied().unwrap_or(0.0);
        let mechanism = self.motion.mechanism();
        let kinetic = mechanism.kinetic_energy(v);
        let gap = kinetic + mechanism.potential_energy(q) - self.energy.start - work;
        self.energy.largest_kinetic = self.energy.largest_kinetic.max(kinetic);
        self.energy.largest_gap = self.energy.largest_gap.max(gap.abs());
    }

    fn show(
        &mut self,
        t: f64,
        y: &mut [f64],
        row: &mut impl FnMut(&mut Sample<'_, '_>) -> Result<ControlFlow<()>, Trip>,
    ) -> Result<ControlFlow<()>, Trip> {
        self.project_row(t, y)?;
        let (q, v) = (&y[..self.n_q], &y[self.n_q..self.n_q + self.n_v]);
        row(&mut Sample {
            t,
            q,
            v,
            motion: &mut self.motion,
        })
    }

    fn summary(&self) -> Summary {
        let EnergyBalance {
            largest_kinetic,
            largest_gap,
            ..
        } = self.energy;
        Summary {
            max_position_residual: self.max_position_residual,
            max_velocity_residual: self.max_velocity_residual,
            energy_balance: if largest_gap > 0.0 {
                largest_gap / largest_kinetic
            } else {
                0.0
            },
            min_pivot_ratio: self.min_pivot_ratio,
            events: self.events.clone(),
            ..Summary::default()
        }
    }
}

impl Ode for Equations<'_> {
    type Error = Trip;

    fn dim(&self) -> usize {
        self.n_q + self.n_v + usize::from(self.works)
    }

    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), Trip> {
        self.derivative(t, y, dy)
    }

    fn end_of_step(
        &mut self,
        step: &StepInfo<'_>,
        y: &mut [f64],
        dy: &mut [f64],
    ) -> Result<StepEnd, Trip> {
        self.before.copy_from_slice(y);
        let (q, rest) = y.split_at_mut(self.n_q);
        let found = self.motion.project_step(step.t, q, &mut rest[..self.n_v])?;
        let pivot_ratio = self.motion.pivot_ratio();
        for (before, y) in self.before.iter_mut().zip(&*y) {
            *before -= y;
        }
        let correction = step.norm(&self.before);
        self.derivative(step.t_rhs, y, dy)?;
        // From here on the step stands.
        self.note(y, found);
        self.events.extend(self.motion.accept());
        self.min_pivot_ratio = self.min_pivot_ratio.min(pivot_ratio);
        Ok(StepEnd::Projected {
            correction,
            evaluations: 1,
        })
    }
}
