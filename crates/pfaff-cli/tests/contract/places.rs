//! Tests markers, joint coordinates and inactive elements on the command line: columns, pages,
//! documents.

use serde_json::Value;

use super::{Folder, stderr, stdout, with_scene};

/// A crank has its frame at its shaft and a pen at its tip; a lock is not active.
const CRANK: &str = r#"
[scene]
name = "crank"
space = "plane"

[[body]]
name = "crank"
mass = 1.0
inertia = 0.1
centre = [0.5, 0.0]

[[marker]]
name = "shaft"
body = "ground"
point = [0.0, 0.0]

[[marker]]
name = "pen"
body = "crank"
point = [1.0, 0.0]

[[marker]]
name = "flag"
body = "crank"
point = [0.0, 1.0]
angle = 0.5

[[measure]]
name = "reach"
type = "distance"
markers = ["shaft", "pen"]

[[measure]]
name = "turned"
type = "angle"
markers = ["pen"]

[[joint]]
name = "A"
type = "revolute"
bodies = ["ground", "crank"]
at = "shaft"

[[joint]]
name = "lock"
type = "fixed"
bodies = ["ground", "crank"]
at = "shaft"
active = false

[[drive]]
name = "motor"
joint = "A"
type = "angle"
motion = { type = "constant-rate", rate = 8.0 }

[simulate]
t_end = 2.0
output_step = 0.25
"#;

fn run(name: &str, arguments: &[&str], scene: &str) -> Folder {
    let folder = Folder::new(name);
    let arguments = [&["simulate", "-", "--out", folder.text()], arguments].concat();
    let output = with_scene(&arguments, scene);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    folder
}

/// The pen makes two and a half revolutions on its circle: all columns have closed forms.
#[test]
fn columns_are_those_of_frames_markers_and_measures() {
    let folder = run("places-columns", &[], CRANK);
    let table = folder.read("trajectory.csv");
    let mut lines = table.lines();
    let header = "t,crank.x,crank.y,crank.angle,crank.vx,crank.vy,crank.omega,pen.x,pen.y,pen.vx,pen.vy,\
                  flag.x,flag.y,flag.angle,flag.vx,flag.vy,flag.omega,reach,turned";
    assert_eq!(lines.next(), Some(header));
    let mut n = 0;
    for line in lines {
        let row: Vec<f64> = line
            .split(',')
            .map(|x| x.parse().expect("a number"))
            .collect();
        let angle = 8.0 * row[0];
        let (sin, cos) = angle.sin_cos();
        let expected = [
            [0.0, 0.0, angle, 0.0, 0.0, 8.0].to_vec(),
            vec![cos, sin, -8.0 * sin, 8.0 * cos],
            vec![-sin, cos, angle + 0.5, -8.0 * cos, -8.0 * sin, 8.0],
            vec![1.0, angle],
        ];
        for (found, expected) in row[1..].iter().zip(expected.concat()) {
            assert!(
                (found - expected).abs() < 1e-12,
                "{found} {expected}: {line}"
            );
        }
        n += 1;
    }
    assert_eq!(n, 9);
    let page = folder.read("report.html");
    for told in [
        "\"markers\":[{\"name\":\"shaft\",\"b\":-1",
        "\"name\":\"pen\",\"b\":0,\"p\":[0.5,0]",
        "\"frame\":[-0.5,0]",
        "<h2>Measures (quantities between markers)</h2>",
        "distance of pen from shaft",
        "Inactive elements, excluded from this model: joint <b>lock</b>.",
    ] {
        assert!(page.contains(told), "{told}");
    }
}

#[test]
fn without_a_trajectory_there_are_no_measures() {
    let scene = format!("{CRANK}\n[output]\ntrajectory = false\n");
    let folder = run("places-none", &[], &scene);
    assert!(!folder.0.join("trajectory.csv").exists());
}

#[test]
fn a_picture_shows_markers_by_name() {
    let folder = Folder::new("places-view");
    std::fs::create_dir_all(&folder.0).expect("a directory");
    let file = folder.0.join("crank.svg").display().to_string();
    let output = with_scene(&["view", "-", "--out", &file, "--no-open"], CRANK);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let picture = folder.read("crank.svg");
    for told in [">pen</text>", ">shaft</text>", "class=\"marker\""] {
        assert!(picture.contains(told), "{told}");
    }
}

#[test]
fn check_says_what_is_not_active() {
    let check = |more: &[&str]| with_scene(&[&["check", "-"], more].concat(), CRANK);
    let text = stdout(&check(&[]));
    assert!(
        text.contains("1 body, 2 joints and drives, 3 holonomic rows"),
        "{text}"
    );
    assert!(text.contains("\nnot active: joint `lock`\n"), "{text}");
    let document: Value = serde_json::from_str(&stdout(&check(&["--json"]))).expect("JSON");
    assert_eq!(document["inactive"], serde_json::json!(["joint `lock`"]));
    // With the lock and the motor together the mechanism cannot move, and the drive contradicts the
    // lock.
    let locked = check(&["--set", "joint.lock.active=1"]);
    assert_eq!(locked.status.code(), Some(2), "{}", stdout(&locked));
    let free = stdout(&check(&["--set", "drive.motor.active=0"]));
    assert!(
        free.contains("not active: joint `lock`, drive `motor`"),
        "{free}"
    );
}

#[test]
fn what_is_not_active_has_no_reaction() {
    for option in [["--make-unique", "lock"], ["--combine", "A.Fx + lock.Fx"]] {
        let output = with_scene(&[&["analyze", "-"], &option[..]].concat(), CRANK);
        assert_eq!(output.status.code(), Some(2), "{option:?}");
        let said = stderr(&output);
        assert!(said.contains("`lock` is not active"), "{option:?}: {said}");
    }
}
