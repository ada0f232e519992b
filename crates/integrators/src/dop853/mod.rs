//! Dormand–Prince 8(5,3): twelve stages and order 8. Error estimates of order 5 and 3 are combined.
//! The dense outputs have the orders 6 and 8.
//!
//! Source: the program DOP853 of E. Hairer and G. Wanner; Hairer, Nørsett, Wanner, Solving Ordinary
//! Differential Equations I, 2nd ed., II.5, II.10. The dense outputs were developed for this crate.

mod dense;
mod step;
mod tableau;

#[cfg(test)]
mod order_conditions;

use crate::control::{Control, ControlConstants};
use crate::method::Method;
use crate::ode::Ode;
use tableau::{STAGES, STEP_STAGES};

/// Dormand–Prince 8(5,3), the method for smooth problems with tolerances of 1e-6 and below. The
/// method has order 8. An accepted step costs twelve evaluations, including the derivative at its
/// end; a rejected step costs eleven. The dense output has order 6 (local error O(h⁷)) without
/// extra evaluations, and order 8 (local error O(h⁹), like the step) with six extra evaluations in
/// the step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Dop853;

impl<O: Ode> Method<O> for Dop853 {
    type Stepper = Dop853Stages;

    fn stepper(&self, ode: &O) -> Dop853Stages {
        Dop853Stages::new(ode.dim())
    }
}

/// The constants of the program DOP853. The controller has no memory of the previous error.
const CONTROL: ControlConstants = ControlConstants {
    alpha: 1.0 / 8.0,
    beta: 0.0,
    safety: 0.9,
    min_factor: 0.333,
    max_factor: 6.0,
};

/// Stages and buffers. Stages 1 and 13 are the derivatives at the ends of the step, which the
/// caller stores.
#[derive(Debug)]
pub struct Dop853Stages {
    control: Control,
    /// Stages 2 to 12 of the last trial.
    k: [Vec<f64>; 11],
    /// Stages 14 to 19 of the last prepared step.
    extra: [Vec<f64>; STAGES - STEP_STAGES],
    /// Buffer for the argument of a stage.
    y: Vec<f64>,
}

impl Dop853Stages {
    /// Allocates storage for `dim` components.
    pub(crate) fn new(dim: usize) -> Self {
        let zeros = || vec![0.0; dim];
        Self {
            control: Control::new(CONTROL),
            k: std::array::from_fn(|_| zeros()),
            extra: std::array::from_fn(|_| zeros()),
            y: zeros(),
        }
    }
}
