//! Combines and splits the verdicts of a motion on all joints and drives.

use model::{ConstraintId, Mechanism, System};

use super::{GroupStretches, ReactionStretches, Stretches, VerdictTrack};
use crate::components::number_names;
use crate::generic::GenericVerdict;
use crate::groups::Group;
use crate::parts::Extent;
use crate::verdict::Verdict;

impl Stretches {
    /// Creates verdicts that are unique from start to end.
    #[must_use]
    pub fn unique(mechanism: &Mechanism, extent: [f64; 2], groups: &[Group]) -> Self {
        let track = || VerdictTrack::constant(extent, Verdict::Unique);
        let layout = mechanism.layout();
        let reaction = |id: ConstraintId| ReactionStretches {
            id,
            whole: track(),
            components: number_names(&layout.groups[id.0])
                .map(|name| (name, track()))
                .collect(),
        };
        let of_group = |group: &Group| GroupStretches {
            whole: track(),
            numbers: group
                .number_names(layout.space)
                .iter()
                .map(|name| (*name, track()))
                .collect(),
        };
        Self {
            extent,
            reactions: layout.constraint_ids().map(reaction).collect(),
            groups: groups.iter().map(of_group).collect(),
        }
    }

    /// Creates the result from these verdicts on the components, in the order of joints and drives.
    pub(crate) fn of_components(
        mechanism: &Mechanism,
        extent: [f64; 2],
        components: impl IntoIterator<Item = VerdictTrack>,
    ) -> Self {
        let mut stretches = Self::unique(mechanism, extent, &[]);
        for (track, found) in stretches.components_mut().zip(components) {
            *track = found;
        }
        stretches.sum_up(&[]);
        stretches
    }

    /// Returns the verdicts on the joints and drives of a part, in the numbering of the part,
    /// without groups.
    pub(crate) fn of_part(&self, extent: &Extent, groups: usize) -> Self {
        let own = (0..groups).map(|own| ReactionStretches {
            id: ConstraintId(own),
            ..self.reactions[extent.group(own)].clone()
        });
        Self {
            extent: self.extent,
            reactions: own.collect(),
            groups: Vec::new(),
        }
    }

    /// Returns the verdicts on all components, in the order of joints and drives.
    pub(crate) fn components(&self) -> impl Iterator<Item = &VerdictTrack> {
        let own = self.reactions.iter();
        own.flat_map(|reaction| reaction.components.iter().map(|(_, track)| track))
    }

    /// Returns mutable verdicts on all components. [`Self::sum_up`] recomputes the verdicts on
    /// joints and drives from these verdicts.
    pub(crate) fn components_mut(&mut self) -> impl Iterator<Item = &mut VerdictTrack> {
        let own = self.reactions.iter_mut();
        own.flat_map(|reaction| reaction.components.iter_mut().map(|(_, track)| track))
    }

    /// Returns the verdicts on joints and drives on the intervals that contain this time, or `None`
    /// outside the motion.
    ///
    /// ```
    /// # use joints::Revolute;
    /// # use model::{Body, BodyRef, Description, Joint, Mechanism};
    /// # use pfaff_solvability::Stretches;
    /// # let pin = Revolute { s_i: [0.0; 2], s_j: [0.0, 1.0] };
    /// # let pendulum = Description {
    /// #     bodies: vec![Body { name: "bob".into(), mass: 1.0, inertia: 1.0, ..Body::default() }],
    /// #     joints: vec![Joint::new("pivot", &[BodyRef::Ground, BodyRef::Body(0)], pin)],
    /// #     ..Description::default()
    /// # };
    /// # let mechanism = Mechanism::build(&pendulum).unwrap();
    /// let stretches = Stretches::unique(&mechanism, [0.0, 2.0], &[]);
    /// let at_one = stretches.generic_at(1.0).unwrap();
    /// assert!(at_one[0].component("Fx").unwrap().is_unique());
    /// assert!(stretches.generic_at(2.1).is_none());
    /// ```
    #[must_use]
    pub fn generic_at(&self, t: f64) -> Option<Vec<GenericVerdict>> {
        let [from, to] = self.extent;
        let of = |reaction: &ReactionStretches| GenericVerdict {
            id: reaction.id,
            whole: reaction.whole.at(t).clone(),
            components: (reaction.components.iter())
                .map(|(name, track)| (*name, track.at(t).clone()))
                .collect(),
        };
        (from <= t && t <= to).then(|| self.reactions.iter().map(of).collect())
    }

    /// Copies the verdicts of some of the joints and drives to the indices that these have in the
    /// whole mechanism. A group of a part contains a share of a group of the whole mechanism.
    pub fn take(&mut self, own: &Self, places: &[usize], shares: &[usize]) {
        for (found, &place) in own.reactions.iter().zip(places) {
            self.reactions[place] = ReactionStretches {
                id: ConstraintId(place),
                ..found.clone()
            };
        }
        for (found, &place) in own.groups.iter().zip(shares) {
            let known = self.groups[place].numbers.iter_mut();
            for ((_, known), (_, track)) in known.zip(&found.numbers) {
                *known = VerdictTrack::together(&[known, track]);
            }
        }
    }

    /// Computes the verdict on each joint, drive or group from the verdicts on its components.
    pub fn sum_up(&mut self, groups: &[Group]) {
        for reaction in &mut self.reactions {
            let own: Vec<&VerdictTrack> = reaction.components.iter().map(|(_, t)| t).collect();
            if !own.is_empty() {
                reaction.whole = VerdictTrack::together(&own);
            }
        }
        for (group, found) in groups.iter().zip(&mut self.groups) {
            let own: Vec<&VerdictTrack> = match group {
                Group::Members(members) => members
                    .iter()
                    .map(|id| &self.reactions[id.0].whole)
                    .collect(),
                _ => found.numbers.iter().map(|(_, track)| track).collect(),
            };
            if !own.is_empty() {
                found.whole = VerdictTrack::together(&own);
            }
        }
    }
}
