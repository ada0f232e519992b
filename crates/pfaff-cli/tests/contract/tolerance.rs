//! Tests tolerances of the data: options that take precedence over the scene, the documents and
//! sentences that report them, and invalid values.

use serde_json::{Value, json};

use super::{Folder, ROBOT, pfaff, stderr, stdout, with_scene};

/// A door on one hinge, 2 m long, has its dimensions from a drawing.
const DOOR: &str = r#"
[scene]
name = "door"
space = "plane"
tolerance = 1e-3
[[body]]
name = "leaf"
mass = 20.0
inertia = 5.0
position = [2.0, 0.0]
[[joint]]
name = "hinge"
type = "revolute"
bodies = ["ground", "leaf"]
at = [0.0, 0.0]
"#;

fn data(output: &std::process::Output) -> Value {
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let document: Value = serde_json::from_str(&stdout(output)).expect("one document");
    document["data"].clone()
}

fn known_to(tolerance: Value, angle: Value) -> Value {
    json!({
        "tolerance": tolerance, "angle_tolerance": angle,
        "lower_rank_from": null, "lower_rank_from_angle": null, "lower_rank_here": null,
    })
}

#[test]
fn flags_go_before_the_scene() {
    let told = |flags: &[&str]| {
        let arguments = [&["analyze", "-", "--json"], flags].concat();
        data(&with_scene(&arguments, DOOR))
    };
    // The angle tolerance is the length tolerance divided by the 2 m of the mechanism.
    assert_eq!(told(&[]), known_to(1e-3.into(), 5e-4.into()));
    assert_eq!(
        told(&["--tolerance", "1e-4"]),
        known_to(1e-4.into(), 5e-5.into())
    );
    assert_eq!(
        told(&["--angle-tolerance", "1e-6"]),
        known_to(1e-3.into(), 1e-6.into())
    );
    let both = ["--tolerance", "1e-4", "--angle-tolerance", "1e-6"];
    assert_eq!(told(&both), known_to(1e-4.into(), 1e-6.into()));
}

#[test]
fn what_nobody_states_is_not_told() {
    let silent = DOOR.replace("tolerance = 1e-3\n", "");
    let output = with_scene(&["analyze", "-", "--json"], &silent);
    assert_eq!(data(&output), known_to(Value::Null, Value::Null));
    let words = stdout(&with_scene(&["analyze", "-"], &silent));
    assert!(!words.contains("accurate to"), "{words}");
    let words = stdout(&with_scene(&["analyze", "-"], DOOR));
    assert!(
        words.contains("  data accurate to 1 mm (angles 0.5 mrad)\n"),
        "{words}"
    );
}

#[test]
fn a_run_tells_it_in_its_summary() {
    let folder = Folder::new("tolerance");
    let arguments = ["simulate", "-", "--t-end", "0.1", "--out", folder.text()];
    let output = with_scene(&[&arguments[..], &["--tolerance", "1e-5"]].concat(), DOOR);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let summary: Value = serde_json::from_str(&folder.read("summary.json")).expect("JSON");
    assert_eq!(summary["data"], known_to(1e-5.into(), 5e-6.into()));
}

#[test]
fn every_command_that_judges_takes_them() {
    let folder = Folder::new("tolerances");
    let picture = format!("{}/robot.svg", folder.text());
    std::fs::create_dir_all(folder.text()).expect("writable");
    let commands: [&[&str]; 6] = [
        &["analyze", ROBOT],
        &["check", ROBOT],
        &["simulate", ROBOT, "--out", folder.text()],
        &["plan", ROBOT],
        &["view", ROBOT, "--no-open", "--out", &picture],
        &["diff", ROBOT, ROBOT],
    ];
    for command in commands {
        for (flag, value, expected) in [
            ("--tolerance", "0", "need a length > 0 in m, as 1e-4"),
            ("--tolerance", "-1e-4", "need a length > 0 in m, as 1e-4"),
            ("--tolerance", "0.1kg", "need a length > 0 in m, as 1e-4"),
            (
                "--angle-tolerance",
                "inf",
                "need an angle > 0 in rad, as 1e-5",
            ),
        ] {
            let output = pfaff(&[command, &[flag, value]].concat());
            let text = stderr(&output);
            assert_eq!(output.status.code(), Some(2), "{command:?}: {text}");
            assert!(
                text.contains(&format!("invalid value '{value}' for '{flag}")),
                "{text}"
            );
            assert!(text.contains(expected), "{text}");
            assert!(output.stdout.is_empty(), "{command:?}");
        }
        let help = stdout(&pfaff(&[command[0], "--help"]));
        for flag in ["--tolerance <LENGTH>", "--angle-tolerance <RAD>"] {
            assert!(help.contains(flag), "{}: {help}", command[0]);
        }
    }
    for command in [commands[1], commands[3], commands[4], commands[5]] {
        let output = pfaff(&[command, &["--tolerance", "1e-9"]].concat());
        assert_eq!(output.status.code(), Some(0), "{output:?}");
    }
}

