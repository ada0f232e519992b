//! Why a sweep does not begin or go on. What is wrong with one run is not here: it stands in its
//! row.

use report::sweep::JournalError;
use report::{FileError, TableError};
use scene::KeyError;

use super::AxisError;
use crate::error::StudyError;

/// Why a sweep does not begin or go on.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SweepError {
    /// The scene is wrong before anything is varied.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A key names no number of the scene.
    #[error(transparent)]
    Key(#[from] KeyError),
    /// The values are none, or too many.
    #[error(transparent)]
    Axis(#[from] AxisError),
    /// No run can begin.
    #[error("none of the {runs} runs can begin; the first, with {values}: {reason}")]
    NoneBegins {
        /// Number of runs.
        runs: u64,
        /// Keys with their values in the first one.
        values: String,
        /// Why it does not begin.
        reason: String,
    },
    /// The results of the directory cannot be continued.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// The threads could not be started.
    #[error("cannot start {threads} threads: {source}")]
    Threads {
        /// How many were asked for; 0 is as many as there are cores.
        threads: usize,
        /// Why.
        source: rayon::ThreadPoolBuildError,
    },
    /// A file could not be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A table could not be written.
    #[error(transparent)]
    Table(#[from] TableError),
}

impl SweepError {
    /// Whether the input is wrong; otherwise the computation stopped.
    #[must_use]
    pub fn is_input(&self) -> bool {
        match self {
            Self::Study(e) => e.is_input(),
            Self::Key(_) | Self::Axis(_) | Self::NoneBegins { .. } => true,
            Self::Journal(e) => matches!(
                e,
                JournalError::Changed { .. }
                    | JournalError::Damaged { .. }
                    | JournalError::Missing { .. }
            ),
            Self::Threads { .. } | Self::File(_) | Self::Table(_) => false,
        }
    }
}
