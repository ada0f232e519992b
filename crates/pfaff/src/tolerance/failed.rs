//! The reason why a sample could not be assembled.

use std::fmt;

/// The reason why a sample could not be assembled.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SampleFailure {
    /// The reason, as a text that is the same for all samples with this reason.
    pub reason: &'static str,
    /// Details of this sample.
    pub detail: String,
}

impl SampleFailure {
    pub(super) fn new(reason: &'static str, detail: impl fmt::Display) -> Self {
        Self {
            reason,
            detail: detail.to_string(),
        }
    }
}
