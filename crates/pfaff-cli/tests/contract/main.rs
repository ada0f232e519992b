//! What users and scripts rely on: exit codes, documents, files, and one clear message for each
//! wrong input.

mod advice;
mod analyze;
mod bad_input;
mod book;
mod cold_start;
mod console;
mod diff;
mod documents;
mod failures;
#[cfg(target_os = "linux")]
mod faults;
mod fragile;
mod freedoms;
mod library;
mod man;
mod new;
mod own_joint;
mod plan;
mod report;
mod resources;
mod schema;
mod singular;
mod sizes;
mod sweep;
mod tolerance;
mod view;
mod watch;
mod work_precision;
mod wrong;

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use lab::generate::{Kind, Order};

/// The published mechanism.
const ROBOT: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../robot-trolley/robot-trolley.toml"
);

fn pfaff(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pfaff"))
        .args(arguments)
        .output()
        .expect("the command starts")
}

/// The command with a scene on standard input.
fn with_scene(arguments: &[&str], scene: &str) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_pfaff"))
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command starts");
    let mut input = child.stdin.take().expect("piped");
    input
        .write_all(scene.as_bytes())
        .expect("the command reads");
    drop(input);
    child.wait_with_output().expect("the command ends")
}

/// A scene of the laboratory.
fn generated(kind: Kind, n: usize) -> String {
    let mut scene = Vec::new();
    let generator = Order::of(kind, n).generate().expect("a possible size");
    generator
        .write(&mut scene)
        .expect("memory takes everything");
    String::from_utf8(scene).expect("UTF-8")
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("UTF-8")
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("UTF-8")
}

/// A directory of one test, removed at its end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let _ = std::fs::remove_dir_all(&path);
        Self(path)
    }

    fn text(&self) -> &str {
        self.0.to_str().expect("UTF-8")
    }

    fn read(&self, name: &str) -> String {
        let path = self.0.join(name);
        std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
