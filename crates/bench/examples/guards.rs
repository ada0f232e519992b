//! Measures the least time to simulate ten seconds of the robot at the default tolerances,
//! interpreted and with generated code. The 201 output rows are discarded. The command
//! `cargo xtask guards` compares this time with the time of the same program compiled without
//! monitors.
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::hint::black_box;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Instant;

use dynamics::{MotionOptions, PreparedMechanism, RowChoice, prepare, simulate};
use model::{Mechanism, StartOptions};
use robot_trolley::generated::automatic;
use tests::robot::{robot, steering};

fn main() -> Result<(), Box<dyn Error>> {
    let runs: usize = std::env::args()
        .nth(1)
        .map_or(Ok(200), |runs| runs.parse())?;
    let mechanism = Mechanism::build(&robot(steering())).map_err(|e| format!("{e:?}"))?;
    let interpreted = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic)?;
    let generated = interpreted.clone().with_code(Arc::new(automatic::Code))?;
    let only = std::env::args().nth(2);
    for (name, prepared) in [("interpreted", interpreted), ("generated", generated)] {
        if only.as_ref().is_some_and(|only| only != name) {
            continue;
        }
        let (seconds, evaluations) = least(&prepared, runs)?;
        println!("{name} {seconds:e} {evaluations}");
    }
    Ok(())
}

/// Returns the least time and the number of evaluations.
fn least(prepared: &PreparedMechanism, runs: usize) -> Result<(f64, u64), Box<dyn Error>> {
    let options = MotionOptions::to(10.0);
    let (mut least, mut evaluations) = (f64::INFINITY, 0);
    for _ in 0..runs {
        let clock = Instant::now();
        let summary = simulate(prepared, black_box(&options), |row| {
            black_box(&row.q);
            Ok(ControlFlow::Continue(()))
        })?;
        least = clock.elapsed().as_secs_f64().min(least);
        evaluations = summary.evaluations as u64;
    }
    Ok((least, evaluations))
}
