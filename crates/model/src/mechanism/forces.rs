//! The applied forces of a mechanism without gravity. This module returns their data for drawings,
//! and their values at a state.

use joints::spec::{ForceSpec, Unit};

use super::Mechanism;
use crate::body::BodyRef;
use crate::law::{DriveForce, UndefinedValue};
use crate::system::Scratch;

/// The applied forces of a mechanism, without gravity.
#[derive(Clone, Copy)]
pub struct AppliedForces<'m>(&'m Mechanism);

/// The data of an applied force for a drawing.
#[derive(Clone, Debug)]
pub struct AppliedForce<'m> {
    /// Name of the force.
    pub name: &'m str,
    /// Description of the definition of the force.
    pub spec: &'static ForceSpec,
    /// Bodies of the force.
    pub bodies: &'m [BodyRef],
    /// Points at which the force acts, each in the frame of its body (m).
    pub points: Vec<(BodyRef, [f64; 3])>,
}

/// A force or a force law whose derivatives with respect to coordinates and velocities are unknown.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{kind} `{name}` {gap}", kind = self.kind())]
#[non_exhaustive]
pub struct ForceWithoutDerivatives {
    /// Name of the force or drive.
    pub name: String,
    /// Whether the force is a drive with a force law.
    pub is_drive: bool,
    /// The reason.
    pub gap: DerivativeGap,
}

/// Reason why a force has no derivatives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DerivativeGap {
    /// The force calls a function, which returns only values.
    #[error("calls a function, which has no derivatives")]
    Function,
    /// The force depends on states of its law, which are not coordinates of the bodies.
    #[error("has a law with a state (`integral` or `lag`), which has no derivatives")]
    State,
}

impl ForceWithoutDerivatives {
    /// Returns "drive" or "force".
    #[must_use]
    pub fn kind(&self) -> &'static str {
        if self.is_drive { "drive" } else { "force" }
    }
}

/// A force without a finite value at a state.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum UndefinedForce {
    /// A force.
    #[error("the force `{name}`")]
    Force {
        /// Name of the force.
        name: String,
    },
    /// A force that is computed by a callback.
    #[error("the force `{name}` ({why})")]
    Called {
        /// Name of the force.
        name: String,
        /// The reason.
        why: UndefinedValue,
    },
    /// The values of a controller.
    #[error("the controller ({why})")]
    Controller {
        /// The reason.
        why: UndefinedValue,
    },
    /// A drive with a force law.
    #[error("the law of drive `{name}` ({why}, at measure = {measure:.6}, rate = {rate:.6})")]
    Law {
        /// The drive.
        name: String,
        /// Joint coordinate of the drive (m or rad).
        measure: f64,
        /// Rate of the joint coordinate (m/s or rad/s).
        rate: f64,
        /// The reason.
        why: UndefinedValue,
    },
}

impl UndefinedForce {
    /// Returns the name of the force or drive.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Force { name } | Self::Called { name, .. } | Self::Law { name, .. } => name,
            Self::Controller { .. } => "controller",
        }
    }

    /// Returns whether a callback is the cause.
    #[must_use]
    pub fn is_of_function(&self) -> bool {
        match self {
            Self::Law { why, .. } | Self::Called { why, .. } | Self::Controller { why } => {
                why.is_of_function()
            }
            Self::Force { .. } => false,
        }
    }
}

/// Returns the name and the unit of the load along the joint coordinate of a drive.
fn along(spec: &ForceSpec) -> (&'static str, Unit) {
    let mut units = spec.common.functions();
    if units.any(|(_, unit)| unit == Unit::Angle) {
        ("torque", Unit::Torque)
    } else {
        ("force", Unit::Force)
    }
}

/// The change of Q if a function of time of a force or the load of a drive changes.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Push<'m> {
    /// Name of the force.
    pub name: &'m str,
    /// Name of the function in the definition of the force; "force" or "torque" for a drive.
    pub function: &'static str,
    /// Unit of the function.
    pub unit: Unit,
    /// Change of Q for a unit change of the function, n_v values.
    pub q: Vec<f64>,
}

/// The change of a function of time, relative to its value or to 1. The central difference is exact
/// if Q is linear or quadratic in the function.
const PUSH: f64 = 1.0 / 256.0;

impl Mechanism {
    /// Returns the applied forces, without gravity.
    #[must_use]
    pub fn applied_forces(&self) -> AppliedForces<'_> {
        AppliedForces(self)
    }
}

