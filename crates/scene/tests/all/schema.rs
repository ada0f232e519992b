//! Tests that the schema agrees with the reader of scenes in all properties that a schema can
//! express: keys, types of values, ranges, choices.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use model::Registry;
use serde_json::{Value, json};

use super::validator::fault;
use super::{BODIES, read};

fn schema() -> Value {
    pfaff_scene::schema(&Registry::standard())
}

fn json_of(text: &str) -> Value {
    let table: toml::Table = text.parse().expect("TOML");
    serde_json::to_value(table).expect("JSON")
}

fn verdict(text: &str) -> Option<String> {
    let schema = schema();
    fault(&schema, &schema, &json_of(text))
}

/// Returns all scene files of the repository.
fn scenes() -> Vec<PathBuf> {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut found = vec![crates.join("robot-trolley/robot-trolley.toml")];
    for folder in ["suite/scenes", "../examples"] {
        let entries = fs::read_dir(crates.join(folder))
            .expect("readable")
            .flatten();
        let files = entries.map(|entry| entry.path());
        found.extend(files.filter(|path| path.extension().is_some_and(|end| end == "toml")));
    }
    found
}

/// The schema contains the purpose of each parameter, its type, its unit and frame, and its
/// default.
#[test]
fn keys_of_joints_and_forces_are_explained() {
    let schema = schema();
    let told = |kind: &str, of: &str, key: &str| {
        let tables = schema["$defs"][kind]["oneOf"].as_array().expect("tables");
        let table = tables
            .iter()
            .find(|t| t["properties"]["type"]["const"] == of);
        let told = &table.expect("a type")["properties"][key]["description"];
        told.as_str().expect("a text").to_owned()
    };
    for (kind, of, key, expected) in [
        (
            "force",
            "spring-damper",
            "stiffness",
            "Stiffness k, tension per extension: a number ≥ 0 (N/m)",
        ),
        (
            "force",
            "spring-damper",
            "free_length",
            "Length without tension at rest, l0: a number (m); if it is omitted, its value at the start",
        ),
        (
            "joint",
            "knife-edge",
            "normal",
            "Direction across the edge, in which the point cannot move: a direction [x, y] in the frame of the body",
        ),
        (
            "joint",
            "knife-edge",
            "point",
            "The point [x, y] in the frame of the body (m). The contact point.",
        ),
        (
            "joint",
            "velocity",
            "rate",
            "Velocity of the point along the direction: a number or a function of time (m/s)",
        ),
    ] {
        assert_eq!(told(kind, of, key), expected, "{of}");
    }
    let measures = &schema["$defs"]["drive"]["properties"]["type"]["description"];
    let measures = measures.as_str().expect("a text");
    assert!(
        measures.contains("`displacement` of `pin-in-slot`, `translational`"),
        "{measures}"
    );
}

#[test]
fn every_scene_of_the_repository_is_valid() {
    let scenes = scenes();
    assert!(scenes.len() > 30, "{}", scenes.len());
    for path in scenes {
        let text = fs::read_to_string(&path).expect("readable");
        assert_eq!(verdict(&text), None, "{}", path.display());
    }
}

/// Items of every type, with all their keys.
const MORE: &str = r#"
[[joint]]
name = "A"
type = "revolute"
bodies = ["ground", "a"]
at = [0.0, 0.0]

[[joint]]
name = "G"
tolerance = 1e-4
type = "gear"
bodies = ["a", "b"]
carrier = "c"
ratio = -2.0

[[drive]]
name = "D"
joint = "A"
type = "angle"
motion = { type = "steps", start = 0.0, steps = [{ from = 0.0, to = 1.0, by = 0.1 }] }

[[force]]
name = "F"
type = "point-force"
body = "a"
point = [0.0, 0.0]
force = [1.0, { type = "harmonic", amplitude = 1.0, omega = 2.0, phase = 0.0, offset = 0.0 }]
frame = "body"

[[force]]
name = "S"
type = "spring-damper"
bodies = ["a", "b"]
points = { a = [0.0, 0.1], b = [0.0, 0.0] }
stiffness = 1.0
damping = 0

