//! A decision with its reason.

use super::saving::{Cost, Saving};

/// A decision.
#[derive(Clone, Debug, PartialEq)]
pub struct Decided<T> {
    /// What was decided.
    pub value: T,
    /// The same in a few words.
    pub taken: String,
    /// Why.
    pub reason: String,
    /// What it saves, where that can be counted.
    pub saves: Option<Saving>,
}

/// A decision as a line of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line<'p> {
    /// The component that it is of; nothing if it is of the whole.
    pub component: Option<&'p str>,
    /// What was to be decided.
    pub decision: &'static str,
    /// What was decided.
    pub taken: &'p str,
    /// Why.
    pub reason: &'p str,
    /// What it saves.
    pub saves: Option<Saving>,
}

impl<T> Decided<T> {
    pub(crate) fn new(value: T, taken: impl Into<String>, reason: impl Into<String>) -> Self {
        let (taken, reason) = (taken.into(), reason.into());
        Self {
            value,
            taken,
            reason,
            saves: None,
        }
    }

    /// The same with what it saves: so many of so many, if any.
    pub(super) fn saving(self, left_out: u64, of: u64, what: Cost) -> Self {
        let saves = (left_out > 0).then_some(Saving { left_out, of, what });
        Self { saves, ..self }
    }

    /// A line of the whole.
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
