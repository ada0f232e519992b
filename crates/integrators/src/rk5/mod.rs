//! Pairs of order 5(4) with seven stages. The last stage is the first stage of the next step. Both
//! pairs share one implementation with two tables of coefficients.

mod dense;
mod dopri5;
mod step;
mod tableau;
mod tsit5;

#[cfg(test)]
mod order_conditions;

pub use dopri5::Dopri5;
use tableau::Tableau;
pub use tsit5::Tsit5;

use crate::control::{Control, ControlConstants};
use crate::method::Method;
use crate::ode::Ode;
use std::marker::PhantomData;

impl<O: Ode> Method<O> for Dopri5 {
    type Stepper = Rk5Stages<Self>;

    fn stepper(&self, ode: &O) -> Rk5Stages<Self> {
        Rk5Stages::new(ode.dim())
    }
}

impl<O: Ode> Method<O> for Tsit5 {
    type Stepper = Rk5Stages<Self>;

    fn stepper(&self, ode: &O) -> Rk5Stages<Self> {
        Rk5Stages::new(ode.dim())
    }
}

/// The constants of the program DOPRI5 of Hairer and Wanner for both pairs: α = 1/5 − ¾·β.
const CONTROL: ControlConstants = ControlConstants {
    alpha: 0.2 - 0.75 * 0.04,
    beta: 0.04,
    safety: 0.9,
    min_factor: 0.2,
    max_factor: 10.0,
};

/// Stages and buffers. The first stage is the derivative at the start of the step, which the caller
/// stores.
#[derive(Debug)]
pub struct Rk5Stages<T> {
    control: Control,
    /// Stages 2 to 7 of the last trial.
    k: [Vec<f64>; 6],
    /// Derivatives f at `NODE_A` and `NODE_B` of the last prepared step.
    f_a: Vec<f64>,
    f_b: Vec<f64>,
    /// Buffer for the argument of a stage.
    y: Vec<f64>,
    tableau: PhantomData<T>,
}

impl<T> Rk5Stages<T> {
    /// Allocates storage for `dim` components.
    pub(crate) fn new(dim: usize) -> Self {
        let zeros = || vec![0.0; dim];
        Self {
            control: Control::new(CONTROL),
            k: std::array::from_fn(|_| zeros()),
            f_a: zeros(),
            f_b: zeros(),
            y: zeros(),
            tableau: PhantomData,
        }
    }
}
