//! Measures the cost of the monitors of a run. The robot is simulated with monitors, and by a
//! program compiled without them (`--cfg pfaff_unguarded`). Both programs run alternately, and the
//! smallest time of each is used. In addition, callgrind counts the instructions of one run.

use std::fmt::Write;
use std::process::Command;

use crate::tree::{cargo, root, run, said_by, target};

/// Number of alternations of the two programs, and number of runs of each program per alternation.
const TURNS: usize = 12;
const RUNS: &str = "60";

/// Number of runs whose instructions are counted. The instructions of a single run are subtracted,
/// and the difference is divided by the number of runs minus one.
const COUNTED: u64 = 4;

/// Times and instructions of interpreted and generated runs, with and without monitors.
pub(crate) fn tell() -> Result<String, String> {
    let root = root();
    let target = target(&root)?;
    let build = ["build", "--release", "-p", "bench", "--example", "guards"];
    run(cargo(&root).args(build))?;
    let bare = format!("{target}/unguarded");
    let flags = "--cfg pfaff_unguarded";
    run(cargo(&root)
        .args(build)
        .args(["--target-dir", &bare])
        .env("RUSTFLAGS", flags))?;
    let programs = [target, bare].map(|folder| format!("{folder}/release/examples/guards"));

    let mut least = [[f64::INFINITY; 2]; 2];
    let mut evaluations = [
        [String::new(), String::new()],
        [String::new(), String::new()],
    ];
    for _ in 0..TURNS {
        for (p, program) in programs.iter().enumerate() {
            let said = said_by(Command::new(program).arg(RUNS))?;
            for (way, line) in said.lines().take(2).enumerate() {
                let words: Vec<&str> = line.split_whitespace().collect();
                let seconds = words.get(1).and_then(|s| s.parse().ok());
                let seconds: f64 = seconds.ok_or_else(|| format!("{program}: {said}"))?;
                least[p][way] = least[p][way].min(seconds);
                evaluations[p][way] = words.get(2).unwrap_or(&"").to_string();
            }
        }
    }
    let mut text = String::from(
        "run             monitors     without    share   instructions      without    share  evaluations\n",
    );
    for (way, name) in ["interpreted", "generated"].iter().enumerate() {
        let [with, without] = [least[0][way], least[1][way]];
        let counts = [
            instructions(&programs[0], name)?,
            instructions(&programs[1], name)?,
        ];
        writeln!(
            text,
            "{name:<13}{:>8.3} ms{:>9.3} ms{:>+7.1} %{:>15}{:>13}{:>+7.1} %  {} / {}",
            with * 1e3,
            without * 1e3,
            100.0 * (with / without - 1.0),
            counts[0],
            counts[1],
            100.0 * (counts[0] as f64 / counts[1] as f64 - 1.0),
            evaluations[0][way],
            evaluations[1][way],
        )
        .map_err(|e| e.to_string())?;
    }
    Ok(text)
}

/// Instructions of one run, interpreted or with generated code.
fn instructions(program: &str, way: &str) -> Result<u64, String> {
    let collected = |runs: u64| -> Result<u64, String> {
        let output = Command::new("valgrind")
            .args([
                "--tool=callgrind",
                "--callgrind-out-file=/dev/null",
                program,
            ])
            .args([&runs.to_string(), way])
            .output()
            .map_err(|e| format!("instructions need valgrind on the path: {e}"))?;
        let said = String::from_utf8_lossy(&output.stderr);
        said.lines()
            .find_map(|line| line.split_once("Collected : "))
            .and_then(|(_, count)| count.trim().parse().ok())
            .ok_or_else(|| format!("callgrind on {program}: {}", said.trim()))
    };
    Ok((collected(COUNTED)? - collected(1)?) / (COUNTED - 1))
}
