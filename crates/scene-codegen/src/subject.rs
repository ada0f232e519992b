//! The input of code generation: a prepared mechanism and states of its motion.

use std::ops::ControlFlow;

use dynamics::{KeptRowMotion, MotionOptions, PreparedMechanism, simulate};
use joints::space3::Pose;
use model::SpaceKind;
use model::record::Input;

use crate::error::CodeError;
use crate::parameters::Inputs;

/// Number of states of a run for the choice of pivots.
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
    /// The mechanism, its start and its independent rows.
    pub prepared: &'a PreparedMechanism,
    /// States of the motion; the start is the first one. The states of the described mechanism are
    /// followed by those of mechanisms in which the inputs have other values.
    pub states: Vec<State>,
    /// For each state, the index of its mechanism; `None` for the described one.
    pub(crate) variants: Vec<Option<usize>>,
    /// The numbers that code takes as inputs.
    pub(crate) inputs: Inputs,
}

/// The matrix of the rotation of a body in space; NaN if q is too short.
pub(crate) fn rotation(q: &[f64], body: usize) -> [[f64; 3]; 3] {
    let first = SpaceKind::Space3.coordinates(body).start + 3;
    let e = q.get(first..).and_then(|e| e.first_chunk());
    Pose::new([0.0; 3], e.copied().unwrap_or([f64::NAN; 4])).rot
}

impl<'a> Subject<'a> {
    /// The subject with the start as its only state.
    #[must_use]
    pub fn at_start(prepared: &'a PreparedMechanism) -> Self {
        let (q, v) = (prepared.q.clone(), prepared.v.clone());
        Self::at_states(prepared, vec![State { t: 0.0, q, v }])
    }

    /// The subject with these states and without inputs.
    pub(crate) fn at_states(prepared: &'a PreparedMechanism, states: Vec<State>) -> Self {
        Self {
            prepared,
            variants: vec![None; states.len()],
            states,
            inputs: Inputs::default(),
        }
    }

    /// The start and states of a run with these options.
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

    /// The value of the input with this index among the numbers of the mechanism, at the state with
    /// this index.
    pub(crate) fn number(&self, k: usize, state: usize) -> f64 {
        match self.variants[state] {
            Some(variant) => self.inputs.variants[variant].values[k],
            None => self.inputs.list[k].described,
        }
    }

    /// The value of an input at the state with this index.
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

    /// The value of an input at a state of the described mechanism.
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

    /// Accelerations of the interpreter at a state.
    ///
    /// # Errors
    /// Returns an error if the equations have no solution at this state.
    pub fn acceleration(&self, state: &State) -> Result<Vec<f64>, CodeError> {
        let mut a = vec![0.0; state.v.len()];
        KeptRowMotion::new(self.prepared)?.acceleration(state.t, &state.q, &state.v, &mut a)?;
        Ok(a)
    }
}
