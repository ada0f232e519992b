//! The format as a JSON schema for editors, generated from the keys of the reader and the
//! definitions of the registry. The schema does not contain conditions that concern the whole scene
//! (existing names, rows, the assembly of the initial configuration).

mod element;
mod value;

use std::collections::{BTreeMap, BTreeSet};

use joints::{Plane, Space3};
use model::{Definitions, Registry, SpaceKind};
use serde_json::{Map, Value, json};

use crate::active::ACTIVE;
use crate::body::SceneBody;
use crate::case;
use crate::drive::{DRIVE_KEYS, MEASURE};
use crate::element::COUPLING;
use crate::function::{KINDS, STEP_KEYS};

use crate::heading::SCENE_KEYS;
use crate::key::{Interval, Key, TYPE};
use crate::language::read::{self as language, UNIT_KEYS};
use crate::nearest::list;
use crate::reactions::{GROUP_KEYS, OUTPUT_KEYS};
use crate::section::{self, NAME, Section};
use crate::silence;
use crate::space::SceneSpace;
use crate::{coupling, cover, marker, measure, simulate, spring, start, tolerance};
use element::{ElementKind, elements};
use value::{described, reference};

/// The JSON schema (draft 2020-12) of scene files with the joints and forces of this registry.
///
/// The function [`read`](crate::read()) rejects every text that the schema rejects. The reverse is
/// not true, because a schema cannot check names, rows and the assembly of the initial
/// configuration.
///
/// ```
/// let schema = pfaff_scene::schema(&model::Registry::standard());
/// assert_eq!(schema["$defs"]["body"]["properties"]["mass"]["minimum"], 0);
/// ```
#[must_use]
pub fn schema(registry: &Registry) -> Value {
    let common = [
        (&section::PARAMETERS, Times::Once, value::parameters()),
        (&section::GROUP, Times::Many, group()),
        (&section::CASE, Times::Many, table("Case", &case::KEYS)),
        (&section::START, Times::Once, table("Start", &start::KEYS)),
        (
            &section::SIMULATE,
            Times::Once,
            table("Run", &simulate::KEYS),
        ),
        (&section::OUTPUT, Times::Once, table("Output", &OUTPUT_KEYS)),
    ];
    let mut definitions = Map::new();
    let mut properties = Map::new();
    for (Section { name, doc }, times, definition) in common {
        properties.insert((*name).to_owned(), property(doc, times, name));
        definitions.insert((*name).to_owned(), definition);
    }
    let plane = in_space::<Plane>(registry, &mut definitions);
    let space = in_space::<Space3>(registry, &mut definitions);
    // The content of these sections depends on the space.
    for section in OF_SPACE {
        properties.insert(
            section.name.to_owned(),
            json!({ "description": section.doc }),
        );
    }
    definitions.insert("function".to_owned(), function());
    definitions.insert("units".to_owned(), table("Units", &UNIT_KEYS));
    definitions.insert("step".to_owned(), table("Step", &STEP_KEYS));
    let is_spatial = json!({ "description": "In space", "properties": { "space": { "const": Space3::NAME } }, "required": ["space"] });
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Scene of pfaff",
        "description": "A multibody mechanism in the plane or in space, with the requested computations. SI units and radians, unless `units` states other units.",
        "type": "object",
        "properties": properties,
        "required": [section::SCENE.name, section::BODY.name],
        "additionalProperties": false,
        "if": { "properties": { "scene": is_spatial }, "required": ["scene"] },
        "then": { "properties": space },
        "else": { "properties": plane },
        "$defs": definitions,
    })
}

/// The sections that are different in the plane and in space.
const OF_SPACE: [&Section; 7] = [
    &section::SCENE,
    &section::BODY,
    &section::MARKER,
    &section::MEASURE,
    &section::JOINT,
    &section::DRIVE,
    &section::FORCE,
];

/// Returns the sections of a space, and adds the definitions of these sections. In
/// three-dimensional space, the names of the definitions have a prefix.
fn in_space<S: SceneBody>(registry: &Registry, definitions: &mut Map<String, Value>) -> Value {
    let registry = S::definitions(registry);
    let tables = [
        scene_table::<S>(),
        named("Body", S::BODY_KEYS),
        named("Marker", marker::keys(S::KIND)),
        named("Measure", &measure::keys(S::KIND)),
        joints(registry),
        drive(registry),
        forces(registry),
    ];
    let mut properties = Map::new();
    for (Section { name, doc }, definition) in OF_SPACE.into_iter().zip(tables) {
        let times = if *name == section::SCENE.name {
            Times::Once
        } else {
            Times::Many
        };
        let of = value::name_in::<S>(name);
        properties.insert((*name).to_owned(), property(doc, times, &of));
        definitions.insert(of, definition);
    }
    // A scene must contain at least one body.
    properties[section::BODY.name]["minItems"] = 1.into();
    definitions.insert(value::name_in::<S>("point"), value::point::<S>());
    definitions.insert(value::name_in::<S>("place"), value::place::<S>());
    properties.into()
}

