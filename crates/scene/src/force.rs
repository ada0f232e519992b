//! `[[force]]`: applied forces that the registry defines, and springs on angles of joints in space.

use model::Force;

use crate::active;
use crate::connection;
use crate::element::{self, Types};
use crate::function::Domain;
use crate::joint_name::References;
use crate::plausible;
use crate::source_map::Entry;
use crate::space::SceneSpace;
use crate::spring;
use crate::table::Table;

/// Reads one force with its position in the text; `None` if it could not be read.
pub(crate) fn read<S: SceneSpace>(
    mut table: Table,
    name: &str,
    types: &Types<S>,
    references: &References<'_, '_, '_, S>,
    domains: &mut Vec<Domain>,
) -> Option<(Force<S>, Entry)> {
    let references = References {
        is_active: active::read(&table),
        ..*references
    };
    if spring::is_meant::<S>(&table) {
        let force = spring::read(&mut table, name, &references);
        let entry = element::end(table, name, references.is_active);
        return Some((force?, entry));
    }
    let Some(scene_type) = element::scene_type(&mut table, types) else {
        connection::check_names(&mut table, &references.bodies.names);
        return None;
    };
    let definitions: Vec<_> = types.registry.forces(scene_type).collect();
    let read = element::read(&mut table, &definitions, &references, domains);
    if let Some(read) = read.as_ref().filter(|_| references.is_active) {
        plausible::forces::spring(&table, read, references.bodies);
    }
    let entry = element::end(table, name, references.is_active);
    let read = read?;
    let (bodies, element) = read.element?;
    let force = Force {
        name: name.to_owned(),
        bodies,
        element,
        functions: read.arguments.functions,
    };
    Some((force, entry))
}
