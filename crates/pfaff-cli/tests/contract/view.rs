//! Tests `pfaff view`: a picture of every example, with names, rows and verdicts.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use suite::generate::Kind;

use serde_json::Value;

use super::{Folder, ROBOT, pfaff, stderr, stdout, with_scene};

fn place(name: &str) -> Folder {
    let folder = Folder::new(name);
    fs::create_dir_all(&folder.0).expect("writable");
    folder
}

#[test]
fn the_robot_has_names_rows_and_verdicts() {
    let folder = place("view-robot");
    let path = format!("{}/robot.svg", folder.text());
    let output = pfaff(&["view", ROBOT, "--out", &path, "--no-open"]);
    assert_eq!((output.status.code(), &*stderr(&output)), (Some(0), ""));
    assert_eq!(
        stdout(&output),
        format!(
            "robot-trolley: 14 joints and drives, 6 not unique; mobility 1 with its drive, 2 without\nwritten to {path}\n"
        )
    );
    let svg = folder.read("robot.svg");
    for words in [
        ">B 3–4</text>",
        ">W1 18</text>",
        "B (revolute): reaction not unique",
        ">steering 17</text>",
    ] {
        assert!(svg.contains(words), "{words}");
    }
}

#[test]
fn the_page_is_written_beside_the_caller_and_nothing_is_opened_without_a_display() {
    let folder = place("view-here");
    let output = Command::new(env!("CARGO_BIN_EXE_pfaff"))
        .args(["view", ROBOT])
        .current_dir(&folder.0)
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env("PATH", "")
        .output()
        .expect("the command starts");
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let said = stdout(&output);
    assert!(
        said.contains("written to robot-trolley.html\nnot opened: "),
        "{said}"
    );
    // The page is that of a run without the parts that only a run has.
    let page = folder.read("robot-trolley.html");
    assert!(page.starts_with("<!DOCTYPE html>") && page.ends_with("</html>\n"));
    assert!(page.contains("22 constraint rows have rank 20: two rows are redundant"));
    assert!(page.contains("id=\"picture\"") && page.contains("id=\"verdicts\""));
    for of_run in ["id=\"scrub\"", "id=\"curves\"", "Statistics of the run"] {
        assert!(!page.contains(of_run), "{of_run}");
    }
}

#[test]
fn mechanisms_that_cannot_move_and_large_ones_are_drawn() {
    let folder = place("view-others");
    let path = format!("{}/x.svg", folder.text());
    let twins = r#"
scene = { name = "bar", space = "plane" }
body = [{ name = "bar", mass = 1.0, inertia = 1.0, position = [1.0, 0.0] }]
joint = [
    { name = "pivot", type = "revolute", bodies = ["ground", "bar"], at = [0.0, 0.0] },
    { name = "twin", type = "revolute", bodies = ["ground", "bar"], at = [1e-9, 0.0] },
]
"#;
    let large = super::generated(Kind::Parallelograms, 120);
    for scene in [twins, &large] {
        let output = with_scene(&["view", "-", "--out", &path, "--json"], scene);
        let document: Value = serde_json::from_slice(&output.stdout).expect("one JSON document");
        assert_eq!(
            (output.status.code(), &document["ok"]),
            (Some(0), &true.into()),
            "{document}"
        );
        assert_eq!(document["bytes"], folder.read("x.svg").len());
        assert!(document["not_unique"].as_u64() > Some(0), "{document}");
    }
}

#[test]
fn wrong_places_and_wrong_scenes_are_refused() {
    let folder = place("view-refused");
    let directory = folder.text();
    let nowhere = format!("{directory}/no/such.svg");
    for (arguments, message) in [
        (
            &["view", ROBOT, "--no-open", "--out", directory][..],
            "a directory, need a file",
        ),
        (
            &["view", ROBOT, "--no-open", "--out", "robot.gif"],
            "need a name that ends with .html, .svg or .png",
        ),
        (
            &["view", ROBOT, "--no-open", "--out", &nowhere],
            "cannot make",
        ),
        (
            &["view", "no-such.toml", "--no-open"],
            "cannot read `no-such.toml`",
        ),
    ] {
        let output = pfaff(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(
            stderr(&output).contains(message),
            "{arguments:?}: {}",
            stderr(&output)
        );
        assert_eq!(stderr(&output).lines().count(), 1, "{}", stderr(&output));
    }
}

/// The pictures in the tables of `examples/README.md`.
#[test]
fn the_pictures_of_the_examples_are_those_of_the_command() {
    let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."));
    let folder = place("view-examples");
    let entries = fs::read_dir(root.join("examples")).expect("examples/ exists");
    let mut scenes: Vec<PathBuf> = entries
        .flatten()
        .map(|e| e.path())
        .filter(|p| p.extension().is_some_and(|e| e == "toml"))
        .collect();
    scenes.push(ROBOT.into());
    let pictures = fs::read_dir(root.join("docs/images/examples")).expect("pictures");
    assert_eq!(pictures.count(), scenes.len());
    for scene in scenes {
        let stem = scene.file_stem().expect("a name").to_string_lossy();
        let (name, scene) = (format!("{stem}.svg"), scene.display().to_string());
        let path = format!("{}/{name}", folder.text());
        let output = pfaff(&["view", &scene, "--out", &path, "--no-open"]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let kept = fs::read_to_string(root.join("docs/images/examples").join(&name));
        assert!(
            kept.is_ok_and(|kept| kept == folder.read(&name)),
            "old: pfaff view {scene} --out docs/images/examples/{name} --no-open"
        );
    }
}
