//! Run times of the commands from a cold start, including the start of the process. The scene is
//! the robot with its trolley, and the build is optimised.

use std::fmt::Write;
use std::process::{Command, Stdio};
use std::time::Instant;

use crate::tree::{cargo, root, run, target};

/// Number of runs of each command.
const RUNS: usize = 50;

const SCENE: &str = "crates/robot-trolley/robot-trolley.toml";

/// Smallest and median time of each command.
pub(crate) fn tell() -> Result<String, String> {
    let root = root();
    run(cargo(&root).args(["build", "--release", "-p", "pfaff-cli"]))?;
    let target = target(&root)?;
    let program = format!("{target}/release/pfaff");
    let out = format!("{target}/cold-start");
    let commands: [(&str, &[&str]); 5] = [
        ("nothing: --version", &["--version"]),
        ("check", &["check", SCENE]),
        ("analyze", &["analyze", SCENE]),
        ("analyze --json", &["analyze", SCENE, "--json"]),
        ("simulate, 10 s", &["simulate", SCENE, "--out", &out]),
    ];
    let mut text = format!("{:<22}{:>12}{:>12}\n", "command", "least", "median");
    for (name, arguments) in commands {
        let mut command = Command::new(&program);
        command.args(arguments).current_dir(&root);
        let mut times = Vec::with_capacity(RUNS);
        for _ in 0..RUNS {
            let clock = Instant::now();
            run(command.stdout(Stdio::null()).stderr(Stdio::null()))?;
            times.push(clock.elapsed().as_secs_f64() * 1e3);
        }
        times.sort_by(f64::total_cmp);
        writeln!(
            text,
            "{name:<22}{:>9.2} ms{:>9.2} ms",
            times[0],
            times[RUNS / 2]
        )
        .map_err(|e| e.to_string())?;
    }
    Ok(text)
}
