//! The schema of joints and forces. There is one table for each definition of the registry, each
//! form of its bodies and each form of its reference point.

use joints::spec::{Parameter, Shape, Spec, Unit};
use model::Definitions;
use serde_json::{Map, Value, json};

use super::value::{described, name_in, number, reference, tuple, vector};
use crate::active::ACTIVE;
use crate::armature;
use crate::bearings::{BEARINGS, CARRIER_KEY, PRESSURE_ANGLE};
use crate::between::{MARKERS, takes_markers};
use crate::body::GROUND;
use crate::connection::{BODIES, BODY, listed};
use crate::contact;
use crate::direction::{self, AXES, CROSS, FRAME, FRAMES};
use crate::key::{Interval, Key, TYPE};
use crate::place::{AT, POINT, local_key, slots_of_points};
use crate::section::NAME;
use crate::space::SceneSpace;
use crate::stiffness;
use crate::tolerance;

/// Kind of element in a section.
#[derive(Clone, Copy)]
pub(super) enum ElementKind {
    Joint,
    Force,
}

/// The items of a section.
pub(super) fn elements<S: SceneSpace>(registry: &Definitions<S>, kind: ElementKind) -> Value {
    let (title, mut specs): (_, Vec<&Spec>) = match kind {
        ElementKind::Joint => ("Joint", registry.constraint_specs().collect()),
        ElementKind::Force => ("Force", registry.force_specs().collect()),
    };
    // Definitions with the same type become adjacent.
    specs.sort_by_key(|spec| spec.scene_type);
    let tables: Vec<Value> = specs
        .iter()
        .map(|spec| table::<S>(spec, keys(registry, spec, kind), title))
        .collect();
    json!({ "title": title, "type": "object", "oneOf": tables })
}

/// The keys of a definition that are not its parameters.
fn keys<S: SceneSpace>(registry: &Definitions<S>, spec: &Spec, of: ElementKind) -> Vec<Key> {
    let mut keys = vec![ACTIVE];
    if let ElementKind::Joint = of {
        let mut definitions = registry.constraints(spec.scene_type);
        let own = definitions.find(|definition| definition.spec.common.name == spec.name);
        keys.extend([tolerance::OF_JOINT, stiffness::key(S::KIND)]);
        keys.extend(own.into_iter().flat_map(|definition| {
            let armature = armature::key(definition.spec);
            armature.into_iter().chain(contact::keys(definition.spec))
        }));
    }
    keys
}

