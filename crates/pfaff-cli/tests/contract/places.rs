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

/// Rounding of a run: the prescribed motion is exact at the rows.
const OF_RUN: f64 = 1e-10;

/// The columns of a table by name.
fn columns(table: &str) -> impl Fn(&str) -> Vec<f64> + use<> {
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    let header = reader.headers().expect("a header").clone();
    let rows: Vec<Vec<f64>> = reader
        .deserialize()
        .map(|row| row.expect("numbers"))
        .collect();
    assert!(rows.len() > 4, "{table}");
    move |name: &str| {
        let at = header.iter().position(|column| column == name);
        let at = at.unwrap_or_else(|| panic!("no column {name}: {header:?}"));
        rows.iter().map(|row| row[at]).collect()
    }
}

fn assert_columns(table: &str, time: &str, expected: &[(&str, &dyn Fn(f64) -> f64)]) {
    let column = columns(table);
    for (name, expected) in expected {
        for (t, found) in column(time).into_iter().zip(column(name)) {
            let (expected, scale) = (expected(t), 1.0 + expected(t).abs());
            assert!(
                (found - expected).abs() < OF_RUN * scale,
                "{name} at {t} s: {found}, not {expected}"
            );
        }
    }
}

/// A wheel is steered about z, tilted about x and turns about its axis y.
const WHEEL: &str = r#"
scene = { name = "wheel", space = "spatial" }
body = [
  { name = "knuckle", mass = 1.0, inertia = [0.1, 0.2, 0.3] },
  { name = "hub", mass = 1.0, inertia = [0.1, 0.2, 0.3] },
  { name = "wheel", mass = 1.0, inertia = [0.1, 0.2, 0.3] },
]
joint = [
  { name = "steer", type = "revolute", bodies = ["ground", "knuckle"], at = [0, 0, 0], axis = [0, 0, 1] },
  { name = "tilt", type = "revolute", bodies = ["knuckle", "hub"], at = [0, 0, 0], axis = [1, 0, 0] },
  { name = "axle", type = "revolute", bodies = ["hub", "wheel"], at = [0, 0, 0], axis = [0, 1, 0] },
]
drive = [
  { name = "s", joint = "steer", type = "angle", motion = { type = "harmonic", amplitude = 0.4, omega = 3.0 } },
  { name = "t", joint = "tilt", type = "angle", motion = { type = "polynomial", coefficients = [0.0, 0.2, -0.1] } },
  { name = "a", joint = "axle", type = "angle", motion = { type = "constant-rate", rate = 8.0 } },
]
marker = [
  { name = "centre", body = "wheel", point = [0, 0, 0] },
  { name = "rim", body = "hub", point = [0, 2, 0], orientation = { axis = [0, 0, 1], angle = 0.5 } },
]
measure = [
  { name = "toe", type = "angle", markers = ["centre"], axes = ["y", "y"], about = "z" },
  { name = "camber", type = "inclination", markers = ["centre"], axes = ["z", "y"] },
  { name = "bend", type = "angle", markers = ["centre"], axes = ["y", "y"] },
  { name = "out", type = "component", markers = ["rim"], axis = [0, 3, 4] },
  { name = "relative", type = "angle", markers = ["rim", "centre"], axes = ["z", "x"], about = [0.479425538604203, 0.8775825618903728, 0] },
]
simulate = { t_end = 1.0, output_step = 0.125 }
output = { accelerations = true, rpy = true }
"#;

#[test]
fn toe_and_camber_follow_the_drives() {
    let folder = run("places-wheel", &[], WHEEL);
    let toe = |t: f64| 0.4 * (3.0 * t).sin();
    let camber = |t: f64| 0.2 * t - 0.1 * t * t;
    assert_columns(
        &folder.read("trajectory.csv"),
        "t",
        &[
            ("toe", &toe),
            ("toe.rate", &|t| 1.2 * (3.0 * t).cos()),
            ("toe.acceleration", &|t| -3.6 * (3.0 * t).sin()),
            ("camber", &camber),
            ("camber.rate", &|t| 0.2 - 0.2 * t),
            ("camber.acceleration", &|_| -0.2),
            ("knuckle.alphaz", &|t| -3.6 * (3.0 * t).sin()),
            ("knuckle.yaw", &toe),
            ("hub.roll", &camber),
            ("hub.yaw", &toe),
            ("rim.yaw", &|t| {
                // The axes of the rim are turned about z of the hub.
                let x = [0.5_f64.cos(), 0.5_f64.sin() * camber(t).cos()];
                toe(t) + x[1].atan2(x[0])
            }),
            // The wheel turns against the axes of the rim.
            ("relative.rate", &|_| 8.0),
            ("rim.x", &|t| -2.0 * toe(t).sin() * camber(t).cos()),
            ("out", &|t| {
                let y = 2.0 * toe(t).cos() * camber(t).cos();
                0.6 * y + 0.8 * 2.0 * camber(t).sin()
            }),
        ],
    );
    let page = folder.read("report.html");
    for told in [
        "toe: angle of centre from ground",
        "out: component of rim from ground",
    ] {
        assert!(page.contains(told), "{told}");
    }
    // At the start the wheel is straight: the angle has a kink there and no rate.
    let column = columns(&folder.read("trajectory.csv"));
    assert!(column("bend")[0] == 0.0 && column("bend.rate")[0].is_nan());
    for (found, [toe, camber]) in column("bend").iter().zip(
        column("toe")
            .into_iter()
            .zip(column("camber"))
            .map(|(a, b)| [a, b]),
    ) {
        assert!(
            (found - (toe.cos() * camber.cos()).acos()).abs() < 1e-7,
            "{found}"
        );
    }
    // Without the request the table is as before.
    let plain = run(
        "places-plain",
        &[],
        &WHEEL.replace("output = { accelerations = true, rpy = true }", ""),
    );
    let header = plain.read("trajectory.csv");
    let header = header.lines().next().expect("a header");
    assert!(
        header.ends_with("rim.vz,toe,camber,bend,out,relative"),
        "{header}"
    );
}

