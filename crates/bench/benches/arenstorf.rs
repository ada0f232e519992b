//! Computes one period of the Arenstorf orbit with the explicit methods:
//! `cargo bench -p bench --bench arenstorf`.
//!
//! Before the times, the benchmark prints the number of evaluations, the error, and the total time
//! per evaluation (ns) for each argument. The benchmark asserts the errors. It does not compare
//! other libraries.

use std::hint::black_box;
use std::ops::ControlFlow;

use divan::Bencher;
use divan::counter::ItemsCount;
use integrators::{
    Dop853, Dopri5, Function, Interval, Method, Ode, Options, Outcome, Tsit5, integrate,
};

const MU: f64 = 0.012277471;
const Y0: [f64; 4] = [0.994, 0.0, 0.0, -2.001_585_106_379_082_5];
const PERIOD: f64 = 17.065_216_560_157_964;

/// Tolerances rtol = atol.
const TOLERANCES: [f64; 3] = [1e-6, 1e-9, 1e-12];

fn main() {
    divan::main();
}

fn rhs(_t: f64, y: &[f64], dy: &mut [f64]) {
    let (to_earth, to_moon) = (y[0] + MU, y[0] - (1.0 - MU));
    let s1 = to_earth * to_earth + y[1] * y[1];
    let s2 = to_moon * to_moon + y[1] * y[1];
    let (d1, d2) = ((1.0 - MU) / (s1 * s1.sqrt()), MU / (s2 * s2.sqrt()));
    dy[0] = y[2];
    dy[1] = y[3];
    dy[2] = y[0] + 2.0 * y[3] - d1 * to_earth - d2 * to_moon;
    dy[3] = y[1] - 2.0 * y[2] - d1 * y[1] - d2 * y[1];
}

fn period<O: Ode>(method: &impl Method<O>, ode: &mut O, tolerance: f64) -> Outcome {
    let interval = Interval::new(0.0, PERIOD);
    let options = Options::with_tolerance(tolerance, tolerance);
    integrate(method, ode, &interval, &Y0, &options, |_| {
        ControlFlow::Continue(())
    })
    .expect("the orbit is smooth")
}

/// The benchmark asserts `error` at the tightest tolerance. The counter counts evaluations, so the
/// items per second in the output are evaluations per second.
macro_rules! bench {
    ($name:ident, $method:expr, $error:expr) => {
        #[divan::bench(args = TOLERANCES)]
        fn $name(bencher: Bencher<'_, '_>, tolerance: f64) {
            let mut ode = Function::new(4, rhs);
            let end = period(&$method, &mut ode, tolerance);
            let error = Y0
                .iter()
                .zip(&end.y)
                .map(|(a, b)| (a - b).abs())
                .fold(0.0, f64::max);
            assert!(tolerance > 1e-12 || error < $error, "{error:e}");
            bencher
                .counter(ItemsCount::new(end.statistics.evaluations))
                .bench_local(|| period(&$method, black_box(&mut ode), tolerance));
        }
    };
}

bench!(dopri5, Dopri5, 3e-8);
bench!(tsit5, Tsit5, 3e-8);
bench!(dop853, Dop853, 2e-9);
