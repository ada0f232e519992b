//! The input of code generation: a prepared mechanism and states of its motion.

use std::ops::ControlFlow;

use dynamics::{KeptRowMotion, MotionOptions, Prepared, simulate};
use model::record::Input;

use crate::error::CodeError;

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

/// A prepared mechanism and states of the motion that its code is made for.
pub struct Subject<'a> {
    /// The mechanism, its start and its kept rows.
    pub prepared: &'a Prepared,
    /// States of the motion; the start is the first.
    pub states: Vec<State>,
}

impl<'a> Subject<'a> {
    /// The start alone.
    #[must_use]
    pub fn at_start(prepared: &'a Prepared) -> Self {
        let (q, v) = (prepared.q.clone(), prepared.v.clone());
        let start = State { t: 0.0, q, v };
        Self {
            prepared,
            states: vec![start],
        }
    }

    /// The start and states of a run with these options.
    ///
    /// # Errors
    /// If the run stops.
    pub fn of_run(prepared: &'a Prepared, options: &MotionOptions) -> Result<Self, CodeError> {
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
        Ok(Self { prepared, states })
    }

    /// The value of an input at a state.
    pub(crate) fn input(&self, input: Input, state: &State) -> f64 {
        match input {
            Input::Coordinate(k) => state.q[k],
            Input::Cos(k) => state.q[k].cos(),
            Input::Sin(k) => state.q[k].sin(),
            Input::Velocity(k) => state.v[k],
            Input::Function {
                function,
                derivative,
            } => {
                let mut functions = self.prepared.mechanism.functions();
                let Some((f, offset)) = functions.nth(function) else {
                    return f64::NAN;
                };
                let value = f.jet(state.t)[derivative];
                if derivative == 0 {
                    value - offset
                } else {
                    value
                }
            }
        }
    }

    /// Accelerations of the interpreter at a state.
    ///
    /// # Errors
    /// If there are none.
    pub fn acceleration(&self, state: &State) -> Result<Vec<f64>, CodeError> {
        let mut a = vec![0.0; state.v.len()];
        KeptRowMotion::new(self.prepared)?.acceleration(state.t, &state.q, &state.v, &mut a)?;
        Ok(a)
    }
}
