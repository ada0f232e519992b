//! Accelerations and multipliers at one state: by kept rows, dense or sparse, plain or refined, or
//! by generated code. Not here: how a state gets onto the constraints ([`crate::manifold`]), and
//! what becomes of a step ([`crate::watch`]).

mod dense;
mod equations;
mod evaluation;
mod generated;
mod rows;
mod solver;
mod sparse;
mod units;

pub(crate) use equations::KeptEquations;
pub(crate) use evaluation::Evaluation;
pub(crate) use generated::{Doubt, GeneratedCode};
pub(crate) use rows::KeptRows;
pub(crate) use solver::{is_sparse, memory};
pub(crate) use units::{is_far, mass_spread};

/// A time with coordinates and velocities.
#[derive(Clone, Copy)]
pub(crate) struct State<'a> {
    pub(crate) t: f64,
    pub(crate) q: &'a [f64],
    pub(crate) v: &'a [f64],
}

/// What solves `M·v̇ + Cᵀ·λ = Q`, `C·v̇ = Γ` at a state.
pub(crate) trait Accelerations {
    /// Why there is no solution.
    type Fault;

    /// v̇, n_v.
    fn accelerations(&mut self, state: State<'_>, a: &mut [f64]) -> Result<(), Self::Fault>;

    /// λ of all rows, 0 for dropped ones.
    fn multipliers(&mut self, state: State<'_>, lambda: &mut [f64]) -> Result<(), Self::Fault>;
}
