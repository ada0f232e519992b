//! The platforms that the command supports, type-checked where their standard library can be
//! installed. Nothing is linked or run for another platform than that of the machine.

use std::process::Command;

use crate::tree::{cargo, root, run, said_by};

/// A target of the compiler, and the system that it belongs to.
pub(crate) const PLATFORMS: [(&str, &str); 4] = [
    ("x86_64-unknown-linux-gnu", "Linux"),
    ("x86_64-pc-windows-gnu", "Windows"),
    ("x86_64-apple-darwin", "macOS"),
    ("aarch64-apple-darwin", "macOS"),
];

/// Systems that are checked when the crates of others change, each with one processor. What is
/// compiled for macOS on x86-64 is either for macOS or for this processor; nothing asks for both.
const ALL: [&str; 3] = [
    "x86_64-unknown-linux-gnu",
    "x86_64-pc-windows-gnu",
    "aarch64-apple-darwin",
];

/// Stands for every system but Linux at each change: sources of this workspace tell Linux from
/// others and nothing else, which a test of `house` holds, so only crates of others can differ.
const OTHER: [&str; 1] = ["x86_64-pc-windows-gnu"];

/// Type-checks the command for a system that is not Linux.
pub(crate) fn check() -> Result<String, String> {
    check_for(&OTHER)
}

/// Type-checks it for all systems.
pub(crate) fn check_all() -> Result<String, String> {
    check_for(&ALL)
}

/// Type-checks the command for those of other systems than this one whose standard libraries are
/// there or can be installed; the others are skipped by name. All in one command: it waits for one
/// crate of a system with crates of another.
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

/// Sees to it that the standard library of a target is there.
fn install(target: &str) -> Result<(), String> {
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
