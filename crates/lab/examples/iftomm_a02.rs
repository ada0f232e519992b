//! The benchmark A02 of the IFToMM/LIM library: forty four-bars in a row for twenty seconds,
//! through flat poses. Prints the largest error of the coordinates of the first upright's top over
//! 400 rows of output, and the run time, for some tolerances and methods.
//!
//! `cargo run --release -p lab --example iftomm_a02`
//!
//! The reference has one unknown, the angle θ of all uprights from the upward vertical:
//! `[(N + 1)/3 + N]·θ̈ = [(N + 1)/2 + N]·g·sin θ`, θ̇(0) = 1 rad/s.
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::ops::ControlFlow;
use std::time::Instant;

use pfaff::dynamics::{Method, MotionOptions, simulate};
use pfaff::model::Registry;
use pfaff::{RunOptions, Study};
use suite::generate::n_four_bar::acceleration;
use suite::generate::{Kind, Order};

const N: usize = 40;
const T_END: f64 = 20.0;
const ROWS: usize = 400;

/// Number of steps of the reference solution between two output rows.
const STEPS: usize = 5000;

fn main() -> Result<(), Box<dyn Error>> {
    let mut text = Vec::new();
    Order::of(Kind::NFourBar, N).generate()?.write(&mut text)?;
    let text = String::from_utf8(text)?;
    let study = Study::read("a02", &text, &Registry::standard(), &RunOptions::default())?;
    let tops = tops();
    println!("method    tolerance  largest error     time  evaluations");
    for method in [Method::Dop853, Method::Dopri5] {
        for tolerance in [1e-6, 1e-7, 1e-8, 1e-9] {
            let options = MotionOptions {
                rtol: tolerance,
                atol: tolerance,
                output_step: T_END / ROWS as f64,
                method,
                ..MotionOptions::to(T_END)
            };
            let (mut error, mut row) = (0.0_f64, 0);
            let clock = Instant::now();
            let ended = simulate(&study.prepared, &options, |sample| {
                // Angle of the first upright. The top and the foot of an upright have the same
                // distance from the centre.
                let angle = sample.q[2];
                let top = [
                    sample.q[0] + 0.5 * angle.cos(),
                    sample.q[1] + 0.5 * angle.sin(),
                ];
                for (own, other) in top.iter().zip(tops[row]) {
                    error = error.max((own - other).abs());
                }
                row += 1;
                Ok(ControlFlow::Continue(()))
            });
            let seconds = clock.elapsed().as_secs_f64();
            match ended {
                Ok(summary) => println!(
                    "{:8} {tolerance:10.0e} {error:14.1e} {seconds:7.3} s {:12}",
                    method.name(),
                    summary.evaluations
                ),
                Err(failure) => println!("{:8} {tolerance:10.0e} {}", method.name(), failure.error),
            }
        }
    }
    Ok(())
}

/// The position of the first top for all rows of output, by the classical Runge–Kutta method.
fn tops() -> Vec<[f64; 2]> {
    let h = T_END / (ROWS * STEPS) as f64;
    let f = |[angle, rate]: [f64; 2]| [rate, acceleration(N, angle)];
    let ahead = |[a, b]: [f64; 2], [da, db]: [f64; 2], h: f64| [a + h * da, b + h * db];
    let mut y = [0.0_f64, 1.0];
    let mut tops = vec![[y[0].sin(), y[0].cos()]];
    for _ in 0..ROWS {
        for _ in 0..STEPS {
            let k1 = f(y);
            let k2 = f(ahead(y, k1, 0.5 * h));
            let k3 = f(ahead(y, k2, 0.5 * h));
            let k4 = f(ahead(y, k3, h));
            for i in 0..2 {
                y[i] += h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
            }
        }
        tops.push([y[0].sin(), y[0].cos()]);
    }
    tops
}
