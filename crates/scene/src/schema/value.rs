//! The schema of the value of one key.

use model::SpaceKind;
use serde_json::{Map, Value, json};

use crate::body::{ANGLE, AXIS, MATRIX, QUATERNION, RPY};
use crate::dimension::Dimension;
use crate::key::{Interval, Key, Takes};
use crate::measure::AXIS_NAMES;
use crate::section::LONGEST_NAME;
use crate::silence;
use crate::space::SceneSpace;

/// Schema of the value of a key with its description, its unit and its default.
pub(super) fn described(key: &Key) -> Value {
    let mut schema = match key.takes {
        Takes::Name => json!({
            "type": "string",
            "minLength": 1,
            "maxLength": LONGEST_NAME,
            // In a spreadsheet, a name that starts like a formula would become a formula. In
            // addition, a name must have only one line.
            "pattern": r"^[^=+@\x00-\x1f\x7f-\x9f-][^\x00-\x1f\x7f-\x9f]*$",
        }),
        Takes::Text => json!({ "type": "string" }),
        Takes::OneOf(names) => json!({ "enum": names() }),
        Takes::Flag => json!({ "type": "boolean" }),
        Takes::Switch => json!({ "type": ["boolean", "number", "string"] }),
        Takes::Whole(least, most) => {
            json!({ "type": "integer", "minimum": least, "maximum": most })
        }
        Takes::Units => reference("units"),
        Takes::Warnings => json!({
            "type": "array",
            "items": { "enum": silence::warnings() },
        }),
        Takes::Number(range) => number(range),
        Takes::Vector(n, range) => tuple(vec![number(range); n]),
        Takes::Direction(n) => direction(n),
        Takes::Directions(n) => tuple(vec![direction(n); 2]),
        Takes::Orientation => orientation(),
        Takes::Table(keys) => table(keys),
        Takes::FlagOr(keys) => json!({ "oneOf": [{ "type": "boolean" }, table(keys)] }),
        Takes::Tensor => {
            let row = || tuple(vec![number(Interval::Any); 3]);
            json!({ "anyOf": [row(), tuple(vec![row(); 3])] })
        }
        Takes::Numbers(least) => {
            json!({ "type": "array", "items": number(Interval::Any), "minItems": least })
        }
        Takes::Texts(least) => texts(least),
        Takes::Names => json!({ "oneOf": [{ "type": "boolean" }, texts(0)] }),
        Takes::Plots(keys) => json!({
            "type": "array",
            "items": { "oneOf": [texts(1), table(keys)] },
        }),
        Takes::Rows => json!({
            "type": "array",
            "items": { "type": "integer", "minimum": 1 },
            "uniqueItems": true,
        }),
        Takes::Function => reference("function"),
        Takes::Load => json!({ "type": ["number", "string"], "minimum": 0 }),
        Takes::Inertias => json!({
            "type": "object",
            "minProperties": 1,
            "additionalProperties": number(Interval::NotNegative),
        }),
        Takes::Law => json!({ "type": ["number", "string"] }),
        Takes::Steps => json!({ "type": "array", "items": reference("step"), "minItems": 1 }),
    };
    schema["description"] = in_unit(key.doc, key.unit).into();
    if let Some(default) = key.default {
        schema["default"] = default();
    }
    schema
}

/// Combines the description of a value with its unit.
pub(super) fn in_unit(meaning: &str, unit: Dimension) -> String {
    match unit {
        Dimension::NONE => meaning.to_owned(),
        unit => format!("{meaning} ({unit})"),
    }
}

/// A number, or a text with an expression.
pub(super) fn number(range: Interval) -> Value {
    let mut number = json!({ "type": ["number", "string"] });
    match range {
        Interval::Any => {}
        Interval::NotNegative => number["minimum"] = 0.into(),
        Interval::Positive => number["exclusiveMinimum"] = 0.into(),
        Interval::Within(least, most) => {
            number["minimum"] = least.into();
            number["maximum"] = most.into();
        }
    }
    number
}

/// Schema of `[parameters]`.
pub(super) fn parameters() -> Value {
    json!({
        "title": "Parameters",
        "type": "object",
        "additionalProperties": number(Interval::Any),
    })
}

/// A list with one value for each of these schemas.
pub(super) fn tuple(items: Vec<Value>) -> Value {
    let n = items.len();
    let mut distinct = items.clone();
    distinct.dedup();
    let mut tuple = json!({ "type": "array", "minItems": n, "maxItems": n });
    match <[Value; 1]>::try_from(distinct) {
        Ok([item]) => tuple["items"] = item,
        Err(_) => tuple["prefixItems"] = items.into(),
    }
    tuple
}

/// The name of a schema definition for a space.
pub(super) fn name_in<S: SceneSpace>(name: &str) -> String {
    match S::KIND {
        SpaceKind::Space3 => format!("{}-{name}", S::NAME),
        _ => name.to_owned(),
    }
}

/// A vector.
pub(super) fn vector<S: SceneSpace>() -> Value {
    tuple(vec![number(Interval::Any); S::DIM])
}

/// A direction: the name of an axis, or a vector with this number of components.
fn direction(n: usize) -> Value {
    let axes = &AXIS_NAMES[..n.min(AXIS_NAMES.len())];
    json!({ "anyOf": [{ "enum": axes }, tuple(vec![number(Interval::Any); n])] })
}

/// A point.
pub(super) fn point<S: SceneSpace>() -> Value {
    let mut point = vector::<S>();
    point["title"] = format!("Point {} (m)", S::VECTOR).into();
    point
}

/// A point, or the name of a marker.
pub(super) fn place<S: SceneSpace>() -> Value {
    json!({
        "title": format!("Point {} (m), or the name of a marker", S::VECTOR),
        "anyOf": [reference(&name_in::<S>("point")), { "type": "string" }],
    })
}

/// A table with these keys, each optional.
fn table(keys: &[Key]) -> Value {
    let properties: Map<String, Value> = keys
        .iter()
        .map(|key| (key.name.to_owned(), described(key)))
        .collect();
    json!({ "type": "object", "properties": properties, "additionalProperties": false })
}

/// The four forms of an orientation.
fn orientation() -> Value {
    let way = |keys: &[&Key]| {
        let properties: Map<String, Value> = keys
            .iter()
            .map(|key| (key.name.to_owned(), described(key)))
            .collect();
        let required: Vec<&str> = keys.iter().map(|key| key.name).collect();
        json!({
            "type": "object",
            "properties": properties,
            "required": required,
            "additionalProperties": false,
        })
    };
    json!({ "oneOf": [
        way(&[&QUATERNION]),
        way(&[&AXIS, &ANGLE]),
        way(&[&RPY]),
        way(&[&MATRIX]),
    ] })
}

/// A list of texts without repetitions.
fn texts(least: usize) -> Value {
    json!({ "type": "array", "items": { "type": "string" }, "minItems": least, "uniqueItems": true })
}

/// A reference to a definition of the schema.
pub(super) fn reference(name: &str) -> Value {
    json!({ "$ref": format!("#/$defs/{name}") })
}
