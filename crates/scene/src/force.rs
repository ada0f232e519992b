//! `[[force]]`: applied forces of the registry.

use model::Force;

use crate::active;
use crate::bodies::Bodies;
use crate::connection;
use crate::element::{self, Types};
use crate::findings::Findings;
use crate::function::Domain;
use crate::source_map::Entry;
use crate::space::SceneSpace;
use crate::table::Table;

/// The forces that were read.
pub(crate) struct Forces<S: SceneSpace> {
    pub(crate) list: Vec<Force<S>>,
    pub(crate) entries: Vec<Entry>,
}

impl<S: SceneSpace> Default for Forces<S> {
    fn default() -> Self {
        Self {
            list: Vec::new(),
            entries: Vec::new(),
        }
    }
}

impl<S: SceneSpace> Forces<S> {
    /// Reads one force.
    pub(crate) fn read(
        &mut self,
        mut table: Table,
        name: &str,
        types: &Types<S>,
        bodies: &Bodies<S>,
        domains: &mut Vec<Domain>,
        findings: &mut Findings,
    ) {
        let mut own = Vec::new();
        let Some(scene_type) = element::scene_type(&mut table, types, findings) else {
            connection::check_names(&mut table, &bodies.names, findings);
            return;
        };
        let definitions: Vec<_> = types.registry.forces(scene_type).collect();
        let read = element::read(&mut table, &definitions, bodies, &mut own, findings);
        let is_active = active::read(&mut table, findings);
        if is_active {
            domains.append(&mut own);
        }
        let entry = Entry::switched(name, &table, is_active);
        table.close(findings);
        if let Some(read) = read
            && let Some((bodies, element)) = read.element
        {
            self.list.push(Force {
                name: name.to_owned(),
                bodies,
                element,
                functions: read.arguments.functions,
            });
            self.entries.push(entry);
        }
    }
}
