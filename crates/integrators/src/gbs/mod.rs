//! Extrapolation of the explicit midpoint rule (Gragg, Bulirsch, Stoer): orders 4 to 18, chosen step by step together with the size.
//!
//! Column j crosses the step with n_j equal substeps of the midpoint rule; the results of columns 1 to k, extrapolated to infinitely
//! many substeps, have order 2k. The step is not smoothed at its end, which saves one evaluation a column.
//!
//! Source: the program ODEX of E. Hairer and G. Wanner; Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I,
//! 2nd ed., II.9.

mod dense;
mod order;
mod sequence;
mod step;

#[cfg(test)]
mod tests;

use crate::method::Method;
use crate::ode::Ode;
use dense::Polynomial;
use order::OrderControl;
use sequence::{COLUMNS, substeps};

/// Extrapolation of the midpoint rule, for very tight tolerances. Order 4 to 18, adapted. Dense output through both ends and the middle
/// without extra evaluations (of order 5, [`Step::interpolate`]), or through many derivatives at the middle with two extra evaluations
/// that check it, and more where it is not as accurate as the step ([`Step::interpolate_accurately`]).
///
/// [`Step::interpolate`]: crate::Step::interpolate
/// [`Step::interpolate_accurately`]: crate::Step::interpolate_accurately
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Gbs;

impl<O: Ode> Method<O> for Gbs {
    type Stepper = Extrapolation;

    fn stepper(&self, ode: &O) -> Extrapolation {
        Extrapolation::new(ode.dim())
    }
}

/// Columns of the last trial and the memory of the control.
#[derive(Debug)]
pub struct Extrapolation {
    control: OrderControl,
    columns: [Column; COLUMNS],
    /// The two last states of the midpoint rule.
    previous: Vec<f64>,
    present: Vec<f64>,
    /// Error norm of the last trial.
    error: f64,
    /// Weights of the error norm of the last trial.
    scale: Vec<f64>,
    /// Change of the state and f at the middle of the last trial.
    to_middle: Vec<f64>,
    f_middle: Vec<f64>,
    /// Accurate dense output of the last prepared step: so many pieces, and for each one polynomial a component.
    pieces: usize,
    polynomials: Vec<Polynomial>,
    /// y0, f0, y1, f1 of a piece.
    piece_ends: [Vec<f64>; 4],
}

/// What one column leaves behind.
#[derive(Debug)]
struct Column {
    /// Change of the state over the whole step and over its first half.
    to_end: Vec<f64>,
    to_middle: Vec<f64>,
    /// f after 1, 2, …, n_j − 1 substeps.
    f: Vec<Vec<f64>>,
}

impl Extrapolation {
    /// Room for `dim` components.
    pub(crate) fn new(dim: usize) -> Self {
        let zeros = || vec![0.0; dim];
        let column = |j: usize| Column {
            to_end: zeros(),
            to_middle: zeros(),
            f: (1..substeps(j)).map(|_| zeros()).collect(),
        };
        Self {
            control: OrderControl::new(),
            columns: std::array::from_fn(|i| column(i + 1)),
            previous: zeros(),
            present: zeros(),
            error: 0.0,
            scale: zeros(),
            to_middle: zeros(),
            f_middle: zeros(),
            pieces: 1,
            polynomials: vec![dense::ZERO; dense::PIECES * dim],
            piece_ends: std::array::from_fn(|_| zeros()),
        }
    }
}