/// Adds a type with these keys to the elements of a section. The registry does not contain this
/// type.
fn with_type(
    mut elements: Value,
    title: &str,
    scene_type: &str,
    (doc, keys): (&str, &[Key]),
) -> Value {
    let mut own = named(&format!("{title} `{scene_type}`"), keys);
    own["properties"][TYPE] = json!({ "const": scene_type, "description": doc });
    require(&mut own, TYPE);
    if let Some(tables) = elements["oneOf"].as_array_mut() {
        tables.push(own);
    }
    elements
}

/// The joints, including couplings.
fn joints<S: SceneSpace>(registry: &Definitions<S>) -> Value {
    let keys = [&coupling::KEYS[..], &[tolerance::OF_JOINT, ACTIVE]].concat();
    let doc = "A measure of one joint follows a measure of another";
    let joints = elements(registry, ElementKind::Joint);
    with_type(joints, "Joint", COUPLING, (doc, &keys))
}

/// The forces. In space, springs on angles are included.
fn forces<S: SceneSpace>(registry: &Definitions<S>) -> Value {
    let forces = elements(registry, ElementKind::Force);
    if S::KIND != SpaceKind::Space3 {
        return forces;
    }
    let keys = [&spring::KEYS[..], &[ACTIVE]].concat();
    let doc = "A spring and a damper on the angle of a joint";
    with_type(forces, "Force", spring::SPRING, (doc, &keys))
}

/// A section with this definition, for the root of the schema.
fn property(doc: &str, times: Times, definition: &str) -> Value {
    let of = reference(definition);
    match times {
        Times::Once => json!({ "description": doc, "$ref": of["$ref"] }),
        Times::Many => json!({ "description": doc, "type": "array", "items": of }),
    }
}

/// Number of occurrences of a section in a file.
enum Times {
    Once,
    Many,
}

/// A table with these keys and no other keys.
fn table(title: &str, keys: &[Key]) -> Value {
    let mut properties = Map::new();
    let mut required = Vec::new();
    for key in keys {
        properties.insert(key.name.to_owned(), described(key));
        if key.is_required {
            required.push(key.name);
        }
    }
    json!({
        "title": title,
        "type": "object",
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    })
}

fn scene_table<S: SceneSpace>() -> Value {
    let keys: Vec<Key> = SCENE_KEYS
        .into_iter()
        .chain([S::GRAVITY])
        .chain(tolerance::SCENE_KEYS)
        .chain(language::SCENE_KEYS)
        .chain(silence::SCENE_KEYS)
        .chain(cover::SCENE_KEYS)
        .collect();
    table("Scene", &keys)
}

/// A table with a name and these keys.
fn named(title: &str, keys: &[Key]) -> Value {
    let keys: Vec<Key> = [&[NAME], keys].concat();
    table(title, &keys)
}

fn drive<S: SceneSpace>(registry: &Definitions<S>) -> Value {
    let mut table = named("Drive", &[&DRIVE_KEYS[..], &[ACTIVE]].concat());
    // Joints with the same set of joint coordinates that can be prescribed.
    let mut measures: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for spec in registry.constraint_specs() {
        for definition in registry.constraints(spec.scene_type) {
            for measure in definition.spec.measures {
                measures
                    .entry(measure.name)
                    .or_default()
                    .insert(spec.scene_type);
            }
        }
    }
    let told: Vec<String> = measures
        .iter()
        .map(|(measure, joints)| format!("`{measure}` of {}", list(joints.iter().copied())))
        .collect();
    table["properties"][TYPE] = json!({
        "description": format!("What is prescribed, {MEASURE}: {}", told.join("; ")),
        "enum": measures.keys().collect::<Vec<_>>(),
    });
    require(&mut table, TYPE);
    table
}

/// Marks a key as required.
fn require(table: &mut Value, key: &str) {
    if let Some(required) = table["required"].as_array_mut() {
        required.push(key.into());
    }
}

/// A table with a name and exactly one of two keys.
fn group() -> Value {
    let either =
        GROUP_KEYS.map(|key| table(&format!("Group with `{}`", key.name), &[NAME, key, ACTIVE]));
    json!({ "title": "Group", "oneOf": either })
}

/// A number, or a table with a type.
fn function() -> Value {
    let kinds = KINDS.iter().map(|kind| {
        let mut table = table(&format!("Function `{}`", kind.name), kind.keys);
        table["description"] = kind.doc.into();
        table["properties"][TYPE] = json!({ "const": kind.name });
        require(&mut table, TYPE);
        table
    });
    let mut number = value::number(Interval::Any);
    number["title"] = "Constant, or an expression of the time `t`".into();
    json!({
        "title": "Function of time",
        "description": "A number, an expression of `t` (s), or { type = … }",
        "oneOf": std::iter::once(number).chain(kinds).collect::<Vec<_>>(),
    })
}
