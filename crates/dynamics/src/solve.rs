//! Accelerations and multipliers at one state. The accelerations and multipliers are computed with
//! independent rows in their null space or through the Schur complement, without or with
//! refinement, or by generated code. The module [`crate::manifold`] moves states onto the
//! constraint manifold; [`crate::watch`] accepts steps.

mod equations;
mod evaluation;
mod generated;
mod matrix;
mod misfits;
mod rows;
mod solver;
mod units;

pub(crate) use equations::KeptEquations;
pub(crate) use evaluation::Evaluation;
pub(crate) use generated::{Doubt, GeneratedCode};
pub use misfits::Misfit;
pub(crate) use misfits::Misfits;
pub(crate) use rows::KeptRows;
pub(crate) use solver::{SolverNeeds, memory};
pub(crate) use units::{is_far, mass_spread};

/// A time with coordinates and velocities.
#[derive(Clone, Copy)]
pub(crate) struct State<'a> {
    pub(crate) t: f64,
    pub(crate) q: &'a [f64],
    pub(crate) v: &'a [f64],
}

/// Solves `M·v̇ + Cᵀ·λ = Q`, `C·v̇ = Γ` at a state.
pub(crate) trait Accelerations {
    /// Reason why there is no solution.
    type Fault;

    /// Computes v̇, n_v values.
    fn accelerations(&mut self, state: State<'_>, a: &mut [f64]) -> Result<(), Self::Fault>;

    /// Computes λ of all rows. λ is 0 for redundant rows.
    fn multipliers(&mut self, state: State<'_>, lambda: &mut [f64]) -> Result<(), Self::Fault>;
}
