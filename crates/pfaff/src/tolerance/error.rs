//! Errors because of which no sample can be computed. Samples that cannot be assembled are counted;
//! they are not an error.

use model::codes::Code;
use scene::KeyError;

use super::limits::{ROWS_MAX, SAMPLES_MAX};
use crate::error::StudyError;

/// Reason why no samples are computed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ToleranceError {
    /// The scene without any displacement is invalid, or cannot be analysed.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// No number has a tolerance.
    #[error(
        "no number of the scene has a tolerance: write `--tolerance 1e-4` for ± 0.1 mm, or `tolerance = 1e-4` in [scene], \
         in a body, a joint or a marker"
    )]
    NoTolerance,
    /// A key does not refer to a number of the scene.
    #[error(transparent)]
    Key(#[from] KeyError),
    /// The scene cannot be assembled at an end of the interval of a number.
    #[error("`--vary {variation}`: {reason}")]
    Vary {
        /// The number and its interval.
        variation: String,
        /// Description of the error at one end of the interval.
        reason: String,
    },
    /// The scene has no numbers that can be displaced.
    #[error("no datum can be displaced: no joint or drive of the scene has data")]
    NoData,
    /// The number of samples is out of its range.
    #[error("{samples} samples: need 1 to {SAMPLES_MAX}")]
    Samples {
        /// The requested number of samples.
        samples: usize,
    },
    /// The mechanism is too large.
    #[error(
        "the mechanism has {rows} rows; at most {ROWS_MAX} are supported, because each sample is analysed with dense matrices: describe a part of the mechanism as a scene"
    )]
    TooLarge {
        /// Number of rows.
        rows: usize,
    },
}

impl ToleranceError {
    /// Returns the code of the error; see [`model::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::Study(e) => e.code(),
            Self::Key(e) => e.code(),
            Self::Vary { .. } => const { Code::new(513) },
            Self::NoTolerance | Self::NoData => const { Code::new(510) },
            Self::Samples { .. } => const { Code::new(511) },
            Self::TooLarge { .. } => const { Code::new(512) },
        }
    }

    /// Whether the input is invalid. Otherwise, the error occurred during the computation.
    #[must_use]
    pub fn is_input(&self) -> bool {
        match self {
            Self::Study(e) => e.is_input(),
            Self::NoTolerance
            | Self::Key(_)
            | Self::Vary { .. }
            | Self::NoData
            | Self::Samples { .. }
            | Self::TooLarge { .. } => true,
        }
    }
}
