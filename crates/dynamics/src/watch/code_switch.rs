//! Switching between generated code and the interpreter. Generated code is used as long as its
//! results are reliable at every stage and step. Otherwise the interpreter continues from the last
//! accepted state. This module never ends a run. The module [`crate::code`] checks whether code
//! belongs to a mechanism.
//!
//! The interpreter does not run while generated code is used. Before it continues the run, it
//! evaluates the last two accepted states, because it predicts singular configurations from the
//! pivots of two states.

use model::System;

use super::passage::Now;
use super::pivots::are_delicate;
use super::step_end::Monitors;
use crate::code::SceneCode;
use crate::error::MotionFault;
use crate::events::{Event, EventKind};
use crate::guards::GUARDED;
use crate::limits::{PATIENCE, RETURN, SAME_ACCELERATIONS};
use crate::manifold::{CodeProjection, Correction, Manifold};
use crate::solve::{Accelerations, Doubt, GeneratedCode, KeptEquations, State};

/// The present evaluator of the equations.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    /// The generated code.
    Code,
    /// The interpreter. The interpreter has not yet evaluated the last accepted states.
    Waking,
    /// The interpreter, for this number of accepted steps.
    Interpreter(u64),
}

/// The state at the end of an accepted step.
#[derive(Clone, Debug, Default)]
struct AcceptedState {
    t: f64,
    q: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
}

impl AcceptedState {
    fn take(&mut self, now: Now<'_>) {
        self.t = now.t;
        for (kept, x) in [
            (&mut self.q, now.q),
            (&mut self.v, now.v),
            (&mut self.a, now.a),
        ] {
            kept.clear();
            kept.extend_from_slice(x);
        }
    }
}

/// Generated code of a motion, and whether it is in use.
pub(crate) struct CodeSwitch<'m> {
    code: GeneratedCode<'m>,
    projection: CodeProjection,
    phase: Phase,
    /// Evaluations by generated code since the last accepted step.
    evaluations: u64,
    /// Number of accepted steps before generated code may be used again.
    patience: u64,
    /// The last two states accepted with generated code, the last state first, and the number of
    /// these states.
    accepted: [AcceptedState; 2],
    n_accepted: usize,
    departure: Option<Departure>,
    /// Work memory for accelerations of generated code that may be used again, n_v values.
    found: Vec<f64>,
}

/// The switch from generated code to the interpreter.
pub(crate) struct Departure {
    /// The event that reports the switch.
    pub(crate) event: Event,
    /// Whether stages of the current step were evaluated by generated code. In this case the step
    /// must start again.
    pub(crate) is_within_step: bool,
}

impl<'m> CodeSwitch<'m> {
    /// Creates the switch. The switch uses generated code from time t on, starting from the state
    /// q.
    pub(crate) fn new(
        code: &'m dyn SceneCode,
        equations: &mut KeptEquations<'_>,
        (t, q): (f64, &[f64]),
    ) -> Self {
        equations.at.pose(t, q);
        let projection = CodeProjection::new(equations, q);
        Self {
            code: GeneratedCode(code),
            projection,
            phase: Phase::Code,
            evaluations: 0,
            patience: PATIENCE,
            accepted: Default::default(),
            n_accepted: 0,
            departure: None,
            found: vec![0.0; equations.at.mechanism.mass().len()],
        }
    }

