//! Joints and forces: one table for each definition of the registry and each way to write its
//! bodies and its place.

use joints::spec::{Parameter, Shape, Spec, Unit};
use model::Registry;
use serde_json::{Map, Value, json};

use super::value::{described, number, reference, tuple};
use crate::active::ACTIVE;
use crate::body::GROUND;
use crate::connection::{BODIES, BODY, listed};
use crate::key::{Interval, TYPE};
use crate::place::{AT, local_key, owners};
use crate::section::NAME;
use crate::tolerance;

/// Kind of element in a section.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    Joint,
    Force,
}

/// The items of a section.
pub(super) fn elements(registry: &Registry, kind: Kind) -> Value {
    let (title, mut specs): (_, Vec<&Spec>) = match kind {
        Kind::Joint => ("Joint", registry.constraint_specs().collect()),
        Kind::Force => ("Force", registry.force_specs().collect()),
    };
    // Definitions with the same type follow each other.
    specs.sort_by_key(|spec| spec.scene_type);
    let tables: Vec<Value> = specs.iter().map(|spec| table(spec, kind, title)).collect();
    json!({ "title": title, "type": "object", "oneOf": tables })
}

/// The table of one definition.
fn table(spec: &Spec, of: Kind, title: &str) -> Value {
    let mut properties = Map::new();
    let mut required = vec![NAME.name, TYPE];
    properties.insert(NAME.name.to_owned(), described(&NAME));
    let kind = json!({ "const": spec.scene_type, "description": in_one_line(spec.doc) });
    properties.insert(TYPE.to_owned(), kind);
    let tolerance = matches!(of, Kind::Joint).then_some(&tolerance::OF_JOINT);
    for key in tolerance.into_iter().chain([&ACTIVE]) {
        properties.insert(key.name.to_owned(), described(key));
    }

    let bodies = match listed(spec) {
        1 => BODY,
        _ => BODIES,
    };
    properties.insert(bodies.to_owned(), connection(spec));
    required.push(bodies);
    for &slot in &spec.slots[listed(spec)..] {
        let body = json!({
            "description": format!("The body in the slot `{slot}` of the definition"),
            "type": "string",
            "default": GROUND,
        });
        properties.insert(slot.to_owned(), body);
    }
    if let Some(variant) = spec.variant {
        let mut value = json!({ "const": variant.value });
        if variant.default {
            value["default"] = variant.value.into();
        } else {
            required.push(variant.key);
        }
        properties.insert(variant.key.to_owned(), value);
    }
    for parameter in spec.parameters {
        if matches!(parameter.shape, Shape::Point { .. }) {
            continue;
        }
        properties.insert(parameter.name.to_owned(), value(parameter, spec));
        if !parameter.optional {
            required.push(parameter.name);
        }
    }
    let mut table = json!({
        "title": format!("{title} `{}`", spec.scene_type),
        "description": in_one_line(spec.doc),
        "type": "object",
        "required": required,
        "additionalProperties": false,
    });
    let owners = owners(spec);
    if !owners.is_empty() {
        let local = local_key(spec);
        properties.insert(AT.to_owned(), global(spec, owners.len()));
        properties.insert(local.to_owned(), in_bodies(spec, &owners));
        table["oneOf"] = json!([{ "required": [AT] }, { "required": [local] }]);
    }
    table["properties"] = properties.into();
    table
}

/// `body` or `bodies`.
fn connection(spec: &Spec) -> Value {
    match listed(spec) {
        1 => json!({ "type": "string", "description": "The body" }),
        n => {
            let slots = spec.slots[..n].join(", ");
            let mut bodies = tuple(vec![json!({ "type": "string" }); n]);
            bodies["uniqueItems"] = true.into();
            bodies["description"] = format!(
                "The bodies [{slots}] of the definition; reactions are reported on the first"
            )
            .into();
            bodies
        }
    }
}

