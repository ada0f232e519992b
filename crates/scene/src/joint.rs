//! `[[joint]]`: constraints that the registry defines, couplings, and gear meshes between wheels.
//! Joints that refer to other joints are read after those joints.

use model::{ContactLimits, Joint};

use crate::active;
use crate::armature;
use crate::bodies::Bodies;
use crate::connection;
use crate::contact;
use crate::coupling;
use crate::element::{self, COUPLING, Types};
use crate::function::Domain;
use crate::joint_name::{JointNames, References};
use crate::joint_read::{CompleteJoint, JointKind, JointRead};
use crate::key::TYPE;
use crate::space::SceneSpace;
use crate::stiffness;
use crate::table::Table;
use crate::tolerance;

/// Reads all joints, in the order of the text.
pub(crate) fn read<'r, S: SceneSpace>(
    tables: Vec<(Table, String)>,
    types: &Types<'r, S>,
    bodies: &Bodies<S>,
    domains: &mut Vec<Domain>,
) -> Vec<JointRead<'r, S>> {
    let mut joints = Vec::with_capacity(tables.len());
    let mut waiting = Vec::new();
    let none = JointNames::of(&[]);
    for (table, name) in tables {
        joints.push(match naming_others(&table, types) {
            Some(kind) => {
                let joint = JointRead::new(&name, kind, &table);
                waiting.push((joints.len(), table, name));
                joint
            }
            None => one(table, &name, types, (bodies, &none), domains),
        });
    }
    let names = JointNames::of(&joints);
    let read = waiting.into_iter().map(|(at, table, name)| {
        let joint = one(table, &name, types, (bodies, &names), domains);
        (at, joint)
    });
    for (at, joint) in read.collect::<Vec<_>>() {
        joints[at] = joint;
    }
    joints
}

/// Returns the kind of a joint that refers to other joints; `None` for other joints.
fn naming_others<'r, S: SceneSpace>(
    table: &Table,
    types: &Types<'r, S>,
) -> Option<JointKind<'r, S>> {
    let scene_type = table.peek(TYPE)?;
    if scene_type == COUPLING {
        return Some(JointKind::Coupling);
    }
    let known = types.known.iter().find(|known| **known == scene_type)?;
    let mut definitions = types.registry.constraints(known);
    let teeth = definitions.find(|definition| definition.spec.common.bearings);
    teeth.map(JointKind::Defined)
}

/// Reads one joint.
fn one<'r, S: SceneSpace>(
    mut table: Table,
    name: &str,
    types: &Types<'r, S>,
    (bodies, joints): (&Bodies<S>, &JointNames<'_, 'r, S>),
    domains: &mut Vec<Domain>,
) -> JointRead<'r, S> {
    let mut read = JointRead::new(name, JointKind::Unknown, &table);
    let Some(scene_type) = element::scene_type(&mut table, types) else {
        connection::check_names(&mut table, &bodies.names);
        return read;
    };
    read.is_active = active::read(&table);
    let references = References {
        bodies,
        joints,
        is_active: read.is_active,
    };
    let (element, functions, arguments);
    if scene_type == COUPLING {
        read.kind = JointKind::Coupling;
        element = coupling::read(&mut table, &references);
        (functions, arguments) = (Vec::new(), Vec::new());
    } else {
        let definitions: Vec<_> = types.registry.constraints(scene_type).collect();
        let Some(found) = element::read(&mut table, &definitions, &references, domains) else {
            tolerance::read(&mut table, &tolerance::OF_JOINT);
            stiffness::read(&mut table, name, None, bodies);
            if let [definition, ..] = definitions[..] {
                contact::read(&mut table, definition.spec, &[]);
                armature::field(&mut table, definition.spec);
            }
            element::end(table, name, read.is_active);
            return read;
        };
        read.kind = JointKind::Defined(found.definition);
        element = found.element;
        (functions, arguments) = (found.arguments.functions, found.arguments.values);
    }
    let tolerance = tolerance::read(&mut table, &tolerance::OF_JOINT);
    let mut limits = ContactLimits::default();
    let centre = match read.kind {
        JointKind::Defined(definition) => {
            limits = contact::read(&mut table, definition.spec, &arguments);
            let joined = element.as_ref().map(|(bodies, _)| bodies.as_slice());
            stiffness::read(&mut table, name, joined, bodies)
        }
        _ => None,
    };
    let armature = match read.kind {
        JointKind::Defined(definition) => armature::field(&mut table, definition.spec),
        JointKind::Unknown | JointKind::Coupling => None,
    };
    let entry = element::end(table, name, read.is_active);
    read.complete = element.map(|(bodies, element)| CompleteJoint {
        joint: Joint {
            name: name.to_owned(),
            bodies,
            element,
            functions,
            tolerance,
            limits,
        },
        entry,
        arguments,
        centre,
        armatures: Vec::new(),
    });
    if let Some(field) = armature {
        let armatures = armature::read(&field, &read);
        if let Some(complete) = &mut read.complete {
            complete.armatures = armatures;
        }
    }
    read
}
