//! Results and errors of the analysis along a motion.

use model::StartError;
use model::codes::Code;
use model::words::short;
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
    /// Verdicts on joints and drives by time interval, with the instants at which the verdicts
    /// differ.
    pub verdicts: Stretches,
    /// The rank almost everywhere on the motion.
    pub generic: GenericRank,
    /// Time intervals with a different rank, in chronological order.
    pub stretches: Vec<Stretch>,
    /// Singular configurations, in chronological order.
    pub passages: Vec<Passage>,
}

/// The rank almost everywhere on a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct GenericRank {
    /// An instant with this rank (s).
    pub time: f64,
    /// Rank of C.
    pub rank: usize,
    /// Degree of redundancy.
    pub redundancy: usize,
}

/// A time interval between break times on which the rank differs from the rank of the rest of the
/// motion.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Stretch {
    /// Start time (s).
    pub from: f64,
    /// End time (s).
    pub to: f64,
    /// Degree of redundancy on this interval.
    pub redundancy: usize,
    /// Description of the interval as text.
    pub text: String,
}

/// An instant at which the configuration is singular or nearly singular.
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
    /// Verdicts that differ from those of the interval that contains the instant.
    pub differences: Vec<Difference>,
    /// Description of the singular configuration as text.
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
    /// The configuration is nearly singular. The rank does not drop.
    NearlySingular {
        /// The smallest non-zero singular value.
        sigma: f64,
    },
    /// The configuration is so close to a singular configuration that a drop of the rank is
    /// undecided.
    Undecided {
        /// The singular values and the tolerance.
        doubt: Doubt,
    },
}

/// A verdict that differs at an instant.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Difference {
    /// Name of the joint or drive.
    pub reaction: String,
    /// The component of the reaction; `None` if the verdict is on all components together.
    pub component: Option<&'static str>,
    /// Verdict on the interval that contains the instant.
    pub generic: Verdict,
    /// Verdict at this instant.
    pub here: Verdict,
}

/// Reason why the verdicts along a motion cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AlongError {
    /// The sample times do not form an interval.
    #[error(
        "at least two sample times are needed, finite and increasing: {found} at index {index}"
    )]
    Times {
        /// Index of the first invalid time, from 0.
        index: usize,
        /// The time at this index; NaN if the index does not exist.
        found: f64,
    },
    /// A state of the motion is not valid for this mechanism.
    #[error(transparent)]
    State(#[from] StateError),
    /// No configuration that satisfies the constraints is near a state of the motion.
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
        "{joints} are on common cycles with {rows} rows in total; a motion can be analysed up to {most} rows"
    )]
    Large {
        /// The first joints and drives of the part.
        joints: String,
        /// Number of rows of the part.
        rows: usize,
        /// Largest permitted number of rows.
        most: usize,
    },
    /// The rank is undecided at every sample time.
    #[error(
        "the rank is undecided at all sample times; at t = {time} s the singular values around the gap are {sigma_r} and {sigma_next}, the tolerance is {tolerance}", sigma_r = short(*sigma_r), sigma_next = short(*sigma_next), tolerance = short(*tolerance))]
    Undecided {
        /// The last sample time (s).
        time: f64,
        /// σ_r at this time, for the candidate of the rank with the larger gap.
        sigma_r: f64,
        /// Next singular value, σ_{r+1}.
        sigma_next: f64,
        /// Singular values below this tolerance count as zero.
        tolerance: f64,
    },
}

impl AlongError {
    /// Returns the error code; see [`model::codes`].
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
