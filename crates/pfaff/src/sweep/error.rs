//! Errors that prevent the start of a sweep or end a sweep. Errors of single runs are reported in
//! the rows of the runs.

use model::codes::Code;
use report::sweep::JournalError;
use report::{FileError, TableError};
use scene::KeyError;

use super::AxisError;
use crate::error::StudyError;

/// Reason why a sweep does not begin or continue.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SweepError {
    /// The scene is invalid before any number is varied.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A key does not refer to a number of the scene.
    #[error(transparent)]
    Key(#[from] KeyError),
    /// The range has no values, or too many values.
    #[error(transparent)]
    Axis(#[from] AxisError),
    /// No run can begin.
    #[error("all {runs} runs fail at the start; the first, with {values}: {reason}")]
    NoneBegins {
        /// Number of runs.
        runs: u64,
        /// Keys with their values in the first run.
        values: String,
        /// Reason why the first run does not begin.
        reason: String,
    },
    /// The results in the directory cannot be continued.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// A file could not be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A table could not be written.
    #[error(transparent)]
    Table(#[from] TableError),
}

impl SweepError {
    /// Returns the code of the error; see [`model::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::Study(e) => e.code(),
            Self::Key(e) => e.code(),
            Self::Axis(e) => e.code(),
            Self::NoneBegins { .. } => const { Code::new(503) },
            Self::Journal(e) => e.code(),
            Self::File(e) => e.code(),
            Self::Table(e) => e.code(),
        }
    }
}

impl SweepError {
    /// Whether the input is invalid. Otherwise, the error occurred during the computation.
    #[must_use]
    pub fn is_input(&self) -> bool {
        match self {
            Self::Study(e) => e.is_input(),
            Self::Key(_) | Self::Axis(_) | Self::NoneBegins { .. } => true,
            Self::Journal(e) => e.is_input(),
            Self::File(e) => e.is_place(),
            Self::Table(_) => false,
        }
    }
}
