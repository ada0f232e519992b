//! The plan of one component: a set of bodies that affect each other.

use model::{ConstraintId, Mechanism, Places};
use solvability::{Choice, Extent, Group};

use super::decisions::Decisions;
use super::sizes::Sizes;
use crate::error::MotionError;
use crate::limits::NAMED;
use crate::options::MotionOptions;
use crate::prepare::PreparedMechanism;

/// The plan of one component.
pub struct ComponentPlan<'a> {
    /// Names of the bodies, as text.
    pub name: String,
    /// Sizes of the component.
    pub sizes: Sizes,
    /// Decisions for the component.
    pub decisions: Decisions,
    whose: Whose<'a>,
}

/// The prepared mechanism of a component.
enum Whose<'a> {
    /// The whole mechanism.
    Whole(&'a PreparedMechanism),
    /// A part, and its indices in the whole mechanism.
    Part(Box<(PreparedMechanism, Places)>),
}

impl<'a> ComponentPlan<'a> {
    /// Returns the whole mechanism as one component, with the reactions of the requested groups.
    pub(super) fn whole(
        prepared: &'a PreparedMechanism,
        options: &MotionOptions,
        wanted: &[bool],
    ) -> Result<Self, MotionError> {
        let reactions = (0..wanted.len()).filter(|&k| wanted[k]).collect();
        Self::of(Whose::Whole(prepared), options, reactions)
    }

    /// Returns a component as a part of the whole mechanism. `wanted` has one entry for each joint
    /// and drive of the whole mechanism.
    pub(super) fn part(
        (prepared, places): (PreparedMechanism, Places),
        options: &MotionOptions,
        wanted: &[bool],
    ) -> Result<Self, MotionError> {
        let groups = 0..places.groups.len();
        let reactions = groups.filter(|&own| wanted[places.groups[own]]).collect();
        Self::of(
            Whose::Part(Box::new((prepared, places))),
            options,
            reactions,
        )
    }

    fn of(
        whose: Whose<'a>,
        options: &MotionOptions,
        reactions: Vec<usize>,
    ) -> Result<Self, MotionError> {
        let prepared = whose.prepared();
        Ok(Self {
            name: name(&prepared.mechanism),
            sizes: Sizes::of(prepared),
            decisions: Decisions::new(prepared, options, reactions)?,
            whose,
        })
    }

    /// Returns the mechanism with its start.
    #[must_use]
    pub fn prepared(&self) -> &PreparedMechanism {
        self.whose.prepared()
    }

    /// Returns the part of a group of the whole mechanism that belongs to this component.
    pub(crate) fn share(&self, group: &Group) -> Option<Group> {
        match self.places() {
            None => Some(group.clone()),
            Some(places) => group.share(|id| {
                let own = places.groups.binary_search(&id.0).ok();
                own.map(ConstraintId)
            }),
        }
    }

    /// Returns the part of a choice of the whole mechanism that belongs to this component.
    pub(crate) fn share_of_choice(&self, choice: &Choice) -> Choice {
        let places = self.places().cloned();
        choice.share(&places.map_or(Extent::Whole, Extent::Places))
    }

    /// Returns the indices of the component in the whole mechanism, or `None` if the component is
    /// the whole mechanism.
    #[must_use]
    pub fn places(&self) -> Option<&Places> {
        match &self.whose {
            Whose::Whole(_) => None,
            Whose::Part(part) => Some(&part.1),
        }
    }
}

impl Whose<'_> {
    fn prepared(&self) -> &PreparedMechanism {
        match self {
            Whose::Whole(prepared) => prepared,
            Whose::Part(part) => &part.0,
        }
    }
}

/// Returns the bodies of a mechanism as text.
fn name(mechanism: &Mechanism) -> String {
    let names: Vec<&str> = mechanism.bodies().iter().map(|b| b.name.as_str()).collect();
    match names.len() {
        0..=NAMED => names.join(", "),
        n => format!("{}, … ({n} bodies)", names[..NAMED - 1].join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use model::{Body, Description};

    use super::*;

    #[test]
    fn three_bodies_are_named_and_more_are_counted() {
        let named = |bodies: &[&str]| {
            let body = |name: &&str| Body {
                name: (*name).into(),
                mass: 1.0,
                inertia: 1.0,
                ..Body::default()
            };
            let description = Description {
                bodies: bodies.iter().map(body).collect(),
                ..Description::default()
            };
            name(&Mechanism::build(&description).unwrap())
        };
        assert_eq!(named(&["crank", "rod", "slider"]), "crank, rod, slider");
        assert_eq!(named(&["a", "b", "c", "d"]), "a, b, … (4 bodies)");
    }
}
