//! `cargo xtask browser`: reports of three scenes in a real browser. Needs Node and Chromium, which are on no list of dependencies: without them
//! the pages are tested as text only.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::tree::{cargo, root, run, target};

/// Scenes whose reports are opened: redundant and driven, closed loops, and nonholonomic without redundancy.
const SCENES: [(&str, &str); 3] = [
    ("robot-trolley", "crates/robot-trolley/robot-trolley.toml"),
    ("three-cranks", "crates/suite/scenes/three-cranks.toml"),
    ("sleigh", "crates/suite/scenes/sleigh.toml"),
];

/// Names under which systems have it.
const CHROMIUM: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

const NO_CHROMIUM: &str = "no Chromium found. Install it, for instance by `apt-get install chromium`, `dnf install chromium` or \
                           `brew install chromium`, or set CHROMIUM to its program";
const NO_NODE: &str =
    "no Node found. Install version 20 or later, for instance by `apt-get install nodejs`";

/// Writes the reports and checks them.
pub(crate) fn check() -> Result<String, String> {
    let chromium = chromium().ok_or(NO_CHROMIUM)?;
    if !answers("node") {
        return Err(NO_NODE.to_owned());
    }
    let root = root();
    run(cargo(&root).args(["build", "--release", "-p", "pfaff-cli"]))?;
    let target = target(&root)?;
    let out = Path::new(&target).join("browser");
    let mut node = Command::new("node");
    node.current_dir(&root)
        .args(["tests/browser/report.mjs", &chromium])
        .arg(out.join("pictures"));
    for (name, scene) in SCENES {
        let folder = out.join(name);
        let mut simulate = Command::new(format!("{target}/release/pfaff"));
        simulate
            .current_dir(&root)
            .args(["simulate", scene, "--out"]);
        run(simulate.arg(&folder).stdout(Stdio::null()))?;
        node.arg(format!("{name}={}", folder.join("report.html").display()));
    }
    run(&mut node)?;
    Ok(format!("pictures in {}", out.join("pictures").display()))
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
