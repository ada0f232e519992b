//! Describes why the second-order terms of the constraints are not sufficient to decide whether the
//! mechanism can move.

use model::words::{rough, short};
use rank::{Doubt, RankError};

/// Reason why the second-order terms of the constraints are not sufficient to decide whether a
/// motion is possible.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum SecondOrderDoubt {
    /// The number of new motions exceeds the largest number that is examined.
    #[error("{found} new motions at this configuration, more than the {most} that are examined")]
    Kernel {
        /// Number of new motions.
        found: usize,
        /// Largest number of motions that is examined.
        most: usize,
    },
    /// The number of regular motions is undecided.
    #[error("how many of the given regular motions are independent is undecided: {0}")]
    RegularCount(Doubt),
    /// The regular motions are outside the range of numbers.
    #[error("the given regular motions cannot be compared: {0}")]
    Regular(RankError),
    /// All quadratic equations are zero.
    #[error("all motions are compatible to second order; terms of third order would decide")]
    NoTerms,
    /// The given motion does not solve the equations.
    #[error(
        "the given motion violates the second-order equations by {residual} (relative), more than {tolerance}", residual = short(*residual), tolerance = rough(*tolerance))]
    Irregular {
        /// Largest value of an equation, relative to its largest coefficient.
        residual: f64,
        /// Largest accepted value.
        tolerance: f64,
    },
    /// The search found neither a proof that no other velocity exists nor another velocity.
    #[error("no other velocity was found, and no combination of self-stresses excludes one")]
    Open,
}