impl<'m> AppliedForces<'m> {
    /// Returns whether there are no applied forces. In this case, only drives can add or remove
    /// energy.
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.0.elements.forces.is_empty()
    }

    /// Returns the data of the forces for a drawing. The function allocates memory.
    pub fn iter(self) -> impl Iterator<Item = AppliedForce<'m>> {
        self.0.elements.forces.iter().map(|f| {
            let spec = f.spec();
            AppliedForce {
                name: &f.name,
                spec,
                bodies: &f.site.bodies,
                points: f.points(),
            }
        })
    }

    /// Returns the change of Q for a unit change of each function of time, and for an additional
    /// unit force or torque of each drive with a force law and of each spring on a joint
    /// coordinate. Q is evaluated at the configuration and the velocities in the work space. The
    /// function allocates memory.
    #[must_use]
    pub fn pushes(self, s: &mut Scratch) -> Vec<Push<'m>> {
        let mut all = Vec::new();
        for force in &self.0.elements.forces {
            if force.is_law() {
                let (function, unit) = along(force.spec());
                let mut q = vec![0.0; s.force.len()];
                force
                    .with_unit_law()
                    .add_q((&s.slots, &mut s.buffers.block), 1.0, &mut q);
                all.push(Push {
                    name: &force.name,
                    function,
                    unit,
                    q,
                });
            } else if !force.is_called() {
                let functions = force.spec().common.functions();
                for ((function, unit), at) in functions.zip(force.site.functions.clone()) {
                    let value = s.slots.jets[at][0];
                    let step = PUSH * value.abs().max(1.0);
                    let mut q = vec![0.0; s.force.len()];
                    for sign in [1.0, -1.0] {
                        s.slots.jets[at][0] = value + sign * step;
                        force.add_q(
                            (&s.slots, &mut s.buffers.block),
                            sign / (2.0 * step),
                            &mut q,
                        );
                    }
                    s.slots.jets[at][0] = value;
                    all.push(Push {
                        name: &force.name,
                        function,
                        unit,
                        q,
                    });
                }
            }
        }
        all
    }

    /// Returns the forces without derivatives, in the order of the forces. These forces use a
    /// callback or states of a law.
    pub fn without_derivatives(self) -> impl Iterator<Item = ForceWithoutDerivatives> {
        self.0.elements.forces.iter().filter_map(|force| {
            let gap = match (force.is_called(), force.n_states()) {
                (true, _) => DerivativeGap::Function,
                (false, 0) => return None,
                (false, _) => DerivativeGap::State,
            };
            Some(ForceWithoutDerivatives {
                name: force.name.clone(),
                is_drive: force.is_law(),
                gap,
            })
        })
    }

    /// Returns the first force without a finite value at the configuration and the velocities in
    /// the work space.
    #[must_use]
    pub fn undefined(self, s: &mut Scratch) -> Option<UndefinedForce> {
        self.0.command(s);
        let is_known = |&place: &usize| s.slots.jets[place][0].is_finite();
        if !self.0.elements.signals.iter().all(is_known)
            && let Some(why) = self.0.uncommanded(s)
        {
            return Some(UndefinedForce::Controller { why });
        }
        self.0.elements.forces.iter().find_map(|force| {
            force.q(&s.slots, &mut s.buffers.block);
            let mut values = s.buffers.block[..force.columns.len()].iter();
            if values.all(|value| value.is_finite()) {
                return None;
            }
            let name = force.name.clone();
            Some(match force.drive(&s.slots) {
                Some(DriveForce {
                    measure,
                    rate,
                    force: Err(why),
                }) => UndefinedForce::Law {
                    name,
                    measure,
                    rate,
                    why,
                },
                _ => match force.undefined(&s.slots) {
                    Some(why) => UndefinedForce::Called { name, why },
                    None => UndefinedForce::Force { name },
                },
            })
        })
    }

    /// Returns the contribution of each force to Q at the configuration and the velocities in the
    /// work space, with the name of the force. Each contribution has n_v values. The function
    /// allocates memory.
    pub fn parts(self, s: &mut Scratch) -> impl Iterator<Item = (&'m str, Vec<f64>)> {
        self.0.command(s);
        let n = s.force.len();
        self.0.elements.forces.iter().map(move |force| {
            let mut q = vec![0.0; n];
            force.add_q((&s.slots, &mut s.buffers.block), 1.0, &mut q);
            (force.name.as_str(), q)
        })
    }

    /// Returns the names of the drives with force laws and the kind of the load, "force" or
    /// "torque", in the order of the forces.
    pub fn law_drives(self) -> impl Iterator<Item = (&'m str, &'static str)> {
        let laws = self.0.elements.forces.iter().filter(|f| f.is_law());
        laws.map(|force| (force.name.as_str(), along(force.spec()).0))
    }

    /// Returns the forces and torques of the drives with force laws at the configuration and the
    /// velocities in the work space. Each load acts on the second body along the joint coordinate.
    /// Undefined values are NaN.
    pub fn of_laws(self, s: &mut Scratch) -> impl Iterator<Item = f64> {
        self.0.command(s);
        let s = &*s;
        let forces = self
            .0
            .elements
            .forces
            .iter()
            .filter_map(|force| force.drive(&s.slots));
        forces.map(|d| d.force.unwrap_or(f64::NAN))
    }
}
