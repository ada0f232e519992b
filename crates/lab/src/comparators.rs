//! Reference methods to compute a motion: formulations that provide right-hand sides for a
//! [`model::System`], and two integration methods with their own step control.
//!
//! Each method is short, uses dense matrices and has no monitors. The rank of C is computed at the
//! initial state only.
//!
//! | module | content |
//! | --- | --- |
//! | [`mod@equations`] | the differential equation, with Baumgarte stabilisation or projection |
//! | `kept_rows`, `null_space`, `minimum_norm`, `proximal` | accelerations from the saddle equations |
//! | `stepping` | the loop of steps for `gbs` and `generalized_alpha` |
//! | `way` | combinations of formulation, method, and treatment of drift |
//! | `run` | runs of a prepared mechanism, with output rows at given times |

pub mod equations;
mod gbs;
mod generalized_alpha;
mod kept_rows;
mod minimum_norm;
mod null_space;
mod proximal;
mod run;
mod stepping;
#[cfg(test)]
mod tests;
mod way;

use linalg::{Matrix, SaddleError};
use model::ForceWithoutDerivatives;

pub use kept_rows::KeptRows;
pub use minimum_norm::MinimumNorm;
pub use null_space::NullSpace;
pub use proximal::{Proximal, Tuning};
pub use run::{Row, Run, run, run_within};
pub use way::{Comparator, Drift, Formulation, Method};

/// The saddle equations `M·a + Cᵀ·λ = f`, `C·a = γ` at one instant, with M = diag(mass).
#[derive(Clone, Copy, Debug)]
pub struct Saddle<'a> {
    /// All rows of C, m × n.
    pub c: &'a Matrix,
    /// Diagonal of M, n.
    pub mass: &'a [f64],
    /// Applied forces, n.
    pub force: &'a [f64],
    /// Right-hand side of all rows, m.
    pub gamma: &'a [f64],
}

/// A solver of the saddle-point equations for a matrix C with dependent rows.
pub trait Solver {
    /// Writes accelerations (n) and multipliers of all rows (m).
    ///
    /// # Errors
    /// Returns an error if the equations have no unique solution.
    fn solve(&mut self, at: &Saddle<'_>, a: &mut [f64], lambda: &mut [f64]) -> Result<(), Fault>;
}

/// The reason why a reference method stops.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// The equations of the independent rows have no solution.
    #[error(transparent)]
    Saddle(#[from] SaddleError),
    /// Rows that were independent at the initial state became dependent.
    #[error("the rank of the constraints is below the rank {rank} of the start")]
    RankLost {
        /// The rank at the initial state.
        rank: usize,
    },
    /// The constraints allow a motion that moves no mass.
    #[error("a motion that the constraints allow moves no mass")]
    Massless,
    /// Corrections of the position do not converge.
    #[error("at t = {time} s the state cannot be projected onto the constraints")]
    Projection {
        /// Time (s).
        time: f64,
    },
    /// The method needs derivatives of the forces, but a force has no derivatives.
    #[error(transparent)]
    Called(#[from] ForceWithoutDerivatives),
    /// A joint has an armature, but the solvers of the method need a diagonal mass matrix.
    #[error("joint `{joint}` has an armature, which the reference methods do not support")]
    Armature {
        /// Name of the joint.
        joint: String,
    },
    /// Newton's method does not converge in an implicit step.
    #[error("the equations of a step cannot be solved")]
    Newton,
    /// The steps became too short.
    #[error("at t = {time} s steps have become too short")]
    StepTooShort {
        /// Time (s).
        time: f64,
    },
    /// The run needs too many steps.
    #[error("at t = {time} s there have been {steps} steps")]
    TooManySteps {
        /// Time (s).
        time: f64,
        /// Accepted and rejected steps.
        steps: u64,
    },
    /// The run exceeds its time limit.
    #[error("the time limit of the computation was reached at t = {time} s")]
    TooLong {
        /// Time (s).
        time: f64,
    },
    /// The integration loop of `integrators` failed.
    #[error("{0}")]
    Integration(String),
    /// A number is not finite.
    #[error("at t = {time} s there is a number that is not finite")]
    NotFinite {
        /// Time (s).
        time: f64,
    },
}

/// The scalar product `Σ x·y`.
fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}
