//! All load cases of a scene in one answer.

use serde_json::Value;

use crate::folder::Folder;
use crate::{stderr, stdout, with_scene};

/// A boom with a load at its tip, held by a stay. A second bearing at the foot and an elevation of
/// the foot are load cases.
const CRANE: &str = r#"
scene = { name = "crane", space = "plane", format = 2, gravity = [0.0, -10.0] }
parameters = { load = 500.0, wind = 0.0 }
body = [
    { name = "boom", mass = 200.0, inertia = 150.0, centre = [1.5, 0.0] },
    { name = "load", mass = "load", inertia = 1.0, position = [3.0, 0.0] },
]
joint = [
    { name = "foot", type = "revolute", bodies = ["ground", "boom"], at = [0.0, 0.0] },
    { name = "hook", type = "revolute", bodies = ["boom", "load"], at = [3.0, 0.0] },
    { name = "stay", type = "distance", bodies = ["ground", "boom"], at = [[0.0, 4.0], [3.0, 0.0]] },
    { name = "hold", type = "angle", bodies = ["ground", "load"] },
    { name = "prop", type = "revolute", bodies = ["ground", "boom"], at = [0.0, 0.0], active = false },
]
force = [{ name = "gust", type = "point-force", body = "load", at = [3.0, 0.0], force = ["wind", 0.0] }]
group = [{ name = "tie", combine = "stay.Fy" }]
case = [
    { name = "empty", set = ["load = 100"] },
    { name = "full", set = ["load = 800"] },
    { name = "storm", set = ["wind = 900"] },
    { name = "propped", set = ["joint.prop.active = 1"] },
]
simulate = { t_end = 0.1, output_step = 0.05 }
"#;

/// Returns the largest forces of foot and stay by the moment about the foot: the stay is at a
/// distance of 12/5 m from it.
fn forces(load: f64, wind: f64) -> [f64; 2] {
    let stay = (200.0 * 10.0 * 1.5 + load * 10.0 * 3.0) / 2.4;
    let foot = [0.6 * stay - wind, (200.0 + load) * 10.0 - 0.8 * stay];
    [foot[0].hypot(foot[1]), stay]
}

fn near(found: &Value, expected: f64) {
    let found = found.as_f64().expect("a number");
    let error = (found - expected).abs() / expected.abs();
    assert!(error < 1e-11, "{found} instead of {expected}");
}

#[test]
fn peaks_of_all_cases_stand_side_by_side() {
    let out = Folder::new("cases");
    let answer = with_scene(&["cases", "-", "--json", "--out", out.text()], CRANE);
    assert!(answer.status.success(), "{}", stderr(&answer));
    let d: Value = serde_json::from_str(&stdout(&answer)).expect("JSON");
    let sets = d["sets"].as_array().expect("sets");
    assert_eq!(sets.len(), 2, "a case with another redundancy is apart");
    let [alike, propped] = [&sets[0], &sets[1]];
    assert_eq!(
        alike["cases"],
        serde_json::json!(["empty", "full", "storm"])
    );
    let find = |set: &Value, name: &str, load: &str| -> Value {
        let peaks = set["peaks"].as_array().expect("peaks").iter();
        let mut own = peaks.filter(|peak| peak["name"] == name && peak["load"] == load);
        own.next()
            .unwrap_or_else(|| panic!("{name}: {load}"))
            .clone()
    };
    for (case, load, wind) in [
        ("empty", 100.0, 0.0),
        ("full", 800.0, 0.0),
        ("storm", 500.0, 900.0),
    ] {
        let [foot, stay] = forces(load, wind);
        near(&find(alike, "foot", "force")["cases"][case]["value"], foot);
        near(&find(alike, "stay", "force")["cases"][case]["value"], stay);
        // On the ground, the first body: the boom pulls the upper end down.
        near(
            &find(alike, "tie", "sum")["cases"][case]["value"],
            -0.8 * stay,
        );
        let gust = &find(alike, "gust", "force")["cases"][case]["value"];
        assert_eq!(gust.as_f64(), Some(wind));
    }
    let largest = find(alike, "foot", "force")["largest"].clone();
    assert_eq!(largest["case"], "full");
    near(&largest["value"], forces(800.0, 0.0)[0]);
    // Two bearings at one place: neither has a force of its own, the stay has.
    assert_eq!(propped["redundancy"], 2);
    assert_eq!(propped["not_unique"], serde_json::json!(["foot", "prop"]));
    let foot = find(propped, "foot", "force");
    assert!(
        foot["largest"].is_null() && foot["cases"]["propped"].is_null(),
        "{foot}"
    );
    near(
        &find(propped, "stay", "force")["largest"]["value"],
        forces(500.0, 0.0)[1],
    );

    let table = out.read("cases.csv");
    assert!(
        table
            .lines()
            .any(|line| line.starts_with("propped,6,2,0,foot,force,N,,")),
        "{table}"
    );
    let run: Value = serde_json::from_str(&out.read("storm/summary.json")).expect("JSON");
    assert_eq!(run["case"], "storm");
    near(
        &run["reactions"]["stay"]["peak"]["force"]["value"],
        forces(500.0, 900.0)[1],
    );
    assert!(out.read("storm/report.html").contains("storm"));
}

