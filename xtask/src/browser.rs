//! `cargo xtask browser`: opens reports of scenes in the plane and in space in a real browser. The
//! test needs Node and Chromium, which are not dependencies of the project. Without these programs,
//! the pages are tested only as text.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::tree::{cargo, root, run, target};

/// Scenes whose reports are opened. In the plane: a redundant mechanism with drives, closed loops,
/// and a nonholonomic mechanism without redundancy. In space: wheels and loops, and a loop that
/// moves although its mobility count is zero.
const SCENES: [(&str, &str); 5] = [
    ("robot-trolley", "crates/robot-trolley/robot-trolley.toml"),
    ("three-cranks", "crates/suite/scenes/three-cranks.toml"),
    ("sleigh", "crates/suite/scenes/sleigh.toml"),
    ("robot-in-space", "examples/robot-in-space.toml"),
    ("bennett", "examples/bennett.toml"),
];

/// Two crossing bars in space. The first bar is above the second. Both bars are on springs, so that
/// they move.
const CROSSING: &str = r#"
scene = { name = "crossing", space = "spatial" }
body = [
  { name = "upper", mass = 1.0, inertia = [0.1, 0.1, 0.1], position = [0, 0, 0.3] },
  { name = "lower", mass = 1.0, inertia = [0.1, 0.1, 0.1], position = [0, 0, -0.3] },
]
joint = [
  { name = "A", type = "spherical", bodies = ["ground", "upper"], at = [-1, 0, 0.3] },
  { name = "B", type = "spherical", bodies = ["ground", "upper"], at = [1, 0, 0.3] },
  { name = "C", type = "spherical", bodies = ["ground", "lower"], at = [0, -1, -0.3] },
  { name = "D", type = "revolute", bodies = ["ground", "lower"], at = [0, 1, -0.3], axis = [0, 1, 0] },
]
force = [
  { name = "twist", type = "torque", body = "upper", torque = [1, 0, 0] },
  { name = "turn", type = "torque", body = "lower", torque = [0, 1, 0] },
]
simulate = { t_end = 0.5, output_step = 0.01 }
"#;

/// A beam on two pins that share loads, and a pendulum. The report is for a customer. It contains a
/// plot with several curves, a determined sum, and an undetermined curve.
const CUSTOMER: &str = r#"
[scene]
name = "customer"
space = "plane"
gravity = [0, -9.81]
title = "Beam & <pendulum>"
author = "A. Author"
project = "P-12"
date = "2026-03-02"
[[body]]
name = "beam"
mass = 2000.0
inertia = 300.0
position = [1, 0]
[[body]]
name = "bob"
mass = 500.0
inertia = 0.1
position = [1, -3]
velocity = [2, 0]
angular_velocity = 2
[[joint]]
name = "left"
type = "revolute"
bodies = ["ground", "beam"]
at = [0, 0]
[[joint]]
name = "right"
type = "revolute"
bodies = ["ground", "beam"]
at = [2, 0]
[[joint]]
name = "pivot"
type = "revolute"
bodies = ["beam", "bob"]
at = [1, -2]
[[group]]
name = "both"
combine = "left.Fy + right.Fy"
[simulate]
t_end = 4.0
[output]
print = "customer"
plots = [{ title = "Loads", curves = ["left.Fy", "right.Fy", "both", "left.Fx"] }, ["bob.x", "bob.y"]]
"#;

/// Number of double pendulums in a large scene, which is half the number of bodies.
const PENDULUMS: usize = 500;

/// A thousand bodies in space.
fn crowd() -> String {
    let mut scene = String::from(
        "[scene]\nname = \"crowd\"\nspace = \"spatial\"\ngravity = [0, 0, -9.81]\n\
         [simulate]\nt_end = 2\noutput_step = 0.02\n",
    );
    for k in 0..PENDULUMS {
        let (x, y) = (1.5 * (k % 25) as f64, 2.0 * (k / 25) as f64);
        let (sin, cos) = (0.3 + 0.02 * k as f64).sin_cos();
        scene += &format!(
            "[[body]]\nname = \"a{k}\"\nmass = 1\ninertia = [0.1, 0.1, 0.1]\nposition = [{x}, {}, 0]\n\
             [[body]]\nname = \"b{k}\"\nmass = 1\ninertia = [0.1, 0.1, 0.1]\nposition = [{x}, {}, -0.5]\n\
             [[joint]]\nname = \"A{k}\"\ntype = \"revolute\"\nbodies = [\"ground\", \"a{k}\"]\nat = [{x}, {y}, 0]\naxis = [{cos}, 0, {sin}]\n\
             [[joint]]\nname = \"B{k}\"\ntype = \"spherical\"\nbodies = [\"a{k}\", \"b{k}\"]\nat = [{x}, {}, 0]\n",
            y + 0.5,
            y + 1.0,
            y + 1.0,
        );
    }
    scene
}

