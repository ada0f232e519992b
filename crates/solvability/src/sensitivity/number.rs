//! Numbers that are linear in the reactions: components, directions, sums, moments. Each number can
//! be evaluated at any configuration and for any data. Therefore it changes like the reported
//! number.

use std::collections::BTreeSet;

use model::reaction::Reactions;
use model::space::{cross, difference, norm};
use model::{ConstraintId, Frame, Mechanism, Reaction, SpaceKind, System};

use crate::groups::{Group, RequestError, unknown_component};
use crate::parts::Extent;

/// A number that is linear in the reactions of some joints and drives. The number is the sum of its
/// terms.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReactionNumber {
    terms: Vec<ReactionTerm>,
}

/// One reaction, multiplied by a fixed vector, or resolved in axes that change with the
/// configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
struct ReactionTerm {
    joint: ConstraintId,
    factor: f64,
    kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// The number `force·F + torque·T` with fixed directions. T is taken about a fixed point or
    /// about the reference point.
    Along {
        force: [f64; 3],
        torque: [f64; 3],
        about: Option<[f64; 3]>,
    },
    /// The named component of the definition.
    Named,
    /// A component in axes that change with the configuration, as index of
    /// [`SpaceKind::components_in`].
    InFrame { frame: Frame, component: usize },
}

impl ReactionNumber {
    /// Returns a component of a reaction by its name. The component is one of the components of the
    /// space, or the named component of the definition.
    ///
    /// # Errors
    /// [`RequestError::UnknownReaction`], [`RequestError::UnknownComponent`]
    pub fn component(
        mechanism: &Mechanism,
        id: ConstraintId,
        name: &str,
    ) -> Result<Self, RequestError> {
        let mut number = Self::default();
        number.add_component(mechanism, id, name, 1.0)?;
        Ok(number)
    }

    /// Returns `Σ direction[k]·component[k]`. The components are given by their names.
    ///
    /// # Errors
    /// Returns the same errors as [`Self::component`].
    pub fn direction<'n>(
        mechanism: &Mechanism,
        id: ConstraintId,
        direction: impl IntoIterator<Item = (&'n str, f64)>,
    ) -> Result<Self, RequestError> {
        let space = mechanism.space();
        let (mut force, mut torque) = ([0.0; 3], [0.0; 3]);
        for (name, x) in direction {
            let k = space
                .component(name)
                .ok_or_else(|| unknown_component(mechanism, id, name))?;
            of_component(space, k, &mut force, &mut torque, x);
        }
        let about = None;
        Ok(Self::along(id, force, torque, about))
    }

    /// Returns the moment of a reaction along a fixed direction about a fixed point (m), in ground
    /// axes.
    #[must_use]
    pub fn moment(id: ConstraintId, along: [f64; 3], about: [f64; 3]) -> Self {
        Self::along(id, [0.0; 3], along, Some(about))
    }

    /// Returns a component of a reaction in a frame, given its index in
    /// [`SpaceKind::components_in`]. The axes change with the configuration.
    #[must_use]
    pub fn in_frame(id: ConstraintId, frame: Frame, component: usize) -> Self {
        Self::of(id, 1.0, Kind::InFrame { frame, component })
    }

    /// Returns the numbers of a sum with their names, as in [`crate::ReactionForms::numbers`], with
    /// moments about this fixed point. Groups of separate reactions and resultants have no numbers.
    ///
    /// # Errors
    /// Returns the same errors as [`Self::component`].
    pub fn of_group(
        mechanism: &Mechanism,
        group: &Group,
        about: Option<[f64; 3]>,
    ) -> Result<Vec<(&'static str, Self)>, RequestError> {
        let space = mechanism.space();
        Ok(match group {
            Group::Combination(terms) => {
                let mut sum = Self::default();
                for term in terms {
                    let (id, factor) = (term.reaction, term.coefficient);
                    sum.add_component(mechanism, id, &term.component, factor)?;
                }
                vec![("sum", sum)]
            }
            Group::WrenchSum(terms) => {
                let number = |k: usize| {
                    let each = terms.iter().map(|&(factor, joint)| {
                        let (mut force, mut torque) = ([0.0; 3], [0.0; 3]);
                        of_component(space, k, &mut force, &mut torque, 1.0);
                        let kind = Kind::Along {
                            force,
                            torque,
                            about,
                        };
                        ReactionTerm {
                            joint,
                            factor,
                            kind,
                        }
                    });
                    let terms = each.collect();
                    (space.components()[k], Self { terms })
                };
                (0..space.n_v()).map(number).collect()
            }
            Group::Members(_) | Group::OneJoint(_) | Group::Resultant(_) => Vec::new(),
        })
    }