/// `at`
fn global(spec: &Spec, n: usize) -> Value {
    let mut place = if spec.points_apart {
        tuple(vec![reference("place"); n])
    } else {
        reference("place")
    };
    let words = if spec.points_apart {
        format!("{n} points [x, y] in global coordinates, at the described start (m)")
    } else {
        "The place [x, y] in global coordinates, at the described start (m)".to_owned()
    };
    place["description"] = with_points(words, spec).into();
    place
}

/// A description with the purpose of its points.
fn with_points(words: impl Into<String>, spec: &Spec) -> String {
    let is_point = |p: &&Parameter| matches!(p.shape, Shape::Point { .. }) && !p.doc.is_empty();
    let points = spec.parameters.iter().filter(is_point);
    let mut words = words.into();
    for (k, point) in points.enumerate() {
        words.push_str(if k == 0 { ". " } else { " " });
        words.push_str(&in_one_line(point.doc));
    }
    words
}

/// `point` or `points`
fn in_bodies(spec: &Spec, owners: &[usize]) -> Value {
    let on = |slot: usize| owners.iter().filter(|owner| **owner == slot).count();
    let points = |n: usize| match n {
        1 => reference("place"),
        n => tuple(vec![reference("place"); n]),
    };
    if listed(spec) == 1 {
        let mut place = points(owners.len());
        place["description"] =
            with_points("The place [x, y] in the frame of the body (m)", spec).into();
        return place;
    }
    let mut forms: Vec<Value> = owners.iter().map(|slot| points(on(*slot))).collect();
    forms.dedup();
    let mut slots = owners.to_vec();
    slots.sort_unstable();
    slots.dedup();
    json!({
        "description": with_points("The place in the frames of the bodies { body = [x, y], … } (m)", spec),
        "type": "object",
        "minProperties": slots.len(),
        "maxProperties": slots.len(),
        "additionalProperties": match forms.len() {
            1 => forms.remove(0),
            _ => json!({ "anyOf": forms }),
        },
    })
}

/// The value of a parameter: its purpose and its type.
fn value(parameter: &Parameter, spec: &Spec) -> Value {
    let mut schema = match parameter.shape {
        Shape::Point { .. } => reference("point"),
        Shape::Direction { .. } => tuple(vec![number(Interval::Any); 2]),
        Shape::Axes { .. } => tuple(vec![number(Interval::Any); 3]),
        Shape::GroundLine | Shape::GroundPlane => tuple(vec![reference("point"); 2]),
        Shape::Numbers(units) => {
            let numbers = units.iter().map(|unit| number(range(*unit)));
            one_or_many(numbers.collect())
        }
        Shape::Functions(units) => one_or_many(vec![reference("function"); units.len()]),
    };
    let meaning = match parameter.doc {
        "" => format!("The parameter `{}`", parameter.name),
        doc => in_one_line(doc).trim_end_matches('.').to_owned(),
    };
    let frame = match parameter.shape {
        Shape::Direction { slot } | Shape::Axes { slot, .. } => {
            format!(" in the frame of {}", owner(spec, slot))
        }
        Shape::GroundLine => " in global coordinates (m)".to_owned(),
        _ => String::new(),
    };
    let default = if parameter.optional {
        "; its value at the start where it is not given"
    } else {
        ""
    };
    schema["description"] =
        format!("{meaning}: {}{frame}{default}", parameter.shape.words(2)).into();
    schema
}

/// The body of a slot, as text.
fn owner(spec: &Spec, slot: usize) -> String {
    match (listed(spec), slot) {
        (1, 0) => "the body".to_owned(),
        (_, 0) => "the first body".to_owned(),
        (_, 1) => "the second body".to_owned(),
        _ => format!("the body `{}`", spec.slots[slot]),
    }
}

fn range(unit: Unit) -> Interval {
    if unit.may_be_negative() {
        Interval::Any
    } else {
        Interval::NotNegative
    }
}

/// A single value is written without brackets.
fn one_or_many(mut items: Vec<Value>) -> Value {
    match items.len() {
        1 => items.remove(0),
        _ => tuple(items),
    }
}

/// Text without line breaks.
fn in_one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
