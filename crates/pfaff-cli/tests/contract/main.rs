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
mod folder;
mod fragile;
mod freedoms;
mod language;
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
use std::process::{Command, Output, Stdio};

use lab::generate::{Kind, Order};

use folder::{Folder, stderr, stdout};

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