    /// Returns the generated code if it is in use.
    pub(crate) fn in_use(&mut self) -> Option<&mut GeneratedCode<'m>> {
        (self.phase == Phase::Code).then_some(&mut self.code)
    }

    /// Returns whether generated code is in use.
    pub(crate) fn is_in_use(&self) -> bool {
        self.phase == Phase::Code
    }

    /// Computes accelerations for an evaluation of a run. Returns `false` if the interpreter must
    /// compute the accelerations. If the generated code is unreliable, the motion stops using it.
    pub(crate) fn evaluate(
        &mut self,
        state: State<'_>,
        a: &mut [f64],
        (equations, watch): (&KeptEquations<'_>, &Monitors),
    ) -> bool {
        if !self.is_in_use() {
            return false;
        }
        match self.code.accelerations(state, a) {
            Ok(()) => {
                self.evaluations += 1;
                true
            }
            Err(doubt) => {
                self.leave(state.t, doubt, (equations, watch));
                false
            }
        }
    }

    /// Moves a state onto the constraint manifold by generated code. If the result is unreliable,
    /// the state is unchanged.
    pub(crate) fn project(
        &mut self,
        equations: &KeptEquations<'_>,
        t: f64,
        state: (&mut [f64], &mut [f64]),
    ) -> Result<Correction, Doubt> {
        let mechanism = equations.at.mechanism;
        self.projection.project(&self.code, mechanism, t, state)
    }

    /// Stores a state accepted with generated code.
    pub(crate) fn accept(&mut self, now: Now<'_>) {
        if GUARDED {
            self.accepted.swap(0, 1);
            self.accepted[0].take(now);
            self.n_accepted = (self.n_accepted + 1).min(2);
            self.evaluations = 0;
        }
    }

    /// Resets the predictions after a jump of the velocities at t, because states before the jump
    /// cannot be used for predictions.
    pub(crate) fn restart(
        &mut self,
        equations: &mut KeptEquations<'_>,
        watch: &mut Monitors,
        t: f64,
    ) {
        if self.is_in_use() {
            self.n_accepted = 0;
            watch.passage.take(&mut equations.velocity, t);
        }
    }

    /// Returns the departure once, after the motion stopped using generated code.
    pub(crate) fn take_departure(&mut self) -> Option<Departure> {
        self.departure.take()
    }

    /// Predicts singular configurations from the last two states accepted with generated code. The
    /// prediction is for steps of the same length.
    pub(crate) fn look_ahead(&self, equations: &KeptEquations<'_>, watch: &mut Monitors) {
        let [AcceptedState { t, q, v, a }, before] = &self.accepted;
        match self.n_accepted {
            2 => watch.look_ahead(equations, Now { t: *t, q, v, a }, t - before.t),
            _ => watch.delicate = None,
        }
    }

    /// Returns to generated code at an accepted, interpreted state far from singular
    /// configurations. This requires that the health of the code has recovered and that enough
    /// steps have passed.
    pub(crate) fn come_back(
        &mut self,
        equations: &KeptEquations<'_>,
        Now { t, q, v, a }: Now<'_>,
    ) -> Option<Event> {
        let Phase::Interpreter(steps) = &mut self.phase else {
            return None;
        };
        *steps += 1;
        let is_early = *steps < self.patience;
        let spec = self.code.0.spec();
        let has_its_rows = equations.requested_rows.is_none()
            && *equations.velocity.kept == *spec.kept
            && *equations.position.kept == *spec.position_kept;
        if is_early || !has_its_rows || are_delicate(&equations.velocity) {
            return None;
        }
        let found = &mut self.found;
        let health = self.code.0.acceleration(t, q, v, found);
        for (found, a) in found.iter_mut().zip(a) {
            *found -= a;
        }
        let at = &equations.at;
        let largest = |x: &[f64]| {
            let (space, shares) = (at.mechanism.space(), x.iter().enumerate());
            let shares = shares.map(|(j, x)| x.abs() / space.unit(j, at.size));
            shares.fold(0.0, f64::max)
        };
        let is_same = largest(found) <= SAME_ACCELERATIONS * largest(a).max(largest(v).powi(2));
        if !(health >= RETURN && is_same && found.iter().all(|x| x.is_finite())) {
            return None;
        }
        self.phase = Phase::Code;
        self.patience = self.patience.saturating_mul(2);
        self.n_accepted = 0;
        self.evaluations = 0;
        let text = format!(
            "the generated code `{}` is used again: its pivots are at {health:.2} of those that it was generated for. The motion is the same.",
            spec.name
        );
        let dropped = &equations.velocity.dropped;
        Some(Event::at(t, EventKind::CodeUsed, dropped, text))
    }

    /// Switches from generated code to the interpreter, at an evaluation or a projection at time t.
    pub(crate) fn leave(
        &mut self,
        t: f64,
        doubt: Doubt,
        (equations, watch): (&KeptEquations<'_>, &Monitors),
    ) {
        self.phase = Phase::Waking;
        let since = match self.n_accepted {
            0 => watch.passage.since(),
            _ => self.accepted[0].t,
        };
        let text = format!(
            "the generated code `{}` is not used from t = {t} s on, because {doubt}; the equations are then interpreted. The motion is the same.",
            self.code.0.spec().name
        );
        let dropped = &equations.velocity.dropped;
        self.departure = Some(Departure {
            event: Event::at(since, EventKind::CodeLeft, dropped, text),
            is_within_step: self.evaluations > 0,
        });
    }

    /// Passes the last accepted states of generated code to the interpreter, if this has not yet
    /// been done.
    pub(crate) fn wake_up(
        &mut self,
        equations: &mut KeptEquations<'_>,
        manifold: &mut Manifold,
        watch: &mut Monitors,
    ) -> Result<(), MotionFault> {
        if self.phase != Phase::Waking {
            return Ok(());
        }
        for AcceptedState { t, q, v, a } in self.accepted[..self.n_accepted].iter_mut().rev() {
            manifold.settle(equations, *t, q)?;
            watch.passage.take(&mut equations.velocity, *t);
            watch.enter(equations, Now { t: *t, q, v, a });
        }
        self.phase = Phase::Interpreter(0);
        Ok(())
    }
}
