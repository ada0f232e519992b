//! Errors that are returned if no consistent initial state was found.

use crate::words::{quantity, short};
use std::fmt;

use crate::codes::Code;
use linalg::{SaddleError, SparseError, StepError};
use rank::RankError;

use super::conflict::VelocityConflict;
use super::options::KeepLevel;
use crate::system::RowLabel;

/// Reason why no consistent initial state was found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StartError {
    /// The constraints cannot be satisfied from the described configuration.
    #[error(
        "the constraints cannot be assembled: after {iterations} iterations these constraints are violated:  {}; \
         they contradict each other, or the start is too far from an assembled one",
        list(misfits)
    )]
    NoAssembly {
        /// The violated joints and drives, the largest violation first.
        misfits: Vec<Misfit>,
        /// Number of iterations.
        iterations: usize,
    },
    /// The closest consistent configuration is far from the described configuration.
    #[error(
        "the start must be corrected by {correction} ({coordinate} of body `{body}`), more than the allowed {limit}: \
         as described, these constraints are violated: {}; correct the scene, or set `allow_correction = true` in `[start]`",
        few(misfits), correction = quantity(*correction, unit), limit = quantity(*limit, unit))]
    LargeCorrection {
        /// The body with the largest displacement.
        body: String,
        /// Name of the coordinate.
        coordinate: &'static str,
        /// The correction.
        correction: f64,
        /// The largest permitted correction.
        limit: f64,
        /// Unit of the correction and the limit: m or rad.
        unit: &'static str,
        /// The joints and drives that are violated at the described configuration, the largest
        /// violation first.
        misfits: Vec<Misfit>,
    },
    /// One-sided joints are described on the side to which their gap cannot open.
    #[error(
        "one-sided joints are described on the side to which they cannot open: {}; move the bodies to the other \
         side, or turn the normal (in the plane `toward`) round",
        depths(joints)
    )]
    WrongSide {
        /// The joints, each with the depth of its gap on the wrong side (m), the deepest first.
        joints: Vec<(String, f64)>,
    },
    /// The given or kept velocities are impossible.
    #[error(transparent)]
    Velocities(#[from] Box<VelocityConflict>),
    /// The initial configuration does not satisfy a requirement of a definition.
    #[error("`{name}` requires at the start: {requirement}")]
    Requirement {
        /// The joint, drive or force.
        name: String,
        /// The requirement.
        requirement: &'static str,
    },
    /// A coordinate in `keep` does not exist.
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
    /// A body with an initial pose does not exist, or the pose belongs to another space.
    #[error(
        "the start contains a pose of body {body}; bodies are 0..{bodies}, with poses of their space"
    )]
    NoPose {
        /// The requested body.
        body: usize,
        /// Number of bodies.
        bodies: usize,
    },
    /// The origin of a body frame is in `keep`, but the rotation of the body is not. The origin is
    /// not the centre of mass.
    #[error(
        "`keep` holds the origin of the frame of body `{body}`, which is not its centre of mass; {}",
        needed(body, *level, rotation)
    )]
    KeptOrigin {
        /// The body.
        body: String,
        /// Position or velocity.
        level: KeepLevel,
        /// Name of the rotation of the body in `keep`.
        rotation: &'static str,
    },
    /// The rows do not permit any velocities, for any given velocities.
    #[error(
        "no velocities satisfy the constraints: row {worst} is violated by {residual}; dependent or nearly dependent rows require different velocities: correct or delete one of them", residual = short(*residual))]
    NoVelocity {
        /// The row with the largest residual.
        worst: RowLabel,
        /// Residual of the row.
        residual: f64,
    },
    /// The initial configuration requires a correction whose matrix is too large for the memory.
    #[error(
        "the start must be corrected, but the correction needs a dense matrix of {rows} × {columns} numbers, more than {most:e}; describe positions and velocities that satisfy the constraints"
    )]
    TooLarge {
        /// Number of rows to be satisfied.
        rows: usize,
        /// Number of coordinates.
        columns: usize,
        /// Largest permitted number of entries of a matrix.
        most: f64,
    },
    /// C at the initial configuration is not finite.
    #[error("the start cannot be corrected: {0}")]
    Rank(#[from] RankError),
    /// The velocities of a large mechanism could not be computed.
    #[error("the initial velocities cannot be computed: {0}")]
    Saddle(#[from] SaddleError),
    /// The sparse equations of the velocities could not be solved.
    #[error("the initial velocities cannot be computed: {0}")]
    Sparse(#[from] SparseError),
    /// The correction step failed.
    #[error("the start cannot be corrected: {0}")]
    Step(#[from] StepError),
}

impl StartError {
    /// Returns the code; see [`crate::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::NoAssembly { .. } => const { Code::new(201) },
            Self::LargeCorrection { .. } => const { Code::new(202) },
            Self::Velocities { .. } => const { Code::new(203) },
            Self::Requirement { .. } => const { Code::new(204) },
            Self::NoCoordinate { .. } | Self::NoPose { .. } => const { Code::new(205) },
            Self::NoVelocity { .. } => const { Code::new(206) },
            Self::TooLarge { .. } => const { Code::new(207) },
            Self::KeptOrigin { .. } => const { Code::new(209) },
            Self::WrongSide { .. } => const { Code::new(216) },
            Self::Rank(_) | Self::Saddle(_) | Self::Sparse(_) | Self::Step(_) => {
                const { Code::new(208) }
            }
        }
    }
}

/// A joint or drive whose rows are not satisfied.
#[derive(Clone, Debug, PartialEq)]
pub struct Misfit {
    /// The joint or drive.
    pub joint: String,
    /// Distance of the points of the joint from their required positions (m).
    pub distance: f64,
    /// Angle between the axes of the joint and their required directions (rad).
    pub angle: f64,
}

impl fmt::Display for Misfit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` by ", self.joint)?;
        let (distance, angle) = (self.distance, self.angle.to_degrees());
        match (distance != 0.0, angle != 0.0) {
            (true, true) => write!(f, "{} and {}°", quantity(distance, "m"), short(angle)),
            (false, true) => write!(f, "{}°", short(angle)),
            _ => f.write_str(&quantity(distance, "m")),
        }
    }
}

fn needed(body: &str, level: KeepLevel, rotation: &str) -> String {
    match level {
        KeepLevel::Position => format!("keep `{body}.{rotation}`, too"),
        KeepLevel::Velocity => {
            format!("give its `velocity` and `angular_velocity`, and keep `{body}.{rotation}`, too")
        }
    }
}

/// Lists joints with the depths of their gaps.
fn depths(joints: &[(String, f64)]) -> String {
    let depth = |(name, depth): &(String, f64)| format!("`{name}` by {}", quantity(*depth, "m"));
    let mut named: Vec<String> = joints.iter().take(FEW).map(depth).collect();
    if joints.len() > FEW {
        named.push(format!("and {} more", joints.len() - FEW));
    }
    named.join(", ")
}

fn list(misfits: &[Misfit]) -> String {
    first(misfits, NAMED)
}

fn few(misfits: &[Misfit]) -> String {
    first(misfits, FEW)
}

fn first(misfits: &[Misfit], most: usize) -> String {
    let parts = misfits.iter().take(most).map(Misfit::to_string);
    let named = parts.collect::<Vec<_>>().join(", ");
    match misfits.len().saturating_sub(most) {
        0 => named,
        more => format!("{named}, and {more} more"),
    }
}

/// Largest number of joints in a message.
const NAMED: usize = 20;

/// Largest number of joints in a message about a correction.
const FEW: usize = 4;
