//! A half-explicit Runge–Kutta method of order 4: explicit in q and v, while each stage's multipliers make the velocities of the next stage
//! obey the constraints (index 2). It never needs the derivatives of G.
//!
//! Source: Brasey, Hairer 1993, see `tableau`; E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 2nd ed., VII.6.

mod step;
mod tableau;

#[cfg(test)]
mod tests;

use crate::constrained::{Constrained, Sizes};
use crate::control::{Control, ControlConstants};
use crate::method::Method;

/// Half-explicit Runge–Kutta method of order 4 with five stages; error estimate of order 3 from the stages and both ends.
///
/// The velocities at the end obey the constraints to rounding; the positions drift with the error of the method and are left to
/// [`Ode::end_of_step`](crate::Ode::end_of_step). Dense output with local error O(h⁴) without and O(h⁵) with one extra evaluation in the
/// step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Hem4;

impl<O: Constrained> Method<O> for Hem4 {
    type Stepper = Stages;

    fn stepper(&self, ode: &O) -> Stages {
        Stages::new(ode.dim(), ode.sizes())
    }
}

/// For an estimate of order 3, with the exponents' ratio of Dormand–Prince 5(4).
const CONTROL: ControlConstants = ControlConstants {
    alpha: 0.25 - 0.75 * 0.04,
    beta: 0.04,
    safety: 0.9,
    min_factor: 0.2,
    max_factor: 5.0,
};

/// Stages and scratch.
#[derive(Debug)]
pub struct Stages {
    control: Control,
    sizes: Sizes,
    /// Derivatives of the stages.
    k: [Vec<f64>; 5],
    /// Derivative at the end of the last trial.
    f1: Vec<f64>,
    /// Argument of a stage.
    y: Vec<f64>,
    /// Positions and velocities at which a stage aims.
    target: Vec<f64>,
    /// Defect of the cubic output at its extra place.
    defect: Vec<f64>,
}

impl Stages {
    fn new(dim: usize, sizes: Sizes) -> Self {
        let zeros = || vec![0.0; dim];
        Self {
            control: Control::new(CONTROL),
            sizes,
            k: std::array::from_fn(|_| zeros()),
            f1: zeros(),
            y: zeros(),
            target: zeros(),
            defect: zeros(),
        }
    }
}
