//! Failures are reported in one JSON document if it was requested, with the same exit code as
//! without it.

use serde_json::{Value, json};

use super::analyze::{contains, document};
use super::bad_input::{PENDULUM, contradiction_at_half_a_second};
use super::{Folder, ROBOT, pfaff, stderr, stdout, with_scene};

/// Returns the document of a failure; there may be no other output.
#[track_caller]
fn failure(output: &std::process::Output, code: i32) -> Value {
    assert_eq!(output.status.code(), Some(code), "{output:?}");
    assert_eq!(stderr(output), "");
    let d: Value = serde_json::from_slice(&output.stdout).expect("one JSON document");
    assert_eq!(d["ok"], false, "{d:#}");
    assert!(d["error"].as_str().is_some_and(|e| !e.is_empty()), "{d:#}");
    d
}

#[test]
fn every_command_says_what_is_wrong_with_a_scene() {
    let folder = Folder::new("json-scene");
    let scene = PENDULUM
        .replace("inertia", "inertja")
        .replace("\"bob\"]", "\"bib\"]");
    for command in [
        vec!["check", "-", "--json"],
        vec!["analyze", "-", "--json"],
        vec!["simulate", "-", "--json", "--out", folder.text()],
    ] {
        let d = failure(&with_scene(&command, &scene), 2);
        let problems = d["problems"].as_array().expect("a list");
        assert_eq!(problems.len(), 2, "{command:?}: {d:#}");
        let error = d["error"].as_str().expect("a text");
        assert!(error.starts_with("<stdin>:10:1: error: "), "{error}");
        assert!(error.ends_with("(and 1 more)"), "{error}");
        assert_eq!(problems[0]["primary"]["line"], 10);
        assert_eq!(problems[0]["severity"], "error");
    }
}

#[test]
fn a_start_that_does_not_exist_is_a_problem_of_the_scene() {
    let second = "[[joint]]\nname = \"other\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bob\"]\npoints = { ground = [5.0, 0.0], bob = [0.0, 0.0] }\n";
    let scene = format!("{PENDULUM}{second}");
    let d = failure(&with_scene(&["analyze", "-", "--json"], &scene), 2);
    let message = d["problems"][0]["message"].as_str().expect("a text");
    assert!(message.contains("cannot be assembled"), "{d:#}");
}

#[test]
fn what_has_no_place_in_the_scene_has_no_problems() {
    let folder = Folder::new("json-rows");
    let simulate = ["simulate", ROBOT, "--json", "--out", folder.text()];
    for (more, piece) in [
        (["--drop", "6"], "drop exactly 2"),
        (["--rtol", "-1"], "rtol is -1"),
    ] {
        let d = failure(&pfaff(&[&simulate[..], &more[..]].concat()), 2);
        assert_eq!(d["problems"], json!([]));
        assert!(d["error"].as_str().is_some_and(|e| e.contains(piece)));
    }
    let d = failure(&pfaff(&["check", "no-such-file.toml", "--json"]), 2);
    assert!(
        d["error"]
            .as_str()
            .is_some_and(|e| e.contains("no-such-file.toml"))
    );
}

#[test]
fn a_run_that_stops_has_code_1() {
    let folder = Folder::new("json-stop");
    let scene = contradiction_at_half_a_second();
    for command in [
        vec!["simulate", "-", "--json", "--out", folder.text()],
        vec!["analyze", "-", "--json", "--at-time", "0.9"],
    ] {
        let d = failure(&with_scene(&command, &scene), 1);
        assert!(
            d["error"].as_str().is_some_and(|e| e.contains("t = 0.5")),
            "{d:#}"
        );
    }
}

