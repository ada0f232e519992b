//! Errors of the analysis.

use model::codes::Code;
use rank::{KeptRowsError, RankError};

use crate::groups::RequestError;
use crate::limits::ROWS_MAX;
use crate::matrices::QueryError;
use crate::state::StateError;

/// Reason why a configuration cannot be analysed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AnalysisError {
    /// Time or coordinates are not valid for this mechanism.
    #[error(transparent)]
    State(#[from] StateError),
    /// The constraint matrix cannot be analysed.
    #[error("at t = {time} s: {source}")]
    Rank {
        /// Time (s).
        time: f64,
        /// Cause.
        source: RankError,
    },
    /// Too many joints share cycles, so the rank of their rows cannot be decided.
    #[error("at t = {time} s: {rows} rows share cycles: {source}")]
    Large {
        /// Time (s).
        time: f64,
        /// Number of rows that share cycles.
        rows: usize,
        /// Cause.
        source: rank::SparseRankError,
    },
    /// The caller cannot choose the redundant rows of a part with so many rows.
    #[error(
        "at t = {time} s: the rows that are dropped cannot be chosen where {rows} rows share cycles; up to {max} rows they can, and elsewhere in \
         this mechanism",
        max = ROWS_MAX
    )]
    Chosen {
        /// Time (s).
        time: f64,
        /// Number of rows of the part.
        rows: usize,
    },
    /// A requested verdict cannot be computed.
    #[error("at t = {time} s: {source}")]
    Query {
        /// Time (s).
        time: f64,
        /// Cause.
        source: QueryError,
    },
    /// A requested combination of reactions has no numbers.
    #[error("at t = {time} s: {source}")]
    Group {
        /// Time (s).
        time: f64,
        /// Cause.
        source: Box<RequestError>,
    },
    /// The rows to drop are not redundant.
    #[error("at t = {time} s these rows cannot be dropped: {source}")]
    Rows {
        /// Time (s).
        time: f64,
        /// Cause; rows are counted from 0 here.
        source: KeptRowsError,
    },
}

impl AnalysisError {
    /// Returns the error code; see [`model::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::State(e) => e.code(),
            Self::Rank { .. } | Self::Query { .. } => const { Code::new(302) },
            Self::Group { source, .. } => source.code(),
            Self::Large { .. } => const { Code::new(303) },
            Self::Chosen { .. } => const { Code::new(304) },
            Self::Rows { .. } => const { Code::new(310) },
        }
    }
}
