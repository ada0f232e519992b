//! The parts of the mechanism: bodies, points on bodies, joints, drives and forces.

use std::collections::HashSet;

use model::{Force, Measure, Registry};

use crate::bodies::Bodies;
use crate::body::SceneBody;
use crate::combination::{ReactionNames, Reactions};
use crate::drive::{self, Action, DriveRead};
use crate::element::Types;
use crate::force;
use crate::function::Domain;
use crate::joint;
use crate::joint_name::{JointNames, References};
use crate::joint_read::JointRead;
use crate::measure;
use crate::names::{NameUse, Names};
use crate::reactions::components;
use crate::section::{self, tables};
use crate::source_map::Entry;
use crate::table::Table;

/// The parts of the mechanism.
pub(crate) struct Parts<'r, S: SceneBody> {
    pub(crate) bodies: Bodies<S>,
    pub(crate) measures: Vec<(Measure, Entry)>,
    pub(crate) joints: Vec<JointRead<'r, S>>,
    pub(crate) drives: Vec<DriveRead<S>>,
    pub(crate) forces: Vec<(Force<S>, Entry)>,
    pub(crate) names: Names,
    pub(crate) domains: Vec<Domain>,
}

impl<'r, S: SceneBody> Parts<'r, S> {
    /// Reads all parts.
    pub(crate) fn read(root: &mut Table, registry: &'r Registry) -> Self {
        let mut names = Names::of(S::KIND);
        let mut bodies = Bodies::default();
        for (table, name) in tables(root, &section::BODY) {
            names.bodies.push(NameUse::of(&name, &table));
            bodies.read(table, &name);
        }
        for (table, name) in tables(root, &section::MARKER) {
            names.bodies.push(NameUse::of(&name, &table));
            bodies.markers.read::<S>(table, &name, &bodies.names);
        }
        let mut measures = Vec::new();
        for (table, name) in tables(root, &section::MEASURE) {
            names.bodies.push(NameUse::of(&name, &table));
            names.measures.push(NameUse::of(&name, &table));
            measures.extend(measure::read::<S>(table, &name, &bodies.markers));
        }
        let mut domains = Vec::new();
        let found = tables(root, &section::JOINT);
        let used = found.iter().map(|(table, name)| NameUse::of(name, table));
        names.elements.extend(used);
        let types = Types::of_joints(registry);
        let mut joints = joint::read(found, &types, &bodies, &mut domains);
        let references = References {
            bodies: &bodies,
            joints: &JointNames::of(&joints),
            is_active: true,
        };
        let (mut drives, mut forces, mut replaced) = (Vec::new(), Vec::new(), HashSet::new());
        for (table, name) in tables(root, &section::DRIVE) {
            names.elements.push(NameUse::of(&name, &table));
            let mut read = drive::read(table, &name, references.joints, &mut domains);
            replaced.extend(read.in_place_of.take());
            match read.action {
                Action::Motion(_) => drives.push(read),
                Action::Law(law) => forces.extend(law),
            }
        }
        let types = Types::of_forces(registry);
        for (table, name) in tables(root, &section::FORCE) {
            names.elements.push(NameUse::of(&name, &table));
            let force = force::read(table, &name, &types, &references, &mut domains);
            forces.extend(force);
        }
        joints.retain(|joint| !replaced.contains(&joint.name));
        Self {
            bodies,
            measures,
            joints,
            drives,
            forces,
            names,
            domains,
        }
    }

    /// Returns all joints and drives by name, or only the active joints and drives. Joints and
    /// drives that could not be read are included.
    pub(crate) fn reactions(&self, of: Participation) -> Reactions<'_> {
        let space = self.names.space;
        let joints = self.joints.iter().map(|joint| {
            let spec = joint.definition().map(|definition| definition.spec);
            (&joint.name, spec, joint.is_active)
        });
        let drives = self.drives.iter().map(|drive| {
            let spec = drive.motion().map(|own| own.element.spec());
            (&drive.name, spec, drive.is_active)
        });
        let (mut wanted, mut others) = (Vec::new(), Vec::new());
        for (name, spec, is_active) in joints.chain(drives) {
            if is_active || of == Participation::Any {
                let components = spec.map(|spec| components(space, spec));
                wanted.push(ReactionNames { name, components });
            } else {
                others.push(name.as_str());
            }
        }
        Reactions::new(wanted).without(others.into_iter())
    }

    /// Number of rows, if all joints and drives could be read.
    pub(crate) fn rows(&self) -> Option<usize> {
        let joints = self.joints.iter().map(|joint| {
            let spec = joint.complete.as_ref()?.joint.element.spec();
            Some((spec, joint.is_active))
        });
        let drives = self
            .drives
            .iter()
            .map(|drive| Some((drive.motion()?.element.spec(), drive.is_active)));
        let rows = joints.chain(drives).map(|read| {
            let (spec, is_active) = read?;
            Some(if is_active { spec.rows.len() } else { 0 })
        });
        rows.sum()
    }
}

/// The joints and drives to which a reference may refer.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Participation {
    Any,
    Active,
}
