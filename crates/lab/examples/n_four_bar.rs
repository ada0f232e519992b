//! Chains of four-bars pass through flat poses, at which branches of the motion meet. Prints the
//! run time for a given error, and the number of runs out of sixteen that stay on one branch.
//!
//! `cargo run --release -p lab --example n_four_bar -- 1 16 64`
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::ops::ControlFlow;
use std::time::Instant;

use pfaff::model::Registry;
use pfaff::{RunOptions, Study};
use suite::generate::n_four_bar::acceleration;
use suite::generate::{Kind, Order};

/// End time (s), and number of steps of the reference solution.
const T_END: f64 = 5.0;
const STEPS: u32 = 2_000_000;

/// Number of runs of each size, and the range of the tolerances of these runs.
const RUNS: u32 = 16;
const SPREAD: f64 = 0.15;

/// Tolerances that are tried until all runs have this error (m). Loose tolerances are tried first.
const TOLERANCES: [f64; 5] = [1e-6, 5e-7, 2.5e-7, 1e-7, 1e-8];
const ERROR: f64 = 1e-5;

fn main() -> Result<(), Box<dyn Error>> {
    println!("     N     rows  tolerance  least time      worst  right of {RUNS}  largest error");
    for n in std::env::args().skip(1) {
        let n: usize = n.parse()?;
        let [x, y] = tip(n);
        let order = Order::of(Kind::NFourBar, n).generate()?;
        let mut text = Vec::new();
        order.write(&mut text)?;
        let text = String::from_utf8(text)?;
        for tolerance in TOLERANCES {
            let (mut least, mut worst, mut right, mut error) = (f64::INFINITY, 0.0_f64, 0, 0.0_f64);
            let mut rows = 0;
            for run in 0..RUNS {
                let share = f64::from(run) / f64::from(RUNS - 1) - 0.5;
                let rtol = tolerance * (1.0 + 2.0 * SPREAD * share);
                let overrides = RunOptions {
                    rtol: Some(rtol),
                    atol: Some(rtol),
                    t_end: Some(T_END),
                    ..RunOptions::default()
                };
                let study = Study::read("n-four-bar", &text, &Registry::standard(), &overrides)?;
                rows = study.prepared.decision.rank;
                let mut options = study.options.clone().ok_or("no end")?;
                options.output_step = T_END;
                // Index of the last upright. The top and the foot of an upright have the same
                // distance from the centre.
                let upright = 3 * n;
                let mut miss = f64::INFINITY;
                let clock = Instant::now();
                let ended = pfaff::dynamics::simulate(&study.prepared, &options, |row| {
                    let angle = row.q[upright + 2];
                    let top = [
                        row.q[upright] + 0.5 * angle.cos(),
                        row.q[upright + 1] + 0.5 * angle.sin(),
                    ];
                    miss = (top[0] - n as f64 - x).hypot(top[1] - y);
                    Ok(ControlFlow::Continue(()))
                });
                let seconds = clock.elapsed().as_secs_f64();
                least = least.min(seconds);
                worst = worst.max(seconds);
                if ended.is_ok() {
                    error = error.max(miss);
                    right += u32::from(miss < 0.1);
                }
            }
            println!(
                "{n:6} {rows:8} {tolerance:10.0e} {:8.2} ms {:8.2} ms {right:12}  {error:13.1e}",
                1e3 * least,
                1e3 * worst
            );
            if right == RUNS && error <= ERROR {
                break;
            }
        }
    }
    Ok(())
}

/// The final position of the top of an upright relative to its foot: the angle from the upward
/// vertical, by the classical Runge–Kutta method.
fn tip(n: usize) -> [f64; 2] {
    let h = T_END / f64::from(STEPS);
    let f = |[angle, rate]: [f64; 2]| [rate, acceleration(n, angle)];
    let ahead = |[a, b]: [f64; 2], [da, db]: [f64; 2], h: f64| [a + h * da, b + h * db];
    let mut y = [0.0, 1.0];
    for _ in 0..STEPS {
        let k1 = f(y);
        let k2 = f(ahead(y, k1, 0.5 * h));
        let k3 = f(ahead(y, k2, 0.5 * h));
        let k4 = f(ahead(y, k3, h));
        for i in 0..2 {
            y[i] += h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
        }
    }
    [y[0].sin(), y[0].cos()]
}
