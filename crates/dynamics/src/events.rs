//! Events during a run that the output reports.

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
    /// Redundant rows after the event, from 0.
    pub dropped: Vec<usize>,
    /// Description.
    pub text: String,
    /// Impulses of all joints and drives if velocities jump. The list is empty for other events,
    /// and if no reactions are requested.
    pub impulses: Vec<ReactionImpulse>,
}

/// The impulse of a joint or drive at a jump of the velocities. The impulse is the integral of each
/// component of the reaction over the instant.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ReactionImpulse {
    /// The joint or drive.
    pub id: ConstraintId,
    /// The components that are not identically zero, and the component that the joint type defines.
    /// Each component has its name and its value (N·s, N·m·s), with the verdict at this instant.
    pub components: Vec<(&'static str, Value)>,
}

impl Event {
    /// Creates an event that does not change the degree of redundancy. `dropped` are the redundant
    /// rows after the event.
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
    /// Other independent rows are used; the rank is the same.
    RowsExchanged,
    /// The mechanism moved through a singular configuration. The rank was lower for an instant.
    SingularPassage,
    /// A prescribed rate jumped, and therefore the velocities also jumped.
    Impulse,
    /// One-sided joints open; the run ends.
    Lifts,
    /// Contacts that grip slip for every sharing of the loads; the run ends.
    Slips,
    /// Generated code became unreliable. The equations are interpreted from this time on.
    CodeLeft,
    /// Generated code is used again.
    CodeUsed,
}

impl EventKind {
    /// Returns whether a new interval of verdicts starts with this event.
    #[must_use]
    pub fn cuts(self) -> bool {
        match self {
            Self::RowsExchanged | Self::SingularPassage | Self::Impulse => true,
            Self::Lifts | Self::Slips | Self::CodeLeft | Self::CodeUsed => false,
        }
    }

    /// Returns the name in output files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::RowsExchanged => "rows-exchanged",
            Self::SingularPassage => "singular-passage",
            Self::Impulse => "impulse",
            Self::Lifts => "lifts",
            Self::Slips => "slips",
            Self::CodeLeft => "code-left",
            Self::CodeUsed => "code-used",
        }
    }
}
