//! Observed orders over halved steps, and symmetries of the formulas.

use crate::problems::{
    distance, fixed_step, kepler, modulated, observed_orders, oscillator, run_function,
};
use integrators::{Dopri5, Function, Interval, Options, integrate};
use std::ops::ControlFlow;

/// Observed orders scatter by the next term of the error, a few per cent at these steps.
const ORDER_TOLERANCE: f64 = 0.25;
const STEPS: [u32; 4] = [32, 64, 128, 256];
const T_END: f64 = 4.0;

fn assert_order(name: &str, errors: &[f64], claimed: f64) {
    let orders = observed_orders(errors);
    assert!(
        orders.iter().all(|p| (p - claimed).abs() < ORDER_TOLERANCE),
        "{name}: errors {errors:?}, orders {orders:?}, claimed {claimed}"
    );
}

/// Largest errors over all steps: at the ends of the steps, and at nine places inside with both dense outputs.
struct Errors {
    ends: f64,
    cheap: f64,
    accurate: f64,
}

fn largest_errors(n: u32) -> Errors {
    let mut ode = Function::new(1, modulated);
    let mut errors = Errors {
        ends: 0.0,
        cheap: 0.0,
        accurate: 0.0,
    };
    let mut y = [0.0];
    let options = fixed_step(T_END / f64::from(n));
    let interval = Interval::new(0.0, T_END);
    let end = integrate(&Dopri5, &mut ode, &interval, &[1.0], &options, |step| {
        let error = |t: f64, y: f64| (y - t.sin().exp()).abs();
        errors.ends = errors.ends.max(error(step.t1(), step.y1()[0]));
        for i in 1..10 {
            let t = step.t0() + f64::from(i) / 10.0 * (step.t1() - step.t0());
            step.interpolate(t, &mut y).expect("t is inside");
            errors.cheap = errors.cheap.max(error(t, y[0]));
            step.interpolate_accurately(t, &mut y).expect("t is inside");
            errors.accurate = errors.accurate.max(error(t, y[0]));
        }
        ControlFlow::Continue(())
    })
    .expect("smooth problem");
    let s = end.statistics;
    assert_eq!(s.accepted, u64::from(n));
    // Two evaluations in a step, however many times are asked for.
    assert_eq!(s.output_evaluations, 2 * u64::from(n));
    errors
}

/// In the sum over all steps the local errors of order 5 (inside) and 6 (at the ends) of the cheap output count alike.
#[test]
fn steps_and_both_dense_outputs_converge_with_order_five() {
    let errors = STEPS.map(largest_errors);
    assert_order("ends", &errors.each_ref().map(|e| e.ends), 5.0);
    assert_order("cheap", &errors.each_ref().map(|e| e.cheap), 5.0);
    assert_order("accurate", &errors.each_ref().map(|e| e.accurate), 5.0);
    for e in &errors {
        // The accurate output adds next to nothing (the largest error lies between two ends); the cheap one is worse.
        assert!(
            e.accurate < 1.25 * e.ends,
            "{:.3e} {:.3e}",
            e.accurate,
            e.ends
        );
        assert!(e.cheap > 1.5 * e.accurate, "{:.3e} {:.3e}", e.cheap, e.ends);
    }
}

/// The local error of both outputs, one step from an exact state, one order higher.
#[test]
fn dense_outputs_have_local_orders_five_and_six() {
    let theta = 0.7;
    let errors = [0.4, 0.2, 0.1, 0.05].map(|h| {
        let mut ode = Function::new(2, oscillator);
        let (mut cheap, mut accurate) = ([0.0; 2], [0.0; 2]);
        let interval = Interval::new(0.0, h);
        let y0 = [1.0, 0.0];
        integrate(&Dopri5, &mut ode, &interval, &y0, &fixed_step(h), |step| {
            step.interpolate(theta * h, &mut cheap).expect("inside");
            step.interpolate_accurately(theta * h, &mut accurate)
                .expect("inside");
            ControlFlow::Continue(())
        })
        .expect("smooth problem");
        let exact = [(theta * h).cos(), -(theta * h).sin()];
        (distance(&cheap, &exact), distance(&accurate, &exact))
    });
    assert_order("cheap, local", &errors.map(|e| e.0), 5.0);
    assert_order("accurate, local", &errors.map(|e| e.1), 6.0);
}

/// Rotating the initial state rotates the solution: the formulas are linear in y and f.
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
    // Some hundred steps, each with a local error of at most 1e-10, errors growing linearly with time.
    assert!(distance(&back.y, &y0) < 1e-7, "{:?}", back.y);
    assert!(back.statistics.accepted > 20);
}
