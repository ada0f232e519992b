//! Dormand–Prince 5(4): seven stages of which the last is the first of the next step, order 5, error estimate of order 4.
//!
//! Source: J. R. Dormand, P. J. Prince, A family of embedded Runge–Kutta formulae, J. Comput. Appl. Math. 6 (1980) 19–26,
//! DOI 10.1016/0771-050X(80)90013-3.

mod dense;
mod step;
mod tableau;

#[cfg(test)]
mod order_conditions;

/// Stages and scratch; the first stage is the derivative at the start of the step, kept by the caller.
#[derive(Debug)]
pub(crate) struct Dopri5 {
    /// Stages 2 to 7 of the last trial.
    k: [Vec<f64>; 6],
    /// f at `NODE_A`, `NODE_B` of the last prepared step.
    f_a: Vec<f64>,
    f_b: Vec<f64>,
    /// Argument of a stage.
    y: Vec<f64>,
}

impl Dopri5 {
    /// Room for `dim` components.
    pub(crate) fn new(dim: usize) -> Self {
        let zeros = || vec![0.0; dim];
        Self {
            k: std::array::from_fn(|_| zeros()),
            f_a: zeros(),
            f_b: zeros(),
            y: zeros(),
        }
    }
}
