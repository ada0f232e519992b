//! Cases that every method must handle: an empty interval, zero weights, divergence in finite time,
//! values that are not numbers, extreme tolerances.

use crate::problems::{Plain, distance, kepler, oscillator, plain};
use pfaff_integrators::{
    Cause, Dop853, Dopri5, Failure, IntegrationError, Interval, Method, Options, Outcome,
    Tolerance, Tsit5, integrate,
};
use std::convert::Infallible;
use std::ops::ControlFlow;

type Rhs = fn(f64, &[f64], &mut [f64]);

fn run(
    method: &impl Method<Plain>,
    f: Rhs,
    t_end: f64,
    y0: &[f64],
    options: &Options,
) -> Result<Outcome, Box<Failure<Infallible>>> {
    let interval = Interval::new(0.0, t_end);
    integrate(
        method,
        &mut plain(y0.len(), f),
        &interval,
        y0,
        options,
        |step| {
            let mut y = vec![0.0; step.y0().len()];
            let middle = 0.5 * (step.t0() + step.t1());
            // Dense output must not panic for any values.
            step.interpolate(middle, &mut y).expect("inside");
            let _ = step.interpolate_accurately(middle, &mut y);
            ControlFlow::Continue(())
        },
    )
}

fn check(name: &str, method: &impl Method<Plain>) {
    let options = Options::default();

    let nothing = run(method, |_, _, _| {}, 1.0, &[], &options).expect("nothing to do");
    assert_eq!(
        (nothing.t, nothing.statistics.rejected()),
        (1.0, 0),
        "{name}"
    );

    let relative = Options::with_tolerance(1e-8, 0.0);
    let zero = run(method, |_, y, dy| dy[0] = -y[0], 1.0, &[0.0], &relative).expect("stays");
    assert_eq!(zero.y, [0.0], "{name}");
    let from_zero = run(method, |_, _, dy| dy[0] = 1.0, 1.0, &[0.0], &relative).expect("leaves");
    assert!((from_zero.y[0] - 1.0).abs() < 1e-8, "{name}");

    // The solution is y = 1/(1 − t).
    let failure = run(
        method,
        |_, y, dy| dy[0] = y[0] * y[0],
        2.0,
        &[1.0],
        &options,
    )
    .expect_err("ends at t = 1");
    assert!(
        matches!(failure.error, IntegrationError::StepSizeCollapsed { .. }),
        "{name}: {failure}"
    );
    assert!((failure.t - 1.0).abs() < 1e-6, "{name}: {}", failure.t);

    // The function returns NaN beyond t = 1.
    let failure = run(
        method,
        |t, _, dy| dy[0] = -(1.0 - t).sqrt(),
        2.0,
        &[1.0],
        &options,
    )
    .expect_err("not defined beyond t = 1");
    let IntegrationError::StepSizeCollapsed { t, cause, .. } = &failure.error else {
        panic!("{name}: {failure}")
    };
    assert!((t - 1.0).abs() < 1e-5, "{name}: {t}");
    assert_eq!(*cause, Cause::NonFinite { component: 0 }, "{name}");

    // One component has no error control, like the work in a run of a mechanism.
    let weights = Options {
        tolerance: Tolerance::PerComponent {
            rtol: vec![1e-9, 1e-9, 0.0],
            atol: vec![1e-9, 1e-9, f64::MAX],
        },
        ..Options::default()
    };
    let with_time: Rhs = |_, y, dy| dy.copy_from_slice(&[y[1], -y[0], 1.0]);
    let end = run(method, with_time, 6.0, &[1.0, 0.0, 0.0], &weights).expect("smooth");
    let exact = [6.0_f64.cos(), -6.0_f64.sin(), 6.0];
    assert!(distance(&end.y, &exact) < 1e-7, "{name}: {:?}", end.y);

    // The tolerances range from very loose to the tightest one.
    let error = |tolerance: f64| {
        let options = Options::with_tolerance(tolerance, tolerance);
        let end = run(method, oscillator, 10.0, &[1.0, 0.0], &options).expect("smooth");
        distance(&end.y, &[10.0_f64.cos(), -10.0_f64.sin()])
    };
    assert!(error(1e6).is_finite() && error(0.1) < 1.0, "{name}");
    assert!(error(1e-15) < 1e-13, "{name}: {:e}", error(1e-15));
}

#[test]
fn edges() {
    check("dopri5", &Dopri5);
    check("tsit5", &Tsit5);
    check("dop853", &Dop853);
}

/// The orbit makes ten revolutions with eccentricity 0.6: the state after 10 periods of 2π is the
/// initial one.
#[test]
fn errors_follow_the_tolerance() {
    fn check(name: &str, method: &impl Method<Plain>) {
        let y0 = [0.4, 0.0, 0.0, 2.0];
        for tolerance in [1e-6, 1e-9, 1e-12] {
            let options = Options::with_tolerance(tolerance, tolerance);
            let end =
                run(method, kepler, 20.0 * std::f64::consts::PI, &y0, &options).expect("smooth");
            let error = distance(&end.y, &y0);
            // The bound is the sum of the local errors of some hundred to thousand steps, which
            // grows with the square of time.
            assert!(error < 2e5 * tolerance, "{name}, {tolerance}: {error:e}");
        }
    }
    check("dopri5", &Dopri5);
    check("tsit5", &Tsit5);
    check("dop853", &Dop853);
}
