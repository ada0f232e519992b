//! Our runs of mechanisms, with projection after each step, monitors and energy balance. Steps end
//! at break times, and there are two rows of output.

use std::ops::ControlFlow;

use dynamics::{Method, MotionOptions, PreparedMechanism, simulate};

use crate::problem::{Asked, End, Solved, array};

/// A run with a method; Radau IIA uses independent coordinates, and the other methods all
/// coordinates on independent rows with projection.
pub fn run<const N: usize>(method: Method, prepared: &PreparedMechanism, asked: &Asked<'_, N>) -> Solved<N> {
    let options = MotionOptions {
        output_step: asked.t_end,
        rtol: asked.rtol,
        atol: asked.atol,
        method,
        ..MotionOptions::to(asked.t_end)
    };
    let mut last = Vec::new();
    let summary = simulate(prepared, &options, |sample| {
        last = [sample.q, sample.v].concat();
        Ok(ControlFlow::Continue(()))
    })
    .map_err(|failure| failure.to_string())?;
    Ok(End {
        y: *array(&last),
        evaluations: summary.evaluations,
        steps: summary.steps,
    })
}
