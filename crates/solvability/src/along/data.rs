//! What is told of a motion, and why nothing is.

use model::{RowLabel, StartError};
use rank::Doubt;

use crate::analysis::Analysis;
use crate::error::AnalysisError;
use crate::second_order::Continuation;
use crate::state::StateError;
use crate::verdict::Verdict;

/// Verdicts along a motion.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Along {
    /// The verdicts that hold almost always, at an instant where they do.
    pub generic: Analysis,
    /// Stretches of time with other verdicts, in the order of time.
    pub stretches: Vec<Stretch>,
    /// Instants where something is different, in the order of time.
    pub passages: Vec<Passage>,
}

/// A stretch of the motion, between break times, on which other verdicts hold than on the rest.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Stretch {
    /// Where it begins (s).
    pub from: f64,
    /// Where it ends (s).
    pub to: f64,
    /// Degree of redundancy on it.
    pub redundancy: usize,
    /// What differs from the generic verdicts.
    pub differences: Vec<Difference>,
    /// All this in words.
    pub text: String,
}

/// An instant where something is different.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Passage {
    /// When (s).
    pub time: f64,
    /// What happens.
    pub kind: PassageKind,
    /// From when to when the smallest non-zero singular value is below 10⁻³, if it is.
    pub nearly_singular: Option<[f64; 2]>,
    /// What differs from the generic verdicts at this instant.
    pub differences: Vec<Difference>,
    /// All this in words.
    pub text: String,
}

/// What happens at an instant.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum PassageKind {
    /// The rank drops.
    RankDrops {
        /// Degree of redundancy at the instant.
        redundancy: usize,
        /// How the motion goes on.
        continuation: Continuation,
    },
    /// The configuration is nearly singular; the rank stays.
    NearlySingular {
        /// The smallest non-zero singular value.
        sigma: f64,
    },
    /// The configuration is so nearly singular that it cannot be said whether the rank drops.
    Undecided {
        /// The numbers.
        doubt: Doubt,
    },
    /// Only verdicts change, the rank stays.
    Verdicts,
}

/// One verdict that differs.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Difference {
    /// Name of the joint or drive.
    pub reaction: String,
    /// Of what the verdict is.
    pub part: Part,
    /// Almost always.
    pub generic: Verdict,
    /// Here.
    pub here: Verdict,
}

/// What a verdict is of.
#[derive(Clone, Debug, PartialEq)]
pub enum Part {
    /// The whole reaction.
    Wrench,
    /// One component of it.
    Component(&'static str),
    /// The multiplier of one row.
    Row(RowLabel),
}

/// Why a motion has no verdicts.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AlongError {
    /// Sample times that are no interval.
    #[error("sample times must be finite and grow, and at least two: {found} at place {index}")]
    Times {
        /// Place of the first wrong one, from 0.
        index: usize,
        /// The time there, NaN if there is none.
        found: f64,
    },
    /// A state of the motion is none.
    #[error(transparent)]
    State(#[from] StateError),
    /// A state of the motion cannot be brought onto the constraints.
    #[error("at t = {time} s the state of the motion is not on the constraints: {source}")]
    OffConstraints {
        /// When.
        time: f64,
        /// Why.
        source: StartError,
    },
    /// The constraint matrix cannot be judged.
    #[error(transparent)]
    Analysis(#[from] AnalysisError),
    /// Too many rows are on common cycles.
    #[error(
        "{joints} are on common cycles with {rows} rows in all: a motion is judged by matrices of all of them, which is possible up to {most} rows"
    )]
    Large {
        /// The first joints and drives of the part.
        joints: String,
        /// Its rows.
        rows: usize,
        /// Rows that are possible.
        most: usize,
    },
    /// The rank is decided at no sample time.
    #[error(
        "the rank is decided at none of the sample times; at t = {time} s singular values are {sigma_r:.3e} and then {sigma_next:.3e}, \
         with a tolerance of {tolerance:.3e}"
    )]
    Undecided {
        /// The last time.
        time: f64,
        /// σ_r there, for the reading with the larger gap.
        sigma_r: f64,
        /// σ_{r+1}
        sigma_next: f64,
        /// Below it a singular value counts as zero.
        tolerance: f64,
    },
}
