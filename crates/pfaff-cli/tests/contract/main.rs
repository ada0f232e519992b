//! The interface for users and scripts: exit codes, documents, files, and one clear message for
//! each invalid input.

mod advice;
mod agreement;
mod analyze;
mod armature;
mod bad_input;
mod book;
mod bounds_of_run;
mod cases;
mod causes;
mod chosen;
mod cold_start;
mod console;
mod couplings;
mod customer;
mod diff;
mod directory;
mod documents;
mod equilibrium;
mod explain;
mod failures;
#[cfg(target_os = "linux")]
mod faults;
mod first_minutes;
mod folder;
mod fragile;
mod freedoms;
mod import;
mod language;
mod library;
mod linearise;
mod loads;
mod man;
mod new;
mod own_joint;
#[cfg(feature = "png")]
mod picture;
mod places;
mod plan;
mod pulling;
mod refusals;
mod remedies;
mod report;
mod resources;
mod schema;
mod sessions;
mod singular;
mod sizes;
mod space;
mod sweep;
mod tolerance;
mod tolerance_samples;
mod view;
mod watch;
mod work_precision;

use std::io::{ErrorKind, Write};
use std::process::{Command, Output, Stdio};

use suite::generate::{Kind, Order};

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

/// Runs the command with a scene on standard input.
fn with_scene(arguments: &[&str], scene: &str) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_pfaff"))
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command starts");
    let mut input = child.stdin.take().expect("piped");
    // A command that rejects its arguments ends without reading.
    match input.write_all(scene.as_bytes()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => {}
        written => written.expect("the command reads"),
    }
    drop(input);
    child.wait_with_output().expect("the command ends")
}

/// Returns a scene of any size.
fn generated(kind: Kind, n: usize) -> String {
    let mut scene = Vec::new();
    let generator = Order::of(kind, n).generate().expect("a possible size");
    generator
        .write(&mut scene)
        .expect("memory takes everything");
    String::from_utf8(scene).expect("UTF-8")
}
