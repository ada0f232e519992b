//! Checks the gallery in `examples/`: each scene, its page, and the table of all scenes. The
//! expected values were derived by hand.

mod answers;
mod fixed;
mod rolling;
mod space;
mod turning;
mod variants;

use std::collections::BTreeSet;
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use dynamics::MotionOptions;
use model::reaction::Reaction;
use model::{Registry, System};
use pfaff::{RunOptions, Study};

/// Tolerance of the runs.
const TIGHT: f64 = 1e-12;

/// Largest difference of a run with [`TIGHT`] from a closed form, relative to the largest value
/// involved. It is the error of the run, not a rounding error.
const CLOSE: f64 = 1e-9;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("tests/ lies in the root")
}

/// Returns the path of the scene of an example. The scene of the published robot is in its own
/// crate.
pub(super) fn scene(name: &str) -> PathBuf {
    match name {
        "robot-trolley" => root().join("crates/robot-trolley/robot-trolley.toml"),
        _ => root().join(format!("examples/{name}.toml")),
    }
}

pub(super) fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

fn page(name: &str) -> String {
    read(&root().join(format!("examples/{name}.md")))
}

/// Returns a text without its line ends.
fn in_one_line(text: &str) -> String {
    let words: Vec<&str> = text.split_whitespace().collect();
    words.join(" ")
}

fn study(name: &str, text: &str) -> Study {
    Study::read(name, text, &Registry::standard(), &RunOptions::default())
        .unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// Returns the names of the files in `examples/` with this ending.
pub(super) fn files(ending: &str) -> BTreeSet<String> {
    let entries = fs::read_dir(root().join("examples")).expect("examples/ exists");
    entries
        .filter_map(|e| {
            let name = e.expect("readable").file_name();
            let name = name.to_str().expect("UTF-8").strip_suffix(ending)?;
            (name != "README").then(|| name.to_owned())
        })
        .collect()
}

/// Output rows of a scene, with names.
struct Run {
    bodies: Vec<String>,
    joints: Vec<String>,
    rows: Vec<Row>,
}

struct Row {
    t: f64,
    q: Vec<f64>,
    v: Vec<f64>,
    reactions: Vec<Reaction>,
}

impl Run {
    fn of(name: &str) -> Self {
        Self::of_text(name, &read(&scene(name)))
    }

    fn of_text(name: &str, text: &str) -> Self {
        let study = study(name, text);
        let options = MotionOptions {
            rtol: TIGHT,
            atol: TIGHT,
            ..study.options.clone().expect("every example says how long")
        };
        let mut rows = Vec::new();
        let done = study.run(&options, |sample| {
            rows.push(Row {
                t: sample.t,
                q: sample.q.to_vec(),
                v: sample.v.to_vec(),
                reactions: sample.reactions()?.as_chosen().to_vec(),
            });
            Ok(ControlFlow::Continue(()))
        });
        if let Err(failure) = done {
            panic!("{name}: {}", failure.error);
        }
        let mechanism = &study.prepared.mechanism;
        let bodies = mechanism.bodies().iter();
        let joints = mechanism.layout().groups.iter();
        Self {
            bodies: bodies.map(|b| b.name.clone()).collect(),
            joints: joints.map(|g| g.name.clone()).collect(),
            rows,
        }
    }

    fn first(&self) -> &Row {
        &self.rows[0]
    }

    fn last(&self) -> &Row {
        self.rows.last().expect("there is a row at the end")
    }

    fn start(&self, body: &str) -> usize {
        let at = self.bodies.iter().position(|b| b == body);
        3 * at.unwrap_or_else(|| panic!("no body `{body}`"))
    }

    /// Returns x, y and angle.
    fn pose(&self, row: &Row, body: &str) -> [f64; 3] {
        let k = self.start(body);
        [row.q[k], row.q[k + 1], row.q[k + 2]]
    }

    /// Returns the rates of x, y and angle.
    fn rate(&self, row: &Row, body: &str) -> [f64; 3] {
        let k = self.start(body);
        [row.v[k], row.v[k + 1], row.v[k + 2]]
    }

    /// Returns the position of a point of a body; `s` is given in its frame.
    fn point(&self, row: &Row, body: &str, s: [f64; 2]) -> [f64; 2] {
        let [x, y, angle] = self.pose(row, body);
        let (sin, cos) = angle.sin_cos();
        [x + cos * s[0] - sin * s[1], y + sin * s[0] + cos * s[1]]
    }

    /// Returns Fx, Fy and T on the first body.
    fn reaction(&self, row: &Row, joint: &str) -> [f64; 3] {
        let r = &row.reactions[self.joint(joint)];
        [r.force[0], r.force[1], r.torque[2]]
    }

    /// Returns the named component: N of a knife edge, or the component of a drive.
    fn component(&self, row: &Row, joint: &str) -> f64 {
        let component = row.reactions[self.joint(joint)].component;
        component.unwrap_or_else(|| panic!("`{joint}` has no named component"))
    }

    fn joint(&self, joint: &str) -> usize {
        let at = self.joints.iter().position(|j| j == joint);
        at.unwrap_or_else(|| panic!("no joint `{joint}`"))
    }
}

/// Compares with a closed form; `scale` is the largest value involved.
#[track_caller]
fn close(found: f64, expected: f64, scale: f64) {
    assert!(
        (found - expected).abs() <= CLOSE * scale,
        "{found} instead of {expected}"
    );
}

/// Asserts that the page of an example contains this number, with this number of decimals.
#[track_caller]
fn says(name: &str, number: f64, decimals: usize) {
    let text = format!("{number:.decimals$}");
    assert!(
        page(name).contains(&text),
        "the page of {name} does not say {text}"
    );
}

/// The two files of this mechanism must be equal.
#[test]
fn andrews_is_the_file_of_the_suite() {
    let suite = read(&root().join("crates/suite/scenes/andrews.toml"));
    assert_eq!(read(&scene("andrews")), suite);
}
