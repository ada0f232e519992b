//! How much memory work on a scene takes, before it is taken. Estimates from sizes and patterns
//! alone, meant to be too large rather than too small.

use solvability::memory_of_verdicts;

use crate::assembled::AssembledScene;
use crate::error::StudyError;
use crate::study::Study;

/// Bytes for a byte of a scene: its text, its tables with their places, the mechanism and its
/// names.
const OF_TEXT: usize = 45;

/// Bytes that nothing can do without.
const FLOOR: usize = 10 << 20;

/// Bytes that reading a text of this length takes at most, about, its mechanism included.
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
    /// Bytes that ranks, kept rows and verdicts take at most on so many threads, about, beside what
    /// was read: see [`memory_of_verdicts`].
    ///
    /// # Errors
    /// [`StudyError::Analysis`]: rows are joined too closely for a sparse decision.
    pub fn memory_of_verdicts(&self, threads: usize) -> Result<usize, StudyError> {
        Ok(memory_of_verdicts(&self.mechanism, threads)?)
    }
}

impl Study {
    /// Bytes that a run takes at most, about, reading a text of this length and the verdicts of the
    /// start included.
    ///
    /// # Errors
    /// [`StudyError::Analysis`]: rows are joined too closely for a sparse decision.
    pub fn memory(&self, text: usize) -> Result<usize, StudyError> {
        let verdicts = memory_of_verdicts(&self.prepared.mechanism, crate::threads())?;
        // Verdicts are there before the run, and are few bytes then.
        Ok(of_reading(text) + verdicts.max(self.prepared.memory()))
    }
}
