//! A run that its caller advances. Between two steps the caller reads the state, and changes the
//! values that a controller of the mechanism returns.

use std::ops::ControlFlow;

use integrators::{End, InitialStep, Interval, Ode, Options, OutputTimes, Rows};
use model::System;

use super::caller::Stop;
use super::component::{cause, check_finite};
use super::equations::RunEquations;
use super::integration::Run;
use super::sample::{AtRows, Sample};
use crate::choose;
use crate::error::{MotionError, MotionFault};
use crate::events::Event;
use crate::motion::KeptRowMotion;
use crate::options::{Method, MotionOptions};
use crate::prepare::PreparedMechanism;

/// A run that the caller advances from one time to another.
///
/// ```
/// use joints::{Revolute, RevoluteAngleDrive};
/// use model::{Body, BodyRef, Description, Law, Mechanism, StartOptions};
/// use pfaff_dynamics::{MotionOptions, RowChoice, Simulator, prepare};
/// use std::sync::atomic::{AtomicU64, Ordering};
/// use std::sync::Arc;
/// // A wheel of 0.5 kg·m², whose torque is changed from 1 N·m to −1 N·m after 2 s.
/// let torque = Arc::new(AtomicU64::new(1.0_f64.to_bits()));
/// let held = Arc::clone(&torque);
/// let mut d = Description::new("wheel");
/// let wheel = d.body(Body::new("wheel", 1.0, 0.5));
/// let (bodies, o) = ([BodyRef::Ground, wheel], [0.0, 0.0]);
/// d.joint("shaft", &bodies, Revolute { s_i: o, s_j: o });
/// let law = Law::called(move |_| Ok(f64::from_bits(held.load(Ordering::Relaxed))));
/// d.drive_by_law("motor", &bodies, RevoluteAngleDrive::new(o, o), law)?;
/// let mechanism = Mechanism::build(&d).unwrap();
/// let prepared = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic)?;
/// let mut simulator = Simulator::new(&prepared, &MotionOptions::to(0.0), &|| false)?;
/// simulator.step(2.0)?;
/// torque.store((-1.0_f64).to_bits(), Ordering::Relaxed);
/// simulator.step(4.0)?;
/// let (t, q, v) = simulator.state();
/// assert!(t == 4.0 && (q[2] - 8.0).abs() < 1e-9 && v[2].abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Simulator<'m> {
    equations: RunEquations<'m>,
    method: Method,
    settings: Options,
    t: f64,
    y: Vec<f64>,
    /// Whether rates may jump at the current time.
    is_before_jump: bool,
    evaluations: u64,
}

impl<'m> Simulator<'m> {
    /// Starts a run at the start of a prepared mechanism. The run has the tolerances, the largest
    /// step, the method and the stabilisation of `options`. An evaluation ends the step if `stop`
    /// returns true.
    ///
    /// # Errors
    /// Returns the same errors as a run before its first step.
    pub fn new(
        prepared: &'m PreparedMechanism,
        options: &MotionOptions,
        stop: &'m Stop<'m>,
    ) -> Result<Self, MotionError> {
        options.check()?;
        check_finite(prepared)?;
        let method = choose::method(prepared, options)?.value;
        let options = &MotionOptions {
            method,
            ..options.clone()
        };
        let t = prepared.start_time();
        let mut motion = KeptRowMotion::with(prepared, options)?;
        motion.begin(t, &mut prepared.q.clone())?;
        let wanted = AtRows {
            on_constraints: true,
            accelerations: true,
            reactions: (0..motion.mechanism().layout().groups.len()).collect(),
            uniqueness: true,
        };
        let wanted = (wanted, None);
        let equations = RunEquations::new(motion, prepared, options, wanted, (&[], None), stop);
        Ok(Self {
            settings: Options {
                tolerance: equations.tolerance(options),
                max_step: options.max_step,
                max_steps: options.max_steps,
                ..Options::with_tolerance(options.rtol, options.atol)
            },
            y: equations.y0(),
            equations,
            method,
            t,
            is_before_jump: false,
            evaluations: 0,
        })
    }

    /// Advances the run to a later time (s). Returns the events of the step.
    ///
    /// # Errors
    /// Returns the same errors as a run. The state is then the last accepted state, and the run can
    /// be continued.
    pub fn step(&mut self, to: f64) -> Result<Vec<Event>, MotionError> {
        if !(to.is_finite() && to > self.t) {
            return Err(MotionError::Option {
                name: "the time of a step",
                value: to,
                expected: "a finite time after the time of the simulator",
            });
        }
        self.equations.run_until(to);
        if std::mem::take(&mut self.is_before_jump) {
            self.equations.at_break(self.t.next_up(), &mut self.y)?;
        }
        let layout = self.equations.motion.mechanism().layout();
        let interval = Interval {
            t0: self.t,
            t_end: to,
            break_times: &layout.break_times,
        };
        let rows = Rows::new(OutputTimes::At(Vec::new()), &interval);
        let rows = rows.map_err(super::caller::named)?;
        let mut no_row = |_: &mut Sample<'_, '_>| Ok(ControlFlow::Continue(()));
        let watch = |_| ControlFlow::Continue(());
        let mut run = Run::new(&mut self.equations, rows, &mut no_row, &watch);
        let outcome = run.go(self.method, &interval, &self.y, &self.settings);
        let (ended, stopped) = (run.ended, run.stopped.take());
        let (t, y, statistics, next) = match &outcome {
            Ok(found) => (found.t, &found.y, found.statistics, found.next_step),
            Err(failure) => (failure.t, &failure.y, failure.statistics, None),
        };
        (self.t, self.evaluations) = (t, self.evaluations + statistics.total_evaluations());
        self.y.copy_from_slice(y);
        self.is_before_jump = self.equations.is_break(t);
        if let Some(next) = next {
            // The last step was shortened by the end of the interval.
            let known = match self.settings.initial_step {
                InitialStep::Given(known) if statistics.rejected() == 0 => known,
                _ => 0.0,
            };
            self.settings.initial_step = InitialStep::Given(next.max(known));
        }
        let events = self.equations.record.take_events();
        let is_whole = matches!(&outcome, Ok(found) if found.end == End::Reached);
        match cause(&mut self.equations, outcome, stopped) {
            Some(error) => Err(error),
            None if is_whole && ended.is_none() => Ok(events),
            None => Err(MotionFault::Interrupted { time: self.t }.into()),
        }
    }

    /// Returns the time (s), the coordinates and the velocities.
    #[must_use]
    pub fn state(&self) -> (f64, &[f64], &[f64]) {
        let (q, v) = self.equations.motion.parts(&self.y);
        (self.t, q, v)
    }

    /// Returns the number of evaluations of accelerations by all steps, including rejected steps.
    #[must_use]
    pub fn evaluations(&self) -> u64 {
        self.evaluations
    }

    /// Evaluates the accelerations and reactions at the current state. `read` receives the same
    /// sample as the rows of a run.
    ///
    /// # Errors
    /// Returns an error if the equations have no unique solution at this state.
    pub fn sample(&mut self, mut read: impl FnMut(&mut Sample<'_, '_>)) -> Result<(), MotionFault> {
        let mut y = self.y.clone();
        let mut row = |sample: &mut Sample<'_, '_>| {
            read(sample);
            Ok(ControlFlow::Continue(()))
        };
        self.equations.show(self.t, &mut y, &mut row).map(drop)
    }
}

#[cfg(test)]
mod tests;
