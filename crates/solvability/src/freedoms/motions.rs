//! Free motions as they are told, and the ranks that they follow from.

use super::ranks::WithoutDrives;

/// A basis of the velocities that rows allow.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct FreeMotions {
    /// In words and numbers, at most [`MOTIONS_TOLD`](crate::MOTIONS_TOLD).
    pub motions: Vec<FreeMotion>,
    /// What is not told. `None` if everything is.
    pub left_out: Option<LeftOut>,
}

/// Freedoms that are counted only.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// How many.
    pub freedoms: usize,
    /// Why.
    pub reason: String,
}

/// One free motion; of a body that nothing holds, and of bodies that are joined to each other
/// alone, the three that it has as a whole.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FreeMotion {
    /// What moves: "`crank` turns about `A`; with it `coupler` and `rocker` turn".
    pub text: String,
    /// One list for each freedom, with the bodies that move: their place among the bodies, vx, vy
    /// (m/s) and ω (rad/s). The largest rotation is 1, or the fastest translation where nothing
    /// turns.
    pub velocities: Vec<Vec<(usize, [f64; 3])>>,
}

/// Ranks of rows that have been decided together: of the whole, or of a part that shares no cycle
/// with others.
pub(crate) struct Decided {
    /// Rows of the whole, ascending.
    pub(crate) rows: Vec<usize>,
    /// Their rank.
    pub(crate) rank: usize,
    /// Without those of drives. `None` if there are none among them.
    pub(crate) without_drives: Option<WithoutDrives>,
}
