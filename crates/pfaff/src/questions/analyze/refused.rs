//! Errors of an analysis.

use crate::error::StudyError;
use crate::question::{INTERRUPTED, NOTHING_WRITTEN};
use crate::refusal::Refusal;
use crate::start::Start;

/// Returns the reason why there is no analysis. No output is written before the analysis is
/// complete.
pub(super) fn refused(of: &Start<'_>, error: StudyError) -> Refusal {
    match error {
        StudyError::Interrupted => Refusal::stopped(NOTHING_WRITTEN.to_owned()).coded(INTERRUPTED),
        error => of.refusal(error),
    }
}
