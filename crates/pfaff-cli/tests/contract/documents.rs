//! Tests documents and files of the published mechanism.

use std::process::{Command, Stdio};

use serde_json::Value;

use super::bad_input::PENDULUM;
use super::{Folder, ROBOT, pfaff, stdout, with_scene};

fn json(text: &str) -> Value {
    serde_json::from_str(text).expect("one JSON document and nothing else")
}

#[test]
fn analyze_writes_the_document_of_the_contract() {
    let output = pfaff(&["analyze", ROBOT, "--json"]);
    assert_eq!(output.status.code(), Some(0));
    let d = json(&stdout(&output));
    for (key, expected) in [
        ("bodies", 7),
        ("coordinates", 21),
        ("rows", 22),
        ("holonomic_rows", 17),
        ("nonholonomic_rows", 5),
        ("rank", 20),
        ("rank_holonomic", 17),
        ("rank_nonholonomic", 4),
        ("redundancy", 2),
        ("mobility", 1),
    ] {
        assert_eq!(d[key], expected, "{key}");
    }
    let evidence = d["evidence"].as_object().expect("an object");
    for key in [
        "sigma_r",
        "sigma_next",
        "gap",
        "tolerance",
        "constraint_residual",
        "permanent",
        "certified",
    ] {
        assert!(evidence.contains_key(key), "{key}");
    }
    let reactions = d["reactions"].as_array().expect("a list");
    let names: Vec<&str> = reactions
        .iter()
        .filter_map(|r| r["name"].as_str())
        .collect();
    let expected = [
        "A", "B", "C", "D", "E", "F", "G", "H", "steering", "W1", "W2", "W3", "W4", "W5",
    ];
    assert_eq!(names, expected);
    let b = &reactions[1];
    assert_eq!(b["type"], "revolute");
    assert_eq!(b["rows"], serde_json::json!([3, 4]));
    assert_eq!(b["verdict"], "not_unique");
    assert_eq!(b["components"][0]["name"], "Fx");
    assert_eq!(b["components"][0]["verdict"], "unique");
    assert_eq!(b["components"][1]["verdict"], "not_unique");
    assert_eq!(b["unique_directions"], serde_json::json!([[1.0, 0.0]]));
    let pair = &d["dependencies"][0];
    assert_eq!(pair["rows"], serde_json::json!([20, 21]));
    assert_eq!(pair["joints"], serde_json::json!(["W3", "W4"]));
    let coefficients: Vec<f64> = pair["coefficients"]
        .as_array()
        .expect("a list")
        .iter()
        .filter_map(Value::as_f64)
        .collect();
    assert!((coefficients[0] - 1.0).abs() < 1e-12 && (coefficients[1] + 1.0).abs() < 1e-12);
}

#[test]
fn analyze_looks_at_any_time_of_the_motion() {
    let output = pfaff(&[
        "analyze",
        ROBOT,
        "--at-time",
        "1.5",
        "--json",
        "--combine",
        "W3.N + W4.N",
    ]);
    let d = json(&stdout(&output));
    assert_eq!(d["time"], 1.5);
    assert_eq!(d["rank"], 20);
    let b = &d["reactions"][1];
    assert_eq!(b["components"][0]["verdict"], "not_unique");
    assert_eq!(b["unique_directions"].as_array().map(Vec::len), Some(1));
    assert_eq!(d["groups"][0]["verdict"], "not_unique");
}

/// If the rate of a motor jumps by −3 rad/s, its impulse equals the change of the angular momentum
/// about the pin, 3·(0.3 + 2·0.5²) N·m·s on the ground. Two coincident pins share their impulse in
/// an undetermined way.
#[test]
fn impulses_are_values_with_verdicts() {
    let scene = r#"
scene = { name = "wheel", space = "plane" }
body = [{ name = "wheel", mass = 2.0, inertia = 0.3, position = [0.5, 0.0] }]
joint = [
    { name = "pin", type = "revolute", bodies = ["ground", "wheel"], at = [0.0, 0.0] },
    { name = "other", type = "revolute", bodies = ["ground", "wheel"], at = [0.0, 0.0] },
]
drive = [{ name = "motor", joint = "pin", type = "angle", motion = { type = "linear-table", times = [0.0, 1.0, 3.0], values = [0.0, 2.0, 0.0] } }]
simulate = { t_end = 2.0 }
"#;
    let impulses = |arguments: &[&str], scene: &str| {
        let output = with_scene(arguments, scene);
        let d = json(&stdout(&output));
        let events = d["events"].as_array().expect("a list").iter();
        let mut impulses = events.filter(|e| e["kind"] == "impulse");
        impulses.next().expect("one")["impulses"].clone()
    };
    let folder = Folder::new("impulses");
    let arguments = ["simulate", "-", "--out", folder.text(), "--json"];
    let found = impulses(&arguments, scene);
    let open = serde_json::json!(
        { "value": null, "verdict": "not_unique", "fragile": false, "sensitivity": null }
    );
    for name in ["pin", "other"] {
        assert_eq!(
            found[name]["components"],
            serde_json::json!({ "Fx": open, "Fy": open })
        );
    }
    let drive = &found["motor"]["components"]["drive"];
    assert_eq!(drive["verdict"], "unique");
    let value = drive["value"].as_f64().expect("a number");
    assert!((value - 2.4).abs() < 1e-9, "{value}");
    let silent = format!("{scene}output = {{ reactions = false }}\n");
    assert_eq!(impulses(&arguments, &silent), Value::Null);
}

