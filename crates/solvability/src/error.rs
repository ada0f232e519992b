//! Why no analysis can be made.

use rank::{KeptRowsError, RankError};

use crate::limits::ROWS_MAX;
use crate::matrices::QueryError;
use crate::state::StateError;

/// Why no analysis can be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AnalysisError {
    /// Time or coordinates are none of this mechanism.
    #[error(transparent)]
    State(#[from] StateError),
    /// The constraint matrix cannot be judged.
    #[error("at t = {time} s: {source}")]
    Rank {
        /// When.
        time: f64,
        /// Why.
        source: RankError,
    },
    /// Joints that share cycles are too many for the rank of their rows.
    #[error("at t = {time} s: {rows} rows share cycles: {source}")]
    Large {
        /// When.
        time: f64,
        /// Their rows.
        rows: usize,
        /// Why.
        source: rank::SparseRankError,
    },
    /// Rows to drop can be chosen in a part of fewer rows only.
    #[error(
        "at t = {time} s: the rows that are dropped cannot be chosen where {rows} rows share cycles; up to {max} rows they can, and elsewhere in \
         this mechanism",
        max = ROWS_MAX
    )]
    Chosen {
        /// When.
        time: f64,
        /// Rows of the part.
        rows: usize,
    },
    /// A verdict cannot be asked for.
    #[error("at t = {time} s: {source}")]
    Query {
        /// When.
        time: f64,
        /// Why.
        source: QueryError,
    },
    /// The rows asked to be dropped cannot be.
    #[error("at t = {time} s these rows cannot be dropped: {source}")]
    Rows {
        /// When.
        time: f64,
        /// Why; rows are counted from 0 here.
        source: KeptRowsError,
    },
}