#[test]
fn a_case_that_fails_does_not_end_the_others() {
    let out = Folder::new("cases-refused");
    let scene = CRANE.replace("load = 100\"", "load = -1\"");
    let answer = with_scene(&["cases", "-", "--out", out.text()], &scene);
    assert_eq!(answer.status.code(), Some(1));
    let text = stdout(&answer);
    for said in [
        "3 done, 1 refused",
        "`empty` refused: <stdin>",
        "mass is -1, need a number ≥ 0",
        "The cases have different ranks or verdicts.",
        "not determined by the model: foot, prop",
    ] {
        assert!(text.contains(said), "{said}: {text}");
    }
    assert!(out.read("full/reactions.csv").starts_with("t,foot.Fx"));
    let options = ["--only", "empty,full", "--out", out.text()];
    let some = with_scene(&[&["cases", "-"], &options[..]].concat(), &scene);
    let text = stdout(&some);
    assert!(
        text.contains("2 load cases: 1 done, 1 refused") && !text.contains("storm"),
        "{text}"
    );
}

#[test]
fn cases_refuse_what_has_no_cases() {
    let out = Folder::new("cases-none");
    let asked = |options: &[&str], scene: &str| {
        let arguments = [&["cases", "-", "--out", out.text()], options].concat();
        let answer = with_scene(&arguments, scene);
        assert_eq!(answer.status.code(), Some(2), "{}", stdout(&answer));
        stderr(&answer)
    };
    let said = asked(&["--only", "storn"], CRANE);
    assert!(said.contains("there is no load case `storn`; there are: empty, full, storm, propped; did you mean `storm`?"), "{said}");
    let said = asked(&["--case", "storm"], CRANE);
    assert!(said.contains("omit `--case storm`"), "{said}");
    let door = include_str!("../../../../examples/door.toml");
    let said = asked(&[], door);
    assert!(said.contains("the scene has no load cases"), "{said}");
    assert!(!out.0.exists(), "nothing is written");
}

#[test]
fn files_of_others_in_a_directory_of_a_case_are_kept() {
    let out = Folder::new("cases-foreign");
    std::fs::create_dir_all(out.0.join("full")).expect("a directory");
    std::fs::write(out.0.join("full/reactions.csv"), "mine\n").expect("a file");
    let arguments = ["cases", "-", "--only", "full", "--out", out.text()];
    let answer = with_scene(&arguments, CRANE);
    let text = stdout(&answer) + &stderr(&answer);
    assert!(text.contains("was not written by pfaff"), "{text}");
    assert_eq!(out.read("full/reactions.csv"), "mine\n");
    let forced = with_scene(&[&arguments[..], &["--force"]].concat(), CRANE);
    assert!(forced.status.success(), "{}", stderr(&forced));
    assert!(out.read("full/reactions.csv").starts_with("t,foot.Fx"));
}
