//! The part of a mechanism that is drawn and plotted.

use model::{Mechanism, System};

use report::Frame;
use report::figures::drawing::Stage;

/// Largest number of joints and drives, and of bodies, that are drawn and plotted.
pub(super) const DRAWN_MAX: usize = 1200;

/// A mechanism, or the drawn part of a mechanism.
pub(super) struct Cast {
    part: Option<model::Part>,
    bodies: Vec<usize>,
    coordinates: Vec<usize>,
    joints: Vec<usize>,
}

impl Cast {
    /// Selects a small mechanism as a whole. For a large mechanism, selects the first bodies, and
    /// the joints and drives between these bodies.
    pub(super) fn of(mechanism: &Mechanism) -> Self {
        let groups = &mechanism.layout().groups;
        let bodies = mechanism.bodies().len();
        if groups.len() <= DRAWN_MAX && bodies <= DRAWN_MAX {
            return Self {
                part: None,
                bodies: (0..bodies).collect(),
                coordinates: (0..mechanism.layout().n_q).collect(),
                joints: (0..groups.len()).collect(),
            };
        }
        // A joint is drawn with the last of its bodies.
        let last = |k: &usize| groups[*k].bodies.iter().filter_map(|b| b.moving()).max();
        let mut joints: Vec<usize> = (0..groups.len()).collect();
        joints.sort_by_key(last);
        joints.truncate(DRAWN_MAX);
        let complete = joints.last().and_then(last);
        let all = groups.len();
        joints.retain(|k| all <= DRAWN_MAX || last(k) < complete || complete.is_none());
        joints.sort_unstable();
        let part = mechanism.part_of_groups(&joints);
        Self {
            bodies: part.places.bodies.clone(),
            coordinates: part.places.coordinates.clone(),
            joints,
            part: Some(part),
        }
    }

    /// Returns the bodies that are drawn, in ascending order.
    pub(super) fn bodies(&self) -> &[usize] {
        &self.bodies
    }

    /// Returns the joints and drives that are drawn, in ascending order.
    pub(super) fn joints(&self) -> &[usize] {
        &self.joints
    }

    pub(super) fn is_whole(&self) -> bool {
        self.part.is_none()
    }

    pub(super) fn stage<'a>(&'a self, whole: &'a Mechanism, frames: &'a [Frame]) -> Stage<'a> {
        Stage {
            mechanism: self.part.as_ref().map_or(whole, |p| &p.mechanism),
            bodies: self.bodies(),
            coordinates: &self.coordinates,
            frames,
        }
    }
}