/// Two parallel cylinders turn an arm about its hinge; the direction of their axes is given with
/// four digits.
fn cylinders(axis: &str) -> String {
    let mut text = String::from(
        r#"
[scene]
name = "cylinders"
space = "plane"
[[body]]
name = "arm"
mass = 1.0
inertia = 1.0
position = [1.2380034223645, 0.8469637100925]
[[joint]]
name = "hinge"
type = "revolute"
bodies = ["ground", "arm"]
at = [1.2, -0.1]
"#,
    );
    let (sin, cos) = 0.6_f64.sin_cos();
    for (k, offset) in [(1, -0.2), (2, 0.2)] {
        let at = |s: f64| format!("[{}, {}]", s * cos - offset * sin, s * sin + offset * cos);
        text += &format!(
            r#"
[[body]]
name = "tube{k}"
mass = 1.0
inertia = 1.0
position = {tube}
[[body]]
name = "rod{k}"
mass = 1.0
inertia = 1.0
position = {rod}
[[joint]]
name = "A{k}"
type = "revolute"
bodies = ["ground", "tube{k}"]
at = {foot}
[[joint]]
name = "S{k}"
type = "translational"
bodies = ["tube{k}", "rod{k}"]
points = {{ tube{k} = [0.0, 0.0], rod{k} = [0.0, 0.0] }}
axis = {axis}
[[joint]]
name = "B{k}"
type = "revolute"
bodies = ["rod{k}", "arm"]
at = {eye}
[[drive]]
name = "pump{k}"
joint = "S{k}"
type = "displacement"
motion = {{ type = "constant-rate", rate = 0.0 }}
"#,
            foot = at(0.0),
            tube = at(0.4),
            rod = at(1.1),
            eye = at(1.5),
        );
    }
    text
}

/// The part of the reactions of the slides that results from the last digits of an axis is zero
/// within the tolerance, and its margin is reported.
#[test]
fn what_is_unique_within_the_tolerance_says_so() {
    let slides = |axis: &str, flags: &[&str]| -> Vec<Value> {
        let arguments = [&["analyze", "-", "--json"], flags].concat();
        let output = with_scene(&arguments, &cylinders(axis));
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let d: Value = serde_json::from_str(&stdout(&output)).expect("one document");
        assert_eq!(d["redundancy"], 1);
        let all = d["reactions"].as_array().expect("a list");
        for r in all {
            let name = r["name"].as_str().expect("a name");
            if !name.starts_with('S') {
                assert_eq!(
                    (&r["verdict"], &r["within_tolerance"]),
                    (&json!("not_unique"), &json!(false))
                );
            }
        }
        let slides = all
            .iter()
            .filter(|r| r["name"] == "S1" || r["name"] == "S2");
        slides.cloned().collect()
    };
    let typed = "[0.8253, 0.5646]";
    for r in slides(typed, &["--tolerance", "1e-4"]) {
        assert_eq!(
            (&r["verdict"], &r["within_tolerance"]),
            (&json!("unique"), &json!(true))
        );
        let margin = r["margin"].as_f64().expect("a number");
        // The direction has an error of 1.5e-5 rad.
        assert!((1e-6..1.5e-5).contains(&margin), "{margin:e}");
        let row = &r["row_verdicts"][0];
        assert_eq!(
            (&row["verdict"], &row["within_tolerance"]),
            (&json!("unique"), &json!(true))
        );
    }
    for r in slides(typed, &[]) {
        assert_eq!(
            (&r["verdict"], &r["within_tolerance"]),
            (&json!("not_unique"), &json!(false))
        );
    }
    for r in slides(
        "[0.825335614909678, 0.564642473395035]",
        &["--tolerance", "1e-4"],
    ) {
        assert_eq!(
            (&r["verdict"], &r["within_tolerance"]),
            (&json!("unique"), &json!(false))
        );
    }
    let output = with_scene(&["analyze", "-", "--tolerance", "1e-4"], &cylinders(typed));
    let text = stdout(&output);
    let line = text
        .lines()
        .find(|line| line.starts_with("S1, "))
        .expect("a line");
    assert!(
        line.contains("unique within the tolerance  2.7e-6 … 4.6e-6"),
        "{line}"
    );
}

