//! `pfaff schema` prints one document, the schema of the reader. The tests of the reader in `scene`
//! check its content.

use serde_json::Value;

use super::{pfaff, stderr, stdout};

#[test]
fn the_schema_is_one_document_with_types_units_and_defaults() {
    let output = pfaff(&["schema"]);
    assert_eq!((output.status.code(), &*stderr(&output)), (Some(0), ""));
    let schema: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    assert_eq!(
        schema["$schema"],
        "https://json-schema.org/draft/2020-12/schema"
    );
    assert_eq!(schema["additionalProperties"], false);
    let mass = &schema["$defs"]["body"]["properties"]["mass"];
    assert_eq!(
        (&mass["description"], &mass["minimum"]),
        (&"Mass (kg)".into(), &0.into())
    );
    let method = &schema["$defs"]["simulate"]["properties"]["method"];
    assert_eq!(method["default"], "auto");
    let joints = schema["$defs"]["joint"]["oneOf"].as_array().expect("types");
    let types: Vec<_> = joints
        .iter()
        .filter_map(|j| j["properties"]["type"]["const"].as_str())
        .collect();
    assert!(
        types.contains(&"knife-edge") && types.len() == joints.len(),
        "{types:?}"
    );
}

#[test]
fn the_help_says_how_an_editor_uses_it() {
    let help = stdout(&pfaff(&["schema", "--help"]));
    assert!(help.contains("#:schema ./pfaff.schema.json"), "{help}");
    assert!(help.contains("Even Better TOML") && help.contains("pfaff schema > pfaff.schema.json"));
}

#[test]
fn it_also_describes_answers() {
    let output = pfaff(&["schema", "robot.toml"]);
    assert_eq!(output.status.code(), Some(2));
    let refused = stderr(&output);
    assert!(
        refused.contains("invalid value 'robot.toml'") && refused.contains("analyze"),
        "{refused}"
    );
    let output = pfaff(&["schema", "equilibrium"]);
    let schema: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(schema["properties"]["stability"]["type"], "string");
}