#[test]
fn what_can_be_judged_but_not_moved_is_checked_analysed_and_not_simulated() {
    // Two pivots are nearly coincident: one constraint too many, or a bar that cannot turn.
    for distance in ["1e-9", "1e-12"] {
        let twin = format!(
            "[[joint]]\nname = \"twin\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bob\"]\nat = [{distance}, 0.0]\n"
        );
        let scene = format!("{PENDULUM}{twin}");
        let d = document(&with_scene(&["check", "-", "--json"], &scene));
        assert_eq!(d["ok"], true, "{d:#}");
        let warning = d["warnings"][0].as_str().expect("a warning");
        let words = stdout(&with_scene(&["check", "-"], &scene));
        contains(&words, &["assembled", &format!("warning: {warning}")]);
        let d = document(&with_scene(&["analyze", "-", "--json"], &scene));
        assert_eq!(d["warnings"][0], warning, "{d:#}");
        // The text gives the reason in terms of the scene.
        let folder = Folder::new("twin-pivots");
        let out = folder.0.to_str().expect("UTF-8");
        let output = with_scene(&["simulate", "-", "--out", out], &scene);
        assert_eq!(output.status.code(), Some(1), "{output:?}");
        let said = stderr(&output);
        for piece in ["(`pivot`, y)", "(`twin`, y)", "Correct the misalignment"] {
            assert!(said.contains(piece), "`{piece}` is not in:\n{said}");
        }
        assert!(!said.contains("higher precision"), "{said}");
    }
}

#[test]
fn a_place_that_takes_no_results_is_wrong_input() {
    let folder = Folder::new("json-occupied");
    std::fs::create_dir_all(&folder.0).expect("writable");
    let file = folder.0.join("file");
    std::fs::write(&file, "here first").expect("writable");
    let out = file.to_str().expect("UTF-8");
    let d = failure(&pfaff(&["simulate", ROBOT, "--json", "--out", out]), 2);
    assert_eq!(d["problems"], json!([]));
}

/// One of the moments is above the sum of the others: the scene is written, although no real body
/// has such moments.
const NO_BODY: &str = "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/>\
    <inertial pos='0 0 -0.5' mass='1' diaginertia='0.1 0.1 0.9'/></body></worldbody></mujoco>";

/// For every error with exit code 1, the document contains the code and the reason.
#[test]
fn every_document_of_exit_code_1_has_its_code_and_error() {
    let folder = Folder::new("json-code-1");
    std::fs::create_dir_all(&folder.0).expect("writable");
    let file = |name: &str, text: &str| {
        let path = folder.0.join(name);
        std::fs::write(&path, text).expect("writable");
        path.display().to_string()
    };
    let at = |name: &str| folder.0.join(name).display().to_string();
    let (scene, model) = (file("scene.toml", PENDULUM), file("model.xml", NO_BODY));
    let stops = file("stops.toml", &contradiction_at_half_a_second());
    let half = [
        "sweep",
        &scene,
        "--vary",
        "body.bob.mass=1,2",
        "--shard",
        "1/2",
        "--out",
        &at("half"),
    ];
    assert_eq!(pfaff(&half).status.code(), Some(0));
    let little = ["--max-memory", "1B"];
    let limited = [
        vec!["analyze", &scene],
        vec!["check", &scene],
        vec!["plan", &scene],
        vec!["linearise", &scene],
        vec!["equilibrium", &scene],
        vec!["diff", &scene, &scene],
    ];
    let (out, page, mended) = (at("out"), at("page.html"), at("mended.toml"));
    let limited_files = [
        vec!["simulate", &scene, "--out", &out],
        vec!["tolerance", &scene, "--tolerance", "1e-3", "--out", &out],
        vec!["view", &scene, "--out", &page],
        vec!["import", &model, "--out", &mended],
    ];
    let limited = limited.into_iter().chain(limited_files);
    let limited = limited.map(|command| ([&command[..], &little].concat(), "P0007"));
    let (swept, merged) = (at("swept"), at("merged"));
    let half = at("half");
    let others = [
        (vec!["import", &model, "--out", &mended], "P0153"),
        (vec!["simulate", &stops, "--out", &out], "P0"),
        (
            vec![
                "sweep",
                &stops,
                "--vary",
                "simulate.t_end=0.4,0.6",
                "--out",
                &swept,
            ],
            "P0514",
        ),
        (vec!["sweep", "--merge", &half, "--out", &merged], "P0514"),
    ];
    for (command, code) in limited.chain(others) {
        let output = pfaff(&[&command[..], &["--json"]].concat());
        assert_eq!(output.status.code(), Some(1), "{command:?}: {output:?}");
        assert_eq!(stderr(&output), "", "{command:?}");
        let d: Value = serde_json::from_slice(&output.stdout).expect("one JSON document");
        let has = d["code"]
            .as_str()
            .is_some_and(|found| found.starts_with(code));
        let says = d["error"].as_str().is_some_and(|error| !error.is_empty());
        assert!(has && says, "{command:?}: {} {}", d["code"], d["error"]);
    }
}
