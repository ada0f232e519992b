//! Impulses of joints and drives where velocities jump, with their verdicts.

use dynamics::{ImpulseComponent, ReactionImpulse};
use serde::Serialize;
use solvability::Verdict;

use super::Named;

/// The impulse of a joint or drive.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ImpulseDocument {
    /// Its components that are not identically zero, and the named one of its definition.
    pub components: Named<ImpulseComponentDocument>,
}

/// A component of an impulse.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ImpulseComponentDocument {
    /// The component (N·s, N·m·s); `null` if it is not unique.
    pub value: Option<f64>,
    /// Its verdict at this instant.
    pub verdict: &'static str,
    /// Reason why it is undecided.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

impl From<&ReactionImpulse> for ImpulseDocument {
    fn from(impulse: &ReactionImpulse) -> Self {
        let components = impulse.components.iter();
        let components = components.map(|c| (c.name.to_owned(), c.into()));
        Self {
            components: Named(components.collect()),
        }
    }
}

impl From<&ImpulseComponent> for ImpulseComponentDocument {
    fn from(component: &ImpulseComponent) -> Self {
        Self {
            value: component.value,
            verdict: component.verdict.word(),
            reason: match &component.verdict {
                Verdict::Undecided { reason } => Some(reason.clone()),
                _ => None,
            },
        }
    }
}
