//! Every invalid input gives one clear message that names the invalid entry and its values, and the
//! correct exit code.

use super::{Folder, ROBOT, pfaff, stderr, with_scene};

/// A pendulum; each case changes one entry.
pub(super) const PENDULUM: &str = r#"
[scene]
name = "pendulum"
space = "plane"
gravity = [0.0, -9.81]

[[body]]
name = "bob"
mass = 1.0
inertia = 0.1
position = [1.0, 0.0]

[[joint]]
name = "pivot"
type = "revolute"
bodies = ["ground", "bob"]
at = [0.0, 0.0]

[simulate]
t_end = 1.0
"#;

/// Checks a changed pendulum: exit code and parts of the message.
fn check(change: impl FnOnce(&str) -> String, code: i32, pieces: &[&str]) {
    let scene = change(PENDULUM);
    assert_ne!(scene, PENDULUM, "the case changes nothing");
    let output = with_scene(&["check", "-"], &scene);
    let text = stderr(&output);
    assert_eq!(output.status.code(), Some(code), "{text}");
    for piece in pieces {
        assert!(text.contains(piece), "`{piece}` is not in:\n{text}");
    }
    assert!(!text.contains("panicked"), "{text}");
}

fn replaced<'a>(from: &'a str, to: &'a str) -> impl FnOnce(&str) -> String + 'a {
    move |scene| scene.replace(from, to)
}

fn added(text: &str) -> impl FnOnce(&str) -> String + '_ {
    move |scene| format!("{scene}{text}")
}

