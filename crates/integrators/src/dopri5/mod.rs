//! Dormand–Prince 5(4): seven stages of which the last is the first of the next step, order 5, error estimate of order 4.
//!
//! Source: J. R. Dormand, P. J. Prince, A family of embedded Runge–Kutta formulae, J. Comput. Appl. Math. 6 (1980) 19–26,
//! DOI 10.1016/0771-050X(80)90013-3.

mod dense;
mod step;
mod tableau;

#[cfg(test)]
mod order_conditions;

use crate::control::{Control, ControlConstants};
use crate::method::Method;
use crate::ode::Ode;

/// Dormand–Prince 5(4), seven stages, the last one reused; known as `ode45`. Order 5. Dense output of order 4
/// (local error O(h⁵)) without and of order 5 (local error O(h⁶), like the step) with two extra evaluations in the step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Dopri5;

impl<O: Ode> Method<O> for Dopri5 {
    type Stepper = Stages;

    fn stepper(&self, ode: &O) -> Stages {
        Stages::new(ode.dim())
    }
}

/// Those of the program DOPRI5 of Hairer and Wanner: α = 1/5 − ¾·β.
const CONTROL: ControlConstants = ControlConstants {
    alpha: 0.2 - 0.75 * 0.04,
    beta: 0.04,
    safety: 0.9,
    min_factor: 0.2,
    max_factor: 10.0,
};

/// Stages and scratch; the first stage is the derivative at the start of the step, kept by the caller.
#[derive(Debug)]
pub struct Stages {
    control: Control,
    /// Stages 2 to 7 of the last trial.
    k: [Vec<f64>; 6],
    /// f at `NODE_A`, `NODE_B` of the last prepared step.
    f_a: Vec<f64>,
    f_b: Vec<f64>,
    /// Argument of a stage.
    y: Vec<f64>,
}

impl Stages {
    /// Room for `dim` components.
    pub(crate) fn new(dim: usize) -> Self {
        let zeros = || vec![0.0; dim];
        Self {
            control: Control::new(CONTROL),
            k: std::array::from_fn(|_| zeros()),
            f_a: zeros(),
            f_b: zeros(),
            y: zeros(),
        }
    }
}
