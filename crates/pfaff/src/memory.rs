//! Estimates the memory for work on a scene before it is allocated. The estimates use only counted
//! sizes and sparsity patterns. They are accurate to one fifth for scenes of many bodies
//! (`resources.rs` in the tests of the command measures the accuracy).

mod budget;
#[cfg(target_os = "linux")]
mod linux;

use dynamics::Method;
use solvability::memory_of_verdicts;

use crate::assembled::AssembledScene;
use crate::error::StudyError;
use crate::study::Study;
use model::System;

pub use budget::{Budget, Bytes};

/// Bytes for each byte of a scene: text and parsed tables, with the positions of their values.
const OF_TEXT: usize = 24;

/// Bytes that are always needed: the program itself and its streams.
const FLOOR: usize = 18_500_000;

/// Additional bytes that each run needs: the buffers of its files, and its page.
const OF_RUN: usize = 5_400_000;

/// Bytes of a joint, drive or coupling in a run: its columns, its peaks and its verdicts.
const OF_COLUMNS: usize = 4_000;

/// Estimated memory (bytes) for reading a text of this length.
///
/// ```
/// // A scene of a megabyte.
/// assert!(pfaff::memory::of_reading(1 << 20) < 100 << 20);
/// ```
#[must_use]
pub fn of_reading(text: usize) -> usize {
    FLOOR + OF_TEXT.saturating_mul(text)
}

/// Bytes for the elements of a file to import, for each byte of the file.
const OF_ELEMENTS: usize = 6;

/// Bytes for each byte of a scene that has been imported: for the model, for the text, and for
/// reading the text.
const OF_IMPORTED: usize = 40;

/// Returns the estimated memory (bytes) for importing a text of length `text`, without included
/// files, and for reading the resulting scene of length `scene`.
#[must_use]
pub fn of_import(text: usize, scene: usize) -> usize {
    let elements = OF_ELEMENTS.saturating_mul(text);
    FLOOR + elements.saturating_add(OF_IMPORTED.saturating_mul(scene))
}

impl AssembledScene {
    /// Returns the estimated memory (bytes) of the mechanism, the ranks, the independent rows, and
    /// the verdicts on this number of threads. The memory of the text is not included. See
    /// [`memory_of_verdicts`].
    ///
    /// # Errors
    /// [`StudyError::Analysis`]: elimination would take too many operations for a sparse decision.
    pub fn memory_of_verdicts(&self, threads: usize) -> Result<usize, StudyError> {
        Ok(memory_of_verdicts(&self.mechanism, threads)?.most(0))
    }
}

impl Study {
    /// Returns the estimated memory (bytes) of a run, including the reading of a text of this
    /// length and the verdicts at the start.
    ///
    /// # Errors
    /// [`StudyError::Analysis`]: elimination would take too many operations for a sparse decision.
    pub fn memory(&self, text: usize) -> Result<usize, StudyError> {
        let mechanism = &self.prepared.mechanism;
        let verdicts = memory_of_verdicts(mechanism, crate::threads())?;
        let method = self.options.as_ref().map_or(Method::Auto, |o| o.method);
        let columns = OF_COLUMNS * mechanism.layout().groups.len();
        let run = OF_RUN + columns + self.prepared.memory(method);
        Ok(of_reading(text) + verdicts.most(run))
    }
}