[[group]]
name = "both"
members = ["A", "G"]

[start]
keep = ["a.angle"]
allow_correction = false

[simulate]
t_end = 1
rtol = 1e-6
stabilisation = "none"
drop = []

[output]
trajectory = true
reactions = ["A"]
report = false
"#;

#[test]
fn all_forms_are_valid() {
    let text = format!("{BODIES}{MORE}");
    assert_eq!(read(&text).err(), None);
    assert_eq!(verdict(&text), None);
}

/// Each entry is one change of a scene; the reader rejects the result because of its form.
const WRONG: [(&str, &str); 53] = [
    ("space = \"plane\"", "space = \"space\""),
    ("space = \"plane\"", ""),
    ("name = \"small\"", "name = 3"),
    ("name = \"small\"", "name = \"small\"\ngravity = 9.81"),
    (
        "name = \"small\"",
        "name = \"small\"\ngravity = [0.0, 1.0, 2.0]",
    ),
    ("name = \"small\"", "name = \"small\"\nunits = \"SI\""),
    (
        "name = \"small\"",
        "name = \"small\"\nformat = 2\nunits = { length = \"deg\" }",
    ),
    ("name = \"small\"", "name = \"small\"\nformat = 3"),
    ("name = \"small\"", "name = \"small\"\nformat = \"2\""),
    ("mass = 1.0", "mass = true"),
    ("name = \"small\"", "name = \"small\"\ntolerance = 0.0"),
    (
        "name = \"small\"",
        "name = \"small\"\nangle_tolerance = -1e-6",
    ),
    ("mass = 1.0", "mass = 1.0\ntolerance = -1e-4"),
    ("mass = 1.0", "mass = 1.0\nangle_tolerance = 1e-4"),
    ("at = [0.0, 0.0]", "at = [0.0, 0.0]\ntolerance = 0"),
    ("stiffness = 1.0", "stiffness = 1.0\ntolerance = 1e-4"),
    ("mass = 1.0", "mass = -1.0"),
    ("mass = 1.0", ""),
    ("mass = 1.0", "mas = 1.0"),
    ("mass = 1.0", "mass = nan"),
    ("name = \"c\"", "name = \"\""),
    ("name = \"c\"", "name = \"=c\""),
    ("name = \"c\"", "name = \"c\\nc\""),
    ("position = [1.0, 2.0]", "position = [1.0]"),
    ("type = \"revolute\"", "type = \"revolut\""),
    ("type = \"revolute\"", ""),
    ("type = \"revolute\"", "type = \"torque\""),
    ("bodies = [\"ground\", \"a\"]", "bodies = [\"a\"]"),
    ("bodies = [\"ground\", \"a\"]", "body = \"a\""),
    ("bodies = [\"ground\", \"a\"]", "bodies = [\"a\", \"a\"]"),
    ("bodies = [\"ground\", \"a\"]", "bodies = [1, 2]"),
    ("at = [0.0, 0.0]", ""),
    ("at = [0.0, 0.0]", "at = [[0.0, 0.0], [0.0, 0.0]]"),
    (
        "at = [0.0, 0.0]",
        "at = [0.0, 0.0]\npoints = { ground = [0.0, 0.0], a = [0.0, 0.0] }",
    ),
    ("at = [0.0, 0.0]", "at = [0.0, 0.0]\naxis = [0.0, 1.0]"),
    ("ratio = -2.0", ""),
    ("ratio = -2.0", "ratio = [2.0]"),
    ("type = \"angle\"", "type = \"turn\""),
    ("type = \"steps\"", "type = \"step\""),
    ("by = 0.1", "by = 0.1, at = 3.0"),
    ("to = 1.0, ", ""),
    ("omega = 2.0, ", ""),
    ("amplitude = 1.0", "amplitude = true"),
    ("frame = \"body\"", "frame = \"wheel\""),
    ("b = [0.0, 0.0] }", "b = [0.0, 0.0], c = [0.0, 0.0] }"),
    ("damping = 0", "damping = -0.1"),
    ("members = [\"A\", \"G\"]", "members = []"),
    (
        "members = [\"A\", \"G\"]",
        "members = [\"A\"]\ncombine = \"A.Fx\"",
    ),
    ("keep = [\"a.angle\"]", "keep = \"a.angle\""),
    ("t_end = 1", "t_end = -1"),
    ("rtol = 1e-6", "rtol = 1"),
    ("drop = []", "drop = [0]"),
    ("report = false", "report = \"no\""),
];

