//! Loads of force elements in tables, documents and texts.

use serde_json::Value;

use super::{Folder, stdout, with_scene};

/// A bed on four bushings with its centre of mass 40 mm and 20 mm from the middle.
const BED: &str = r#"
scene = { name = "bed", space = "spatial", format = 2, units = { length = "mm" }, gravity = [0, 0, -9810] }
body = [{ name = "bed", mass = 200, inertia = [2e7, 3e7, 4e7], centre = [40, 20, 0] }]
force = [
    { name = "M1", type = "bushing", bodies = ["bed", "ground"], at = [-500, -300, 0], stiffness = [500, 500, 1000, 0, 0, 0], damping = [5, 5, 10, 0, 0, 0] },
    { name = "M2", type = "bushing", bodies = ["bed", "ground"], at = [500, -300, 0], stiffness = [500, 500, 1000, 0, 0, 0], damping = [5, 5, 10, 0, 0, 0] },
    { name = "M3", type = "bushing", bodies = ["bed", "ground"], at = [-500, 300, 0], stiffness = [500, 500, 1000, 0, 0, 0], damping = [5, 5, 10, 0, 0, 0] },
    { name = "M4", type = "bushing", bodies = ["bed", "ground"], at = [500, 300, 0], stiffness = [500, 500, 1000, 0, 0, 0], damping = [5, 5, 10, 0, 0, 0] },
]
simulate = { t_end = 3 }
"#;

/// The share of each bushing in the weight, for a rigid bed on equal springs: 1/4 of the weight,
/// more by the distance of the centre of mass towards the bushing.
fn shares() -> [f64; 4] {
    let share = |x: f64, y: f64| 1962.0 / 4.0 * (1.0 + 40.0 / x + 20.0 / y);
    [
        share(-500.0, -300.0),
        share(500.0, -300.0),
        share(-500.0, 300.0),
        share(500.0, 300.0),
    ]
}

fn json(arguments: &[&str]) -> Value {
    serde_json::from_str(&stdout(&with_scene(arguments, BED))).expect("JSON")
}

#[test]
fn an_equilibrium_has_the_loads_of_its_springs() {
    let d = json(&["equilibrium", "-", "--json"]);
    for (k, share) in shares().into_iter().enumerate() {
        let load = &d["loads"][format!("M{}", k + 1)];
        let found = load["Fz"].as_f64().expect("a number");
        // The bed leans by less than 1e-4, so the shares change by less than its square.
        assert!((found - share).abs() < 1e-5 * share, "M{}: {found}", k + 1);
    }
    let text = stdout(&with_scene(&["equilibrium", "-"], BED));
    assert!(text.contains("force on the first body"), "{text}");
}

#[test]
fn a_run_has_a_table_of_loads() {
    let folder = Folder::new("loads");
    with_scene(&["simulate", "-", "--out", folder.text()], BED);
    let table = std::fs::read_to_string(folder.0.join("loads.csv")).expect("written");
    let mut rows = table.lines();
    let header = rows.next().expect("a header");
    assert!(
        header.starts_with("t,M1.Fx,M1.Fy,M1.Fz,M1.Tx,M1.Ty,M1.Tz,M2.Fx"),
        "{header}"
    );
    let last: Vec<f64> = rows
        .last()
        .expect("rows")
        .split(',')
        .map(|x| x.parse().expect("a number"))
        .collect();
    for (k, share) in shares().into_iter().enumerate() {
        let found = last[3 + 6 * k];
        assert!((found - share).abs() < 1e-5 * share, "M{}: {found}", k + 1);
    }
    let summary = std::fs::read_to_string(folder.0.join("summary.json")).expect("written");
    let d: Value = serde_json::from_str(&summary).expect("JSON");
    let peak = d["loads"]["M4"]["peak"]["force"]["value"]
        .as_f64()
        .expect("a peak");
    assert!(peak > shares()[3], "it overshoots: {peak}");
    let page = std::fs::read_to_string(folder.0.join("report.html")).expect("written");
    assert!(page.contains("Peak loads</h2>") && page.contains("<td><b>M4</b></td>"));
}

#[test]
fn choices_of_reactions_come_with_the_loads() {
    let d = json(&["analyze", "-", "--json", "--choose", "minimum-norm"]);
    // The bushings have no load at the start.
    assert_eq!(d["loads"]["M2"]["Fz"].as_f64(), Some(0.0), "{d}");
    assert_eq!(json(&["analyze", "-", "--json"]).get("loads"), None);
}