/// Two wheels of one axle have directions that differ by 1e-4 rad, with a line of `[scene]`.
fn axle(stated: &str) -> String {
    format!(
        r#"
[scene]
name = "cart"
space = "plane"
{stated}
[[body]]
name = "cart"
mass = 10.0
inertia = 1.0
[[joint]]
name = "left"
type = "knife-edge"
body = "cart"
point = [0.0, 0.5]
normal = [0.0, 1.0]
[[joint]]
name = "right"
type = "knife-edge"
body = "cart"
point = [0.0, -0.5]
normal = [1e-4, 1.0]
"#
    )
}

/// The tolerance of directions alone changes verdicts, stated by the option or by the scene.
#[test]
fn an_angle_tolerance_changes_verdicts_without_a_length() {
    let judged = |stated: &str, flags: &[&str]| -> Value {
        let arguments = [&["analyze", "-", "--json"], flags].concat();
        let output = with_scene(&arguments, &axle(stated));
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        serde_json::from_str(&stdout(&output)).expect("one document")
    };
    let ways: [(&str, &[&str]); 2] = [
        ("angle_tolerance = 1e-3", &[]),
        ("", &["--angle-tolerance", "1e-3"]),
    ];
    for (stated, flags) in ways {
        let d = judged(stated, flags);
        assert_eq!((&d["rank"], &d["redundancy"]), (&json!(1), &json!(1)));
        assert_eq!(d["evidence"]["grounds"], "within_tolerance");
        assert_eq!(d["data"]["tolerance"], Value::Null);
    }
    let d = judged("angle_tolerance = 1e-5", &[]);
    assert_eq!((&d["rank"], &d["redundancy"]), (&json!(2), &json!(0)));
    assert_eq!(d["data"]["lower_rank_from"], Value::Null);
    let from = d["data"]["lower_rank_from_angle"].as_f64().expect("near");
    // One of them rotates by the whole difference: both must become perpendicular to the axle.
    assert!((from / 1e-4 - 1.0).abs() < 0.06, "{from:e}");
    let output = with_scene(&["analyze", "-"], &axle("angle_tolerance = 1e-5"));
    let text = stdout(&output)
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ");
    assert!(
        text.contains("one row is redundant from an angle tolerance of 0.099 mrad on (`--angle-tolerance 0.0003` decides for it)"),
        "{text}"
    );
}

/// A lid is on four hinges along x, the third of them `off` (m) from the line of the others.
fn hatch(off: f64) -> String {
    let hinge = |(k, x): (usize, f64)| {
        let y = if k == 2 { off } else { 0.0 };
        format!(
            "[[joint]]\nname = \"hinge {}\"\ntype = \"revolute\"\nbodies = [\"ground\", \"lid\"]\nat = [{x}, {y}, 0.0]\naxis = [1, 0, 0]\n",
            k + 1
        )
    };
    let hinges = [-0.4, -0.15, 0.15, 0.4].into_iter().enumerate().map(hinge);
    format!(
        "[scene]\nname = \"hatch\"\nspace = \"spatial\"\ngravity = [0, 0, -9.81]\n[[body]]\nname = \"lid\"\nmass = 18.0\n\
         inertia = [0.7, 1.2, 1.9]\nposition = [0.0, 0.35, 0.1]\n{}[simulate]\nt_end = 0.1\n",
        hinges.collect::<String>()
    )
}

