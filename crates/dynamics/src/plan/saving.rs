//! The amount of work that a run omits because of a decision.

use std::fmt;

/// Number of items that a run omits because of a decision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Saving {
    /// Number of omitted items.
    pub left_out: u64,
    /// Number of items without the decision.
    pub of: u64,
    /// Kind of the items.
    pub what: Cost,
}

/// Work that can be omitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cost {
    /// Output rows, with accurate dense output and projection.
    Rows,
    /// Multiply-adds of the dense elimination in an evaluation.
    Elimination,
    /// Pairs of sine and cosine in an evaluation.
    Trigonometry,
    /// Entries of C in an evaluation.
    Entries,
    /// Values of b and Φt in an evaluation.
    TimeRows,
    /// Values of Γ in an evaluation.
    Gamma,
    /// Stored floating-point numbers.
    Storage,
    /// Redundant rows whose residuals are compared with a limit at each accepted step.
    Monitors,
    /// Reactions at each output row.
    Reactions,
}

impl Cost {
    /// Returns the name of the work, and how often it is done.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Rows => "rows",
            Self::Elimination => "multiply-adds per evaluation",
            Self::Trigonometry => "sines and cosines per evaluation",
            Self::Entries => "entries of C per evaluation",
            Self::TimeRows => "values of b",
            Self::Gamma => "values of Γ per evaluation",
            Self::Storage => "stored numbers",
            Self::Monitors => "compared rows per step",
            Self::Reactions => "reactions per row",
        }
    }
}

impl fmt::Display for Saving {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} of {} {}", self.left_out, self.of, self.what.name())
    }
}
