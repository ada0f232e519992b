//! The laboratory: comparators against known motions and against the product, scenes of any size,
//! and the command `lab`.

mod campaign;
mod exact;
mod formulations;
mod generate;
mod known;
mod large_files;
mod methods;
mod quick;
mod solvers;
mod stress;
mod work_precision;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use pfaff::model::Registry;
use pfaff_cli::Stream;

fn lab(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lab"))
        .args(arguments)
        .output()
        .expect("the command starts")
}

/// What the product answers to this.
fn pfaff(arguments: &[&str]) -> String {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let arguments = std::iter::once(&"pfaff").chain(arguments);
    let streams = (Stream::plain(&mut out), Stream::plain(&mut err));
    pfaff_cli::run(&Registry::planar(), arguments, streams.0, streams.1);
    assert!(err.is_empty(), "{}", String::from_utf8_lossy(&err));
    String::from_utf8(out).expect("UTF-8")
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