/// With the data given in the scene, the offset of half a millimetre locks the lid. Within a
/// tolerance of one millimetre, the lid rotates for every command. The hinges carry its weight
/// minus its acceleration.
#[test]
fn what_a_tolerance_has_freed_is_moved_shared_out_and_not_advised_again() {
    let scene = hatch(5e-4);
    let words = |arguments: &[&str]| {
        let output = with_scene(arguments, &scene);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        stdout(&output)
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ")
    };
    let locked = words(&["check", "-"]);
    assert!(
        locked.contains("mobility 0 for data as written, but 1 if lengths are accurate only to"),
        "{locked}"
    );
    let advised = locked
        .split("`tolerance = ")
        .nth(1)
        .and_then(|x| x.split('`').next());
    let advised = advised.expect("a length").to_owned();
    for tolerance in ["1e-3", &advised] {
        let free = words(&["check", "-", "--tolerance", tolerance]);
        assert!(
            free.contains("mobility 1") && !free.contains("warning"),
            "{free}"
        );
    }
    let sum = ["Fy", "Fz"].map(|c| {
        let terms: Vec<String> = (1..5).map(|k| format!("hinge {k}.{c}")).collect();
        terms.join(" + ")
    });
    let arguments = [
        "analyze",
        "-",
        "--json",
        "--tolerance",
        "1e-3",
        "--choose",
        "minimum-norm",
    ];
    let asked = [
        &arguments[..],
        &["--combine", &sum[0], "--combine", &sum[1]],
    ]
    .concat();
    let output = with_scene(&asked, &scene);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let d: Value = serde_json::from_str(&stdout(&output)).expect("one document");
    assert_eq!((&d["redundancy"], &d["mobility"]), (&json!(15), &json!(1)));
    // The values about the line of the hinges are J = 0.7 + 18·(0.35² + 0.1²) and M = 18·9.81·0.35.
    let alpha = -18.0 * 9.81 * 0.35 / (0.7 + 18.0 * (0.35_f64.powi(2) + 0.01));
    let acceleration = [-0.1 * alpha, 0.35 * alpha];
    // The reaction acts on the ground.
    let expected = [-18.0 * acceleration[0], -18.0 * (9.81 + acceleration[1])];
    for (k, expected) in expected.into_iter().enumerate() {
        let values = [
            &d["groups"][k]["values"][0]["value"],
            &d["choices"][0]["groups"][k]["components"][0]["value"],
        ];
        for value in values {
            let value = value
                .as_f64()
                .unwrap_or_else(|| panic!("{:#}", d["groups"]));
            // Lever arms of a tenth of a metre have an error of up to half a millimetre.
            assert!(
                (value - expected).abs() < 1e-2 * expected.abs(),
                "{value} {expected}"
            );
        }
    }
    // A choice deletes as many rows as the run.
    let dropped: Vec<String> = d["dropped_rows"]
        .as_array()
        .expect("rows")
        .iter()
        .map(ToString::to_string)
        .collect();
    let dropped = dropped.join(",");
    let drop = format!("drop:{dropped}");
    words(&["analyze", "-", "--tolerance", "1e-3", "--choose", &drop]);
    let verdicts = |more: &[&str]| {
        let output = with_scene(
            &[&["analyze", "-", "--json", "--tolerance", "1e-3"], more].concat(),
            &scene,
        );
        let d: Value = serde_json::from_str(&stdout(&output)).expect("one document");
        let all = d["reactions"].as_array().expect("a list").iter();
        all.map(|r| {
            r["components"]
                .as_array()
                .expect("a list")
                .iter()
                .map(|c| c["verdict"].clone())
                .collect::<Vec<_>>()
        })
        .collect::<Vec<_>>()
    };
    assert_eq!(verdicts(&[]), verdicts(&["--drop", &dropped]));
    let folder = Folder::new("hatch");
    words(&[
        "simulate",
        "-",
        "--tolerance",
        "1e-3",
        "--drop",
        &dropped,
        "--out",
        folder.text(),
    ]);
}

