//! Compares all known methods for the right-hand side of the robot with its trolley in one run:
//! `cargo bench -p bench --bench right_hand_side`. Candidates alternate, so that ratios are correct
//! on a processor with changing speed. Before its time is measured, each candidate must return the
//! same accelerations (or matrices) as all other candidates.
//!
//! | arguments | action |
//! | --- | --- |
//! | no argument | times |
//! | `--instructions` | instructions per call by callgrind, with the times |
//! | `--out DIR` | times and counts, and `table.md`, `table.csv` and `table.svg` in a directory |
//! | `--repeat KEY LAPS` | only calls of one candidate, for callgrind |
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod candidates;
mod dual;
mod faer_lu;
mod figure;
mod instructions;
mod nalgebra_lu;
mod recursive;
mod robot;
mod runs;
mod saddle;
mod table;
mod timing;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use candidates::{Group, Work};
use robot::Robot;
use table::Line;

type Outcome<T> = Result<T, Box<dyn Error>>;

fn main() -> ExitCode {
    // Cargo adds the argument `--bench`.
    let arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| a != "--bench")
        .collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let done = match arguments.as_slice() {
        [] => tell(false).map(drop),
        ["--instructions"] => tell(true).map(drop),
        ["--out", directory] => report(&root().join(directory)),
        ["--repeat", key, laps] => repeat(key, laps),
        _ => Err(format!("arguments {arguments:?}: none, --instructions, or --out DIR").into()),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Returns the directory of the workspace: cargo runs benchmarks in the directory of their package.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Measures everything and prints the table.
fn tell(instructions: bool) -> Outcome<Vec<Line>> {
    let robot = Robot::moving()?;
    let mut all = candidates::all(&robot)?;
    all.extend(runs::all(&robot)?);
    let times = timing::take_turns(&mut all);
    // The number of evaluations is always printed, because it does not depend on the machine.
    let count = |work: &Work<'_>| {
        if instructions && work.group != Group::Run {
            instructions::per_lap(work.key).map(Some)
        } else {
            Ok(None)
        }
    };
    let mut lines = Vec::new();
    for (work, time) in all.iter().zip(times) {
        lines.push(Line::new(work, time, count(work)?));
    }
    println!("{}", table::text(&lines));
    Ok(lines)
}

fn report(directory: &Path) -> Outcome<()> {
    let lines = tell(true)?;
    std::fs::create_dir_all(directory)?;
    std::fs::write(directory.join("table.md"), table::page(&lines))?;
    std::fs::write(directory.join("table.csv"), table::csv(&lines))?;
    let of_group: Vec<&Line> = lines
        .iter()
        .filter(|l| l.group == Group::RightHandSide)
        .collect();
    std::fs::write(directory.join("table.svg"), figure::bars(&of_group))?;
    Ok(())
}

fn repeat(key: &str, laps: &str) -> Outcome<()> {
    let laps: usize = laps.parse()?;
    let robot = Robot::moving()?;
    let mut all = candidates::all(&robot)?;
    let work = all
        .iter_mut()
        .find(|w| w.key == key)
        .ok_or("no such candidate")?;
    for _ in 0..laps {
        (work.lap)();
    }
    Ok(())
}
