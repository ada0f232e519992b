//! Reported free motions, and the ranks from which they are computed.

use super::ranks::WithoutDrives;

/// A basis of the velocities that the rows allow.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct FreeMotions {
    /// The motions as text and numbers, at most [`MOTIONS_REPORTED`](crate::MOTIONS_REPORTED).
    pub motions: Vec<FreeMotion>,
    /// Free motions that are not described. `None` if all free motions are described.
    pub left_out: Option<LeftOut>,
}

/// Free motions that are counted but not described.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct LeftOut {
    /// Number of these free motions.
    pub freedoms: usize,
    /// Reason why the free motions are not described.
    pub reason: String,
}

/// One free motion. The rigid motions of a body without joints form one entry. The same applies to
/// bodies that are joined only to each other.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct FreeMotion {
    /// Description, for example "`crank` turns about `A`; with it `coupler` and `rocker` turn".
    pub text: String,
    /// The moving bodies for each degree of freedom. Each item is the index of the body, and the
    /// velocities of the body in the order of [`SpaceKind::velocities`](model::SpaceKind) (m/s,
    /// rad/s), in ground axes. In the plane these are the velocities of the centre of mass, in the
    /// order of the columns of C. In space they are the velocities of the origin of the body frame.
    /// The largest rotation is 1. If no body rotates, the fastest translation is 1.
    pub velocities: Vec<Vec<(usize, Vec<f64>)>>,
}

/// Rank of rows that are decided together. The rows are the rows of the whole mechanism, or of a
/// part that shares no cycle with other parts.
pub(crate) struct PartRank {
    /// Rows of the whole mechanism, ascending.
    pub(crate) rows: Vec<usize>,
    /// Rank of the rows.
    pub(crate) rank: usize,
    /// The rank without the rows of drives. `None` if no row belongs to a drive.
    pub(crate) without_drives: Option<WithoutDrives>,
}
