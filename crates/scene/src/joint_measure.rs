//! Joint coordinates, to which tables refer: a drive prescribes one joint coordinate, a coupling
//! relates two joint coordinates, and a spring acts on an angle.

use joints::Argument;
use joints::spec::Measure;
use model::coupling::AttachedMeasure;
use model::registry::{ConstraintDefinition, DriveDefinition};
use model::{BodyRef, Force, Function, Law};

use crate::dimension::Dimension;
use crate::field::Field;
use crate::joint_read::{JointKind, JointRead};
use crate::mistake::Mistake;
use crate::nearest::{list, nearest};
use crate::space::SceneSpace;

/// Purpose for which a table refers to a joint.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// The table prescribes a joint coordinate, or a load along it.
    Drive,
    /// The table relates a joint coordinate to another one.
    Couple,
    /// The table adds a spring to an angle of the joint.
    Spring,
    /// The table uses the joint as the bearing of a wheel.
    Bear,
}

impl Purpose {
    /// The verb for this purpose in messages, before the name of the joint.
    pub(crate) fn verb(self) -> &'static str {
        match self {
            Self::Drive => "drives",
            Self::Couple => "couples",
            Self::Spring => "springs",
            Self::Bear => "is between wheels of",
        }
    }

    /// Advice for a joint without a suitable joint coordinate.
    fn without_measure(self) -> &'static str {
        match self {
            Self::Drive => "joints of this type cannot be driven",
            Self::Couple | Self::Bear => "joints of this type have no measure",
            Self::Spring => "springs need a joint with a measured angle, such as `revolute`",
        }
    }
}

/// The dimension of a joint coordinate of a definition, if its drive is registered.
pub(crate) fn dimension<S: SceneSpace>(
    definition: &ConstraintDefinition<S>,
    measure: usize,
) -> Option<Dimension> {
    let functions = definition.drives.get(measure)?.spec.common.functions();
    functions.last().map(|(_, unit)| unit.into())
}

/// A joint coordinate.
pub(crate) struct JointMeasure<'j, 'r, S: SceneSpace> {
    pub(crate) joint: &'j JointRead<'r, S>,
    pub(crate) spec: &'static Measure,
    pub(crate) dimension: Dimension,
    drive: &'r DriveDefinition<S>,
}

impl<'r, S: SceneSpace> JointRead<'r, S> {
    /// Returns the joint coordinate with this name, or otherwise the first suitable joint
    /// coordinate. If there is no suitable joint coordinate, the function reports this at a field
    /// and returns `None`.
    pub(crate) fn measure(
        &self,
        name: Option<&str>,
        purpose: Purpose,
        field: &Field,
    ) -> Option<JointMeasure<'_, 'r, S>> {
        let (findings, at) = (field.findings, field.span());
        let subject = &field.subject;
        let definition = match self.kind {
            JointKind::Unknown => return None,
            JointKind::Defined(definition) => definition,
            JointKind::Coupling => {
                findings.error(
                    Mistake::UnknownMeasure,
                    at,
                    format!(
                        "{subject}: `{}` is a coupling, which has no measure",
                        self.name
                    ),
                    "name a measure of one of its joints",
                );
                return None;
            }
        };
        let is_angle = |k| dimension(definition, k) == Some(Dimension::ANGLE);
        let of_joint = definition.spec.measures.iter().enumerate();
        let suitable = || {
            let of_joint = of_joint.clone();
            of_joint.filter(|(k, _)| purpose != Purpose::Spring || is_angle(*k))
        };
        let found = suitable().find(|(_, spec)| name.is_none_or(|name| spec.name == name));
        let Some((k, spec)) = found else {
            let what = match purpose {
                Purpose::Spring => "angle",
                _ => "measure",
            };
            let names = || suitable().map(|(_, spec)| spec.name);
            let named = name.map_or_else(String::new, |name| format!(" `{name}`"));
            findings.error_with_help(
                Mistake::UnknownMeasure,
                at,
                format!(
                    "{subject}: joint `{}` (`{}`) has no {what}{named}",
                    self.name, definition.spec.common.scene_type
                ),
                match name.and_then(|name| nearest(name, names())) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => format!("no such {what}"),
                },
                Some(match names().next() {
                    Some(_) => format!("its {what}s are {}", list(names())),
                    None => purpose.without_measure().to_owned(),
                }),
            );
            return None;
        };
        let (drive, dimension) = (definition.drives.get(k), dimension(definition, k));
        let Some((drive, dimension)) = drive.zip(dimension) else {
            let of = spec.name;
            findings.error(
                Mistake::Registry,
                at,
                format!("{subject}: the definition of the drive of `{of}` is not registered"),
                "no such definition",
            );
            return None;
        };
        Some(JointMeasure {
            joint: self,
            spec,
            dimension,
            drive,
        })
    }
}

impl<S: SceneSpace> JointMeasure<'_, '_, S> {
    /// Returns the bodies of the joint, and the arguments for a drive of the joint coordinate, if
    /// all arguments could be read.
    fn arguments(&self) -> Option<(Vec<BodyRef>, Vec<Argument>)> {
        let complete = self.joint.complete.as_ref()?;
        let mut arguments = complete.arguments.clone();
        // The last argument is the argument of the motion.
        arguments.push(Argument::Absent);
        Some((complete.joint.bodies.clone(), arguments))
    }

    /// Tolerance of the data of the joint (m).
    pub(crate) fn tolerance(&self) -> Option<f64> {
        self.joint.complete.as_ref()?.joint.tolerance
    }

    /// Returns the bodies of the joint and the kernels of the drive that prescribes the joint
    /// coordinate. The joint accepted these arguments, so an error can only be due to a wrong
    /// registration of the definition.
    pub(crate) fn rows(&self, field: &Field) -> Option<AttachedMeasure<S>> {
        let (bodies, arguments) = self.arguments()?;
        let built = (self.drive.build)(&arguments);
        let element = built.map_err(|error| refuse(field, &error));
        Some((bodies, element.ok()?))
    }

    /// Returns the force that a force law applies along the joint coordinate.
    pub(crate) fn force(&self, name: &str, law: Law, field: &Field) -> Option<Force<S>> {
        let (bodies, arguments) = self.arguments()?;
        let built = (self.drive.law)(&arguments, law);
        let element = built.map_err(|error| refuse(field, &error));
        Some(Force {
            name: name.to_owned(),
            bodies,
            element: element.ok()?,
            functions: vec![Function::time()],
        })
    }
}

fn refuse(field: &Field, error: &impl std::fmt::Display) {
    field.error(Mistake::Registry, format!(": {error}"), "not possible");
}
