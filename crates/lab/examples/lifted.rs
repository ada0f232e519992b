//! Compares planar scenes with the same scenes lifted into space: the time of a run in both spaces,
//! and the distance between the bodies at the end of the run.
//!
//! Scenes with a joint that cannot be lifted are omitted, and forces are removed from both models.
//!
//! `cargo run --release -p lab --example lifted -- examples/four-bar.toml examples/truck.toml`
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::fs;
use std::ops::ControlFlow;
use std::time::Instant;

use dynamics::{MotionOptions, RowChoice, prepare, simulate};
use lab::fuzz::space::lifted::{Lifted, lift};
use model::{AnyDescription, Mechanism, Registry, StartOptions};
use pfaff::AssembledScene;

/// Runs of each scene; the fastest counts.
const RUNS: usize = 5;

/// Time at the end of each run (s).
const T_END: f64 = 1.0;

/// Relative and absolute tolerance of each run.
const TOLERANCE: f64 = 1e-9;

fn main() -> Result<(), Box<dyn Error>> {
    println!("   plane (ms)   space (ms)   ratio   apart (m)  scene");
    let mut largest: f64 = 0.0;
    for file in std::env::args().skip(1) {
        let text = fs::read_to_string(&file)?;
        let read = AssembledScene::read(&file, &text, &Registry::standard());
        let scene = read.map_err(|e| e.to_string())?.scene;
        let AnyDescription::Plane(description) = &scene.description else {
            continue;
        };
        let lifted = lift(description, &scene.start)?;
        if !lifted.left_out.is_empty() || lifted.plane.joints.is_empty() {
            continue;
        }
        match both(&lifted) {
            Ok([(plane, here), (space, there)]) => {
                largest = largest.max(space / plane);
                println!(
                    "{:13.3}{:13.3}{:8.2}{:12.1e}  {file}",
                    1e3 * plane,
                    1e3 * space,
                    space / plane,
                    apart(&here, &there)
                );
            }
            Err(e) => println!("{file}: {e}"),
        }
    }
    println!("largest ratio {largest:.2}");
    Ok(())
}

/// The shortest time of a run (s) and the configuration at its end, in the plane and in space.
fn both(lifted: &Lifted) -> Result<[(f64, Vec<f64>); 2], String> {
    let plane = Mechanism::build(&lifted.plane).map_err(|faults| format!("{faults:?}"))?;
    let space = Mechanism::build(&lifted.space).map_err(|faults| format!("{faults:?}"))?;
    Ok([run(plane)?, run(space)?])
}

fn run(mechanism: Mechanism) -> Result<(f64, Vec<f64>), String> {
    let start = StartOptions::default();
    let prepared = prepare(mechanism, &start, &RowChoice::Automatic).map_err(|e| e.to_string())?;
    let mut options = MotionOptions::to(T_END);
    (options.rtol, options.atol) = (TOLERANCE, TOLERANCE);
    let (mut seconds, mut end) = (f64::INFINITY, Vec::new());
    for _ in 0..RUNS {
        let clock = Instant::now();
        let outcome = simulate(&prepared, &options, |sample| {
            end = sample.q.to_vec();
            Ok(ControlFlow::Continue(()))
        });
        outcome.map_err(|failure| failure.to_string())?;
        seconds = seconds.min(clock.elapsed().as_secs_f64());
    }
    Ok((seconds, end))
}

/// The largest distance between the two positions of a centre of mass (m). A body has three
/// coordinates in the plane and seven in space; the position comes first.
fn apart(plane: &[f64], space: &[f64]) -> f64 {
    let bodies = plane.chunks_exact(3).zip(space.chunks_exact(7));
    let distances = bodies.map(|(p, s)| (p[0] - s[0]).hypot(p[1] - s[1]).hypot(s[2]));
    distances.fold(0.0, f64::max)
}