/// Two mechanisms are independent of each other: if only the reactions of one are requested, the
/// other also has its verdicts.
#[test]
fn what_is_not_wanted_is_not_called_unique() {
    let scene = r#"
scene = { name = "two", space = "plane", gravity = [0.0, -10.0] }
body = [
    { name = "beam", mass = 1.0, inertia = 0.1 },
    { name = "bob", mass = 1.0, inertia = 0.1, position = [5.0, -1.0] },
]
joint = [
    { name = "left", type = "revolute", bodies = ["ground", "beam"], at = [-1.0, 0.0] },
    { name = "right", type = "revolute", bodies = ["ground", "beam"], at = [1.0, 0.0] },
    { name = "pivot", type = "revolute", bodies = ["ground", "bob"], at = [5.0, 0.0] },
]
simulate = { t_end = 0.1 }
output = { reactions = ["pivot"] }
"#;
    let folder = Folder::new("not-wanted");
    let arguments = ["simulate", "-", "--out", folder.text(), "--json"];
    let d = json(&stdout(&with_scene(&arguments, scene)));
    let verdict = |name: &str| d["reactions"][name]["verdict"].clone();
    assert_eq!(
        ["left", "right", "pivot"].map(verdict),
        ["not_unique", "not_unique", "unique"]
    );
    let components = &d["reactions"]["left"]["components"];
    assert_eq!(components["Fx"]["verdict"], "not_unique");
    assert_eq!(components["Fy"]["verdict"], "unique");
}

