//! Reasons why no consistent start was found.

use crate::codes::Code;
use linalg::{SaddleError, SparseError, StepError};
use rank::RankError;

use super::conflict::VelocityConflict;
use super::options::KeepLevel;
use crate::system::RowLabel;

/// Reason why no consistent start was found.
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
        /// The violated rows, the worst first.
        rows: Vec<Misfit>,
        /// Number of iterations.
        iterations: usize,
    },
    /// The closest consistent configuration is far from the described one.
    #[error(
        "the start must be corrected by {correction:.3e} ({coordinate} of body `{body}`), more than the allowed {limit:.3e}; \
         correct the scene, or set `allow_correction = true` in `[start]`"
    )]
    LargeCorrection {
        /// The body that moves most.
        body: String,
        /// Name of the coordinate.
        coordinate: &'static str,
        /// The correction.
        correction: f64,
        /// The largest correction allowed.
        limit: f64,
    },
    /// The given velocities, or those held by `keep`, are impossible.
    #[error(transparent)]
    Velocities(#[from] Box<VelocityConflict>),
    /// A requirement of a definition is not satisfied at the start.
    #[error("`{name}` requires at the start: {requirement}")]
    Requirement {
        /// The joint, drive or force.
        name: String,
        /// The requirement.
        requirement: &'static str,
    },
    /// A coordinate that is to be kept does not exist.
    #[error(
        "`keep` names coordinate {dof} of body {body}; bodies are 0..{bodies}, coordinates 0 x, 1 y, 2 angle"
    )]
    NoCoordinate {
        /// The requested body.
        body: usize,
        /// The requested coordinate.
        dof: usize,
        /// Number of bodies.
        bodies: usize,
    },
    /// A coordinate of a frame that is not at the centre of mass is to be kept without its angle.
    #[error(
        "`keep` holds the origin of the frame of body `{body}`, which is not its centre of mass; {}",
        needed(body, *level)
    )]
    KeptOrigin {
        /// The body.
        body: String,
        /// Position or velocity.
        level: KeepLevel,
    },
    /// The rows allow no velocities, whatever velocities are given.
    #[error(
        "no velocities satisfy the constraints: row {worst} still misses by {residual:.3e}; the rows depend on each other, or nearly, and ask for \
         different velocities: correct or delete one of them"
    )]
    NoVelocity {
        /// The row with the largest residual.
        worst: RowLabel,
        /// Its residual.
        residual: f64,
    },
    /// The start has to be corrected, and the matrix for this is too large for the memory.
    #[error(
        "the start has to be corrected, which takes a dense matrix of {rows} × {columns} numbers, more than {most:e}; \
         describe positions and velocities that satisfy the constraints"
    )]
    TooLarge {
        /// Number of rows to be satisfied.
        rows: usize,
        /// Number of coordinates.
        columns: usize,
        /// Largest number of entries of a matrix.
        most: f64,
    },
    /// C at the start is not finite.
    #[error("the start cannot be corrected: {0}")]
    Rank(#[from] RankError),
    /// The velocities of a large mechanism could not be computed.
    #[error("the velocities of the start cannot be found: {0}")]
    Saddle(#[from] SaddleError),
    /// The sparse equations of the velocities could not be solved.
    #[error("the velocities of the start cannot be found: {0}")]
    Sparse(#[from] SparseError),
    /// The correction step failed.
    #[error("the start cannot be corrected: {0}")]
    Step(#[from] StepError),
}

impl StartError {
    /// Its code; see [`crate::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::NoAssembly { .. } => const { Code::new(201) },
            Self::LargeCorrection { .. } => const { Code::new(202) },
            Self::Velocities { .. } => const { Code::new(203) },
            Self::Requirement { .. } => const { Code::new(204) },
            Self::NoCoordinate { .. } => const { Code::new(205) },
            Self::NoVelocity { .. } => const { Code::new(206) },
            Self::TooLarge { .. } => const { Code::new(207) },
            Self::KeptOrigin { .. } => const { Code::new(209) },
            Self::Rank(_) | Self::Saddle(_) | Self::Sparse(_) | Self::Step(_) => {
                const { Code::new(208) }
            }
        }
    }
}

/// A row that is not satisfied.
#[derive(Clone, Debug, PartialEq)]
pub struct Misfit {
    /// The row.
    pub row: RowLabel,
    /// Its residual.
    pub residual: f64,
}

fn needed(body: &str, level: KeepLevel) -> String {
    match level {
        KeepLevel::Position => format!("hold `{body}.angle` too"),
        KeepLevel::Velocity => {
            format!("give its `velocity` and `angular_velocity`, and hold `{body}.omega` too")
        }
    }
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

/// Largest number of rows named in a message.
const NAMED_ROWS: usize = 20;
