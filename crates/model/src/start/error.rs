//! Why no consistent start was found.

use linalg::{SaddleError, SparseError, StepError};
use rank::RankError;

use super::conflict::VelocityConflict;
use crate::system::RowLabel;

/// Why no consistent start was found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StartError {
    /// The constraints cannot be satisfied from the described configuration.
    #[error(
        "the constraints cannot be assembled: after {iterations} iterations these rows still miss: {}; \
         they contradict each other, or the start is too far from an assembled one",
        list(rows)
    )]
    NoAssembly {
        /// The rows that cannot be reconciled, the worst first.
        rows: Vec<Misfit>,
        /// Iterations made.
        iterations: usize,
    },
    /// The nearest assembled configuration is far from the described one.
    #[error(
        "the start must be corrected by {correction:.3e} ({coordinate} of body `{body}`), more than the allowed {limit:.3e}; \
         correct the scene, or set `allow_correction = true` in `[start]`"
    )]
    LargeCorrection {
        /// The body that moves most.
        body: String,
        /// Which coordinate.
        coordinate: &'static str,
        /// By how much.
        correction: f64,
        /// What is allowed.
        limit: f64,
    },
    /// Velocities that are given, or held by `keep`, are not those of any motion.
    #[error(transparent)]
    Velocities(#[from] Box<VelocityConflict>),
    /// A definition requires something that the start does not have.
    #[error("`{name}` requires at the start: {requirement}")]
    Requirement {
        /// The joint, drive or force.
        name: String,
        /// What is required.
        requirement: &'static str,
    },
    /// A coordinate that does not exist is to be kept.
    #[error(
        "`keep` names coordinate {dof} of body {body}; bodies are 0..{bodies}, coordinates 0 x, 1 y, 2 angle"
    )]
    NoCoordinate {
        /// The body asked for.
        body: usize,
        /// The coordinate asked for.
        dof: usize,
        /// Number of bodies.
        bodies: usize,
    },
    /// The rows leave no velocities, whichever are given.
    #[error(
        "no velocities satisfy the constraints: row {worst} still misses by {residual:.3e}; the rows depend on each other, or nearly, and ask for \
         different velocities: correct or delete one of them"
    )]
    NoVelocity {
        /// The row that misses most.
        worst: RowLabel,
        /// By how much.
        residual: f64,
    },
    /// The start has to be corrected, and the matrix for it would fill the memory.
    #[error(
        "the start has to be corrected, which takes a dense matrix of {rows} × {columns} numbers, more than {most:e}; \
         describe positions and velocities that satisfy the constraints"
    )]
    TooLarge {
        /// Rows that have to be satisfied.
        rows: usize,
        /// Coordinates.
        columns: usize,
        /// Most entries of a matrix.
        most: f64,
    },
    /// C at the start is not finite.
    #[error("the start cannot be corrected: {0}")]
    Rank(#[from] RankError),
    /// The velocities of a large mechanism could not be solved for.
    #[error("the velocities of the start cannot be found: {0}")]
    Saddle(#[from] SaddleError),
    /// The same.
    #[error("the velocities of the start cannot be found: {0}")]
    Sparse(#[from] SparseError),
    /// The correction step failed.
    #[error("the start cannot be corrected: {0}")]
    Step(#[from] StepError),
}

/// A row that is not satisfied.
#[derive(Clone, Debug, PartialEq)]
pub struct Misfit {
    /// The row.
    pub row: RowLabel,
    /// Its residual.
    pub residual: f64,
}

fn list(rows: &[Misfit]) -> String {
    let parts = rows.iter().take(NAMED_ROWS);
    let parts: Vec<String> = parts
        .map(|m| format!("{} by {:.3e}", m.row, m.residual))
        .collect();
    let named = parts.join(", ");
    match rows.len().saturating_sub(NAMED_ROWS) {
        0 => named,
        more => format!("{named}, and {more} more"),
    }
}

/// Rows that a message names.
const NAMED_ROWS: usize = 20;
