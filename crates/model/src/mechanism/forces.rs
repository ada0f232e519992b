//! The applied forces of a mechanism, without the weight: their data for pictures, and what they
//! apply at a state.

use joints::spec::{ForceSpec, Unit};

use super::Mechanism;
use crate::body::BodyRef;
use crate::element::PlacedForce;
use crate::law::DriveForce;
use crate::system::Scratch;

/// The applied forces of a mechanism, without the weight.
#[derive(Clone, Copy)]
pub struct AppliedForces<'m>(&'m [PlacedForce]);

/// The data of an applied force for a picture.
#[derive(Clone, Debug)]
pub struct AppliedForce<'m> {
    /// Its name.
    pub name: &'m str,
    /// Description of its definition.
    pub spec: &'static ForceSpec,
    /// Its bodies.
    pub bodies: &'m [BodyRef],
    /// Points at which it acts, each in the frame of its body (m).
    pub points: Vec<(BodyRef, [f64; 3])>,
}

impl Mechanism {
    /// Its applied forces, without the weight.
    #[must_use]
    pub fn applied_forces(&self) -> AppliedForces<'_> {
        AppliedForces(&self.elements.forces)
    }
}

impl<'m> AppliedForces<'m> {
    /// Whether there are none: nothing but drives can add or remove energy.
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.0.is_empty()
    }

    /// Their data for a picture; allocates.
    pub fn iter(self) -> impl Iterator<Item = AppliedForce<'m>> {
        self.0.iter().map(|f| {
            let spec = f.spec();
            AppliedForce {
                name: &f.name,
                spec,
                bodies: &f.site.bodies,
                points: f.points(),
            }
        })
    }

    /// The first force without a finite value at the pose and the twist of the scratch: "the force
    /// `spring`", or a drive by a law with its numbers.
    #[must_use]
    pub fn undefined(self, s: &mut Scratch) -> Option<String> {
        self.0.iter().find_map(|force| {
            force.q(&s.slots, &mut s.block);
            let mut values = s.block[..force.columns.len()].iter();
            if values.all(|value| value.is_finite()) {
                return None;
            }
            let name = &force.name;
            Some(match force.drive(&s.slots) {
                Some(DriveForce {
                    measure,
                    rate,
                    force: Err(why),
                }) => format!(
                    "the law of drive `{name}` ({why}, at measure = {measure:.6}, rate = {rate:.6})"
                ),
                _ => format!("the force `{name}`"),
            })
        })
    }

    /// Names of the drives by laws and what they apply, "force" or "torque", in the order of the
    /// forces.
    pub fn law_drives(self) -> impl Iterator<Item = (&'m str, &'static str)> {
        let laws = self.0.iter().filter(|f| f.is_law());
        laws.map(|force| {
            let mut units = force.spec().common.functions();
            let turns = units.any(|(_, unit)| unit == Unit::Angle);
            (force.name.as_str(), if turns { "torque" } else { "force" })
        })
    }

    /// Forces and torques of the drives by laws at the pose and the twist of the scratch, each on
    /// the second body along the measure; NaN where one is not defined.
    pub fn of_laws(self, s: &Scratch) -> impl Iterator<Item = f64> {
        let forces = self.0.iter().filter_map(|force| force.drive(&s.slots));
        forces.map(|d| d.force.unwrap_or(f64::NAN))
    }
}
