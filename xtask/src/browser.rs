//! `cargo xtask browser`: reports of three scenes in a real browser. Needs Node and Chromium, which
//! are not dependencies of the project: without them the pages are tested only as text.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::tree::{cargo, root, run, target};

/// Scenes whose reports are opened: redundant and driven, closed loops, and nonholonomic without
/// redundancy.
const SCENES: [(&str, &str); 3] = [
    ("robot-trolley", "crates/robot-trolley/robot-trolley.toml"),
    ("three-cranks", "crates/suite/scenes/three-cranks.toml"),
    ("sleigh", "crates/suite/scenes/sleigh.toml"),
];

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

/// Returns what this machine lacks, or `None` if the test can run.
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
    // An earlier program may have left files that this one refuses to replace.
    if out.exists() {
        fs::remove_dir_all(&out).map_err(|e| format!("{}: {e}", out.display()))?;
    }
    let mut node = Command::new("node");
    node.current_dir(&root)
        .args(["tests/browser/report.mjs", &chromium])
        .arg(out.join("pictures"));
    for (name, scene) in SCENES {
        let folder = out.join(name);
        let mut simulate = Command::new(&pfaff);
        simulate
            .current_dir(&root)
            .args(["simulate", scene, "--out"]);
        run(simulate.arg(&folder).stdout(Stdio::null()))?;
        node.arg(format!("{name}={}", folder.join("report.html").display()));
    }
    run(&mut node)?;
    Ok(format!("pictures in {}", out.join("pictures").display()))
}

/// The browser's program, if Node is available, too.
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
