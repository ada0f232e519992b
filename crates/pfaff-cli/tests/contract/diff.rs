//! Tests `pfaff diff`: the changes if a joint is relaxed.

use std::fs;

use serde_json::Value;

use super::{Folder, ROBOT, pfaff, stderr, stdout, with_scene};

const DOOR: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/door.toml");
const SLEIGH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/sleigh.toml");

/// Returns a scene with some text replaced.
fn changed(folder: &Folder, of: &str, from: &str, to: &str) -> String {
    fs::create_dir_all(&folder.0).expect("writable");
    let text = fs::read_to_string(of).expect("readable");
    assert!(text.contains(from), "{from}");
    let path = folder.0.join("changed.toml");
    fs::write(&path, text.replace(from, to)).expect("writable");
    path.to_str().expect("UTF-8").to_owned()
}

#[test]
fn a_relaxed_hinge_is_told_in_words_and_numbers() {
    let folder = Folder::new("diff-door");
    let hinge = "{ name = \"upper\", type = \"revolute\", bodies = [\"ground\", \"leaf\"], at = [0.0, 1.75] }";
    let roller = "{ name = \"upper\", type = \"pin-in-slot\", bodies = [\"ground\", \"leaf\"], at = [0.0, 1.75], axis = [0.0, 1.0] }";
    let relaxed = changed(&folder, DOOR, hinge, roller);
    let output = pfaff(&["diff", DOOR, &relaxed]);
    assert_eq!((output.status.code(), &*stderr(&output)), (Some(0), ""));
    let text = stdout(&output);
    for words in [
        "redundancy",
        "−1",
        "revolute, not unique (Fy)",
        "pin-in-slot, unique",
        "dependencies gone:",
        "motion to t = 1 s, largest difference of each body:",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    assert!(!text.contains("dependencies new:"), "{text}");

    let document = pfaff(&["diff", DOOR, &relaxed, "--json"]);
    let d: Value = serde_json::from_slice(&document.stdout).expect("one JSON document");
    assert_eq!(
        (&d["a"]["redundancy"], &d["b"]["redundancy"]),
        (&1.into(), &0.into())
    );
    assert_eq!((&d["a"]["rank"], &d["b"]["rank"]), (&3.into(), &3.into()));
    let names: Vec<_> = d["changed"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|c| &c["name"])
        .collect();
    assert_eq!(names, ["lower", "upper"]);
    assert_eq!(d["changed"][1]["b"]["type"], "pin-in-slot");
    assert_eq!(d["dependencies_gone"].as_array().map(Vec::len), Some(1));
    assert_eq!(d["dependencies_new"].as_array().map(Vec::len), Some(0));
    // A door that cannot move with two hinges cannot move with a roller either.
    assert!(
        d["motion"]["bodies"][0]["distance"]
            .as_f64()
            .expect("a number")
            < 1e-9,
        "{d}"
    );
}

#[test]
fn joints_come_and_go_by_name() {
    let folder = Folder::new("diff-sleigh");
    let renamed = changed(&folder, SLEIGH, "\"left\"", "\"port\"");
    // The group also contains the name of the runner.
    let text = fs::read_to_string(&renamed).expect("readable");
    fs::write(&renamed, text.replace("left.N", "port.N")).expect("writable");
    let document = pfaff(&["diff", SLEIGH, &renamed, "--json"]);
    let d: Value = serde_json::from_slice(&document.stdout).expect("one JSON document");
    assert_eq!(
        (&d["removed"][0]["name"], &d["added"][0]["name"]),
        (&"left".into(), &"port".into())
    );
    assert_eq!(d["dependencies_gone"].as_array().map(Vec::len), Some(1));
    assert_eq!(d["motion"]["bodies"][0]["distance"], 0.0);
}

#[test]
fn a_scene_is_like_itself_and_faster_wheels_are_not() {
    let output = pfaff(&["diff", ROBOT, ROBOT]);
    let text = stdout(&output);
    assert!(
        text.contains("no joint, drive, verdict or dependency differs"),
        "{text}"
    );
    assert!(text.contains("place (m)"), "{text}");

    let folder = Folder::new("diff-speed");
    let faster = changed(
        &folder,
        SLEIGH,
        "velocity = [0.0, 1.0], angular_velocity = 2.0",
        "velocity = [0.0, 1.25], angular_velocity = 2.5",
    );
    let slower = fs::read_to_string(SLEIGH).expect("readable");
    let d = with_scene(&["diff", "-", &faster, "--json"], &slower);
    let d: Value = serde_json::from_slice(&d.stdout).expect("one JSON document");
    assert_eq!(d["changed"].as_array().map(Vec::len), Some(0));
    let moved = &d["motion"]["bodies"][0];
    assert!(moved["angle"].as_f64().expect("a number") > 0.1, "{moved}");
    assert!(
        moved["t_angle"].as_f64().expect("a number") > 0.0,
        "{moved}"
    );
}

#[test]
fn scenes_without_a_run_are_compared_all_the_same() {
    let folder = Folder::new("diff-still");
    let still = changed(&folder, DOOR, "simulate = { t_end = 1.0 }", "");
    let output = pfaff(&["diff", DOOR, &still]);
    assert_eq!(output.status.code(), Some(0));
    let text = stdout(&output);
    assert!(
        text.contains("motions not compared: ") && text.contains("has no [simulate]"),
        "{text}"
    );
}

#[test]
fn wrong_scenes_are_refused_with_their_places() {
    let folder = Folder::new("diff-wrong");
    let wrong = changed(&folder, DOOR, "mass = 20.0", "mass = -20.0");
    let output = pfaff(&["diff", DOOR, &wrong]);
    assert_eq!((output.status.code(), &*stdout(&output)), (Some(2), ""));
    assert!(
        stderr(&output).contains("mass is -20"),
        "{}",
        stderr(&output)
    );
    let twice = pfaff(&["diff", "-", "-"]);
    assert_eq!(twice.status.code(), Some(2));
    assert_eq!(
        stderr(&twice),
        "error[P0001]: standard input contains one scene; give the second scene as a file\n"
    );
}

/// A body is on a joint in space and driven at two rates.
fn driven(joint: &str, drives: &[(&str, f64)]) -> String {
    let drive = |(kind, rate): &(&str, f64)| {
        format!(
            "{{ name = \"{kind}\", joint = \"J\", type = \"{kind}\", \
             motion = {{ type = \"constant-rate\", rate = {rate} }} }}"
        )
    };
    let drives: Vec<String> = drives.iter().map(drive).collect();
    format!(
        "scene = {{ name = \"driven\", space = \"spatial\" }}
body = [{{ name = \"car\", mass = 1.0, inertia = [1, 2, 2.5], position = [0.0, 0.3, 0.0] }}]
joint = [{{ name = \"J\", bodies = [\"ground\", \"car\"], at = [0.0, 0.0, 0.0], {joint} }}]
drive = [{}]
simulate = {{ t_end = 1.0 }}
",
        drives.join(", ")
    )
}

#[test]
fn motions_in_space_are_compared_along_and_about_all_axes() {
    let folder = Folder::new("diff-space");
    fs::create_dir_all(&folder.0).expect("writable");
    let slide = "type = \"translational\", axis = [0, 0, 1]";
    let hinge = "type = \"revolute\", axis = [1, 0, 0]";
    let screw = "type = \"cylindrical\", axis = [0, 0, 1]";
    // Distances between the scenes after one second: along z, about x by 2.5 rad with the origin of
    // the frame at 0.3 m from the axis, and both about z. During a whole revolution the largest
    // angle is half a turn.
    let chord = |angle: f64| 0.6 * (0.5 * angle).sin();
    let full = std::f64::consts::TAU + 0.1;
    let oblique = 0.9_f64.hypot(chord(0.9));
    for (joint, kinds, [a, b], expected) in [
        (slide, &["displacement"][..], [1.0, 0.1], [0.9, 0.0]),
        (hinge, &["angle"], [2.7, 0.2], [chord(2.5), 2.5]),
        (
            screw,
            &["displacement", "angle"],
            [1.0, 0.1],
            [oblique, 0.9],
        ),
        (
            hinge,
            &["angle"],
            [full, 0.1],
            [chord(std::f64::consts::PI), std::f64::consts::PI],
        ),
    ] {
        let write = |name: &str, rate: f64| {
            let path = folder.0.join(name);
            let drives: Vec<_> = kinds.iter().map(|kind| (*kind, rate)).collect();
            fs::write(&path, driven(joint, &drives)).expect("writable");
            path.to_str().expect("UTF-8").to_owned()
        };
        let (a, b) = (write("a.toml", a), write("b.toml", b));
        let output = pfaff(&["diff", &a, &b, "--json"]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let d: Value = serde_json::from_slice(&output.stdout).expect("one JSON document");
        let car = &d["motion"]["bodies"][0];
        let found = ["distance", "angle"].map(|key| car[key].as_f64().expect("a number"));
        for (found, expected) in found.into_iter().zip(expected) {
            // Half a turn occurs at an instant between the compared ones: 2π/200 per row.
            let bound = if expected == std::f64::consts::PI {
                0.02
            } else {
                1e-8
            };
            assert!((found - expected).abs() < bound, "{joint} {car}");
        }
        let text = stdout(&pfaff(&["diff", &a, &b]));
        let four_digits = format!("{:.3e}", found[0]);
        let four_digits: f64 = four_digits.parse().expect("a number");
        assert!(text.contains(&format!("  {four_digits} ")), "{text}");
    }
}
