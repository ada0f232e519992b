//! Contacts with surfaces that a scene describes as two-sided. Such contacts may pull.

use linalg::kernels::{max_abs, norm};
use model::start::scene_size;
use model::{ConstraintId, Mechanism, System};

use super::carried::pressing_force;
use crate::limits::CLEAR_PULL;
use crate::pose::evaluated;

/// The contacts with surfaces that are not one-sided.
#[derive(Clone, Debug)]
pub struct TwoSidedContacts {
    joints: Vec<ConstraintId>,
}

impl TwoSidedContacts {
    /// Returns the contacts of a mechanism, or `None` if the mechanism has no contacts.
    #[must_use]
    pub fn of(mechanism: &Mechanism) -> Option<Self> {
        let layout = mechanism.layout();
        let is_one = |id: &ConstraintId| {
            let group = &layout.groups[id.0];
            let is_two_sided = group.limits.open_side.is_none() && !group.is_drive();
            is_two_sided && group.spec.has_surface()
        };
        let joints: Vec<ConstraintId> = layout.constraint_ids().filter(is_one).collect();
        (!joints.is_empty()).then_some(Self { joints })
    }

    /// Returns the joints in the order of their rows.
    #[must_use]
    pub fn joints(&self) -> &[ConstraintId] {
        &self.joints
    }

    /// Returns the force (N) with which each contact pulls at time t, coordinates q and velocities
    /// v, for these multipliers (m + h). The force is zero for a contact that presses and for a
    /// force that is rounding of the loads. The force is NaN if its multiplier is NaN.
    #[must_use]
    pub fn pulls(
        &self,
        mechanism: &Mechanism,
        (t, q, v): (f64, &[f64], &[f64]),
        multipliers: &[f64],
    ) -> Vec<f64> {
        let mut s = evaluated(mechanism, t, q);
        mechanism.twist(v, &mut s);
        mechanism.force(&mut s);
        let (layout, reactions) = (mechanism.layout(), mechanism.reactions(&s));
        let mut block = Vec::new();
        let ids = layout.constraint_ids();
        let loads = ids.map(|id| norm(&reactions.reaction_in(&mut block, id, multipliers).force));
        // Without loads, a force is compared with the force that would reverse the velocities
        // within the size of the mechanism. Smaller forces are rounding.
        let turning = 2.0 * mechanism.kinetic_energy(q, v) / scene_size(mechanism, q);
        let size = loads.fold(max_abs(&s.force).max(turning), f64::max);
        // The gap of a surface is positive outside, so its multiplier is negative while it presses.
        let pull = |id: &ConstraintId| {
            let multiplier = multipliers[layout.groups[id.0].rows.row(0)];
            let pull = pressing_force(mechanism, &s, *id) * multiplier;
            if pull <= CLEAR_PULL * size { 0.0 } else { pull }
        };
        self.joints.iter().map(pull).collect()
    }
}
