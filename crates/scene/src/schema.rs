//! The format as a JSON schema for editors, generated from the keys of the reader and the
//! definitions of the registry. Conditions on a whole scene (names that exist, rows, a start that
//! assembles) are not part of it.

mod element;
mod value;

use std::collections::{BTreeMap, BTreeSet};

use model::Registry;
use serde_json::{Map, Value, json};

use crate::active::ACTIVE;
use crate::function::{KINDS, STEP_KEYS};
use crate::joint::{DRIVE_KEYS, MEASURE};
use crate::key::{Interval, Key, TYPE};
use crate::language::read::{self as language, UNIT_KEYS};
use crate::nearest::list;
use crate::reactions::{GROUP_KEYS, OUTPUT_KEYS};
use crate::read::SCENE_KEYS;
use crate::section::{self, NAME, Section};
use crate::silence;
use crate::{body, marker, measure, simulate, start, tolerance};
use element::{Kind, elements};
use value::{described, reference};

/// The JSON schema (draft 2020-12) of scene files that name joints and forces of this registry.
///
/// A text that it refuses is also refused by [`read`](crate::read()). The reverse does not hold,
/// because names, rows and the assembly of a start are not checked by a schema.
///
/// ```
/// let schema = scene::schema(&model::Registry::planar());
/// assert_eq!(schema["$defs"]["body"]["properties"]["mass"]["minimum"], 0);
/// ```
#[must_use]
pub fn schema(registry: &Registry) -> Value {
    let sections = [
        (&section::SCENE, Times::Once, scene_table()),
        (&section::PARAMETERS, Times::Once, value::parameters()),
        (&section::BODY, Times::Many, named("Body", &body::KEYS)),
        (
            &section::MARKER,
            Times::Many,
            named("Marker", &marker::KEYS),
        ),
        (
            &section::MEASURE,
            Times::Many,
            named("Measure", &measure::KEYS),
        ),
        (
            &section::JOINT,
            Times::Many,
            elements(registry, Kind::Joint),
        ),
        (&section::DRIVE, Times::Many, drive(registry)),
        (
            &section::FORCE,
            Times::Many,
            elements(registry, Kind::Force),
        ),
        (&section::GROUP, Times::Many, group()),
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
    for (Section { name, doc }, times, definition) in sections {
        let of = reference(name);
        let property = match times {
            Times::Once => json!({ "description": doc, "$ref": of["$ref"] }),
            Times::Many => json!({ "description": doc, "type": "array", "items": of }),
        };
        properties.insert((*name).to_owned(), property);
        definitions.insert((*name).to_owned(), definition);
    }
    // A scene needs at least one body.
    properties[section::BODY.name]["minItems"] = 1.into();
    definitions.insert("point".to_owned(), value::point());
    definitions.insert("place".to_owned(), value::place());
    definitions.insert("function".to_owned(), function());
    definitions.insert("units".to_owned(), table("Units", &UNIT_KEYS));
    definitions.insert("step".to_owned(), table("Step", &STEP_KEYS));
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Scene of pfaff",
        "description": "A planar multibody mechanism and what is to be done with it. SI units and radians, unless `units` says otherwise.",
        "type": "object",
        "properties": properties,
        "required": [section::SCENE.name, section::BODY.name],
        "additionalProperties": false,
        "$defs": definitions,
    })
}

/// How often a section may occur in a file.
enum Times {
    Once,
    Many,
}

/// A table with these keys and no others.
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

fn scene_table() -> Value {
    let keys: Vec<Key> = SCENE_KEYS
        .into_iter()
        .chain(tolerance::SCENE_KEYS)
        .chain(language::SCENE_KEYS)
        .chain(silence::SCENE_KEYS)
        .collect();
    table("Scene", &keys)
}

/// A table with a name and these keys.
fn named(title: &str, keys: &[Key]) -> Value {
    let keys: Vec<Key> = [&[NAME], keys].concat();
    table(title, &keys)
}

fn drive(registry: &Registry) -> Value {
    let mut table = named("Drive", &[&DRIVE_KEYS[..], &[ACTIVE]].concat());
    // Joints, grouped by the measures that can be prescribed.
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

/// Adds a key to the required ones.
fn require(table: &mut Value, key: &str) {
    if let Some(required) = table["required"].as_array_mut() {
        required.push(key.into());
    }
}

/// A name and one of two kinds of content.
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
    number["title"] = "Constant".into();
    json!({
        "title": "Function of time",
        "description": "A number, or { type = … }",
        "oneOf": std::iter::once(number).chain(kinds).collect::<Vec<_>>(),
    })
}