/// A pendulum in the plane of the page, in space: an arm of length 1 on a hinge along z, whose axes
/// are turned.
const ARM: &str = r#"
scene = { name = "arm", space = "spatial", gravity = [0, -10, 0] }
body = [{ name = "arm", mass = 2.0, inertia = [0.1, 0.2, 0.25], position = [1, 0, 0], angular_velocity = [0, 0, 3], velocity = [0, 3, 0] }]
joint = [{ name = "hinge", type = "revolute", bodies = ["ground", "arm"], at = [0, 0, 0], axis = [0, 0, 1] }]
force = [{ name = "push", type = "point-force", frame = "body", body = "arm", point = [0.5, 0, 0], force = [0, 4, 0] }]
simulate = { t_end = 1.0 }
"#;

/// The rows of a table by the names of its columns.
fn rows(folder: &Folder, file: &str) -> Vec<std::collections::HashMap<String, f64>> {
    let table = std::fs::read_to_string(folder.0.join(file)).expect("written");
    let mut lines = table.lines();
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let row = |line: &str| {
        let numbers = line.split(',').map(|x| x.parse().expect("a number"));
        let named = header.iter().map(|name| (*name).to_owned()).zip(numbers);
        named.collect()
    };
    lines.map(row).collect()
}

#[test]
fn all_loads_on_a_body_balance_in_its_axes() {
    let folder = Folder::new("body-loads");
    let scene = format!("{ARM}output = {{ bodies = [\"arm\"] }}\n");
    let run = |scene| {
        stdout(&with_scene(
            &["simulate", "-", "--out", folder.text()],
            scene,
        ))
    };
    let said = run(&scene);
    assert!(!said.contains("other commands"), "{said}");
    let all = rows(&folder, "body_arm.csv");
    assert_eq!(all.len(), 201);
    for row in &all {
        for component in ["Fx", "Fy", "Fz", "Tx", "Ty", "Tz"] {
            let parts = ["hinge", "push", "gravity", "inertia"];
            let sum: f64 = parts
                .iter()
                .map(|part| row[&format!("{part}.{component}")])
                .sum();
            assert!(sum.abs() < 1e-10, "{component} at {}: {sum:e}", row["t"]);
        }
        // In the axes of the arm: the force follows the arm, 0.5 m ahead of its centre of mass.
        assert!((row["push.Fy"] - 4.0).abs() < 1e-12 && (row["push.Tz"] - 2.0).abs() < 1e-12);
    }
    // At the start: the moment 2 − 20 + 6 about the hinge turns J + m = 2.25, and ω = 3.
    let alpha = (6.0 - 20.0) / 2.25;
    let first = &all[0];
    for (column, expected) in [
        ("inertia.Fx", 2.0 * 9.0),
        ("inertia.Fy", -2.0 * alpha),
        ("inertia.Tz", -0.25 * alpha),
        ("gravity.Fy", -20.0),
        ("hinge.Fx", -2.0 * 9.0),
    ] {
        assert!(
            (first[column] - expected).abs() < 1e-9,
            "{column}: {}",
            first[column]
        );
    }
    let summary = std::fs::read_to_string(folder.0.join("summary.json")).expect("written");
    assert!(summary.contains("body_arm.csv"));
    // A later run without this table removes it, because it is not of this run.
    let said = run(ARM);
    assert!(!said.contains("other commands"), "{said}");
    assert!(!folder.0.join("body_arm.csv").exists());
}

#[test]
fn loads_that_are_not_determined_need_a_choice() {
    let door = include_str!("../../../../examples/door.toml").to_owned()
        + "\noutput = { bodies = [\"leaf\"] }\n";
    let folder = Folder::new("open-body");
    let refused = with_scene(&["simulate", "-", "--out", folder.text()], &door);
    let said = super::stderr(&refused);
    assert!(!refused.status.success());
    assert!(
        said.contains("lower, upper") && said.contains("--choose"),
        "{said}"
    );
    let chosen = with_scene(
        &[
            "simulate",
            "-",
            "--choose",
            "minimum-norm:length=1",
            "--out",
            folder.text(),
        ],
        &door,
    );
    assert!(chosen.status.success(), "{}", super::stderr(&chosen));
    assert!(!folder.0.join("body_leaf.csv").exists());
    let summary = std::fs::read_to_string(folder.0.join("summary.json")).expect("written");
    let summary: Value = serde_json::from_str(&summary).expect("JSON");
    assert_eq!(
        summary["bodies"]["leaf"],
        serde_json::json!({ "file": "choice_body_leaf.csv", "choice": true, "rows_left_out": 0 })
    );
    for row in rows(&folder, "choice_body_leaf.csv") {
        for component in ["Fx", "Fy", "T"] {
            let parts = ["lower", "upper", "gravity", "inertia"];
            let sum: f64 = parts
                .iter()
                .map(|part| row[&format!("{part}.{component}")])
                .sum();
            assert!(sum.abs() < 1e-9, "{component}: {sum:e}");
        }
    }
    let unknown = door.replace("[\"leaf\"] }", "[\"lesf\"] }");
    let said = super::stderr(&with_scene(&["check", "-"], &unknown));
    assert!(said.contains("did you mean `leaf`?"), "{said}");
    let ground = door.replace("[\"leaf\"] }", "[\"ground\"] }");
    let said = super::stderr(&with_scene(&["check", "-"], &ground));
    assert!(said.contains("refers to the ground"), "{said}");
}

