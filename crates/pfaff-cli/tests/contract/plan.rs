//! Tests `pfaff plan`, and that runs follow the plan.

use serde_json::Value;

use super::bad_input::PENDULUM;
use super::{Folder, ROBOT, pfaff, stderr, stdout, with_scene};

fn json(text: &str) -> Value {
    serde_json::from_str(text).expect("one JSON document and nothing else")
}

/// Returns the decision on a subject, for one component if there are several.
fn decision<'d>(document: &'d Value, what: &str, component: Option<&str>) -> &'d Value {
    let decisions = document["decisions"].as_array().expect("a list");
    let mut found = decisions.iter().filter(|d| {
        d["decision"] == what && d.get("component").and_then(Value::as_str) == component
    });
    let only = found
        .next()
        .unwrap_or_else(|| panic!("{what} of {component:?}"));
    assert!(found.next().is_none(), "{what} is decided once");
    only
}

/// Two mechanisms have one ground: a pendulum, and a mass on a stiff damper.
const TWO: &str = r#"
scene = { name = "two", space = "plane", gravity = [0.0, -9.81] }
body = [
    { name = "bob", mass = 1.0, inertia = 0.1, position = [1.0, 0.0] },
    { name = "mass", mass = 1.0, inertia = 0.1, position = [6.1, 0.0] },
]
joint = [
    { name = "pivot", type = "revolute", bodies = ["ground", "bob"], at = [0.0, 0.0] },
    { name = "rail", type = "translational", bodies = ["ground", "mass"], at = [6.1, 0.0], axis = [1.0, 0.0] },
]
force = [{ name = "damper", type = "spring-damper", bodies = ["ground", "mass"], at = [[5.0, 0.0], [6.1, 0.0]],
    stiffness = 1e4, damping = 1e8, free_length = 1.0 }]
simulate = { t_end = 1.0, output_step = 0.25 }
"#;

#[test]
fn the_plan_of_the_robot_is_a_table_and_a_document() {
    let output = pfaff(&["plan", ROBOT]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = stdout(&output);
    assert!(
        text.starts_with("robot-trolley: plan of a run to t = 10 s (independent rows, projection)")
    );
    for words in ["decision", "solved as one", "2 monitored", "b and Φt of 1"] {
        assert!(text.contains(words), "{words}: {text}");
    }
    let d = json(&stdout(&pfaff(&["plan", ROBOT, "--json"])));
    let whole = &d["components"][0];
    for (key, expected) in [
        ("velocities", 21),
        ("holonomic_rows", 17),
        ("nonholonomic_rows", 5),
        ("rank", 20),
        ("redundancy", 2),
        ("mobility", 1),
    ] {
        assert_eq!(whole[key], expected, "{key}");
    }
    let time = decision(&d, "rows_of_time", None);
    let saves = serde_json::json!({ "left_out": 21, "of": 22, "what": "values of b" });
    assert_eq!(time["saves"], saves);
    assert!(
        time["reason"]
            .as_str()
            .is_some_and(|r| r.starts_with("driven"))
    );
}

#[test]
fn flags_change_the_plan_as_they_change_the_run() {
    let radau = json(&stdout(&pfaff(&[
        "plan", ROBOT, "--json", "--method", "radau5",
    ])));
    assert_eq!(decision(&radau, "method", None)["reason"], "requested");
    assert_eq!(
        decision(&radau, "linear_systems", None)["taken"],
        "on independent coordinates"
    );
    // Options that no run has cannot be planned.
    for wrong in [
        &["--method", "radau5", "--stabilisation", "none"][..],
        &["--drop", "1,2"],
    ] {
        let output = pfaff(&[&["plan", ROBOT], wrong].concat());
        assert_eq!(
            output.status.code(),
            Some(2),
            "{wrong:?}: {}",
            stderr(&output)
        );
    }
    let endless = PENDULUM.replace("[simulate]", "[ignored]");
    let endless = endless.split("[ignored]").next().expect("a scene");
    let output = with_scene(&["plan", "-"], endless);
    assert_eq!(output.status.code(), Some(2), "{}", stdout(&output));
    assert!(stderr(&output).contains("t_end"), "{}", stderr(&output));
}

#[test]
fn components_have_plans_and_numbers_of_their_own() {
    let d = json(&stdout(&with_scene(&["plan", "-", "--json"], TWO)));
    let method = |component| decision(&d, "method", Some(component))["taken"].clone();
    assert_eq!(
        (method("bob"), method("mass")),
        ("dop853".into(), "radau5".into())
    );
    assert_eq!(
        decision(&d, "turning_bodies", Some("mass"))["taken"],
        "0 of 1"
    );
    let text = stdout(&with_scene(&["plan", "-"], TWO));
    assert!(
        text.contains("\nbob: 3 velocities, 2 rows, rank 2\n"),
        "{text}"
    );

    let folder = Folder::new("two");
    let output = with_scene(&["simulate", "-", "--out", folder.text()], TWO);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let summary = json(&folder.read("summary.json"));
    assert_eq!(summary["method"], "auto");
    assert_eq!(
        summary["plan"]["components"],
        "2, each with its own method and step size"
    );
    let components = summary["components"].as_array().expect("a list");
    let names: Vec<&Value> = components.iter().map(|c| &c["name"]).collect();
    assert_eq!(names, ["bob", "mass"]);
    assert_eq!(components[1]["method"], "radau5");
    assert_eq!(
        components[1]["plan"]["linear_systems"],
        "on independent coordinates"
    );
    let sum: u64 = components
        .iter()
        .filter_map(|c| c["evaluations"].as_u64())
        .sum();
    assert_eq!(summary["evaluations"], sum);
    let trajectory = folder.read("trajectory.csv");
    assert_eq!(trajectory.lines().count(), 1 + 5);
    assert!(trajectory.starts_with("t,bob.x,"));
}

#[test]
fn output_that_is_not_wanted_is_not_computed() {
    let quiet = format!("{TWO}output = {{ trajectory = false, reactions = false }}\n");
    let some = format!("{TWO}output = {{ reactions = [\"rail\"] }}\n");
    let run = |name: &str, scene: &str| {
        let folder = Folder::new(name);
        let output = with_scene(&["simulate", "-", "--out", folder.text()], scene);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let summary = json(&folder.read("summary.json"));
        let has = |name: &str| folder.0.join(name).exists();
        let files = [has("trajectory.csv"), has("reactions.csv")];
        let reactions = files[1].then(|| folder.read("reactions.csv"));
        (summary, files, reactions)
    };
    let (everything, files, _) = run("everything", TWO);
    assert_eq!(files, [true; 2]);
    let (nothing, files, _) = run("nothing", &quiet);
    assert_eq!(files, [false; 2]);
    assert_eq!(nothing["plan"]["rows_of_output"], "only first and last");
    assert_eq!(nothing["steps"], everything["steps"]);
    let evaluations = |summary: &Value| summary["evaluations"].as_u64().expect("a number");
    assert!(evaluations(&nothing) < evaluations(&everything));
    let (named, _, reactions) = run("named", &some);
    let taken: Vec<&Value> = (0..2)
        .map(|k| &named["components"][k]["plan"]["reactions"])
        .collect();
    assert_eq!(taken, ["none", "all 1"]);
    let table = reactions.expect("asked for");
    assert_eq!(table.lines().next(), Some("t,rail.Fx,rail.Fy,rail.T"));
    assert!(!table.contains("NaN"), "{table}");
}
