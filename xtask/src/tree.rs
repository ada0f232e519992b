//! Paths of the project, and functions that run programs in the directories of the project.

use std::path::{Path, PathBuf};
use std::process::Command;

/// The root of the workspace.
pub(crate) fn root() -> PathBuf {
    let xtask = Path::new(env!("CARGO_MANIFEST_DIR"));
    xtask.parent().unwrap_or(xtask).to_owned()
}

/// A cargo command in a directory of the project.
pub(crate) fn cargo(folder: &Path) -> Command {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.current_dir(folder);
    cargo
}

/// Runs a command and waits for its end.
pub(crate) fn run(command: &mut Command) -> Result<(), String> {
    let status = command.status().map_err(|e| format!("{command:?}: {e}"))?;
    if status.success() {
        Ok(())
    } else {
        Err(format!("{command:?}: {status}"))
    }
}

/// The standard output of a command.
pub(crate) fn said_by(command: &mut Command) -> Result<String, String> {
    let output = command.output().map_err(|e| format!("{command:?}: {e}"))?;
    if output.status.success() {
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    } else {
        Err(format!(
            "{command:?}: {}",
            String::from_utf8_lossy(&output.stderr)
        ))
    }
}

/// The target directory of cargo.
pub(crate) fn target(root: &Path) -> Result<String, String> {
    let metadata = said_by(cargo(root).args(["metadata", "--format-version=1", "--no-deps"]))?;
    metadata
        .split_once("\"target_directory\":\"")
        .and_then(|(_, rest)| rest.split_once('"'))
        .map(|(target, _)| target.to_owned())
        .ok_or_else(|| "cargo metadata does not state the target directory".to_owned())
}

/// Processor, cores and compiler, as lines of a list.
pub(crate) fn machine() -> Result<String, String> {
    let cpu = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = cpu
        .lines()
        .find_map(|line| line.strip_prefix("model name\t: "));
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let compiler = said_by(Command::new("rustc").arg("--version"))?;
    let commit = said_by(Command::new("git").args(["rev-parse", "--short", "HEAD"]))?;
    Ok(format!(
        "- {}, {cores} cores\n- {}\n- commit {}\n",
        model.unwrap_or("unknown processor"),
        compiler.trim(),
        commit.trim()
    ))
}
