//! Observed orders over halved steps, and symmetries of the formulas.

use crate::problems::{
    Plain, distance, fixed_step, kepler, modulated, observed_orders, plain, run_function,
};
use pfaff_integrators::{Dop853, Dopri5, Interval, Method, Options, Tsit5, integrate};
use std::ops::ControlFlow;

/// Observed orders differ from the exact one by the next term of the error, by some percent at
/// these steps.
const ORDER_TOLERANCE: f64 = 0.2;

fn assert_order(name: &str, errors: &[f64], claimed: f64) {
    let orders = observed_orders(errors);
    assert!(
        orders.iter().all(|p| (p - claimed).abs() < ORDER_TOLERANCE),
        "{name}: errors {errors:?}, orders {orders:?}, claimed {claimed}"
    );
}

/// Returns the solution of [`modulated`].
fn exact(t: f64) -> f64 {
    t.sin().exp()
}

/// Largest errors over all steps: at the ends of the steps, and of both dense outputs at nine
/// points inside.
struct Errors {
    ends: f64,
    cheap: f64,
    accurate: f64,
}

fn largest_errors(
    method: &impl Method<Plain>,
    t0: f64,
    t_end: f64,
    n: u32,
    output_evaluations: u64,
) -> Errors {
    let mut ode = plain(1, modulated);
    let mut errors = Errors {
        ends: 0.0,
        cheap: 0.0,
        accurate: 0.0,
    };
    let mut y = [0.0];
    let options = fixed_step((t_end - t0) / f64::from(n));
    let interval = Interval::new(t0, t_end);
    let end = integrate(
        method,
        &mut ode,
        &interval,
        &[exact(t0)],
        &options,
        |step| {
            let error = |t: f64, y: &[f64]| (y[0] - exact(t)).abs();
            errors.ends = errors.ends.max(error(step.t1(), step.y1()));
            for i in 1..10 {
                let t = step.t0() + f64::from(i) / 10.0 * (step.t1() - step.t0());
                step.interpolate(t, &mut y).expect("t is inside");
                errors.cheap = errors.cheap.max(error(t, &y));
                step.interpolate_accurately(t, &mut y).expect("t is inside");
                errors.accurate = errors.accurate.max(error(t, &y));
            }
            ControlFlow::Continue(())
        },
    )
    .expect("smooth problem");
    let s = end.statistics;
    assert_eq!(s.accepted, u64::from(n));
    // The number of evaluations is the same in every step, for any number of requested times.
    assert_eq!(s.output_evaluations, output_evaluations * u64::from(n));
    errors
}

/// Returns the errors from 0 to 10 with n and 2n steps.
fn halved(method: &impl Method<Plain>, n: u32, output_evaluations: u64) -> [Errors; 2] {
    [n, 2 * n].map(|n| largest_errors(method, 0.0, 10.0, n, output_evaluations))
}

/// The output without extra evaluations has order 5, like the steps. Inside a step its local error
/// is O(h⁵); at the ends, the local errors O(h⁶) of all steps add up to O(h⁵).
#[test]
fn pairs_and_both_dense_outputs_converge_with_order_five() {
    for (name, errors) in [
        ("dopri5", halved(&Dopri5, 250, 2)),
        ("tsit5", halved(&Tsit5, 250, 2)),
    ] {
        assert_order(name, &errors.each_ref().map(|e| e.ends), 5.0);
        assert_order(name, &errors.each_ref().map(|e| e.cheap), 5.0);
        assert_order(name, &errors.each_ref().map(|e| e.accurate), 5.0);
        // The accurate output adds almost no error (the largest error is between two ends); the
        // other output is less accurate.
        for e in &errors {
            assert!(
                e.accurate < 1.1 * e.ends,
                "{name}: {:e} {:e}",
                e.accurate,
                e.ends
            );
            assert!(e.cheap > 2.0 * e.accurate, "{name}: {:e}", e.cheap);
        }
    }
}

/// The local error of order 7 of the output without extra evaluations leads to a global error of
/// order 7. The accurate output is as good as the ends.
#[test]
fn dop853_and_its_accurate_output_converge_with_order_eight_and_the_cheap_one_with_seven() {
    let errors = halved(&Dop853, 35, 6);
    assert_order("ends", &errors.each_ref().map(|e| e.ends), 8.0);
    assert_order("cheap", &errors.each_ref().map(|e| e.cheap), 7.0);
    assert_order("accurate", &errors.each_ref().map(|e| e.accurate), 8.0);
    for e in &errors {
        assert!(e.accurate < 1.1 * e.ends, "{:e} {:e}", e.accurate, e.ends);
    }
}

/// Returns the errors inside one step from an exact state, over a step and its half.
fn one_step(method: &impl Method<Plain>, h: f64, output_evaluations: u64) -> [Errors; 2] {
    [h, 0.5 * h].map(|h| largest_errors(method, 1.0, 1.0 + h, 1, output_evaluations))
}

#[test]
fn dense_outputs_have_the_local_orders_they_claim() {
    for (name, errors, cheap, accurate) in [
        ("dopri5", one_step(&Dopri5, 0.1, 2), 5.0, 6.0),
        ("tsit5", one_step(&Tsit5, 0.1, 2), 5.0, 6.0),
        ("dop853", one_step(&Dop853, 0.4, 6), 7.0, 9.0),
    ] {
        assert_order(name, &errors.each_ref().map(|e| e.cheap), cheap);
        assert_order(name, &errors.each_ref().map(|e| e.accurate), accurate);
    }
}

/// A rotation of the initial state rotates the solution: the formulas are linear in y and f.
#[test]
fn constant_steps_commute_with_rotation() {
    const ROUNDING: f64 = 1e-13;
    let rotate = |y: &[f64]| {
        let (s, c) = 0.7_f64.sin_cos();
        [
            c * y[0] - s * y[1],
            s * y[0] + c * y[1],
            c * y[2] - s * y[3],
            s * y[2] + c * y[3],
        ]
    };
    let y0 = [1.0, 0.0, 0.0, 1.1];
    let run = |y0: &[f64]| run_function(kepler, (0.0, 2.0), y0, &fixed_step(0.05)).y;
    assert!(distance(&rotate(&run(&y0)), &run(&rotate(&y0))) < ROUNDING);
}

#[test]
fn backwards_returns_to_the_start() {
    let options = Options::with_tolerance(1e-10, 1e-10);
    let y0 = [1.0, 0.0, 0.0, 1.1];
    let there = run_function(kepler, (0.0, 5.0), &y0, &options);
    let back = run_function(kepler, (5.0, 0.0), &there.y, &options);
    assert_eq!(back.t, 0.0);
    // There are some hundred steps, each with a local error of at most 1e-10, and errors grow
    // linearly with time.
    assert!(distance(&back.y, &y0) < 1e-7, "{:?}", back.y);
    assert!(back.statistics.accepted > 20);
}
