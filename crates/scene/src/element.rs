//! Properties that joints and forces have in common: a type in the registry, bodies, a reference
//! point and parameters. This module contains no names of individual joints and forces.

use joints::ArgumentError;
use joints::spec::Spec;
use model::registry::{ConstraintDefinition, ForceDefinition};
use model::{BodyRef, ConstraintKernels, Definitions, ForceKernels, Registry};

use crate::active::ACTIVE;
use crate::argument_source::ArgumentSource;
use crate::arguments::Arguments;
use crate::bearings::Bearings;
use crate::between::JointMarkers;
use crate::connection;
use crate::direction::Directions;
use crate::function::Domain;
use crate::joint_name::References;
use crate::key::TYPE;
use crate::mistake::Mistake;
use crate::nearest::{list, meant, nearest};
use crate::place;
use crate::section;
use crate::source_map::Entry;
use crate::space::{self, SceneSpace};
use crate::table::{Table, belongs};

/// The type of joints that couple two joint coordinates; the registry does not contain a definition
/// of this type.
pub(crate) const COUPLING: &str = "coupling";

/// A definition in the registry.
pub(crate) trait Definition {
    /// The space of the definition.
    type Space: SceneSpace;
    /// The type of the constructed element.
    type Element;
    /// The description of the definition.
    fn spec(&self) -> &'static Spec;
    /// The constructor of the definition.
    fn constructor(&self) -> fn(&[joints::Argument]) -> Result<Self::Element, ArgumentError>;
}

impl<S: SceneSpace> Definition for ConstraintDefinition<S> {
    type Space = S;
    type Element = Box<dyn ConstraintKernels<S>>;
    fn spec(&self) -> &'static Spec {
        &self.spec.common
    }
    fn constructor(&self) -> fn(&[joints::Argument]) -> Result<Self::Element, ArgumentError> {
        self.build
    }
}

impl<S: SceneSpace> Definition for ForceDefinition<S> {
    type Space = S;
    type Element = Box<dyn ForceKernels<S>>;
    fn spec(&self) -> &'static Spec {
        &self.spec.common
    }
    fn constructor(&self) -> fn(&[joints::Argument]) -> Result<Self::Element, ArgumentError> {
        self.build
    }
}

/// An element whose definition is known; its values may be incomplete.
pub(crate) struct ElementRead<'d, D: Definition> {
    pub(crate) definition: &'d D,
    /// Bodies and element, if all values could be read.
    pub(crate) element: Option<(Vec<BodyRef>, D::Element)>,
    pub(crate) arguments: Arguments,
}

/// The types that the registry defines for scenes.
pub(crate) struct Types<'r, S: SceneSpace> {
    /// The definitions of all spaces.
    all: &'r Registry,
    pub(crate) registry: &'r Definitions<S>,
    /// The word for the elements of this section in messages.
    pub(crate) kind: &'static str,
    pub(crate) known: Vec<&'static str>,
    /// The section of the other kind of element (forces for joints, joints for forces): the name of
    /// its table, the word for its elements, and its types.
    pub(crate) other: (&'static str, &'static str, Vec<&'static str>),
}

impl<'r, S: SceneSpace> Types<'r, S> {
    /// The types of joints.
    pub(crate) fn of_joints(all: &'r Registry) -> Self {
        let registry = S::definitions(all);
        Self {
            all,
            registry,
            kind: "joint",
            known: with_coupling(names(registry.constraint_specs())),
            other: ("force", "force", names(registry.force_specs())),
        }
    }

    /// The types of forces.
    pub(crate) fn of_forces(all: &'r Registry) -> Self {
        let registry = S::definitions(all);
        Self {
            all,
            registry,
            kind: "force",
            known: names(registry.force_specs()),
            other: ("joint", "joint", names(registry.constraint_specs())),
        }
    }
}

/// The types of these definitions, without repetitions.
fn names(specs: impl Iterator<Item = &'static Spec>) -> Vec<&'static str> {
    let mut types: Vec<_> = specs.map(|spec| spec.scene_type).collect();
    types.sort_unstable();
    types.dedup();
    types
}

/// The types of joints, and the type of couplings.
fn with_coupling(mut types: Vec<&'static str>) -> Vec<&'static str> {
    let at = types.partition_point(|known| *known < COUPLING);
    types.insert(at, COUPLING);
    types
}

/// Prints the types as a list.
impl<S: SceneSpace> std::fmt::Display for Types<'_, S> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&list(self.known.iter().copied()))
    }
}

