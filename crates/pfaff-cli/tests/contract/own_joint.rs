//! Tests the whole command with a joint that is not built in: the program of a user calls
//! `pfaff_cli::run` with its registry.

use std::fs;
use std::process::ExitCode;

use pfaff::model::Registry;
use pfaff_cli::{Stream, run};

use crate::Folder;

pfaff::joint! { plane BeadOnWire(i, j) {
    /// Point `s_j` of body j stays on the parabola `y = x²/(2·rho)` of body i.
    params {
        /// The hole of the bead.
        s_j: Point in j,
        /// Radius of the wire at its vertex.
        rho: Length,
    }
    initial { curvature: PerLength = 1.0 / rho }
    require "the radius of the vertex is not zero": rho != 0.0;
    let p = local(i, point(j, s_j) - origin(i));
    rows: [normal];
    phi: p[1] - 0.5 * curvature * p[0] * p[0];
    measure along: p[0];
    place: point(j, s_j);
} }

/// At x = 1 the slope is 1, so that half of gravity accelerates along each axis: the wire exerts
/// m·(a − g) = 2·(−5, 5) N.
const BEAD: &str = r#"
scene = { name = "bead", space = "plane", gravity = [0.0, -10.0] }
body = [{ name = "bead", mass = 2.0, inertia = 1.0, position = [1.0, 0.5] }]
joint = [{ name = "wire", type = "bead-on-wire", bodies = ["ground", "bead"], at = [1.0, 0.5], rho = 1.0 }]
simulate = { t_end = 0.1 }
"#;

/// Returns exit code, answers and errors of a command with the joint of the bead.
fn command(arguments: &[&str]) -> (ExitCode, String, String) {
    let mut registry = Registry::standard();
    registry.add_constraint::<BeadOnWire>();
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let arguments = std::iter::once("bead").chain(arguments.iter().copied());
    let code = run(
        &registry,
        arguments,
        Stream::plain(&mut out),
        Stream::plain(&mut err),
    );
    let [out, err] = [out, err].map(|text| String::from_utf8(text).expect("UTF-8"));
    (code, out, err)
}

fn answer(arguments: &[&str]) -> String {
    let (code, out, err) = command(arguments);
    assert_eq!(
        (code, err.as_str()),
        (ExitCode::SUCCESS, ""),
        "{arguments:?}: {out}"
    );
    out
}

fn written(folder: &Folder, text: &str) -> String {
    fs::create_dir_all(&folder.0).expect("a folder");
    let path = folder.0.join("bead.toml");
    fs::write(&path, text).expect("a scene");
    path.display().to_string()
}

#[test]
fn a_joint_of_ones_own_has_every_command() {
    let folder = Folder::new("own-joint");
    let scene = written(&folder, BEAD);
    assert!(answer(&["check", &scene]).contains("mobility 2"));

    let told = answer(&["analyze", &scene, "--choose", "minimum-norm", "--json"]);
    let told: serde_json::Value = serde_json::from_str(&told).expect("a document");
    assert_eq!(told["reactions"][0]["type"], "bead-on-wire");
    assert_eq!(told["reactions"][0]["verdict"], "unique");

    let out = folder.0.join("run");
    let place = out.display().to_string();
    answer(&["simulate", &scene, "--out", &place]);
    let reactions = fs::read_to_string(out.join("reactions.csv")).expect("a table");
    let mut rows = csv::Reader::from_reader(reactions.as_bytes());
    let header = rows.headers().expect("a header").clone();
    let at = |name: &str| header.iter().position(|h| h == name).expect("a column");
    let first = rows.records().next().expect("a row").expect("read");
    let number = |name: &str| -> f64 { first[at(name)].parse().expect("a number") };
    // On the first body, the ground, the force is opposite to the force on the bead.
    assert!((number("wire.Fx") - 10.0).abs() < 1e-9 && (number("wire.Fy") + 10.0).abs() < 1e-9);

    assert!(answer(&["schema"]).contains("bead-on-wire"));
}

#[test]
fn two_wires_of_one_shape_share_the_load() {
    let folder = Folder::new("own-joints");
    let second = BEAD.replace("joint = [", "joint = [\n    { name = \"spare\", type = \"bead-on-wire\", bodies = [\"ground\", \"bead\"], at = [1.0, 0.5], rho = 1.0 },\n    ");
    let scene = written(&folder, &second);
    let told = answer(&["analyze", &scene, "--combine", "wire + spare"]);
    assert!(told.contains("\nspare, wire  "), "{told}");
    assert!(told.contains("wire + spare: unique"), "{told}");
}

#[test]
fn faults_go_where_they_are_sent() {
    let folder = Folder::new("own-joint-wrong");
    let scene = written(&folder, &BEAD.replace("rho = 1.0", "rho = 0.0"));
    let (code, out, err) = command(&["check", &scene]);
    assert_eq!((code, out.as_str()), (ExitCode::from(2), ""));
    assert!(
        err.contains("the radius of the vertex is not zero"),
        "{err}"
    );
}
