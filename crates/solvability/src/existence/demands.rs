//! The motions that drives prescribe.

use model::{ConstraintId, Mechanism, Scratch, System};

use super::ConstraintLevel;
use crate::words::short;

/// The motion that a drive prescribes at one time.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Demand {
    /// The drive.
    pub drive: String,
    /// The driven joint and the measure; `None` if no joint is at this place, or the drive
    /// is in the place of the joint.
    pub joint: Option<(String, &'static str)>,
    /// The measure.
    pub measure: &'static str,
    /// Whether the measure is an angle.
    pub angular: bool,
    /// Change of the measure since the start, its rate and acceleration.
    pub prescribed: [f64; 3],
}

impl Demand {
    /// The demand of a drive whose function of time has been evaluated. Returns `None` if this is
    /// not a drive.
    pub(super) fn of(mechanism: &Mechanism, id: ConstraintId, s: &Scratch) -> Option<Self> {
        let groups = &mechanism.layout().groups;
        let group = &groups[id.0];
        // After the prescribed motion come the angles that are counted.
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

    /// "the angle of `A`"
    pub(super) fn of_what(&self) -> String {
        match &self.joint {
            Some((joint, measure)) => format!("the {measure} of `{joint}`"),
            None => format!("its {}", self.measure),
        }
    }

    /// "to change by 0.3 m"
    pub(super) fn asked(&self, level: ConstraintLevel) -> String {
        let (verb, value) = match level {
            ConstraintLevel::Position => ("change by", self.prescribed[0]),
            ConstraintLevel::Velocity => ("change at", self.prescribed[1]),
            ConstraintLevel::Acceleration => ("accelerate at", self.prescribed[2]),
        };
        format!("to {verb} {} {}", short(value), level.unit(self.angular))
    }
}