/// Reads `type`. If the key is missing or no definition has this type, the function reports this
/// and returns `None`.
pub(crate) fn scene_type<S: SceneSpace>(
    table: &mut Table,
    types: &Types<S>,
) -> Option<&'static str> {
    let field = table.needed(TYPE, types)?;
    let name = field.text("the name of a type")?;
    if let Some(known) = types.known.iter().find(|known| **known == name) {
        return Some(known);
    }
    let (section, kind, others) = &types.other;
    let near = nearest(name, types.known.iter().copied());
    let elsewhere = space::of_type(S::NAME, types.all, name).filter(|_| !others.contains(&name));
    let (label, help) = match (elsewhere, near) {
        (Some(space), near) => {
            let near = near.filter(|near| meant(name) == Some(*near));
            (
                belongs(name, space),
                near.map(|near| format!("here it is `{near}`")),
            )
        }
        (None, Some(near)) => (format!("did you mean `{near}`?"), None),
        (None, None) if others.contains(&name) => (
            format!("`{name}` is a {kind}"),
            Some(format!("write it under `[[{section}]]`")),
        ),
        (None, None) => match nearest(name, [section::DRIVE.name]) {
            Some(drive) => (
                format!("`{name}` is a {drive}"),
                Some(
                    "write it under `[[drive]]`, with the name of the joint that it moves"
                        .to_owned(),
                ),
            ),
            None => ("unknown type".to_owned(), None),
        },
    };
    let all = || format!("the types of a {} are {}", types.kind, types);
    field.error_with_help(
        Mistake::UnknownType,
        format!(" has the unknown type `{name}`"),
        label,
        help.or_else(|| Some(all())),
    );
    None
}

/// Reads all keys of the definitions of one type. If no definition fits, the function reports this
/// and returns `None`.
pub(crate) fn read<'d, D: Definition>(
    table: &mut Table,
    definitions: &[&'d D],
    references: &References<'_, '_, '_, D::Space>,
    domains: &mut Vec<Domain>,
) -> Option<ElementRead<'d, D>> {
    let specs: Vec<&'static Spec> = definitions.iter().map(|d| d.spec()).collect();
    let bodies = references.bodies;
    let (at, slots, source);
    if let Some(borne) = specs.iter().position(|spec| spec.bearings) {
        let bearings = Bearings::read(table, references);
        slots = bearings.slots();
        (at, source) = (borne, ArgumentSource::Bearings(bearings));
    } else {
        let chosen = connection::named(table, &specs, &bodies.names).and_then(|named| {
            let at = connection::choose(table, &specs, named.len())?;
            Some((at, named))
        });
        let Some((chosen, named)) = chosen else {
            connection::forgive(table, &specs);
            return None;
        };
        slots = connection::slots(table, specs[chosen], named, &bodies.names);
        let between = JointMarkers::read(table, specs[chosen], &slots, bodies);
        (at, source) = (
            chosen,
            between.map_or(ArgumentSource::Text, ArgumentSource::Markers),
        );
    }
    let (spec, definition) = (specs[at], definitions[at]);
    let of_points = match source {
        ArgumentSource::Markers(_) => Vec::new(),
        ArgumentSource::Text | ArgumentSource::Bearings(_) => place::slots_of_points(spec),
    };
    let place = place::read(table, spec, (&of_points, &slots), bodies);
    let directions = Directions::read(table, spec, &slots, (bodies, source));
    let mut own = Vec::new();
    let mut arguments = Arguments::read(table, spec, place, &directions, &mut own);
    if references.is_active {
        domains.append(&mut own);
    }
    let built = arguments.build::<D::Space, _>(table, spec, definition.constructor());
    let slots: Option<Vec<BodyRef>> = slots.into_iter().collect();
    Some(ElementRead {
        definition,
        element: slots.zip(built),
        arguments,
    })
}

/// Completes the table of an element; the key `active` was read earlier.
pub(crate) fn end(mut table: Table, name: &str, is_active: bool) -> Entry {
    table.optional(&ACTIVE);
    let entry = Entry::switched(name, &table, is_active);
    table.close();
    entry
}