#[test]
fn simulate_writes_the_files_of_the_contract() {
    let folder = Folder::new("simulate");
    let output = pfaff(&["simulate", ROBOT, "--out", folder.text()]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert!(stdout(&output).contains("not determined by the model: B, C, W1, W2, W3, W4"));

    let trajectory = folder.read("trajectory.csv");
    let lines: Vec<&str> = trajectory.lines().collect();
    assert!(lines[0].starts_with(
        "t,platform.x,platform.y,platform.angle,platform.vx,platform.vy,platform.omega,"
    ));
    assert_eq!(lines.len(), 202);
    assert!(lines[1].starts_with("0,") || lines[1].starts_with("0.0,"));
    let last: f64 = lines[201]
        .split(',')
        .next()
        .expect("a cell")
        .parse()
        .expect("a number");
    assert_eq!(last, 10.0);

    let reactions = folder.read("reactions.csv");
    let header = reactions.lines().next().expect("a header");
    assert!(header.starts_with("t,A.Fx,A.Fy,A.T,B.Fx"));
    assert!(header.contains("steering.Fx,steering.Fy,steering.T,steering.drive"));
    assert!(header.ends_with("W5.Fx,W5.Fy,W5.T,W5.N"));

    let summary = json(&folder.read("summary.json"));
    for key in [
        "method",
        "formulation",
        "stabilisation",
        "steps",
        "evaluations",
        "projections",
        "normalisations",
        "wall_seconds",
        "max_position_residual",
        "max_velocity_residual",
        "energy_balance",
        "start_correction",
        "events",
        "reactions",
    ] {
        assert!(summary.get(key).is_some(), "{key}");
    }
    assert!(summary["max_position_residual"].as_f64().expect("a number") <= 1e-12);
    assert!(summary["energy_balance"].as_f64().expect("a number") <= 1e-7);
    assert_eq!(summary["reactions"]["A"]["verdict"], "unique");
    let choice = &summary["choice"][0];
    assert_eq!(choice["deleted_rows"], serde_json::json!([20, 21]));
    // Up to 1 s the edges are parallel to x, and so are the determined components. The table
    // contains only the determined components, and the choice contains all components.
    let b = &summary["reactions"]["B"];
    assert_eq!(b["verdict"], "not_unique");
    let along = &b["components"]["Fx"];
    assert_eq!(along["verdict"], "not_unique");
    assert_eq!(along["determined"], serde_json::json!([[0.0, 1.0]]));
    assert!(b["components"]["Fy"].get("determined").is_none());
    let [determined, all] = ["reactions.csv", "choice.csv"].map(|file| folder.read(file));
    let columns: Vec<&str> = all.lines().next().expect("a header").split(',').collect();
    assert_eq!(determined.lines().next(), all.lines().next());
    let place = |name: &str| columns.iter().position(|c| *c == name).expect("a column");
    for (determined, all) in determined.lines().zip(all.lines()).skip(1) {
        let cells = [determined, all].map(|line| line.split(',').collect::<Vec<_>>());
        let t: f64 = cells[0][0].parse().expect("a time");
        let open = ["B.Fy", "W1.N", "W4.Fy"].map(&place);
        assert!(open.iter().all(|&k| cells[0][k].is_empty()), "{determined}");
        assert_eq!(cells[0][place("B.Fx")].is_empty(), t >= 1.0, "{determined}");
        assert_eq!(cells[0][place("A.Fx")], cells[1][place("A.Fx")]);
        assert!(cells[1].iter().all(|cell| !cell.is_empty()), "{all}");
    }
}

/// The run names the choice of the reactions that the model does not determine.
#[test]
fn the_run_names_its_choice() {
    let folder = Folder::new("choice");
    let simulate = ["simulate", ROBOT, "--t-end", "2", "--out", folder.text()];
    let output = pfaff(&simulate);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let text = stdout(&output);
    assert!(text.contains("(independent rows, projection)"), "{text}");
    assert!(text.contains("(rows 20, 21 deleted)"), "{text}");
    let summary = json(&folder.read("summary.json"));
    let choice = &summary["choice"][0];
    assert_eq!(summary["formulation"], "kept-rows");
    assert_eq!(choice["name"], "kept-rows");
    assert_eq!((&choice["from"], &choice["to"]), (&0.0.into(), &2.0.into()));
    assert!(choice.get("deleted_rows").is_some(), "{choice}");
}

/// Without projection, the remaining errors of the constraints are written.
#[test]
fn stabilisations_tell_their_drift() {
    let mut missed = Vec::new();
    for stabilisation in ["projection", "none"] {
        let folder = Folder::new(stabilisation);
        let simulate = ["simulate", ROBOT, "--json", "--out", folder.text()];
        let more = ["--t-end", "3", "--stabilisation", stabilisation];
        let output = pfaff(&[&simulate[..], &more[..]].concat());
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        let summary = json(&stdout(&output));
        assert_eq!(summary["stabilisation"], stabilisation);
        missed.push(summary["max_velocity_residual"].as_f64().expect("a number"));
    }
    let told = missed[1..].iter().all(|x| *x > 1e-10);
    assert!(missed[0] < 1e-12 && told, "{missed:?}");
}

#[test]
fn a_scene_may_come_from_standard_input() {
    let scene = std::fs::read_to_string(ROBOT).expect("the scene exists");
    let output = with_scene(&["analyze", "-", "--json"], &scene);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(json(&stdout(&output))["scene"], "robot-trolley");
}

#[test]
fn a_closed_standard_output_ends_quietly() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_pfaff"))
        .args(["analyze", ROBOT, "--json"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("the command ends");
    assert_eq!(output.status.code(), Some(0));
    assert!(output.stderr.is_empty(), "{output:?}");
}

#[test]
fn results_that_cannot_be_written_are_named() {
    let folder = Folder::new("occupied");
    std::fs::create_dir_all(&folder.0).expect("writable");
    let file = folder.0.join("file");
    std::fs::write(&file, "here first").expect("writable");
    let output = pfaff(&["simulate", ROBOT, "--out", file.to_str().expect("UTF-8")]);
    assert_eq!(output.status.code(), Some(2));
    assert!(super::stderr(&output).contains("file"), "{output:?}");
}

#[test]
fn one_body_is_no_bodies() {
    let text = stdout(&with_scene(&["check", "-"], PENDULUM));
    let expected = "pendulum: 1 body, 1 joint or drive, 2 holonomic rows\n";
    assert!(text.starts_with(expected), "{text}");
    let text = stdout(&with_scene(&["analyze", "-"], PENDULUM));
    assert!(
        text.contains("\n1 body, 3 coordinates, 2 holonomic rows: "),
        "{text}"
    );
    let text = stdout(&pfaff(&["check", ROBOT]));
    assert!(
        text.contains(": 7 bodies, 14 joints and drives, 22 rows "),
        "{text}"
    );
}

#[test]
fn a_run_that_loses_energy_warns() {
    let folder = Folder::new("energy");
    let simulate = ["simulate", "-", "--out", folder.text(), "--t-end", "10"];
    let warning = "warning: the error of the energy balance is ";
    let text = stdout(&with_scene(&simulate, PENDULUM));
    assert!(!text.contains(warning), "{text}");
    let loose = [&simulate[..], &["--rtol", "1e-3", "--atol", "1e-3"]].concat();
    let text = stdout(&with_scene(&loose, PENDULUM));
    assert!(text.contains(warning), "{text}");
    let balance = json(&folder.read("summary.json"))["energy_balance"].as_f64();
    assert!(balance.is_some_and(|x| x > 1e-3), "{text}");
}
