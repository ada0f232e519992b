//! The input of code generation: a prepared mechanism and states of its motion.

use std::ops::ControlFlow;

use dynamics::{KeptRowMotion, MotionOptions, PreparedMechanism, simulate};
use joints::space3::Pose;
use model::SpaceKind;
use model::record::Input;

use crate::error::CodeError;
use crate::parameters::Inputs;

/// Number of states of a run that are used to choose the pivots.
const STATES: f64 = 48.0;

/// A state of the motion.
#[derive(Clone, Debug)]
pub struct State {
    /// Time (s).
    pub t: f64,
    /// Coordinates.
    pub q: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
}

/// A prepared mechanism, and the states of the motion for which its code is generated.
pub struct Subject<'a> {
    /// The mechanism with its initial state and its independent rows.
    pub prepared: &'a PreparedMechanism,
    /// States of the motion; the first state is the initial state. The states of the described
    /// mechanism come first. The states of mechanisms with other values of the inputs follow.
    pub states: Vec<State>,
    /// For each state, the index of its mechanism in the variants of the inputs; `None` for the
    /// described mechanism.
    pub(crate) variants: Vec<Option<usize>>,
    /// The values that are inputs of the code.
    pub(crate) inputs: Inputs,
}

/// Returns the rotation matrix of a body in space; NaN if q is too short.
pub(crate) fn rotation(q: &[f64], body: usize) -> [[f64; 3]; 3] {
    let first = SpaceKind::Space3.coordinates(body).start + 3;
    let e = q.get(first..).and_then(|e| e.first_chunk());
    Pose::new([0.0; 3], e.copied().unwrap_or([f64::NAN; 4])).rot
}

impl<'a> Subject<'a> {
    /// Returns the subject with the initial state as its only state.
    #[must_use]
    pub fn at_start(prepared: &'a PreparedMechanism) -> Self {
        let (q, v) = (prepared.q.clone(), prepared.v.clone());
        Self::at_states(prepared, vec![State { t: 0.0, q, v }])
    }

    /// Returns the subject with these states and without inputs.
    pub(crate) fn at_states(prepared: &'a PreparedMechanism, states: Vec<State>) -> Self {
        Self {
            prepared,
            variants: vec![None; states.len()],
            states,
            inputs: Inputs::default(),
        }
    }

    /// Returns the subject with the initial state and the states of a run with these options.
    ///
    /// # Errors
    /// Returns an error if the run stops.
    pub fn of_run(
        prepared: &'a PreparedMechanism,
        options: &MotionOptions,
    ) -> Result<Self, CodeError> {
        if options.t_end == 0.0 {
            return Ok(Self::at_start(prepared));
        }
        let options = MotionOptions {
            output_step: options.t_end / STATES,
            ..options.clone()
        };
        let mut states = Vec::new();
        simulate(prepared, &options, |row| {
            states.push(State {
                t: row.t,
                q: row.q.to_vec(),
                v: row.v.to_vec(),
            });
            Ok(ControlFlow::Continue(()))
        })?;
        Ok(Self::at_states(prepared, states))
    }

    /// Returns the value of the input with index `k` at the state with this index.
    pub(crate) fn number(&self, k: usize, state: usize) -> f64 {
        match self.variants[state] {
            Some(variant) => self.inputs.variants[variant].values[k],
            None => self.inputs.list[k].described,
        }
    }

    /// Returns the value of an input of the mechanism at the state with this index.
    pub(crate) fn input_at(&self, input: Input, state: usize) -> f64 {
        match (input, self.variants[state]) {
            (
                Input::Function {
                    function,
                    derivative,
                },
                Some(variant),
            ) => {
                let f = self.inputs.variants[variant].functions.get(function);
                f.map_or(f64::NAN, |f| f.jet(self.states[state].t)[derivative])
            }
            _ => self.input(input, &self.states[state]),
        }
    }

    /// Returns the value of an input of the mechanism at a state of the described mechanism.
    pub(crate) fn input(&self, input: Input, state: &State) -> f64 {
        match input {
            Input::Coordinate(k) => state.q[k],
            Input::Cos(k) => state.q[k].cos(),
            Input::Sin(k) => state.q[k].sin(),
            Input::Rotation { body, row, column } => rotation(&state.q, body)[row][column],
            Input::Velocity(k) => state.v[k],
            Input::Function {
                function,
                derivative,
            } => {
                let mut functions = self.prepared.mechanism.functions();
                let f = functions.nth(function);
                f.map_or(f64::NAN, |f| f.jet(state.t)[derivative])
            }
        }
    }

    /// Returns the accelerations that the interpreter computes at a state.
    ///
    /// # Errors
    /// Returns an error if the equations have no solution at this state.
    pub fn acceleration(&self, state: &State) -> Result<Vec<f64>, CodeError> {
        let mut a = vec![0.0; state.v.len()];
        KeptRowMotion::new(self.prepared)?.acceleration(state.t, &state.q, &state.v, &mut a)?;
        Ok(a)
    }
}