/// The table of one definition.
fn table<S: SceneSpace>(spec: &Spec, keys: Vec<Key>, title: &str) -> Value {
    let mut properties = Map::new();
    let mut required = vec![NAME.name, TYPE];
    properties.insert(NAME.name.to_owned(), described(&NAME));
    let kind = json!({ "const": spec.scene_type, "description": in_one_line(spec.doc) });
    properties.insert(TYPE.to_owned(), kind);
    for key in keys {
        properties.insert(key.name.to_owned(), described(&key));
    }

    if spec.bearings {
        required.push(BEARINGS.name);
        for key in [&BEARINGS, &CARRIER_KEY, &PRESSURE_ANGLE] {
            properties.insert(key.name.to_owned(), described(key));
        }
    } else {
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
    }
    if let Some(variant) = spec.variant {
        let mut value = json!({ "const": variant.value, "description": in_one_line(spec.doc) });
        if variant.default {
            value["default"] = variant.value.into();
        } else {
            required.push(variant.key);
        }
        properties.insert(variant.key.to_owned(), value);
    }
    let takes_markers = takes_markers::<S>(spec);
    let mut has_axes = None;
    let mut directions = Vec::new();
    let mut all = Vec::new();
    for parameter in spec.parameters {
        match parameter.shape {
            Shape::Point { .. } | Shape::Axes { like: Some(_), .. } => continue,
            Shape::Axes { .. } if parameter.optional || spec.bearings => continue,
            Shape::Axes { .. } => has_axes = Some(parameter.name),
            Shape::Direction { .. } if spec.bearings => {
                let both = [parameter.name, PRESSURE_ANGLE.name];
                all.push(json!({ "not": { "required": both } }));
            }
            Shape::Direction { .. } if takes_markers => directions.push(parameter.name),
            _ if !parameter.optional => required.push(parameter.name),
            _ => {}
        }
        properties.insert(parameter.name.to_owned(), value::<S>(parameter, spec));
    }
    let keys: Vec<&str> = direction::keys(spec).filter(|_| S::CARRIES).collect();
    for key in &keys {
        properties.insert((*key).to_owned(), beside::<S>(key, spec));
    }
    let mut table = json!({
        "title": format!("{title} `{}`", spec.scene_type),
        "description": in_one_line(spec.doc),
        "type": "object",
        "required": required,
        "additionalProperties": false,
    });
    let markers = takes_markers.then(|| {
        properties.insert(MARKERS.to_owned(), two_markers());
        json!({ "required": [MARKERS] })
    });
    let owners = slots_of_points(spec);
    if !owners.is_empty() {
        let local = local_key(spec);
        properties.insert(AT.to_owned(), global::<S>(spec, owners.len()));
        properties.insert(local.to_owned(), in_bodies::<S>(spec, &owners));
        let mut ways = vec![json!({ "required": [AT] }), json!({ "required": [local] })];
        ways.extend(markers.clone());
        table["oneOf"] = ways.into();
    }
    if let Some(axis) = has_axes {
        let mut ways = vec![json!({ "required": [axis] })];
        ways.extend(keys.contains(&AXES).then(|| json!({ "required": [AXES] })));
        ways.extend(markers.clone());
        all.push(json!({ "oneOf": ways }));
    }
    if let Some(markers) = markers {
        let ways = |key: &str| json!({ "oneOf": [{ "required": [key] }, markers] });
        all.extend(directions.into_iter().map(ways));
        // Keys that only specify the axes of directions are not permitted together with markers.
        let beside = keys.iter().filter(|key| [FRAME, CROSS].contains(*key));
        all.extend(beside.map(|key| json!({ "not": { "required": [key, MARKERS] } })));
    }
    if !all.is_empty() {
        table["allOf"] = all.into();
    }
    table["properties"] = properties.into();
    table
}

/// Schema of `markers`.
fn two_markers() -> Value {
    let mut markers = tuple(vec![json!({ "type": "string" }); 2]);
    markers["description"] = "Two markers [first, second] of the bodies, in place of points and directions: z along the axis of the joint, x across".into();
    markers["uniqueItems"] = true.into();
    markers
}

/// Schema of a key that contains directions but is not a parameter of a definition.
fn beside<S: SceneSpace>(key: &str, spec: &Spec) -> Value {
    match key {
        FRAME => json!({
            "description": format!("Where directions are written: in the frame of {}, or in ground axes of the described start", owner(spec, 0)),
            "enum": FRAMES,
            "default": FRAMES[0],
        }),
        CROSS => {
            let mut cross = vector::<S>();
            cross["description"] = "A direction across the axis, for the rows and for the reaction in joint axes; if it is omitted, the coordinate axis of the first body that is closest to perpendicular to the axis".into();
            cross
        }
        _ => json!({
            "description": "The axis in the frames of both bodies { body = [x, y, z], … }, in place of one that follows from the described start",
            "type": "object",
            "minProperties": 2,
            "maxProperties": 2,
            "additionalProperties": vector::<S>(),
        }),
    }
}

/// Schema of `body` or `bodies`.
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

/// Schema of `at`.
fn global<S: SceneSpace>(spec: &Spec, n: usize) -> Value {
    let one = reference(&name_in::<S>("place"));
    let mut place = if spec.points_apart {
        tuple(vec![one; n])
    } else {
        one
    };
    let words = if spec.points_apart {
        format!(
            "{n} points {} in global coordinates, at the described start (m)",
            S::VECTOR
        )
    } else {
        format!(
            "The point {} in global coordinates, at the described start (m)",
            S::VECTOR
        )
    };
    place["description"] = with_points(words, spec).into();
    place
}

