//! Why second order does not decide.

use rank::{Doubt, RankError};

/// Why second order does not decide.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Undetermined {
    /// More new motions than are examined.
    #[error("{found} new motions at once, more than the {most} that are examined")]
    Kernel {
        /// New motions.
        found: usize,
        /// As many are examined.
        most: usize,
    },
    /// How many motions are regular is undecided.
    #[error("how many of the given regular motions are independent is undecided: {0}")]
    RegularCount(Doubt),
    /// The regular motions leave the range of numbers.
    #[error("the given regular motions cannot be compared: {0}")]
    Regular(RankError),
    /// The quadratic equations are empty.
    #[error("all motions are compatible to second order; terms of third order would decide")]
    NoTerms,
    /// What was given as the motion does not solve the equations.
    #[error(
        "the given motion itself misses the second-order equations by {residual:.3e} (relative), more than {tolerance:.1e}"
    )]
    Irregular {
        /// Largest value of an equation, relative to its largest coefficient.
        residual: f64,
        /// What is allowed.
        tolerance: f64,
    },
    /// Neither a proof that there are no others nor another velocity.
    #[error("no other velocity was found, and no combination of self-stresses excludes one")]
    Open,
}
