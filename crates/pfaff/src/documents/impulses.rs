//! Impulses of joints and drives at jumps of velocities, with their verdicts.

use dynamics::ReactionImpulse;
use serde::Serialize;
use solvability::Value;

use super::ByName;

/// The impulse of a joint or drive.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ImpulseDocument {
    /// Components that are not identically zero, and the named component of the definition, at this
    /// instant (N·s, N·m·s).
    pub components: ByName<Value>,
}

impl From<&ReactionImpulse> for ImpulseDocument {
    fn from(impulse: &ReactionImpulse) -> Self {
        let components = impulse.components.iter();
        let components = components.map(|(name, value)| ((*name).to_owned(), value.clone()));
        Self {
            components: ByName(components.collect()),
        }
    }
}
