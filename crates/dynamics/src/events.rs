//! Events during a run that are reported to the user.

use model::ConstraintId;
use solvability::Value;

/// One event.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Event {
    /// Time (s).
    pub time: f64,
    /// Kind of event.
    pub kind: EventKind,
    /// Degree of redundancy before.
    pub redundancy_before: usize,
    /// Degree of redundancy after.
    pub redundancy_after: usize,
    /// Rows dropped after the event, from 0.
    pub dropped: Vec<usize>,
    /// Description.
    pub text: String,
    /// The impulses of all joints and drives where velocities jump; empty at other events, and
    /// if no reactions are requested.
    pub impulses: Vec<ReactionImpulse>,
}

/// The impulse of a joint or drive where velocities jump: the integral of its reaction over the
/// instant, with the components of the reaction.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ReactionImpulse {
    /// The joint or drive.
    pub id: ConstraintId,
    /// The components that are not identically zero, and the named one of the definition, with
    /// their names and their verdicts at this instant (N·s, N·m·s).
    pub components: Vec<(&'static str, Value)>,
}

impl Event {
    /// An event that does not change the degree of redundancy, with the rows dropped after it.
    pub(crate) fn at(time: f64, kind: EventKind, dropped: &[usize], text: String) -> Self {
        Self {
            time,
            kind,
            redundancy_before: dropped.len(),
            redundancy_after: dropped.len(),
            dropped: dropped.to_vec(),
            text,
            impulses: Vec::new(),
        }
    }
}

/// Kinds of events.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum EventKind {
    /// Other rows are kept; the rank is the same.
    RowsExchanged,
    /// A singular configuration was passed: the rank dropped for an instant.
    SingularPassage,
    /// A rate, and with it the velocities, jumped.
    Impulse,
    /// Generated code was no longer reliable: the equations are interpreted from here on.
    CodeLeft,
    /// Generated code is used again.
    CodeUsed,
}

impl EventKind {
    /// Whether another stretch of verdicts begins with it.
    #[must_use]
    pub fn cuts(self) -> bool {
        match self {
            Self::RowsExchanged | Self::SingularPassage | Self::Impulse => true,
            Self::CodeLeft | Self::CodeUsed => false,
        }
    }

    /// Its name in output files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::RowsExchanged => "rows-exchanged",
            Self::SingularPassage => "singular-passage",
            Self::Impulse => "impulse",
            Self::CodeLeft => "code-left",
            Self::CodeUsed => "code-used",
        }
    }
}
