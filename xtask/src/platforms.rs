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

/// Type-checks the command for each platform other than that of this machine, if its standard
/// library is there or can be installed; the others are skipped by name.
pub(crate) fn check() -> Result<String, String> {
    let own = said_by(Command::new("rustc").args(["--print", "host-tuple"]))?;
    let mut lines = Vec::new();
    for (target, _) in PLATFORMS {
        if target == own.trim() {
            continue;
        }
        lines.push(match install(target) {
            Ok(()) => {
                let arguments = ["check", "--locked", "-p", "pfaff-cli", "--target", target];
                run(cargo(&root()).args(arguments))?;
                format!("{target}: checked")
            }
            Err(reason) => format!("{target}: skipped: {reason}"),
        });
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