#[test]
fn what_the_reader_refuses_by_form_is_not_valid() {
    let whole = format!("{BODIES}{MORE}");
    for (from, to) in WRONG {
        assert!(whole.contains(from), "{from}");
        let text = whole.replacen(from, to, 1);
        assert!(read(&text).is_err(), "the reader takes {to:?} for {from:?}");
        assert!(
            verdict(&text).is_some(),
            "the schema takes {to:?} for {from:?}"
        );
    }
    for text in [
        "",
        "[scene]\nname = \"a\"\nspace = \"plane\"\n",
        "[[scene]]\n",
        "[bodies]\n",
    ] {
        assert!(read(text).is_err() && verdict(text).is_some(), "{text}");
    }
}

/// A joint between markers is valid. The same joint with a key that also gives the reference point
/// or the axis is not.
#[test]
fn markers_stand_alone() {
    let scene = |kind: &str, more: &str| {
        format!(
            "[scene]\nname = \"pin\"\nspace = \"spatial\"\n[[body]]\nname = \"a\"\nmass = 1.0\n\
             inertia = [1, 1, 1]\n[[marker]]\nname = \"m\"\nbody = \"ground\"\npoint = [0, 0, 0]\n\
             orientation = {{ rpy = [0, 0.5, 0] }}\n[[marker]]\nname = \"n\"\nbody = \"a\"\n\
             point = [0, 0, 0]\n[[joint]]\nname = \"J\"\ntype = \"{kind}\"\n\
             bodies = [\"ground\", \"a\"]\nmarkers = [\"m\", \"n\"]\n{more}"
        )
    };
    for kind in [
        "revolute",
        "universal",
        "fixed",
        "spherical",
        "perpendicular",
        "orientation",
    ] {
        let text = scene(kind, "");
        assert_eq!((read(&text).err(), verdict(&text)), (None, None), "{kind}");
    }
    for (kind, more) in [
        ("revolute", "at = [0, 0, 0]"),
        ("revolute", "points = { ground = [0, 0, 0], a = [0, 0, 0] }"),
        ("revolute", "axis = [0, 0, 1]"),
        ("revolute", "axes = { ground = [0, 0, 1], a = [0, 0, 1] }"),
        ("revolute", "frame = \"global\""),
        ("revolute", "cross = [1, 0, 0]"),
        ("universal", "axis = [0, 0, 1]"),
        ("universal", "cross = [1, 0, 0]"),
        ("perpendicular", "cross = [1, 0, 0]"),
    ] {
        let text = scene(kind, more);
        assert!(read(&text).is_err(), "the reader takes {more:?} of {kind}");
        assert!(
            verdict(&text).is_some(),
            "the schema takes {more:?} of {kind}"
        );
    }
}

/// In format 2 expressions may replace numbers; the schema does not distinguish the formats.
#[test]
fn expressions_are_valid() {
    let whole = format!("{BODIES}{MORE}");
    let text = whole
        .replacen(
            "space =",
            "format = 2\nunits = { angle = \"deg\" }\nspace =",
            1,
        )
        .replacen(
            "[[body]]",
            "[parameters]\nm1 = 1.0\nL = \"m1*2 mm\"\n[[body]]",
            1,
        )
        .replacen("mass = 1.0", "mass = \"m1\"", 1)
        .replacen("angle = 1.5707963267948966", "angle = 90", 1)
        .replacen("at = [0.0, 0.0]", "at = [\"0 mm\", \"L - L\"]", 1)
        .replacen("by = 0.1", "by = \"5 deg\"", 1)
        .replacen("t_end = 1", "t_end = \"500 ms*2\"", 1);
    assert_eq!(read(&text).err(), None);
    assert_eq!(verdict(&text), None);
    let mass = whole.replacen("mass = 1.0", "mass = \"1\"", 1);
    assert!(read(&mass).is_err());
    assert_eq!(verdict(&mass), None);
}