/// Adds the purpose of the points to a description.
fn with_points(words: impl Into<String>, spec: &Spec) -> String {
    let is_point = |p: &&Parameter| matches!(p.shape, Shape::Point { .. }) && !p.doc.is_empty();
    let points: Vec<_> = spec.parameters.iter().filter(is_point).collect();
    let own = points.len().min(slots_of_points(spec).len());
    let mut words = words.into();
    for (k, point) in points[points.len() - own..].iter().enumerate() {
        words.push_str(if k == 0 { ". " } else { " " });
        words.push_str(&in_one_line(point.doc));
    }
    words
}

/// Schema of `point` or `points`.
fn in_bodies<S: SceneSpace>(spec: &Spec, owners: &[usize]) -> Value {
    let place = reference(&name_in::<S>("place"));
    let on = |slot: usize| owners.iter().filter(|owner| **owner == slot).count();
    let points = |n: usize| match n {
        1 => place.clone(),
        n => tuple(vec![place.clone(); n]),
    };
    if local_key(spec) == POINT {
        let mut place = points(owners.len());
        let (vector, body) = (S::VECTOR, owner(spec, 0));
        let words = format!("The point {vector} in the frame of {body} (m)");
        place["description"] = with_points(words, spec).into();
        return place;
    }
    let mut forms: Vec<Value> = owners.iter().map(|slot| points(on(*slot))).collect();
    forms.dedup();
    let mut slots = owners.to_vec();
    slots.sort_unstable();
    slots.dedup();
    let words = format!(
        "The point in the frames of the bodies {{ body = {}, … }} (m)",
        S::VECTOR
    );
    json!({
        "description": with_points(words, spec),
        "type": "object",
        "minProperties": slots.len(),
        "maxProperties": slots.len(),
        "additionalProperties": match forms.len() {
            1 => forms.remove(0),
            _ => json!({ "anyOf": forms }),
        },
    })
}

/// Schema of the value of a parameter: purpose and type of the parameter.
fn value<S: SceneSpace>(parameter: &Parameter, spec: &Spec) -> Value {
    let mut schema = match parameter.shape {
        Shape::Point { .. } => reference(&name_in::<S>("point")),
        Shape::Direction { .. } | Shape::Axes { .. } => vector::<S>(),
        Shape::GroundLine => tuple(vec![reference(&name_in::<S>("point")); 2]),
        Shape::GroundPlane => json!({
            "type": "object",
            "properties": {
                "point": described_as("A point of the plane", reference(&name_in::<S>("point"))),
                "normal": described_as("Across the plane, towards the side of the body", vector::<S>()),
            },
            "required": ["point", "normal"],
            "additionalProperties": false,
        }),
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
        Shape::Direction { .. } | Shape::Axes { .. } if S::CARRIES => {
            format!(" in the frame of {}, or global", owner(spec, 0))
        }
        Shape::Direction { slot } | Shape::Axes { slot, .. } => {
            format!(" in the frame of {}", owner(spec, slot))
        }
        Shape::GroundLine | Shape::GroundPlane => " in global coordinates (m)".to_owned(),
        _ => String::new(),
    };
    let default = if parameter.optional {
        "; if it is omitted, its value at the start"
    } else if spec.bearings {
        "; the normal of the plane of both axes, turned by the pressure angle, if it is not given"
    } else {
        ""
    };
    schema["description"] = format!(
        "{meaning}: {}{frame}{default}",
        parameter.shape.words(S::DIM)
    )
    .into();
    schema
}

fn described_as(words: &str, mut schema: Value) -> Value {
    schema["description"] = words.into();
    schema
}

/// The body with the index `slot`, in words.
fn owner(spec: &Spec, slot: usize) -> String {
    match (listed(spec), slot) {
        _ if spec.bearings => "the carrier".to_owned(),
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
