//! Tests mobility with and without the drives, free motions, and drives that contradict each other,
//! in every output.

use serde_json::{Value, json};

use super::analyze::contains;
use super::bad_input::contradiction_at_half_a_second;
use super::{Folder, ROBOT, pfaff, stderr, stdout, with_scene};

/// A crank, with a motor or without a motor.
fn crank(motor: bool) -> String {
    let drive = r#"
[[drive]]
name = "motor"
joint = "pin"
type = "angle"
motion = { type = "constant-rate", rate = 1.0 }
"#;
    let scene = r#"
[scene]
name = "crank"
space = "plane"

[[body]]
name = "crank"
mass = 1.0
inertia = 1.0
position = [0.5, 0.0]

[[joint]]
name = "pin"
type = "revolute"
bodies = ["ground", "crank"]
at = [0.0, 0.0]

[simulate]
t_end = 0.1
"#;
    format!("{scene}{}", if motor { drive } else { "" })
}

#[track_caller]
fn document(arguments: &[&str], scene: &str) -> Value {
    let output = with_scene(arguments, scene);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    serde_json::from_slice(&output.stdout).expect("one JSON document")
}

/// Returns `[vx, vy, omega]` of the crank that rotates about its pin.
fn turns() -> Value {
    json!([{ "text": "`crank` turns about `pin`", "velocities": [{ "crank": [0.0, 0.5, 1.0] }] }])
}

#[test]
fn documents_have_both() {
    let free = document(&["analyze", "-", "--json"], &crank(false));
    assert_eq!(
        (&free["mobility"], &free["without_drives"]),
        (&json!(1), &Value::Null)
    );
    assert_eq!(free["free_motions"], turns());
    let driven = document(&["analyze", "-", "--json"], &crank(true));
    let without =
        json!({ "drives": 1, "rank": 2, "redundancy": 0, "mobility": 1, "free_motions": turns() });
    assert_eq!(
        (&driven["mobility"], &driven["free_motions"]),
        (&json!(0), &json!([]))
    );
    assert_eq!(driven["without_drives"], without);

    let folder = Folder::new("freedoms-run");
    let run = document(
        &["simulate", "-", "--out", folder.text(), "--json"],
        &crank(true),
    );
    let summary: Value = serde_json::from_str(&folder.read("summary.json")).expect("JSON");
    for d in [&run, &summary] {
        assert_eq!(
            (&d["mobility"], &d["without_drives"]),
            (&json!(0), &without)
        );
    }
    let page = folder.read("report.html");
    for words in [
        "The mobility is zero with its drive, and the mobility without drives is one",
        "<li>Free without its drive: <b>crank</b> turns about <b>pin</b></li>",
        "<b>1</b><span>mobility without drives</span>",
    ] {
        assert!(page.contains(words), "{words}");
    }

    for command in ["check", "view"] {
        let picture = format!("{}/x.svg", folder.text());
        let more = ["--out", &picture, "--no-open"];
        let more: &[&str] = if command == "view" { &more } else { &[] };
        let arguments = [&[command, "-", "--json"], more].concat();
        let d = document(&arguments, &crank(true));
        let found = (&d["mobility"], &d["mobility_without_drives"]);
        assert_eq!(found, (&json!(0), &json!(1)), "{command}");
        let d = document(&arguments, &crank(false));
        let found = (&d["mobility"], &d["mobility_without_drives"]);
        assert_eq!(found, (&json!(1), &Value::Null), "{command}");
    }
}

/// Without drives there is no duplicate text.
#[test]
fn words_have_both_where_they_differ() {
    let said = |arguments: &[&str], scene: &str| stdout(&with_scene(arguments, scene));
    let driven = said(&["analyze", "-"], &crank(true));
    contains(
        &driven,
        &[
            "redundancy 0, mobility 0 with its drive, 1 without rank proved",
            "free without its drive: `crank` turns about `pin`",
        ],
    );
    let free = said(&["analyze", "-"], &crank(false));
    contains(
        &free,
        &[
            "redundancy 0, mobility 1 rank proved",
            "free: `crank` turns about `pin`",
        ],
    );
    assert!(!free.contains("without"), "{free}");
    contains(
        &said(&["check", "-"], &crank(true)),
        &["mobility 0 with its drive, 1 without"],
    );
    let robot = stdout(&pfaff(&["check", ROBOT]));
    contains(&robot, &["mobility 1 with its drive, 2 without"]);
}

/// Hinges lock a leaf: it cannot move with any additional drive.
#[test]
fn what_cannot_move_is_said_to() {
    let locked = crank(true).replace(
        "[simulate]",
        "[[joint]]\nname = \"third\"\ntype = \"revolute\"\nbodies = [\"ground\", \"crank\"]\nat = [1.0, 0.0]\n\n[simulate]",
    );
    let still = locked.replace("rate = 1.0", "rate = 0.0");
    contains(
        &stdout(&with_scene(&["check", "-"], &still)),
        &["mobility 0 with its drive, 0 without: it cannot move"],
    );
    contains(
        &stdout(&with_scene(&["analyze", "-"], &still)),
        &["mobility 0 with its drive, 0 without: it cannot move"],
    );
    // The motor prescribes a motion that the hinges prevent.
    let output = with_scene(&["check", "-"], &locked);
    assert_eq!(output.status.code(), Some(2));
    contains(
        &stderr(&output),
        &[
            "drive `motor` requires the angle of `pin` to change at 1 rad/s, which differs by 1 rad/s from the value that rows 2 (`pin`, y) and 4 (`third`, y) allow",
            "requires what the others forbid",
            "holds it",
        ],
    );
}

/// From 0.5 s on, one motor prescribes 1 rad, the other 1.1 rad: `check` rejects the scene,
/// `analyze` warns, and the run stops; all name both motors.
#[test]
fn drives_that_part_later_are_named_by_every_command() {
    let scene = contradiction_at_half_a_second();
    let names = "drives `one` and `other` contradict each other: they require different";
    let check = with_scene(&["check", "-"], &scene);
    assert_eq!(check.status.code(), Some(2));
    contains(
        &stderr(&check),
        &["error[P0210]: at t = ", names, "contradicts too"],
    );
    let analyze = with_scene(&["analyze", "-"], &scene);
    assert_eq!(analyze.status.code(), Some(0));
    contains(&stdout(&analyze), &["warning: at t = ", names]);
    let folder = Folder::new("freedoms-part");
    let run = with_scene(&["simulate", "-", "--out", folder.text()], &scene);
    assert_eq!(run.status.code(), Some(1));
    contains(
        &stderr(&run),
        &[
            "at t = 0.5",
            "redundant rows contradict each other: at t = ",
            names,
        ],
    );
}