/// Names of the program on different systems.
const CHROMIUM: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

const NO_CHROMIUM: &str = "no Chromium found: install it, for instance by `apt-get install chromium`, `dnf install chromium` or \
                           `brew install chromium`, or set CHROMIUM to its program";
const NO_NODE: &str =
    "no Node found: install version 20 or later, for instance by `apt-get install nodejs`";

/// The command `pfaff` that writes the reports.
pub(crate) enum Program {
    /// A release build made for this test.
    Release,
    /// The build of `cargo test`, so that nothing is compiled again.
    OfTests,
}

/// Returns the tools that are missing on this machine, or `None` if the test can run.
pub(crate) fn missing() -> Result<String, String> {
    Ok(tools().err().unwrap_or_default().to_owned())
}

/// Writes the reports and checks them.
pub(crate) fn check(program: Program) -> Result<String, String> {
    let chromium = tools()?;
    let root = root();
    let target = target(&root)?;
    let pfaff = match program {
        Program::Release => {
            run(cargo(&root).args(["build", "--release", "-p", "pfaff-cli"]))?;
            format!("{target}/release/pfaff")
        }
        Program::OfTests => format!("{target}/debug/pfaff"),
    };
    let out = Path::new(&target).join("browser");
    // An earlier version of the program may have left files that this version refuses to replace.
    if out.exists() {
        fs::remove_dir_all(&out).map_err(|e| format!("{}: {e}", out.display()))?;
    }
    let mut node = Command::new("node");
    node.current_dir(&root)
        .args(["tests/browser/report.mjs", &chromium])
        .arg(out.join("pictures"));
    fs::create_dir_all(&out).map_err(|e| format!("{}: {e}", out.display()))?;
    let mut scenes = SCENES
        .map(|(name, scene)| (name, scene.to_owned()))
        .to_vec();
    for (name, text) in [
        ("crossing", CROSSING.to_owned()),
        ("crowd", crowd()),
        ("customer", CUSTOMER.to_owned()),
    ] {
        let path = out.join(format!("{name}.toml"));
        fs::write(&path, text).map_err(|e| format!("{}: {e}", path.display()))?;
        scenes.push((name, path.display().to_string()));
    }
    let mut begun = Vec::new();
    for (name, scene) in scenes {
        let folder = out.join(name);
        let mut simulate = Command::new(&pfaff);
        simulate
            .current_dir(&root)
            .args(["simulate", &scene, "--out"]);
        let child = simulate.arg(&folder).stdout(Stdio::null()).spawn();
        begun.push((name, child.map_err(|e| format!("{pfaff}: {e}"))?));
        node.arg(format!("{name}={}", folder.join("report.html").display()));
    }
    for (name, mut child) in begun {
        let ended = child.wait().map_err(|e| format!("{name}: {e}"))?;
        if !ended.success() {
            return Err(format!("the run of `{name}` failed: {ended}"));
        }
    }
    run(&mut node)?;
    Ok(format!("pictures in {}", out.join("pictures").display()))
}

/// The path of the browser, if Node is also available.
fn tools() -> Result<String, &'static str> {
    let chromium = chromium().ok_or(NO_CHROMIUM)?;
    if answers("node") {
        Ok(chromium)
    } else {
        Err(NO_NODE)
    }
}

fn chromium() -> Option<String> {
    let named = std::env::var("CHROMIUM").ok();
    named.or_else(|| {
        CHROMIUM
            .into_iter()
            .find(|name| answers(name))
            .map(str::to_owned)
    })
}

fn answers(program: &str) -> bool {
    let mut asked = Command::new(program);
    asked
        .arg("--version")
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    asked.status().is_ok_and(|status| status.success())
}
