//! The machine and the versions of a measurement.

use std::process::Command;

const LOCK: &str = include_str!("../Cargo.lock");

/// Processor, cores, compiler, commit and versions as a list.
pub fn describe() -> String {
    let cpu = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = cpu
        .lines()
        .find_map(|line| line.strip_prefix("model name\t: "));
    let cores = std::thread::available_parallelism().map_or(0, usize::from);
    let mut out = format!(
        "- {} ({cores} cores used by others too; one thread measured by its own time)\n- {}\n- commit {}\n",
        model.unwrap_or("unknown processor"),
        said_by("rustc", &["--version"]),
        said_by("git", &["rev-parse", "--short", "HEAD"]),
    );
    for name in ["differential-equations", "diffsol", "nalgebra"] {
        let version = version(name).unwrap_or("unknown");
        out += &format!("- {name} {version}\n");
    }
    out
}

fn said_by(program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).output();
    let text = output.map(|o| String::from_utf8_lossy(&o.stdout).trim().to_owned());
    text.unwrap_or_else(|_| format!("{program} unknown"))
}

/// The version of a package from the lock file.
fn version(name: &str) -> Option<&'static str> {
    let package = LOCK
        .split("[[package]]")
        .find(|p| p.contains(&format!("\nname = \"{name}\"\n")))?;
    package
        .lines()
        .find_map(|line| line.strip_prefix("version = "))
        .map(|version| version.trim_matches('"'))
}
