//! Joints that name other joints: couplings of their measures, and teeth between wheels that they
//! bear. They are read when the others are known, and put where their tables stand.

use model::registry::ConstraintDefinition;

use crate::bodies::Bodies;
use crate::coupling;
use crate::element::{COUPLING, Types};
use crate::findings::Findings;
use crate::joint::{JointNames, Joints};
use crate::key::TYPE;
use crate::space::SceneSpace;
use crate::table::Table;
use crate::teeth;

/// What such a joint takes from others.
pub(crate) enum Kind<'r, S: SceneSpace> {
    /// Measures.
    Coupling,
    /// Bearings, by a definition that says so.
    Teeth(&'r ConstraintDefinition<S>),
}

impl<'r, S: SceneSpace> Kind<'r, S> {
    /// Returns `None` for the table of a joint that names no others.
    pub(crate) fn of(table: &Table, types: &Types<'r, S>) -> Option<Self> {
        let scene_type = table.peek(TYPE)?;
        if scene_type == COUPLING {
            return Some(Self::Coupling);
        }
        let known = types.known.iter().find(|known| **known == scene_type)?;
        let mut definitions = types.registry.constraints(known);
        let teeth = definitions.find(|definition| definition.spec.common.bearings);
        teeth.map(Self::Teeth)
    }
}

/// A joint whose table was found and not yet read.
pub(crate) struct Found<'t, 'r, S: SceneSpace> {
    kind: Kind<'r, S>,
    table: Table<'t>,
    name: String,
    /// How many joints were known, and how many complete, before it.
    before: [usize; 2],
}

impl<'t, 'r, S: SceneSpace> Found<'t, 'r, S> {
    /// The table of a joint behind those that were read.
    pub(crate) fn behind(
        kind: Kind<'r, S>,
        table: Table<'t>,
        name: String,
        joints: &Joints<S>,
    ) -> Self {
        Self {
            kind,
            table,
            name,
            before: [joints.known.len(), joints.list.len()],
        }
    }
}

/// Reads these joints and puts each where its table stands.
pub(crate) fn read<'r, S: SceneSpace>(
    found: Vec<Found<'_, 'r, S>>,
    bodies: &Bodies<S>,
    joints: &mut Joints<'r, S>,
    findings: &mut Findings,
) {
    let mut all = Vec::new();
    for Found {
        kind,
        table,
        name,
        before,
    } in found
    {
        let names = JointNames::of(joints);
        let read = match kind {
            Kind::Coupling => coupling::read(table, name, &names, findings),
            Kind::Teeth(definition) => {
                teeth::read(table, name, definition, (bodies, &names), findings)
            }
        };
        all.push((before, read));
    }
    let mut complete = 0;
    for (more, ([known_before, list_before], (known, read))) in all.into_iter().enumerate() {
        joints.known.insert(known_before + more, known);
        if let Some((joint, entry)) = read {
            joints.list.insert(list_before + complete, joint);
            joints.entries.insert(list_before + complete, entry);
            complete += 1;
        }
    }
}
