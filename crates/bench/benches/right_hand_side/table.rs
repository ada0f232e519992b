//! The results as text, as a page, and as CSV.

use std::fmt::Write;
use std::process::Command;

use pfaff::work_precision::provenance;

use crate::candidates::{Group, Work};
use crate::timing::{ROUNDS, Time};

/// One line of the table.
pub(crate) struct Line {
    key: &'static str,
    /// Description of the candidate, with Markdown markup.
    pub(crate) title: String,
    /// The table to which the line belongs.
    pub(crate) group: Group,
    /// Time of one call.
    pub(crate) time: Time,
    /// Instructions of one call, if they were counted.
    pub(crate) instructions: Option<u64>,
}

impl Line {
    /// Creates the line of a measured candidate. `instructions` is the number of instructions of
    /// one lap.
    pub(crate) fn new(work: &Work<'_>, time: Time, instructions: Option<u64>) -> Self {
        Self {
            key: work.key,
            title: work.title.clone(),
            group: work.group,
            time,
            instructions: instructions.map(|n| n / work.calls as u64),
        }
    }

    /// Whether the candidate is code of this project. The other candidates are compared with code
    /// of this project.
    pub(crate) fn is_ours(&self) -> bool {
        self.title.starts_with("**")
    }

    /// The title without markup.
    pub(crate) fn plain_title(&self) -> &str {
        self.title.trim_matches('*')
    }
}

/// Formats a time with three digits and its unit.
pub(crate) fn duration(seconds: f64) -> String {
    let (value, unit) = match seconds {
        s if s < 1e-6 => (s * 1e9, "ns"),
        s if s < 1e-3 => (s * 1e6, "µs"),
        s => (s * 1e3, "ms"),
    };
    let digits = if value < 10.0 {
        2
    } else if value < 100.0 {
        1
    } else {
        0
    };
    format!("{value:.digits$} {unit}")
}

/// Returns all tables.
pub(crate) fn text(lines: &[Line]) -> String {
    let mut out = String::new();
    for group in Group::ALL {
        let of_group: Vec<&Line> = lines.iter().filter(|l| l.group == group).collect();
        let ours = of_group.iter().copied().find(|l| l.is_ours());
        // Writing to a string cannot fail.
        let _ = writeln!(out, "## {}\n", group.title());
        out += "| what | time | ÷ ours | instructions | ÷ ours |\n| --- | ---: | ---: | ---: | ---: |\n";
        for line in &of_group {
            let share = |value: f64, of: Option<f64>| {
                of.map_or(String::new(), |of| format!("{:.2}", value / of))
            };
            let count = line.instructions.map_or(String::new(), |n| n.to_string());
            let counts = |l: &Line| l.instructions.map(|n| n as f64);
            let _ = writeln!(
                out,
                "| {} | {} | {} | {count} | {} |",
                line.title,
                duration(line.time.least),
                share(line.time.least, ours.map(|o| o.time.least)),
                counts(line).map_or(String::new(), |n| share(n, ours.and_then(counts))),
            );
        }
        out.push('\n');
    }
    out
}

/// Returns the tables and a description of the machine.
pub(crate) fn page(lines: &[Line]) -> String {
    let versions = ["faer", "nalgebra", "num-dual"].map(|name| format!("{name} {}", version(name)));
    format!(
        "# Tables\n\nWritten by `cargo xtask right-hand-side`. What they mean: [README](README.md).\n\n- {}\n- {}, profile `bench`, no flags; least of {ROUNDS} rounds in turns\n- {}\n- {}, commit {}\n\n{}",
        provenance::machine(),
        said_by("rustc", &["--version"]),
        versions.join(", "),
        provenance::date(),
        said_by("git", &["rev-parse", "--short", "HEAD"]),
        text(lines).trim_end(),
    ) + "\n"
}

/// Returns one line per candidate, with all digits.
pub(crate) fn csv(lines: &[Line]) -> String {
    let mut out = String::from("key,title,seconds,seconds_median,instructions\n");
    for line in lines {
        let Time { median, least } = line.time;
        let count = line.instructions.map_or(String::new(), |n| n.to_string());
        let _ = writeln!(
            out,
            "{},\"{}\",{least:e},{median:e},{count}",
            line.key,
            line.plain_title()
        );
    }
    out
}

fn said_by(program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).output();
    let text = output.map(|o| String::from_utf8_lossy(&o.stdout).trim().to_owned());
    text.unwrap_or_else(|_| format!("{program} unknown"))
}

/// The version of a dependency from the lock file.
fn version(name: &str) -> &'static str {
    const LOCK: &str = include_str!("../../../../Cargo.lock");
    let package = LOCK
        .split("[[package]]")
        .find(|p| p.contains(&format!("\nname = \"{name}\"\n")));
    let line = package.and_then(|p| p.lines().find_map(|l| l.strip_prefix("version = ")));
    line.map_or("unknown", |version| version.trim_matches('"'))
}
