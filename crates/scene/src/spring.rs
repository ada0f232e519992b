//! Forces of the type `torsion-spring-damper` in space, which act on the angle of a joint. Like
//! drives, they refer to a joint; in the plane this type has a definition with two bodies.

use joints::spec::Unit;
use model::law::{Join, Law, Operation};
use model::{Force, SpaceKind};

use crate::dimension::Dimension;
use crate::joint_measure::Purpose;
use crate::joint_name::References;
use crate::key::{Interval, Key, TYPE, Takes};
use crate::space::SceneSpace;
use crate::table::Table;

/// The type of these forces.
pub(crate) const SPRING: &str = "torsion-spring-damper";

const OF: Key = Key::required("joint", "the name of a joint", Takes::Text)
    .doc("The joint whose angle is sprung; angles count their full turns");
const MEASURE: Key = Key::optional("measure", "an angle of the joint", Takes::Text)
    .doc("The angle of the joint; its first one if it is not given");
const STIFFNESS: Key = Key::required("stiffness", "a number", Takes::Number(Interval::Any))
    .doc("Torque per angle (N·m/rad)");
const DAMPING: Key = Key::required("damping", "a number", Takes::Number(Interval::Any))
    .doc("Torque per angular velocity (N·m·s/rad)");
const FREE_ANGLE: Key = Key::optional("free_angle", "a number", Takes::Number(Interval::Any))
    .unit(Dimension::ANGLE)
    .doc("Angle of the joint without torque at rest (rad); that of the start if it is not given");

/// Keys of such a spring, except its name and its type.
pub(crate) const KEYS: [Key; 5] = [OF, MEASURE, STIFFNESS, DAMPING, FREE_ANGLE];

/// Returns whether the table describes a spring on the angle of a joint.
pub(crate) fn is_meant<S: SceneSpace>(table: &Table) -> bool {
    S::KIND == SpaceKind::Space3 && table.peek(TYPE) == Some(SPRING)
}

/// Reads a spring on the angle of a joint; `None` if it could not be read.
pub(crate) fn read<S: SceneSpace>(
    table: &mut Table,
    name: &str,
    references: &References<'_, '_, '_, S>,
) -> Option<Force<S>> {
    let usage = (Purpose::Spring, references.is_active);
    let _ = table.optional(TYPE);
    let of = table.required(&OF);
    let joint = of
        .as_ref()
        .and_then(|field| references.joints.one(field, usage));
    let measure = table.optional(&MEASURE);
    let [stiffness, damping] = [
        (&STIFFNESS, Unit::TorsionStiffness),
        (&DAMPING, Unit::TorsionDamping),
    ]
    .map(|(key, unit)| table.of_key(key)?.number(unit.into()));
    let free = table.of_key(&FREE_ANGLE);
    let free = free.map(|field| field.number(FREE_ANGLE.unit));
    let (joint, of) = (joint?, of?);
    let asked = match &measure {
        Some(field) => Some(field.text(MEASURE.expected)?),
        None => None,
    };
    let field = measure.as_ref().unwrap_or(&of);
    let angle = joint.measure(asked, Purpose::Spring, field)?;
    let (stiffness, damping) = (stiffness?, damping?);
    let law = match free {
        Some(free) => law(stiffness, damping, free?),
        None => law(stiffness, damping, 0.0).map(Law::since_start),
    };
    angle.force(name, law?, field)
}

/// The force law −(k·(angle − free) + c·rate).
fn law(stiffness: f64, damping: f64, free: f64) -> Option<Law> {
    Law::new(&[
        Operation::Number(-stiffness),
        Operation::Measure,
        Operation::Number(free),
        Operation::Join(Join::Subtract),
        Operation::Join(Join::Multiply),
        Operation::Number(damping),
        Operation::Rate,
        Operation::Join(Join::Multiply),
        Operation::Join(Join::Subtract),
    ])
    .ok()
}
