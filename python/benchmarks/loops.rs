//! The same loops as in `measure.py`, in Rust: `cargo run --release --example loops -- SCENE` in
//! `python`.

use std::time::Instant;

use pfaff::model::Registry;
use pfaff::{Overrides, Study, StudyError};

/// Times each loop is tried; the least time is told.
const TIMES: usize = 3;

/// Analyses of a loop.
const ANALYSES: usize = 1000;

#[allow(clippy::print_stdout)]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).ok_or("need a scene")?;
    let text = std::fs::read_to_string(path)?;
    let registry = Registry::standard();
    let read = || Study::read("robot.toml", &text, &registry, &Overrides::default());
    let judged = |study: &Study| {
        let start = study.analyse(0.0, None)?;
        Ok::<_, StudyError>(start.verdict("W3")?.wrench.verdict.is_unique())
    };
    let study = read()?;
    let tell = |what: &str, work: &dyn Fn() -> Result<(), StudyError>| {
        let mut least = f64::INFINITY;
        for _ in 0..TIMES {
            let begun = Instant::now();
            for _ in 0..ANALYSES {
                work()?;
            }
            least = least.min(begun.elapsed().as_secs_f64());
        }
        println!("Rust, {ANALYSES} {what}: {least:.4} s");
        Ok::<_, StudyError>(())
    };
    tell("analyses from the text", &|| {
        assert!(!judged(&read()?)?);
        Ok(())
    })?;
    tell("analyses of a scene that was read", &|| {
        assert!(!judged(&study)?);
        Ok(())
    })?;
    Ok(())
}
