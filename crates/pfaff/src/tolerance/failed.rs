//! Why a sample could not be assembled.

use std::fmt;

/// Why a sample could not be assembled.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SampleFailure {
    /// The reason, the same words for all samples with it.
    pub reason: &'static str,
    /// This sample in particular.
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