#[test]
fn an_angle_without_a_meaning_at_the_start_is_refused() {
    let scene = WHEEL.replace(
        "axes = [\"y\", \"y\"], about = \"z\"",
        "axes = [\"y\", \"z\"], about = \"z\"",
    );
    let output = with_scene(&["check", "-"], &scene);
    assert_eq!(output.status.code(), Some(2), "{}", stdout(&output));
    let said = stderr(&output);
    assert!(
        said.contains(
            "`toe` requires at the start: its second direction is not parallel to `about`"
        ) && said.contains("P0204"),
        "{said}"
    );
}

/// The crank in millimetres and degrees: r·ω² at its pen, and units in all headers.
#[test]
fn tables_have_the_units_of_the_scene_on_request() {
    let scene = CRANK
        .replace(
            "space = \"plane\"",
            "space = \"plane\"\nformat = 2\nunits = { length = \"mm\", angle = \"deg\" }",
        )
        .replace("inertia = 0.1", "inertia = \"0.1 kg*m^2\"")
        .replace("centre = [0.5, 0.0]", "centre = [500, 0]")
        .replace("point = [1.0, 0.0]", "point = [1000, 0]")
        .replace(
            "point = [0.0, 1.0]\nangle = 0.5",
            "point = [0, 1000]\nangle = \"0.5 rad\"",
        )
        .replace("rate = 8.0", "rate = \"8 rad/s\"");
    let spring = "\n[[force]]\nname = \"S\"\ntype = \"spring-damper\"\nbodies = [\"ground\", \"crank\"]\n\
                  points = { ground = [0, 2000], crank = \"pen\" }\nstiffness = \"3 N/m\"\ndamping = 0\nfree_length = \"1 m\"\n";
    let output = "\n[output]\naccelerations = true\nunits = \"scene\"\n";
    let written = run("places-units", &[], &format!("{scene}{spring}{output}"));
    assert_columns(
        &written.read("trajectory.csv"),
        "t (s)",
        &[
            ("crank.angle (deg)", &|t| (8.0 * t).to_degrees()),
            ("crank.omega (deg/s)", &|_| 8.0_f64.to_degrees()),
            ("crank.alpha (deg/s²)", &|_| 0.0),
            ("pen.x (mm)", &|t| 1000.0 * (8.0 * t).cos()),
            ("pen.vy (mm/s)", &|t| 8000.0 * (8.0 * t).cos()),
            ("pen.ax (mm/s²)", &|t| -64_000.0 * (8.0 * t).cos()),
            ("pen.ay (mm/s²)", &|t| -64_000.0 * (8.0 * t).sin()),
            ("flag.ay (mm/s²)", &|t| -64_000.0 * (8.0 * t).cos()),
            ("reach (mm)", &|_| 1000.0),
            ("reach.rate (mm/s)", &|_| 0.0),
            ("turned.rate (deg/s)", &|_| 8.0_f64.to_degrees()),
        ],
    );
    let length = |t: f64| (5.0 - 4.0 * (8.0 * t).sin()).sqrt();
    let loads = written.read("loads.csv");
    assert_columns(
        &loads,
        "t (s)",
        &[
            ("S.length (mm)", &|t| 1000.0 * length(t)),
            ("S.rate (mm/s)", &|t| {
                -16_000.0 * (8.0 * t).cos() / length(t)
            }),
        ],
    );
    let header = written.read("reactions.csv");
    let header = header.lines().next().expect("a header");
    assert!(
        header.starts_with("t (s),A.Fx (N),A.Fy (N),A.T (N·m)"),
        "{header}"
    );
    // The same run in SI units has the same loads.
    let plain = run("places-si", &[], &format!("{scene}{spring}"));
    let [own, other] = [(&written, " (N)"), (&plain, "")]
        .map(|(folder, unit)| columns(&folder.read("reactions.csv"))(&format!("A.Fx{unit}")));
    assert_eq!(own, other);
    // A run may replace its own files, which are recognised by their headers.
    let arguments = ["simulate", "-", "--out", written.text()];
    let again = with_scene(&arguments, &format!("{scene}{spring}{output}"));
    assert_eq!(again.status.code(), Some(0), "{}", stderr(&again));
}

#[test]
fn trajectories_of_a_sweep_have_the_requested_columns() {
    let folder = Folder::new("places-sweep");
    let scene = format!("{CRANK}\n[output]\naccelerations = true\nunits = \"scene\"\n");
    let arguments = [
        "sweep",
        "-",
        "--vary",
        "body.crank.mass=1,2",
        "--keep-rows",
        "--out",
        folder.text(),
    ];
    let output = with_scene(&arguments, &scene);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let table = folder.read("runs/1/trajectory.csv");
    assert_columns(
        &table,
        "t (s)",
        &[("pen.ax (m/s²)", &|t| -64.0 * (8.0 * t).cos())],
    );
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
