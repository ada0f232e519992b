//! The platforms that the command supports. It is type-checked for each platform whose standard
//! library can be installed. No program is linked or run for a platform other than the present
//! machine.

use std::process::Command;

use crate::tree::{cargo, root, run, said_by};

/// A target of the compiler, and the system of this target.
pub(crate) const PLATFORMS: [(&str, &str); 4] = [
    ("x86_64-unknown-linux-gnu", "Linux"),
    ("x86_64-pc-windows-gnu", "Windows"),
    ("x86_64-apple-darwin", "macOS"),
    ("aarch64-apple-darwin", "macOS"),
];

/// Systems that are checked when the third-party crates change, each with one processor. Code
/// compiled for macOS on x86-64 depends either on macOS or on this processor; no code depends on
/// the combination.
const ALL: [&str; 3] = [
    "x86_64-unknown-linux-gnu",
    "x86_64-pc-windows-gnu",
    "aarch64-apple-darwin",
];

/// This target represents every system except Linux in the check of each change. The sources of
/// this workspace only distinguish Linux from other systems, so only third-party crates can differ.
/// A test of `house` checks this property of the sources.
const OTHER: [&str; 1] = ["x86_64-pc-windows-gnu"];

/// Type-checks the command for a system that is not Linux.
pub(crate) fn check() -> Result<String, String> {
    check_for(&OTHER)
}

/// Type-checks the command for all systems.
pub(crate) fn check_all() -> Result<String, String> {
    check_for(&ALL)
}

/// Type-checks the command for all of these systems whose standard libraries are installed or can
/// be installed. The names of skipped systems are printed. One cargo command checks all systems, so
/// that the compilations for different systems overlap.
fn check_for(targets: &[&str]) -> Result<String, String> {
    let own = said_by(Command::new("rustc").args(["--print", "host-tuple"]))?;
    let mut lines = Vec::new();
    let mut arguments = vec!["check", "--locked", "-p", "pfaff-cli"];
    for &target in targets.iter().filter(|&&target| target != own.trim()) {
        match install(target) {
            Ok(()) => {
                arguments.extend(["--target", target]);
                lines.push(format!("{target}: checked"));
            }
            Err(reason) => lines.push(format!("{target}: skipped: {reason}")),
        }
    }
    if arguments.contains(&"--target") {
        run(cargo(&root()).args(arguments))?;
    }
    Ok(lines.join("\n"))
}

/// Installs the standard library of a target if it is missing.
pub(crate) fn install(target: &str) -> Result<(), String> {
    let folder =
        said_by(Command::new("rustc").args(["--print", "target-libdir", "--target", target]))?;
    if std::path::Path::new(folder.trim()).is_dir() {
        return Ok(());
    }
    let added = said_by(Command::new("rustup").args(["target", "add", target]));
    added.map(drop).map_err(|said| {
        let last = said.lines().rev().find(|line| !line.trim().is_empty());
        format!(
            "rustup cannot install it: {}",
            last.unwrap_or_default().trim()
        )
    })
}