/// A block on a spring, with two load cases; the second one also stops it by a second support.
const CASES: &str = r#"
scene = { name = "block", space = "plane", format = 2, gravity = [0.0, -10.0] }
parameters = { load = 3.0 }
body = [{ name = "block", mass = "load", inertia = 1.0 }]
joint = [
    { name = "guide", type = "translational", bodies = ["ground", "block"], at = [0.0, 0.0], axis = [1.0, 0.0] },
    { name = "second", type = "translational", bodies = ["ground", "block"], at = [1.0, 0.0], axis = [1.0, 0.0], active = false },
]
force = [{ name = "push", type = "point-force", body = "block", at = [0.0, 0.0], force = [1.0, 0.0] }]
case = [
    { name = "heavy", set = ["load = 5", "force.push.force[0] = 2"] },
    { name = "twice", set = ["joint.second.active = 1"] },
]
simulate = { t_end = 1.0 }
"#;

#[test]
fn a_load_case_replaces_values_of_the_scene() {
    let chosen = |options: &[&str]| -> Value {
        let arguments = ["analyze", "-", "--json", "--choose", "minimum-norm"];
        let output = with_scene(&[&arguments, options].concat(), CASES);
        serde_json::from_str(&stdout(&output)).expect("JSON")
    };
    let numbers = |d: &Value| {
        let of = |d: &Value| d.as_f64().expect("a number");
        let guide = d["choices"][0]["reactions"][0]["components"]
            .as_array()
            .expect("components");
        let fy = guide.iter().find(|c| c["name"] == "Fy").expect("Fy");
        (
            of(&fy["value"]),
            of(&d["loads"]["push"]["Fx"]),
            of(&d["redundancy"]),
        )
    };
    // On the ground, the first body, the block pushes down with its weight.
    assert_eq!(numbers(&chosen(&[])), (-30.0, 1.0, 0.0));
    assert_eq!(numbers(&chosen(&["--case", "heavy"])), (-50.0, 2.0, 0.0));
    assert_eq!(
        numbers(&chosen(&["--case", "heavy", "--set", "load=7"])),
        (-70.0, 2.0, 0.0)
    );
    // A case that changes the rank.
    assert_eq!(numbers(&chosen(&["--case", "twice"])).2, 2.0);
    for (option, said) in [
        (&["--case", "heavi"][..], "did you mean `heavy`?"),
        (&["--case", ""], "there is no load case"),
    ] {
        let output = with_scene(&[&["check", "-"], option].concat(), CASES);
        let error = super::stderr(&output);
        assert!(!output.status.success() && error.contains(said), "{error}");
    }
    let none = with_scene(&["check", "-", "--case", "heavy"], BED);
    assert!(super::stderr(&none).contains("has no load cases"));
}

#[test]
fn load_cases_are_checked() {
    for (from, to, said) in [
        ("load = 5", "laod = 5", "did you mean `load`?"),
        ("load = 5", "load", "need NAME=EXPR"),
        ("name = \"twice\"", "name = \"heavy\"", "exists already"),
        (
            "set = [\"joint.second.active = 1\"]",
            "sat = [\"load = 1\"]",
            "did you mean `set`?",
        ),
    ] {
        let scene = CASES.replace(from, to);
        assert_ne!(scene, CASES);
        let output = with_scene(&["check", "-"], &scene);
        let error = super::stderr(&output);
        assert!(
            !output.status.success() && error.contains(said),
            "{to}: {error}"
        );
    }
}