/// Returns the keys that the reader accepts in a table, as listed in its message about an unknown
/// key.
fn keys_of_reader(text: &str) -> BTreeSet<String> {
    let problems = read(text).expect_err("a key is unknown");
    let unknown = problems
        .iter()
        .find(|p| p.message.contains("has no key `zzz`"));
    let unknown = unknown.unwrap_or_else(|| panic!("{text}\n{problems:#?}"));
    let help = unknown.help.as_deref().expect("its keys");
    help.split('`')
        .skip(1)
        .step_by(2)
        .map(str::to_owned)
        .collect()
}

fn keys_of_schema(table: &Value) -> BTreeSet<String> {
    let properties = table["properties"].as_object().expect("a table");
    properties.keys().cloned().collect()
}

/// Returns a value of a key, in TOML, that is valid according to the schema.
fn example(key: &str, of: &Value) -> String {
    match key {
        "body" => "\"a\"".to_owned(),
        "bodies" => "[\"a\", \"b\"]".to_owned(),
        "name" => "\"X\"".to_owned(),
        _ => match &of["const"] {
            Value::Null => "false".to_owned(),
            constant => constant.to_string(),
        },
    }
}

#[test]
fn keys_of_elements_are_those_of_the_reader() {
    let schema = schema();
    for section in ["joint", "force"] {
        let tables = schema["$defs"][section]["oneOf"]
            .as_array()
            .expect("tables");
        assert!(tables.len() >= 6, "{section}");
        for table in tables {
            // These keys are sufficient to select a definition.
            let mut text = format!("{BODIES}[[{section}]]\nzzz = 1\n");
            for (key, of) in table["properties"].as_object().expect("keys") {
                if ["name", "type", "body", "bodies", "frame"].contains(&key.as_str()) {
                    text.push_str(&format!("{key} = {}\n", example(key, of)));
                }
            }
            // For a type with several definitions, the message of the reader lists all ways to give
            // the bodies.
            let mut keys = keys_of_reader(&text);
            let type_of = |table: &Value| table["properties"]["type"]["const"].clone();
            let shared = |other: &&Value| type_of(other) == type_of(table);
            let ways: BTreeSet<String> = tables
                .iter()
                .filter(shared)
                .flat_map(keys_of_schema)
                .collect();
            let own = keys_of_schema(table);
            let is_way =
                |key: &String| ["body", "bodies"].contains(&key.as_str()) && ways.contains(key);
            keys.retain(|key| own.contains(key) || !is_way(key));
            assert_eq!(keys, own, "{text}");
        }
    }
}

#[test]
fn keys_of_sections_are_those_of_the_reader() {
    let schema = schema();
    for name in ["scene", "start", "simulate", "output"] {
        let text = match name {
            "scene" => BODIES.replacen("[scene]\n", "[scene]\nzzz = 1\n", 1),
            _ => format!("{BODIES}[{name}]\nzzz = 1\n"),
        };
        assert_eq!(
            keys_of_reader(&text),
            keys_of_schema(&schema["$defs"][name]),
            "{name}"
        );
    }
    for name in ["body", "drive"] {
        let text = format!("{BODIES}[[{name}]]\nzzz = 1\n");
        assert_eq!(
            keys_of_reader(&text),
            keys_of_schema(&schema["$defs"][name]),
            "{name}"
        );
    }
    let group = schema["$defs"]["group"]["oneOf"]
        .as_array()
        .expect("two forms");
    let of_schema: BTreeSet<String> = group.iter().flat_map(keys_of_schema).collect();
    assert_eq!(
        keys_of_reader(&format!("{BODIES}[[group]]\nzzz = 1\n")),
        of_schema
    );

    let whole = keys_of_reader(&format!("zzz = 1\n{BODIES}"));
    assert_eq!(whole, keys_of_schema(&schema));
}

