//! A decision and the reason for it.

use super::saving::{Cost, Saving};

/// A decision.
#[derive(Clone, Debug, PartialEq)]
pub struct Decision<T> {
    /// The value that was chosen.
    pub value: T,
    /// Short description of the value.
    pub taken: String,
    /// Reason for the decision.
    pub reason: String,
    /// The computations that the decision saves, if they can be counted.
    pub saves: Option<Saving>,
}

/// A decision as a line of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line<'p> {
    /// The component. `None` if the decision applies to the whole mechanism.
    pub component: Option<&'p str>,
    /// The question that is decided.
    pub decision: &'static str,
    /// The decision.
    pub taken: &'p str,
    /// Reason for the decision.
    pub reason: &'p str,
    /// The computations that the decision saves.
    pub saves: Option<Saving>,
}

impl<T> Decision<T> {
    pub(crate) fn new(value: T, taken: impl Into<String>, reason: impl Into<String>) -> Self {
        let (taken, reason) = (taken.into(), reason.into());
        Self {
            value,
            taken,
            reason,
            saves: None,
        }
    }

    /// Adds the saving of the decision: `left_out` items of `of` are omitted.
    pub(super) fn saving(self, left_out: u64, of: u64, what: Cost) -> Self {
        let saves = (left_out > 0).then_some(Saving { left_out, of, what });
        Self { saves, ..self }
    }

    /// Returns a line about the whole mechanism.
    pub(super) fn line(&self, decision: &'static str) -> Line<'_> {
        Line {
            component: None,
            decision,
            taken: &self.taken,
            reason: &self.reason,
            saves: self.saves,
        }
    }
}