    fn along(id: ConstraintId, force: [f64; 3], torque: [f64; 3], about: Option<[f64; 3]>) -> Self {
        Self::of(
            id,
            1.0,
            Kind::Along {
                force,
                torque,
                about,
            },
        )
    }

    fn of(joint: ConstraintId, factor: f64, kind: Kind) -> Self {
        Self {
            terms: vec![ReactionTerm {
                joint,
                factor,
                kind,
            }],
        }
    }

    fn add_component(
        &mut self,
        mechanism: &Mechanism,
        joint: ConstraintId,
        name: &str,
        factor: f64,
    ) -> Result<(), RequestError> {
        let groups = &mechanism.layout().groups;
        let unknown = || unknown_component(mechanism, joint, name);
        let group = groups.get(joint.0).ok_or_else(unknown)?;
        let kind = match mechanism.space().component(name) {
            Some(k) => {
                let (mut force, mut torque, about) = ([0.0; 3], [0.0; 3], None);
                of_component(mechanism.space(), k, &mut force, &mut torque, 1.0);
                Kind::Along {
                    force,
                    torque,
                    about,
                }
            }
            None if group.spec.component == Some(name) => Kind::Named,
            None => return Err(unknown()),
        };
        self.terms.push(ReactionTerm {
            joint,
            factor,
            kind,
        });
        Ok(())
    }

    /// Returns the joints and drives of the terms, each once, ascending.
    pub(super) fn joints(&self) -> BTreeSet<usize> {
        self.terms.iter().map(|term| term.joint.0).collect()
    }

    /// Returns the number of terms of this number.
    pub(super) fn terms(&self) -> usize {
        self.terms.len()
    }

    /// Returns the terms that belong to a part, in the numbering of the part.
    pub(super) fn within(&self, extent: &Extent) -> Self {
        let own = self.terms.iter().filter_map(|term| {
            let joint = ConstraintId(extent.own_group(term.joint.0)?);
            Some(ReactionTerm { joint, ..*term })
        });
        Self {
            terms: own.collect(),
        }
    }

    /// Returns the value that a load of 1 N has in this number: 1 for forces, and the size (m) for
    /// torques. For several terms, it is the largest value.
    pub(super) fn unit(&self, mechanism: &Mechanism, size: f64) -> f64 {
        let space = mechanism.space();
        let of = |term: &ReactionTerm| {
            let own = match term.kind {
                Kind::Along { force, torque, .. } => norm(&force).hypot(size * norm(&torque)),
                Kind::Named if turns(&mechanism.layout().groups[term.joint.0]) => size,
                Kind::Named => 1.0,
                Kind::InFrame { component, .. } if space.forces().contains(&component) => 1.0,
                Kind::InFrame { .. } => size,
            };
            term.factor.abs() * own
        };
        self.terms.iter().map(of).fold(0.0, f64::max)
    }

    /// Returns the contribution of one joint or drive with this reaction.
    pub(super) fn of_joint(
        &self,
        reactions: Reactions<'_>,
        id: ConstraintId,
        reaction: &Reaction,
    ) -> f64 {
        let terms = self.terms.iter().filter(|term| term.joint == id);
        let values = terms.map(|term| term.factor * value(reactions, id, term.kind, reaction));
        values.sum()
    }
}

/// Adds a component of the space with this coefficient to directions of force and torque.
fn of_component(
    space: SpaceKind,
    component: usize,
    force: &mut [f64; 3],
    torque: &mut [f64; 3],
    x: f64,
) {
    let axis = space.axis_of(component);
    if space.forces().contains(&component) {
        force[axis] += x;
    } else {
        torque[axis] += x;
    }
}

/// Returns whether the named component of a definition is a torque. In this case, no row of the
/// joint has a force in its reaction.
fn turns(group: &model::reaction::ConstraintGroup) -> bool {
    !(0..group.rows.len()).any(|row| group.pushes(row))
}

fn value(reactions: Reactions<'_>, id: ConstraintId, kind: Kind, reaction: &Reaction) -> f64 {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (f, t) = (reaction.force, reaction.torque);
    match kind {
        Kind::Along {
            force,
            torque,
            about,
        } => {
            let arm = about.map_or([0.0; 3], |about| difference(reactions.place(id), about));
            dot(force, f) + dot(torque, t) + dot(torque, cross(arm, f))
        }
        Kind::Named => reaction.component.unwrap_or(0.0),
        Kind::InFrame { frame, component } => {
            let Some(axes) = reactions.axes(id, frame) else {
                return 0.0;
            };
            let space = reactions.space();
            let is_force = space.forces().contains(&component);
            // In the plane, the direction of a torque is z in all axes.
            let along = match (is_force, space.n_rotations()) {
                (false, 1) => [0.0, 0.0, 1.0],
                _ => axes[component % axes.len()],
            };
            dot(along, if is_force { f } else { t })
        }
    }
}
