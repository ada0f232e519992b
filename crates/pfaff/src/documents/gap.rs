//! Rows of a table without values.

use serde::Serialize;

/// Rows of a table without values of a choice, or without bounds.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Gap {
    /// Number of these rows.
    pub rows: usize,
    /// Time of the first of these rows (s).
    pub first: f64,
    /// Reason at the first of these rows.
    pub reason: String,
}

impl Gap {
    /// Creates a gap without rows. The first row of the gap will be at this time.
    #[must_use]
    pub fn at(first: f64, reason: String) -> Self {
        Self {
            rows: 0,
            first,
            reason,
        }
    }
}
