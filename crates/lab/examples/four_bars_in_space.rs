//! Spatial four-bars in a row: each four-bar stands on the coupler of the previous four-bar. Prints
//! the time for all verdicts on one thread (s), the exponent of this time in the number of
//! four-bars, and the memory of the process.
//!
//! `cargo run --release -p lab --example four_bars_in_space -- 1000 3000 10000`
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::time::Instant;

use lab::fuzz::space::text::Precision;
use lab::fuzz::space::{catalogue, description};
use model::{Mechanism, System};
use solvability::{Analysis, analyse};

/// Runs of each size; the fastest counts.
const RUNS: usize = 3;

fn main() -> Result<(), Box<dyn Error>> {
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    println!(
        "four-bars     rows   rank     p  build (s)  verdicts (s)  exponent  most memory (MB)"
    );
    let mut before: Option<(f64, f64)> = None;
    for n in std::env::args().skip(1) {
        let n: usize = n.parse()?;
        let description = description(&catalogue::four_bars_in_a_row(n), &Precision::default())?;
        let clock = Instant::now();
        let mechanism = Mechanism::build(&description).map_err(|faults| format!("{faults:?}"))?;
        let built = clock.elapsed().as_secs_f64();
        drop(description);
        let (q, _) = mechanism.described_state();
        let mut seconds = f64::INFINITY;
        for _ in 0..RUNS {
            let clock = Instant::now();
            let found = one.install(|| analyse(&mechanism, 0.0, &q))?;
            seconds = seconds.min(clock.elapsed().as_secs_f64());
            check(&found, n)?;
        }
        let size = n as f64;
        let exponent = before.map_or(f64::NAN, |(n, s)| (seconds / s).ln() / (size / n).ln());
        before = Some((size, seconds));
        let memory = memory().unwrap_or(f64::NAN);
        println!(
            "{n:9} {:8} {:6} {:5} {built:10.2} {seconds:13.3} {exponent:9.2} {memory:17.0}",
            mechanism.layout().rows(),
            17 * n,
            3 * n
        );
    }
    Ok(())
}

/// The result by theory: each four-bar has three redundant rows and one degree of freedom, and only
/// the forces in the plane of the four-bar are unique.
fn check(found: &Analysis, n: usize) -> Result<(), String> {
    let unique = |r: &&solvability::ReactionVerdict| r.wrench.verdict.is_unique();
    let unique = found.reactions.iter().filter(unique).count();
    let counts = [
        found.decision.rank,
        found.decision.redundancy,
        found.mobility(),
        unique,
    ];
    if counts != [17 * n, 3 * n, n, 0] {
        return Err(format!("{n}: {counts:?}"));
    }
    Ok(())
}

/// Largest memory that the process has used (MB), if the system reports this number.
fn memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kilobytes: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes / 1e3)
}
