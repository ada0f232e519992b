//! What the data are known to: flags that go before the scene, the documents and sentences that tell it, and wrong values.

use serde_json::{Value, json};

use super::{Folder, ROBOT, pfaff, stderr, stdout, with_scene};

/// A door on one hinge, 2 m long, with its sizes from a drawing.
const DOOR: &str = r#"
[scene]
name = "door"
space = "plane"
tolerance = 1e-3
[[body]]
name = "leaf"
mass = 20.0
inertia = 5.0
position = [2.0, 0.0]
[[joint]]
name = "hinge"
type = "revolute"
bodies = ["ground", "leaf"]
at = [0.0, 0.0]
"#;

fn data(output: &std::process::Output) -> Value {
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let document: Value = serde_json::from_str(&stdout(output)).expect("one document");
    document["data"].clone()
}

fn known_to(tolerance: Value, angle: Value) -> Value {
    json!({
        "tolerance": tolerance, "angle_tolerance": angle,
        "lower_rank_from": null, "lower_rank_here": null,
    })
}

#[test]
fn flags_go_before_the_scene() {
    let told = |flags: &[&str]| {
        let arguments = [&["analyze", "-", "--json"], flags].concat();
        data(&with_scene(&arguments, DOOR))
    };
    // Angles: the length over the 2 m of the mechanism.
    assert_eq!(told(&[]), known_to(1e-3.into(), 5e-4.into()));
    assert_eq!(
        told(&["--tolerance", "1e-4"]),
        known_to(1e-4.into(), 5e-5.into())
    );
    assert_eq!(
        told(&["--angle-tolerance", "1e-6"]),
        known_to(1e-3.into(), 1e-6.into())
    );
    let both = ["--tolerance", "1e-4", "--angle-tolerance", "1e-6"];
    assert_eq!(told(&both), known_to(1e-4.into(), 1e-6.into()));
}

#[test]
fn what_nobody_states_is_not_told() {
    let silent = DOOR.replace("tolerance = 1e-3\n", "");
    let output = with_scene(&["analyze", "-", "--json"], &silent);
    assert_eq!(data(&output), known_to(Value::Null, Value::Null));
    let words = stdout(&with_scene(&["analyze", "-"], &silent));
    assert!(!words.contains("known to"), "{words}");
    let words = stdout(&with_scene(&["analyze", "-"], DOOR));
    assert!(
        words.contains("  data known to 1 mm (angles 5.0e-4 rad)\n"),
        "{words}"
    );
}

#[test]
fn a_run_tells_it_in_its_summary() {
    let folder = Folder::new("tolerance");
    let arguments = ["simulate", "-", "--t-end", "0.1", "--out", folder.text()];
    let output = with_scene(&[&arguments[..], &["--tolerance", "1e-5"]].concat(), DOOR);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let summary: Value = serde_json::from_str(&folder.read("summary.json")).expect("JSON");
    assert_eq!(summary["data"], known_to(1e-5.into(), 5e-6.into()));
}

#[test]
fn every_command_that_judges_takes_them() {
    let folder = Folder::new("tolerances");
    let picture = format!("{}/robot.svg", folder.text());
    std::fs::create_dir_all(folder.text()).expect("writable");
    let commands: [&[&str]; 6] = [
        &["analyze", ROBOT],
        &["check", ROBOT],
        &["simulate", ROBOT, "--out", folder.text()],
        &["plan", ROBOT],
        &["view", ROBOT, "--no-open", "--out", &picture],
        &["diff", ROBOT, ROBOT],
    ];
    for command in commands {
        for (flag, value, expected) in [
            ("--tolerance", "0", "need a length in m > 0, as 1e-4"),
            ("--tolerance", "-1e-4", "need a length in m > 0, as 1e-4"),
            ("--tolerance", "0.1mm", "need a length in m > 0, as 1e-4"),
            (
                "--angle-tolerance",
                "inf",
                "need an angle in rad > 0, as 1e-5",
            ),
        ] {
            let output = pfaff(&[command, &[flag, value]].concat());
            let text = stderr(&output);
            assert_eq!(output.status.code(), Some(2), "{command:?}: {text}");
            assert!(
                text.contains(&format!("invalid value '{value}' for '{flag}")),
                "{text}"
            );
            assert!(text.contains(expected), "{text}");
            assert!(output.stdout.is_empty(), "{command:?}");
        }
        let help = stdout(&pfaff(&[command[0], "--help"]));
        for flag in ["--tolerance <LENGTH>", "--angle-tolerance <RAD>"] {
            assert!(help.contains(flag), "{}: {help}", command[0]);
        }
    }
    for command in [commands[1], commands[3], commands[4], commands[5]] {
        let output = pfaff(&[command, &["--tolerance", "1e-9"]].concat());
        assert_eq!(output.status.code(), Some(0), "{output:?}");
    }
}
