//! Tests of the laboratory: reference methods, which are compared with known motions and with
//! pfaff, scenes of any size, and the command `lab`.

mod book;
mod campaign;
mod exact;
#[path = "../../../pfaff-cli/tests/contract/folder.rs"]
mod folder;
mod formulations;
mod generate;
mod invariance;
mod known;
mod large_files;
mod methods;
mod numbers;
mod quick;
mod solvers;
mod space;
mod stress;
mod work_precision;

use std::process::{Command, Output};

use pfaff::model::Registry;
use pfaff_cli::Stream;

use folder::{Folder, stderr, stdout};

fn lab(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lab"))
        .args(arguments)
        .output()
        .expect("the command starts")
}

/// Returns the output of pfaff for these arguments.
fn pfaff(arguments: &[&str]) -> String {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let arguments = std::iter::once(&"pfaff").chain(arguments);
    let streams = (Stream::plain(&mut out), Stream::plain(&mut err));
    pfaff_cli::run(&Registry::standard(), arguments, streams.0, streams.1);
    assert!(err.is_empty(), "{}", String::from_utf8_lossy(&err));
    String::from_utf8(out).expect("UTF-8")
}
