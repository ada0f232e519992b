//! Results of the verdicts along a motion, and the errors if there are none.

use model::StartError;
use model::codes::Code;
use rank::Doubt;

use crate::error::AnalysisError;
use crate::second_order::Continuation;
use crate::state::StateError;
use crate::stretches::Stretches;
use crate::verdict::Verdict;

/// Verdicts along a motion.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct MotionAnalysis {
    /// The verdicts on joints and drives, by stretches of time, with the instants at which others
    /// hold.
    pub verdicts: Stretches,
    /// The rank that holds almost everywhere.
    pub generic: GenericRank,
    /// Stretches of time with another rank, in the order of time.
    pub stretches: Vec<Stretch>,
    /// Singular configurations, in the order of time.
    pub passages: Vec<Passage>,
}

/// The rank that holds almost everywhere on a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct GenericRank {
    /// An instant at which it holds (s).
    pub time: f64,
    /// Rank of C.
    pub rank: usize,
    /// Degree of redundancy.
    pub redundancy: usize,
}

/// A stretch of the motion, between break times, with another rank than the rest.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Stretch {
    /// Time at which it begins (s).
    pub from: f64,
    /// Time at which it ends (s).
    pub to: f64,
    /// Degree of redundancy on this stretch.
    pub redundancy: usize,
    /// Description of the stretch as text.
    pub text: String,
}

/// An instant at which the configuration is singular, or nearly so.
#[derive(Clone, Debug)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Passage {
    /// Time of the instant (s).
    pub time: f64,
    /// The kind of the event.
    pub kind: PassageKind,
    /// First and last time at which the smallest non-zero singular value is below 10⁻³.
    pub nearly_singular: [f64; 2],
    /// Verdicts that differ from those of the stretch that contains the instant.
    pub differences: Vec<Difference>,
    /// Description of the passage as text.
    pub text: String,
}

/// The kind of an event at an instant.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum PassageKind {
    /// The rank drops.
    RankDrops {
        /// Degree of redundancy at the instant.
        redundancy: usize,
        /// How the motion continues.
        continuation: Continuation,
    },
    /// The configuration is nearly singular; the rank does not drop.
    NearlySingular {
        /// The smallest non-zero singular value.
        sigma: f64,
    },
    /// The configuration is so close to singular that it is undecided whether the rank drops.
    Undecided {
        /// The singular values and the tolerance.
        doubt: Doubt,
    },
}

/// One verdict that differs.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Difference {
    /// Name of the joint or drive.
    pub reaction: String,
    /// The component of the reaction; `None` for the whole reaction.
    pub component: Option<&'static str>,
    /// Verdict on the stretch that contains the instant.
    pub generic: Verdict,
    /// Verdict at this instant.
    pub here: Verdict,
}

/// Reason why the verdicts along a motion cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AlongError {
    /// The sample times do not form an interval.
    #[error("sample times must be finite and grow, and at least two: {found} at place {index}")]
    Times {
        /// Index of the first wrong time, from 0.
        index: usize,
        /// The time at this index, NaN if there is none.
        found: f64,
    },
    /// A state of the motion is not valid for this mechanism.
    #[error(transparent)]
    State(#[from] StateError),
    /// A state of the motion cannot be brought onto the constraints.
    #[error("at t = {time} s the state of the motion is not on the constraints: {source}")]
    OffConstraints {
        /// Time of the state (s).
        time: f64,
        /// Cause.
        source: StartError,
    },
    /// The constraint matrix cannot be analysed.
    #[error(transparent)]
    Analysis(#[from] AnalysisError),
    /// Too many rows are on common cycles.
    #[error(
        "{joints} are on common cycles with {rows} rows in all: a motion is judged by matrices of all of them, which is possible up to {most} rows"
    )]
    Large {
        /// The first joints and drives of the part.
        joints: String,
        /// Number of their rows.
        rows: usize,
        /// Largest number of rows that is possible.
        most: usize,
    },
    /// The rank is undecided at every sample time.
    #[error(
        "the rank is decided at none of the sample times; at t = {time} s singular values are {sigma_r:.3e} and then {sigma_next:.3e}, \
         with a tolerance of {tolerance:.3e}"
    )]
    Undecided {
        /// The last sample time (s).
        time: f64,
        /// σ_r at this time, for the reading of the rank with the larger gap.
        sigma_r: f64,
        /// σ_{r+1}
        sigma_next: f64,
        /// Singular values below this tolerance count as zero.
        tolerance: f64,
    },
}

impl AlongError {
    /// Its code; see [`model::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::State(e) => e.code(),
            Self::Analysis(e) => e.code(),
            Self::Times { .. }
            | Self::OffConstraints { .. }
            | Self::Large { .. }
            | Self::Undecided { .. } => const { Code::new(314) },
        }
    }
}
