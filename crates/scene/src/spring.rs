//! Forces of the type `torsion-spring-damper` in space: on the angle of a joint. They name a joint,
//! as drives do; in the plane the type is a definition between two bodies.

use joints::spec::Unit;
use model::law::{Join, Law, Operation};
use model::{Force, Function, SpaceKind};

use crate::active;
use crate::dimension::Dimension;
use crate::findings::Findings;
use crate::force::Forces;
use crate::joint::{JOINT, JointNames, dimension, must_be_active, of_name};
use crate::key::{Interval, Key, TYPE, Takes};
use crate::mistake::Mistake;
use crate::nearest::list;
use crate::source_map::Entry;
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

/// Keys of such a spring in addition to its name and its type.
pub(crate) const KEYS: [Key; 5] = [OF, MEASURE, STIFFNESS, DAMPING, FREE_ANGLE];

/// Whether this force is one of these springs.
pub(crate) fn is_meant<S: SceneSpace>(table: &Table) -> bool {
    S::KIND == SpaceKind::Space3 && table.peek(TYPE) == Some(SPRING)
}

impl<S: SceneSpace> Forces<S> {
    /// Reads a spring on the angle of a joint.
    pub(crate) fn read_spring(
        &mut self,
        mut table: Table,
        name: &str,
        joints: &JointNames<S>,
        findings: &mut Findings,
    ) {
        let _ = table.optional(TYPE);
        let field = table.required(&OF, findings);
        let joint = field.as_ref().and_then(|field| {
            let name = field.text(JOINT.expected, findings)?;
            of_name(name, field, joints, findings)
        });
        let measure = table.optional(&MEASURE);
        let number = |key: &Key, unit: Unit, table: &mut Table, findings: &mut Findings| {
            let field = table.required(key, findings)?;
            field.number(unit.into(), findings)
        };
        let stiffness = number(&STIFFNESS, Unit::TorsionStiffness, &mut table, findings);
        let damping = number(&DAMPING, Unit::TorsionDamping, &mut table, findings);
        let free = table
            .optional(&FREE_ANGLE)
            .map(|field| field.number(Dimension::ANGLE, findings));
        let is_active = active::read(&mut table, findings);
        if let (Some(field), true) = (&field, is_active) {
            must_be_active(&table.subject, "springs", field.span(), joint, findings);
        }
        let entry = Entry::switched(name, &table, is_active);
        let (subject, at) = (table.subject.clone(), table.span_of(OF.name));
        table.close(findings);
        let Some(joint) = joint else { return };
        let angles: Vec<&'static str> = match joint.definition {
            Some(definition) => {
                let measures = definition.spec.measures.iter().map(|m| m.name);
                measures
                    .filter(|m| dimension(joint, m) == Some(Dimension::ANGLE))
                    .collect()
            }
            None if joint.is_coupling => Vec::new(),
            None => return,
        };
        let asked = match &measure {
            Some(field) => match field.text(MEASURE.expected, findings) {
                Some(text) => Some((text, field.span())),
                None => return,
            },
            None => angles.first().map(|first| (*first, at.clone())),
        };
        let found = asked
            .as_ref()
            .and_then(|(asked, _)| angles.iter().find(|angle| **angle == *asked));
        let Some(&angle) = found else {
            let help = if angles.is_empty() {
                "springs act on the angle of a revolute, cylindrical or screw joint".to_owned()
            } else {
                format!("its angles are {}", list(angles.iter().copied()))
            };
            findings.error_with_help(
                Mistake::UnknownMeasure,
                asked.map_or(at, |(_, at)| at),
                format!("{subject}: joint `{}` has no such angle", joint.name),
                "no angle here",
                Some(help),
            );
            return;
        };
        let (Some(stiffness), Some(damping)) = (stiffness, damping) else {
            return;
        };
        let law = match free {
            Some(None) => return,
            Some(Some(free)) => law(stiffness, damping, free),
            None => law(stiffness, damping, 0.0).map(Law::since_start),
        };
        let drive = joint.definition.and_then(|definition| {
            let at = definition
                .spec
                .measures
                .iter()
                .position(|m| m.name == angle)?;
            definition.drives.get(at)
        });
        let (Some(drive), Some((bodies, arguments)), Some(law)) = (drive, joint.with_motion(), law)
        else {
            return;
        };
        match (drive.law)(&arguments, law) {
            Ok(element) => {
                self.list.push(Force {
                    name: name.to_owned(),
                    bodies,
                    element,
                    functions: vec![Function::time()],
                });
                self.entries.push(entry);
            }
            Err(error) => findings.error(
                Mistake::Registry,
                at,
                format!("{subject}: {error}"),
                "not possible",
            ),
        }
    }
}

/// −(k·(angle − free) + c·rate)
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
