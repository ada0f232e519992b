//! Free motions as reported, and the ranks from which they follow.

use super::ranks::WithoutDrives;

/// A basis of the velocities that the rows allow.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct FreeMotions {
    /// The motions as text and numbers, at most [`MOTIONS_REPORTED`](crate::MOTIONS_REPORTED).
    pub motions: Vec<FreeMotion>,
    /// Freedoms that are not described. `None` if all are.
    pub left_out: Option<LeftOut>,
}

/// Freedoms that are only counted.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct LeftOut {
    /// Their number.
    pub freedoms: usize,
    /// Reason why they are not described.
    pub reason: String,
}

/// One free motion. A body that is attached to nothing, and bodies that are joined only to each
/// other, have all rigid motions in one entry.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct FreeMotion {
    /// Description, for example "`crank` turns about `A`; with it `coupler` and `rocker` turn".
    pub text: String,
    /// One list for each degree of freedom, with the bodies that move: index of the body, and its
    /// velocities in the order of [`SpaceKind::velocities`](model::SpaceKind) (m/s, rad/s), ground
    /// axes. In the plane they are those of the centre of mass, in the order of the columns of C;
    /// in space those of the origin of its frame. The largest rotation is 1, or the fastest
    /// translation if nothing rotates.
    pub velocities: Vec<Vec<(usize, Vec<f64>)>>,
}

/// Rank of rows that have been decided together: those of the whole mechanism, or of a part that
/// shares no cycle with others.
pub(crate) struct PartRank {
    /// Rows of the whole mechanism, ascending.
    pub(crate) rows: Vec<usize>,
    /// Their rank.
    pub(crate) rank: usize,
    /// The rank without the rows of drives. `None` if no row is of a drive.
    pub(crate) without_drives: Option<WithoutDrives>,
}
