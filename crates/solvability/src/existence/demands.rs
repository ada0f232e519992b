//! The motions that drives prescribe.

use model::words::quantity;
use model::{ConstraintId, Mechanism, Scratch, System};

use super::ConstraintLevel;

/// The motion that a drive prescribes at one time.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Demand {
    /// The drive.
    pub drive: String,
    /// The driven joint and the joint coordinate. `None` if the drive has no joint at its reference
    /// point, or if the drive replaces the joint.
    pub joint: Option<(String, &'static str)>,
    /// Name of the joint coordinate.
    pub measure: &'static str,
    /// Whether the joint coordinate is an angle.
    pub angular: bool,
    /// The change of the joint coordinate since the start, the rate of the coordinate and its
    /// acceleration.
    pub prescribed: [f64; 3],
}

impl Demand {
    /// Returns the motion that a drive prescribes, given its evaluated function of time. Returns
    /// `None` if the constraint is not a drive.
    pub(super) fn of(mechanism: &Mechanism, id: ConstraintId, s: &Scratch) -> Option<Self> {
        let groups = &mechanism.layout().groups;
        let group = &groups[id.0];
        // The unwrapped angles follow the prescribed motion in the list.
        let [prescribed, ..] = *mechanism.prescribed(id, s) else {
            return None;
        };
        group.is_drive().then(|| Self {
            drive: group.name.clone(),
            joint: mechanism
                .driven(id)
                .map(|(joint, measure)| (groups[joint.0].name.clone(), measure)),
            measure: group.spec.common.scene_type,
            angular: mechanism.layout().is_angular(group.rows.row(0)),
            prescribed,
        })
    }

    /// Returns, for example, "the angle of `A`".
    pub(super) fn of_what(&self) -> String {
        match &self.joint {
            Some((joint, measure)) => format!("the {measure} of `{joint}`"),
            None => format!("its {}", self.measure),
        }
    }

    /// Returns, for example, "to change by 0.3 m".
    pub(super) fn asked(&self, level: ConstraintLevel) -> String {
        let (verb, value) = match level {
            ConstraintLevel::Position => ("change by", self.prescribed[0]),
            ConstraintLevel::Velocity => ("change at", self.prescribed[1]),
            ConstraintLevel::Acceleration => ("accelerate at", self.prescribed[2]),
        };
        format!("to {verb} {}", quantity(value, level.unit(self.angular)))
    }
}