#[test]
fn the_pendulum_itself_is_right() {
    let output = with_scene(&["check", "-"], PENDULUM);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn wrong_toml() {
    check(replaced("mass = 1.0", "mass = = 1.0"), 2, &["<stdin>:9:"]);
}

#[test]
fn unknown_key() {
    check(
        replaced("inertia", "inertja"),
        2,
        &["inertja", "did you mean `inertia`", "<stdin>:10:1"],
    );
}

#[test]
fn unknown_body_and_joint() {
    check(
        replaced("\"ground\", \"bob\"", "\"ground\", \"bib\""),
        2,
        &["bib", "did you mean `bob`"],
    );
    let drive = "[[drive]]\nname = \"m\"\njoint = \"pivto\"\ntype = \"angle\"\nmotion = { type = \"constant-rate\", rate = 1.0 }\n";
    check(added(drive), 2, &["pivto", "did you mean `pivot`"]);
}

#[test]
fn unknown_type_does_not_hide_an_unknown_body() {
    let both = |scene: &str| {
        scene
            .replace("revolute", "revolut")
            .replace("\"bob\"]", "\"bib\"]")
    };
    check(both, 2, &["did you mean `revolute`", "did you mean `bob`"]);
}

#[test]
fn duplicate_names() {
    check(
        added("[[body]]\nname = \"bob\"\nmass = 1.0\ninertia = 1.0\n"),
        2,
        &["`bob` is used twice", "first used"],
    );
}

#[test]
fn masses_that_are_none() {
    check(
        replaced("mass = 1.0", "mass = nan"),
        2,
        &["bob", "mass", "NaN"],
    );
    check(
        replaced("mass = 1.0", "mass = inf"),
        2,
        &["bob", "mass", "inf"],
    );
    check(
        replaced("mass = 1.0", "mass = -2.5"),
        2,
        &["bob", "mass is -2.5", "≥ 0"],
    );
}

#[test]
fn a_direction_without_length() {
    let edge = "[[joint]]\nname = \"edge\"\ntype = \"knife-edge\"\nbody = \"bob\"\nat = [0.0, 0.0]\nnormal = [0.0, 0.0]\n";
    check(added(edge), 2, &["edge", "normal", "length zero"]);
}

#[test]
fn constraints_that_cannot_be_assembled() {
    // A rigid bob cannot be connected to two pivots whose distance differs from that of its points.
    let second = "[[joint]]\nname = \"other\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bob\"]\npoints = { ground = [5.0, 0.0], bob = [0.0, 0.0] }\n";
    check(
        added(second),
        2,
        &[
            "cannot be assembled",
            "are violated",
            "`pivot` by 2 m",
            "`other` by 2 m",
        ],
    );
}

#[test]
fn a_start_that_needs_a_large_correction() {
    let apart = "points = { ground = [0.0, 0.0], bob = [-1.2, 0.0] }";
    check(
        replaced("at = [0.0, 0.0]", apart),
        2,
        &["corrected by", "bob", "allow_correction"],
    );
    let allowed = PENDULUM.replace("at = [0.0, 0.0]", apart) + "[start]\nallow_correction = true\n";
    let output = with_scene(&["check", "-"], &allowed);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn a_fault_in_a_long_line_is_shown_without_the_line() {
    let times: Vec<String> = (0..200_000).map(|k| k.to_string()).collect();
    let force = format!(
        "[[force]]\nname = \"pull\"\ntype = \"torque\"\nbody = \"bob\"\ntorque = {{ type = \"table\", times = [{}, x], values = [] }}\n",
        times.join(", ")
    );
    let output = with_scene(&["check", "-"], &format!("{PENDULUM}{force}"));
    let text = stderr(&output);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        text.contains("<stdin>:25:") && text.contains("199999, x], values"),
        "{text}"
    );
    assert!(text.len() < 2000, "{} bytes", text.len());
}

#[test]
fn a_fault_in_every_line_is_listed_up_to_a_limit() {
    let mut scene = PENDULUM.to_owned();
    for k in 0..6000 {
        scene.push_str(&format!(
            "[[body]]\nname = \"b{k}\"\nmass = 1.0\ninertja = 1.0\n"
        ));
    }
    let output = with_scene(&["check", "-"], &scene);
    let text = stderr(&output);
    assert_eq!(output.status.code(), Some(2));
    // One key is missing, and one is unknown.
    let more = "the first 50 of more than 2500 problems in `<stdin>`; `--json` lists more\n";
    assert!(text.ends_with(more), "{} bytes", text.len());
    assert_eq!(text.matches("error[P").count(), 50);
    let output = with_scene(&["check", "-", "--json"], &scene);
    let more = "and 7000 more problems: only the first 5000 are listed";
    assert!(super::stdout(&output).contains(more));
}

#[test]
fn no_bodies() {
    let output = with_scene(
        &["check", "-"],
        "[scene]\nname = \"nothing\"\nspace = \"plane\"\n",
    );
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).contains("at least one body"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn redundant_drives_that_contradict_each_other() {
    let drives = "
[[drive]]
name = \"slow\"
joint = \"pivot\"
type = \"angle\"
motion = { type = \"constant-rate\", rate = 1.0 }

[[drive]]
name = \"fast\"
joint = \"pivot\"
type = \"angle\"
motion = { type = \"constant-rate\", rate = 2.0 }
";
    check(added(drives), 2, &["slow", "fast", "differ by", "t = 0"]);
    // The mark is at the drives, not at `[run]`.
    check(added(drives), 2, &["<stdin>:23:8", "contradicts too"]);
}

/// Two drives are consistent up to t = 0.5 s.
pub(super) fn contradiction_at_half_a_second() -> String {
    let drives = "
[[drive]]
name = \"one\"
joint = \"pivot\"
type = \"angle\"
motion = { type = \"steps\", steps = [{ from = 0.5, to = 1.0, by = 1.0 }] }

[[drive]]
name = \"other\"
joint = \"pivot\"
type = \"angle\"
motion = { type = \"steps\", steps = [{ from = 0.5, to = 1.0, by = 1.1 }] }
";
    format!("{PENDULUM}{drives}")
}

#[test]
fn drives_that_contradict_each_other_later_stop_the_run_and_keep_its_rows() {
    let folder = Folder::new("contradiction");
    let scene = contradiction_at_half_a_second();
    let output = with_scene(&["simulate", "-", "--out", folder.text()], &scene);
    let text = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(
        text.contains("contradict") && (text.contains("one") || text.contains("other")),
        "{text}"
    );
    let rows = folder.read("trajectory.csv").lines().count();
    assert!(rows > 100, "{rows} rows up to t = 0.5 are kept");
    let summary: serde_json::Value =
        serde_json::from_str(&folder.read("summary.json")).expect("JSON");
    assert_eq!(summary["partial"], true);
    assert!(
        summary["error"]
            .as_str()
            .is_some_and(|e| e.contains("t = 0.5")),
        "{summary}"
    );
}

#[test]
fn rows_that_cannot_be_dropped() {
    let folder = Folder::new("drop");
    for (drop, piece) in [
        (
            "1,21",
            "at t = 0 s these rows cannot be dropped: what is kept is dependent",
        ),
        (
            "3,20",
            "at t = 0 s these rows cannot be dropped: what is kept is dependent",
        ),
        ("6", "drop exactly 2"),
        ("6,6", "listed twice"),
        ("6,99", "rows are 1 to 22"),
        ("0,6", "counted from 1"),
    ] {
        let output = pfaff(&["simulate", ROBOT, "--out", folder.text(), "--drop", drop]);
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{drop}: {text}");
        assert!(text.contains(piece), "{drop}: {text}");
    }
}

#[test]
fn options_that_do_not_go_together() {
    let folder = Folder::new("together");
    let simulate = ["simulate", ROBOT, "--out", folder.text()];
    let options = ["--method", "radau5", "--stabilisation", "none"];
    let output = pfaff(&[&simulate[..], &options[..]].concat());
    assert_eq!(output.status.code(), Some(2));
    let message = "radau5 cannot be combined with none: the method relies on projection";
    assert!(stderr(&output).contains(message), "{}", stderr(&output));
}

#[test]
fn names_of_choices_are_listed() {
    let folder = Folder::new("names");
    for (option, names) in [
        ("--method", "auto, dop853, dopri5, tsit5, radau5"),
        ("--stabilisation", "projection, none"),
    ] {
        let output = pfaff(&["simulate", ROBOT, "--out", folder.text(), option, "best"]);
        assert_eq!(output.status.code(), Some(2));
        let text = stderr(&output);
        assert!(text.contains("'best'") && text.contains(names), "{text}");
    }
}

#[test]
fn a_scene_that_does_not_say_how_long() {
    let folder = Folder::new("no-end");
    let scene = PENDULUM.replace("[simulate]\nt_end = 1.0\n", "");
    let output = with_scene(&["simulate", "-", "--out", folder.text()], &scene);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("t_end"));
    let output = with_scene(
        &["simulate", "-", "--out", folder.text(), "--t-end", "0.5"],
        &scene,
    );
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn files_that_cannot_be_read() {
    let output = pfaff(&["check", "no-such-file.toml"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("no-such-file.toml"));
    let output = pfaff(&["analyze"]);
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn numbers_of_the_command_line() {
    for arguments in [
        vec!["analyze", ROBOT, "--at-time", "-1"],
        vec!["analyze", ROBOT, "--at-time=-1"],
        vec!["analyze", ROBOT, "--combine", "W9.N"],
        vec!["analyze", ROBOT, "--combine", "W3 + W4.N"],
    ] {
        let output = pfaff(&arguments);
        assert_eq!(
            output.status.code(),
            Some(2),
            "{arguments:?}: {}",
            stderr(&output)
        );
    }
    let folder = Folder::new("numbers");
    for (option, value) in [("--rtol", "0"), ("--atol", "nan"), ("--t-end", "inf")] {
        let output = pfaff(&["simulate", ROBOT, "--out", folder.text(), option, value]);
        assert_eq!(
            output.status.code(),
            Some(2),
            "{option} {value}: {}",
            stderr(&output)
        );
    }
}

#[test]
fn negative_numbers_of_the_command_line_are_values() {
    let folder = Folder::new("negative");
    for (option, value, message) in [
        (
            "--rtol",
            "-1",
            "rtol is -1, need a number from 1e-15 (rounding) to 0.1",
        ),
        ("--atol", "-1e-3", "atol is -0.001, need a number > 0"),
        (
            "--rtol",
            "-inf",
            "rtol is -inf, need a number from 1e-15 (rounding) to 0.1",
        ),
        ("--t-end", "-3", "t_end is -3, need a finite time ≥ 0"),
    ] {
        let output = pfaff(&["simulate", ROBOT, "--out", folder.text(), option, value]);
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{option}: {text}");
        assert!(text.contains(message), "{option}: {text}");
    }
    let output = pfaff(&["analyze", ROBOT, "--at-time", "-1"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).contains("--at-time is -1, need a time ≥ 0"),
        "{}",
        stderr(&output)
    );
}

/// The pendulum has velocities that its pivot does not allow. The same rule applies as for
/// positions. The given velocities are kept, and the others are computed.
#[test]
fn velocities_that_contradict_the_constraints_are_refused_by_name() {
    let given = |velocities: &'static str| replaced("position = [1.0, 0.0]", velocities);
    // In the nearest velocity in the mass metric, 1 rad/s about the centre gives I/(I + m·l²) =
    // 1/11 rad/s about the pivot.
    check(
        given("position = [1.0, 0.0]\nvelocity = [0.0, 0.0]\nangular_velocity = 1.0"),
        2,
        &[
            "`omega` of body `bob` is given as 1 rad/s, which row 2 (`pivot`, y) does not allow together with the other given velocities",
            "in consistent velocities it is 0 rad/s, more than 0.001 rad/s off",
            "omit `angular_velocity` of body `bob`, so that it follows from the other velocities",
            "allow_correction = true",
            "not with these constraints",
        ],
    );
    // The velocities are consistent to less than a thousandth, or given only in part.
    for velocities in [
        "position = [1.0, 0.0]\nangular_velocity = 1.0",
        "position = [1.0, 0.0]\nvelocity = [0.0, 1.0]",
        "position = [1.0, 0.0]\nvelocity = [0.0, 1.0]\nangular_velocity = 1.0",
        "position = [1.0, 0.0]\nvelocity = [0.0, 1.0001]\nangular_velocity = 1.0",
        "position = [1.0, 0.0]\nvelocity = [0.0, 0.0]\nangular_velocity = 0.0",
    ] {
        let scene = PENDULUM.replace("position = [1.0, 0.0]", velocities);
        let output = with_scene(&["check", "-"], &scene);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
    // A zero that is written in the scene counts as given.
    let motor = "[[drive]]\nname = \"motor\"\njoint = \"pivot\"\ntype = \"angle\"\nmotion = { type = \"constant-rate\", rate = 1.0 }\n";
    check(
        |scene| {
            let still = scene.replace(
                "position = [1.0, 0.0]",
                "position = [1.0, 0.0]\nangular_velocity = 0.0",
            );
            format!("{still}{motor}")
        },
        2,
        &[
            "drive `motor` requires velocities that the given ones do not allow",
            "`omega` of body `bob` is given as 0 rad/s, and in consistent velocities it is 1 rad/s",
            "requires other velocities",
            "given here",
        ],
    );
    let output = with_scene(&["check", "-"], &format!("{PENDULUM}{motor}"));
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    for start in [
        "allow_correction = true",
        "keep = [\"bob.omega\"]\nallow_correction = true",
    ] {
        let scene = PENDULUM.replace(
            "position = [1.0, 0.0]",
            "position = [1.0, 0.0]\nvelocity = [0.0, 1.01]\nangular_velocity = 1.0",
        );
        let output = with_scene(&["check", "-"], &format!("{scene}[start]\n{start}\n"));
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
}

#[test]
fn names_that_do_not_exist_are_answered_with_those_that_do() {
    let folder = Folder::new("names-beside");
    std::fs::create_dir_all(&folder.0).expect("writable");
    std::fs::write(folder.0.join("door.toml"), PENDULUM).expect("writable");
    let path = |name: &str| folder.0.join(name).display().to_string();
    let out = path("out");
    let (dor, bare, hinge) = (path("dor.toml"), path("door"), path("hinge.toml"));
    let near = format!("did you mean `{}`?", path("door.toml"));
    for (arguments, piece) in [
        (&["check", &dor][..], &*near),
        (&["check", &bare], &near),
        (&["check", &dor, "--watch"], &near),
        (&["simulate", &dor, "--out", &out], &near),
        (&["work-precision", &dor, "--out", &out], &near),
    ] {
        let output = pfaff(arguments);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(piece), "`{piece}` is not in:\n{said}");
    }
    let said = stderr(&pfaff(&["check", &hinge]));
    assert!(!said.contains("did you mean"), "{said}");
}