#[test]
fn keys_of_functions_are_those_of_the_reader() {
    let schema = schema();
    let drive = |motion: &str| {
        format!(
            "{BODIES}{MORE}[[drive]]\nname = \"X\"\njoint = \"A\"\ntype = \"angle\"\nmotion = {motion}\n"
        )
    };
    let kinds = schema["$defs"]["function"]["oneOf"]
        .as_array()
        .expect("kinds");
    for table in kinds.iter().filter(|kind| kind["type"] == "object") {
        // If a value has the wrong form, the reader does not reach the check of the keys.
        let mut words = vec!["zzz = 1".to_owned()];
        for (key, of) in table["properties"].as_object().expect("keys") {
            let value = match (&of["const"], of["type"].as_str()) {
                (Value::String(name), _) => format!("{name:?}"),
                (_, Some("array")) if key == "steps" => "[{ from = 0, to = 1, by = 1 }]".to_owned(),
                (_, Some("array")) => "[0, 1]".to_owned(),
                _ => "1".to_owned(),
            };
            words.push(format!("{key} = {value}"));
        }
        let text = drive(&format!("{{ {} }}", words.join(", ")));
        assert_eq!(keys_of_reader(&text), keys_of_schema(table), "{text}");
    }
    let step = drive("{ type = \"steps\", steps = [{ from = 0, to = 1, by = 1, zzz = 1 }] }");
    assert_eq!(
        keys_of_reader(&step),
        keys_of_schema(&schema["$defs"]["step"])
    );
}

#[test]
fn defaults_are_those_of_the_reader() {
    let schema = schema();
    let written = |table: &str| {
        let keys = schema["$defs"][table]["properties"]
            .as_object()
            .expect("keys");
        let defaults = keys.iter().filter(|(_, of)| !of["default"].is_null());
        let lines: Vec<String> = defaults
            .map(|(key, of)| format!("{key} = {}", of["default"]))
            .collect();
        assert!(!lines.is_empty(), "{table}");
        lines.join("\n")
    };
    let plain = |more: &str, body: &str| {
        let text = format!(
            "[[body]]\nname = \"a\"\nmass = 1\ninertia = 1\n{body}\n[[joint]]\nname = \"A\"\ntype = \"angle\"\nbodies = [\"ground\", \"a\"]\n{more}"
        );
        read(&text).unwrap_or_else(|problems| panic!("{text}\n{problems:#?}"))
    };
    let head = "[scene]\nname = \"a\"\nspace = \"plane\"\n";
    let short = plain(&format!("{head}[simulate]\nt_end = 2\n"), "");
    let long = plain(
        &format!(
            "{head}{}\n[simulate]\nt_end = 2\n{}\n[start]\n{}\n[output]\n{}\n",
            written("scene"),
            written("simulate"),
            written("start"),
            written("output")
        ),
        &written("body"),
    );
    assert_eq!(
        short.description.plane().expect("a planar scene").gravity,
        long.description.plane().expect("a planar scene").gravity
    );
    assert_eq!(
        format!(
            "{:?}",
            short.description.plane().expect("a planar scene").bodies
        ),
        format!(
            "{:?}",
            long.description.plane().expect("a planar scene").bodies
        )
    );
    assert_eq!(
        format!("{:?}", short.simulate),
        format!("{:?}", long.simulate)
    );
    assert_eq!(format!("{:?}", short.start), format!("{:?}", long.start));
    assert_eq!(short.output, long.output);
}

#[test]
fn everything_has_words() {
    fn walk(path: &str, value: &Value, silent: &mut Vec<String>) {
        let Some(table) = value.as_object() else {
            return;
        };
        for (key, of) in table {
            let here = format!("{path}/{key}");
            if path.ends_with("/properties")
                && of.get("description").is_none()
                && of.get("const").is_none()
            {
                silent.push(here.clone());
            }
            walk(&here, of, silent);
        }
        for (k, item) in table
            .get("oneOf")
            .and_then(Value::as_array)
            .into_iter()
            .flatten()
            .enumerate()
        {
            walk(&format!("{path}/oneOf/{k}"), item, silent);
        }
    }
    let mut silent = Vec::new();
    walk("", &schema(), &mut silent);
    assert_eq!(silent, Vec::<String>::new());
    assert_eq!(
        schema()["$schema"],
        json!("https://json-schema.org/draft/2020-12/schema")
    );
}
