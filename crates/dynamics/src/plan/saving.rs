//! The computations that a decision saves, as a count.

use std::fmt;

/// A number of items that are omitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Saving {
    /// Number of omitted items.
    pub left_out: u64,
    /// Number of all items.
    pub of: u64,
    /// Kind of the items.
    pub what: Cost,
}

/// Work that can be omitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cost {
    /// Rows of output: accurate dense output, projection.
    Rows,
    /// Multiply-adds of the dense elimination of an evaluation.
    Elimination,
    /// Pairs of sine and cosine of an evaluation.
    Trigonometry,
    /// Entries of C of an evaluation.
    Entries,
    /// Values of b and Φt of an evaluation.
    TimeRows,
    /// Values of Γ of an evaluation.
    Gamma,
    /// Stored numbers.
    Storage,
    /// Rows whose residuals are compared with a limit at each accepted step.
    Monitors,
    /// Reactions at each row of output.
    Reactions,
}

impl Cost {
    /// Its name, with how often it is done.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Rows => "rows",
            Self::Elimination => "multiply-adds an evaluation",
            Self::Trigonometry => "sines and cosines an evaluation",
            Self::Entries => "entries of C an evaluation",
            Self::TimeRows => "values of b",
            Self::Gamma => "values of Γ an evaluation",
            Self::Storage => "stored numbers",
            Self::Monitors => "compared rows a step",
            Self::Reactions => "reactions a row",
        }
    }
}

impl fmt::Display for Saving {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} of {} {}", self.left_out, self.of, self.what.name())
    }
}
