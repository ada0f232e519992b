//! How long a scene file takes to read and to build, and how much memory it needs:
//!
//! ```text
//! cargo run --release -p lab -- generate parallelograms --n 9000 --out chain.toml
//! cargo run --release -p pfaff-scene --example reading -- chain.toml
//! ```

#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "an example is a binary"
)]

use std::process::ExitCode;
use std::time::Instant;

use model::start::{assemble, consistent_velocity};
use model::{Registry, System};

fn main() -> ExitCode {
    let Some(path) = std::env::args().nth(1) else {
        eprintln!("give a scene file");
        return ExitCode::from(2);
    };
    let text = match std::fs::read_to_string(&path) {
        Ok(text) => text,
        Err(e) => {
            eprintln!("cannot read `{path}`: {e}");
            return ExitCode::from(2);
        }
    };
    println!(
        "{:>9.1} MB of text, {} in memory",
        text.len() as f64 / 1e6,
        peak()
    );
    let begin = Instant::now();
    let read = pfaff_scene::read_and_build(&path, &text, &Registry::standard());
    said("pfaff_scene::read_and_build", begin);
    let (scene, mut mechanism) = match read {
        Ok(read) => read,
        Err(problems) => {
            println!("{} problems, the first:", problems.len());
            println!("{}", problems[0]);
            return ExitCode::from(2);
        }
    };
    let begin = Instant::now();
    let assembly = assemble(&mut mechanism, &scene.start);
    said("start::assemble", begin);
    let assembly = match assembly {
        Ok(assembly) => assembly,
        Err(e) => {
            println!("{e}");
            return ExitCode::FAILURE;
        }
    };
    let begin = Instant::now();
    let rows: Vec<usize> = (0..mechanism.layout().rows()).collect();
    let given = mechanism.frames().given_velocities(&assembly.q);
    let v = consistent_velocity(&mechanism, &scene.start, &assembly.q, &given, &rows);
    said("start::consistent_velocity", begin);
    if let Err(e) = v {
        println!("{e}");
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}

fn said(what: &str, begin: Instant) {
    let seconds = begin.elapsed().as_secs_f64();
    println!("{seconds:>9.3} s  {what}, {} in memory at most", peak());
}

/// The largest memory so far, if the operating system reports it.
fn peak() -> String {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.map_or_else(|| "?".to_owned(), |line| line.trim().to_owned())
}
