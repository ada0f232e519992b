//! Estimates the memory for work on a scene before it is allocated, from sizes and sparsity
//! patterns only. The estimates are meant to be upper bounds.

#[cfg(feature = "messages")]
mod budget;
#[cfg(all(feature = "messages", target_os = "linux"))]
mod linux;

use solvability::memory_of_verdicts;

use crate::assembled::AssembledScene;
use crate::error::StudyError;
use crate::study::Study;

#[cfg(feature = "messages")]
pub use budget::{Budget, Bytes};

/// Bytes for each byte of a scene: its text, its tables with their places, the mechanism and its
/// names.
const OF_TEXT: usize = 45;

/// Bytes that are always needed.
const FLOOR: usize = 10 << 20;

/// Estimated upper bound (bytes) on the memory for reading a text of this length, including its
/// mechanism.
///
/// ```
/// // A scene of a megabyte.
/// assert!(pfaff::memory::of_reading(1 << 20) < 100 << 20);
/// ```
#[must_use]
pub fn of_reading(text: usize) -> usize {
    FLOOR + OF_TEXT.saturating_mul(text)
}

impl AssembledScene {
    /// Estimated upper bound (bytes) on the memory of ranks, kept rows and verdicts on this number
    /// of threads, in addition to the scene: see [`memory_of_verdicts`].
    ///
    /// # Errors
    /// [`StudyError::Analysis`]: elimination would take too many operations for a sparse decision.
    pub fn memory_of_verdicts(&self, threads: usize) -> Result<usize, StudyError> {
        Ok(memory_of_verdicts(&self.mechanism, threads)?)
    }
}

impl Study {
    /// Estimated upper bound (bytes) on the memory of a run, including the reading of a text of
    /// this length and the verdicts at the start.
    ///
    /// # Errors
    /// [`StudyError::Analysis`]: elimination would take too many operations for a sparse decision.
    pub fn memory(&self, text: usize) -> Result<usize, StudyError> {
        let verdicts = memory_of_verdicts(&self.prepared.mechanism, crate::threads())?;
        // Verdicts are computed before the run, and afterwards take little memory.
        Ok(of_reading(text) + verdicts.max(self.prepared.memory()))
    }
}
