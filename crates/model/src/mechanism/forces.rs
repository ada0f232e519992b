//! The applied forces of a mechanism, without the weight: their data for pictures, and what they
//! apply at a state.

use joints::spec::{ForceSpec, Unit};

use super::holds::placed;
use super::{Mechanism, PlacedForce};
use crate::description::BodyRef;
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
    pub points: Vec<(BodyRef, [f64; 2])>,
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
            let element = &f.element;
            let spec = element.spec();
            AppliedForce {
                name: &f.name,
                spec,
                bodies: &f.site.bodies,
                points: placed(&spec.common, &f.site.bodies, element.points()),
            }
        })
    }

    /// The first force without a finite value at the pose and the twist of the scratch: "the force
    /// `spring`", or a drive by a law with its numbers.
    #[must_use]
    pub fn undefined(self, s: &mut Scratch) -> Option<String> {
        self.0.iter().find_map(|force| {
            let (x, v, f) = force.site.xvf(&s.slots);
            force.element.q(x, v, f, &mut s.block);
            let mut values = s.block[..force.columns.len()].iter();
            if values.all(|value| value.is_finite()) {
                return None;
            }
            let name = &force.name;
            Some(match force.element.drive(x, v, f) {
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
        let laws = self.0.iter().filter(|f| f.element.is_law());
        laws.map(|force| {
            let mut units = force.element.spec().common.functions();
            let turns = units.any(|(_, unit)| unit == Unit::Angle);
            (force.name.as_str(), if turns { "torque" } else { "force" })
        })
    }

    /// Forces and torques of the drives by laws at the pose and the twist of the scratch, each on
    /// the second body along the measure; NaN where one is not defined.
    pub fn of_laws(self, s: &Scratch) -> impl Iterator<Item = f64> {
        let forces = self.0.iter().filter_map(|force| {
            let (x, v, f) = force.site.xvf(&s.slots);
            force.element.drive(x, v, f)
        });
        forces.map(|d| d.force.unwrap_or(f64::NAN))
    }
}