/// A beam on three supports carries 10 N at 0.3 of its length; the points are known to 1 mm. On two
/// supports a < b the push on a is 10·(b − 0.3)/(b − a).
#[test]
fn samples_have_the_bounds_of_the_mechanism_that_is_described() {
    let scene = r#"
        scene = { name = "beam", space = "plane", gravity = [0.0, -10.0], tolerance = 1e-3 }
        body = [{ name = "beam", mass = 1.0, inertia = 1.0, position = [0.3, 0.0] }]
        joint = [
            { name = "wall", type = "point-on-line", body = "beam", at = [0.0, 0.0], line = [[0.0, -1.0], [0.0, 1.0]] },
            { name = "a", type = "point-on-line", body = "beam", at = [0.0, 0.0], line = [[-1.0, 0.0], [1.0, 0.0]] },
            { name = "b", type = "point-on-line", body = "beam", at = [0.5, 0.0], line = [[-1.0, 0.0], [1.0, 0.0]] },
            { name = "c", type = "point-on-line", body = "beam", at = [1.0, 0.0], line = [[-1.0, 0.0], [1.0, 0.0]] },
        ]
    "#;
    let arguments = ["tolerance", "-", "--bounds", "--runs", "300", "--json"];
    let output = with_scene(&arguments, scene);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let d: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    let assumption = d["bounds"].as_str().expect("a sentence");
    assert!(
        assumption.contains("misfits within the tolerance cause preload"),
        "{assumption}"
    );
    let reaction = |name: &str| {
        let all = d["reactions"].as_array().expect("a list");
        all.iter().find(|r| r["name"] == name).expect("a reaction")
    };
    let value = |name: &str, what: &str| {
        let values = reaction(name)["values"].as_array().expect("a list");
        values
            .iter()
            .find(|v| v["name"] == what)
            .expect("a value")
            .clone()
    };
    for (name, lowest, highest) in [("a", 0.0, 7.0), ("b", 0.0, 14.0), ("c", -4.0, 3.0)] {
        let value = value(name, "Fy");
        let ends =
            ["lowest", "highest"].map(|end| value["bounds"][end].as_f64().expect("a number"));
        // A point moves by 1 mm, so a lever of 0.5 m changes by 0.4 % at most.
        for (end, expected, outward) in [(ends[0], lowest, -1.0), (ends[1], highest, 1.0)] {
            let beyond = outward * (end - expected);
            assert!((-1e-9..0.3).contains(&beyond), "{name}: {ends:?}");
        }
        assert!(ends[0] < lowest || ends[1] > highest, "{name}: {ends:?}");
    }
    // Displaced data couple the wall with the supports by about 0.1 %, and no more.
    let wall = value("wall", "Fx");
    let ends = ["lowest", "highest"].map(|end| wall["bounds"][end].as_f64().expect("a number"));
    assert!(ends.iter().all(|end| end.abs() < 0.1), "{ends:?}");
    let output = with_scene(&["tolerance", "-", "--rigid", "a"], scene);
    assert!(
        stderr(&output).contains("add --bounds"),
        "{}",
        stderr(&output)
    );
    let output = with_scene(&["tolerance", "-", "--bounds", "--rigid", "d"], scene);
    assert!(stderr(&output).contains('d'), "{}", stderr(&output));
    let output = with_scene(&["tolerance", "-", "--bounds", "--runs", "50"], scene);
    let text = stdout(&output);
    assert!(
        text.contains("Bounds in all samples:\nreaction  what  lowest (N)  highest (N)"),
        "{text}"
    );
}

/// The rank of displaced data is higher than that of the described mechanism: a beam that can slide
/// on three supports. The bounds are those of the described mechanism, for any size of the
/// tolerance.
#[test]
fn bounds_of_samples_are_continuous_in_the_tolerance() {
    let scene = r#"
        scene = { name = "beam", space = "plane", gravity = [0.0, -9.81] }
        body = [{ name = "bar", mass = 1.0, inertia = 0.1, position = [0.5, 0.0] }]
        joint = [
            { name = "A", type = "point-on-line", body = "bar", at = [0.0, 0.0], line = [[0.0, 0.0], [1.0, 0.0]] },
            { name = "B", type = "point-on-line", body = "bar", at = [0.4, 0.0], line = [[0.0, 0.0], [1.0, 0.0]] },
            { name = "C", type = "point-on-line", body = "bar", at = [1.1, 0.0], line = [[0.0, 0.0], [1.0, 0.0]] },
        ]
    "#;
    for tolerance in [1e-10, 1e-8, 1e-6, 1e-4, 1e-3] {
        let text = format!("{tolerance:e}");
        let arguments = [
            "tolerance",
            "-",
            "--bounds",
            "--runs",
            "40",
            "--tolerance",
            &text,
            "--json",
        ];
        let output = with_scene(&arguments, scene);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let d: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
        // 9.81 N at 0.5 m on two of the supports at 0, 0.4 and 1.1 m.
        for (name, ends) in [
            ("A", [9.81 * (0.4 - 0.5) / 0.4, 9.81 * (1.1 - 0.5) / 1.1]),
            ("B", [0.0, 9.81 * 0.5 / 0.4]),
            ("C", [0.0, 9.81 * 0.5 / 1.1]),
        ] {
            let reactions = d["reactions"].as_array().expect("a list");
            let own = reactions
                .iter()
                .find(|r| r["name"] == name)
                .expect("a reaction");
            for value in own["values"].as_array().expect("a list") {
                let Some(bounds) = value.get("bounds") else {
                    continue;
                };
                let found =
                    ["lowest", "highest"].map(|end| bounds[end].as_f64().expect("a number"));
                let expected = match value["name"].as_str() {
                    Some("Fy") => ends,
                    Some("Fx") => [0.0; 2],
                    _ => continue,
                };
                for (found, expected) in found.into_iter().zip(expected) {
                    let near = 1e-9 + 60.0 * tolerance;
                    assert!(
                        (found - expected).abs() < near,
                        "{name} {tolerance}: {found} {expected}"
                    );
                }
            }
        }
    }
}
