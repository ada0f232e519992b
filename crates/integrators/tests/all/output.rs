//! Tests output times, early stops and failing output.

use crate::problems::oscillator;
use pfaff_integrators::{
    Dopri5, End, Function, InitialStep, IntegrationError, Interval, Ode, Options, OutputTimes,
    integrate, sample,
};
use std::ops::ControlFlow;
use thiserror::Error;

fn times(interval: &Interval<'_>, times: &OutputTimes) -> Vec<f64> {
    let mut rows = Vec::new();
    let options = Options::default();
    let mut ode = Function::new(2, oscillator);
    sample(
        &Dopri5,
        &mut ode,
        interval,
        &[1.0, 0.0],
        &options,
        times,
        |_, t, y| {
            // The state at the start of the interval is (1, 0).
            let phase = t - interval.t0;
            assert!((y[0] - phase.cos()).abs() < 1e-7 && (y[1] + phase.sin()).abs() < 1e-7);
            y.fill(f64::NAN); // the integration must not see this
            rows.push(t);
            ControlFlow::Continue(())
        },
    )
    .expect("smooth problem");
    rows
}

#[test]
fn rows_start_and_end_exactly_and_do_not_drift() {
    let every = |dt| OutputTimes::Every(dt);
    assert_eq!(
        times(&Interval::new(0.0, 1.0), &every(0.4)),
        [0.0, 0.4, 0.8, 1.0]
    );
    assert_eq!(
        times(&Interval::new(1.0, 0.0), &every(0.4)),
        [1.0, 0.6, 1.0 - 0.8, 0.0]
    );
    assert_eq!(times(&Interval::new(2.0, 3.0), &every(7.0)), [2.0, 3.0]);
    assert_eq!(times(&Interval::new(2.0, 3.0), &every(1e12)), [2.0, 3.0]);
    assert_eq!(times(&Interval::new(2.0, 2.0), &every(0.1)), [2.0]);
    let rows = times(&Interval::new(0.0, 10.0), &every(0.05)); // 200·0.05 rounds to 10
    assert_eq!((rows.len(), rows[200]), (201, 10.0));
    assert!(rows.iter().enumerate().all(|(i, t)| *t == i as f64 * 0.05));
    // The product 3·0.1 is larger than 0.3: there is one row and not two, and no row after the end.
    assert_eq!(
        times(&Interval::new(0.0, 0.3), &every(0.1)),
        [0.0, 0.1, 0.2, 0.3]
    );
}

#[test]
fn rows_at_given_times() {
    let at = OutputTimes::At(vec![0.25, 0.5, 2.0]);
    assert_eq!(times(&Interval::new(0.0, 2.0), &at), [0.25, 0.5, 2.0]);
    for (bad, index) in [
        (vec![0.5, 0.5], 1),
        (vec![-0.1], 0),
        (vec![2.1], 0),
        (vec![f64::NAN], 0),
    ] {
        let mut ode = Function::new(2, oscillator);
        let interval = Interval::new(0.0, 2.0);
        let options = Options::default();
        let at = OutputTimes::At(bad);
        let failure = sample(
            &Dopri5,
            &mut ode,
            &interval,
            &[1.0, 0.0],
            &options,
            &at,
            |_, _, _| ControlFlow::Continue(()),
        )
        .expect_err("bad times");
        let IntegrationError::InvalidOutputTime { index: found, .. } = failure.error else {
            panic!("{failure}")
        };
        assert_eq!(found, index);
    }
}

#[test]
fn bad_output_steps_are_refused() {
    for dt in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let mut ode = Function::new(2, oscillator);
        let (interval, options) = (Interval::new(0.0, 2.0), Options::default());
        let every = OutputTimes::Every(dt);
        let failure = sample(
            &Dopri5,
            &mut ode,
            &interval,
            &[1.0, 0.0],
            &options,
            &every,
            |_, _, _| panic!("no row may come"),
        )
        .expect_err("bad step");
        assert!(
            failure.to_string().starts_with("output step = "),
            "{failure}"
        );
    }
}

#[test]
fn the_observer_can_stop() {
    let mut ode = Function::new(2, oscillator);
    let (interval, options) = (Interval::new(0.0, 100.0), Options::default());
    let mut t_stop = 0.0;
    let end = integrate(
        &Dopri5,
        &mut ode,
        &interval,
        &[1.0, 0.0],
        &options,
        |step| {
            t_stop = step.t1();
            if t_stop > 3.0 {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        },
    )
    .expect("smooth problem");
    assert_eq!((end.end, end.t), (End::Stopped, t_stop));
    assert!(t_stop > 3.0 && t_stop < 5.0);
    assert!((end.y[0] - t_stop.cos()).abs() < 1e-7);

    let mut rows = 0;
    let every = OutputTimes::Every(0.5);
    let end = sample(
        &Dopri5,
        &mut ode,
        &interval,
        &[1.0, 0.0],
        &options,
        &every,
        |_, t, _| {
            rows += 1;
            if t < 2.0 {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        },
    )
    .expect("smooth problem");
    assert_eq!((end.end, rows), (End::Stopped, 5));
}

/// The equation y' = 1, which cannot be evaluated at the times of the extra evaluations.
struct OnlyAtStages;

#[derive(Debug, Error)]
#[error("not at t = {0}")]
struct NotHere(f64);

impl Ode for OnlyAtStages {
    type Error = NotHere;

    fn dim(&self) -> usize {
        1
    }

    fn rhs(&mut self, t: f64, _y: &[f64], dy: &mut [f64]) -> Result<(), NotHere> {
        if t == 0.5 {
            return Err(NotHere(t));
        }
        dy[0] = 1.0;
        Ok(())
    }
}

#[test]
fn a_failing_extra_evaluation_is_named() {
    let options = Options {
        initial_step: pfaff_integrators::InitialStep::Given(1.0),
        ..Options::default()
    };
    let at = OutputTimes::At(vec![0.7]);
    let interval = Interval::new(0.0, 1.0);
    let failure = sample(
        &Dopri5,
        &mut OnlyAtStages,
        &interval,
        &[0.0],
        &options,
        &at,
        |_, _, _| ControlFlow::Continue(()),
    )
    .expect_err("0.5 is in the middle of the only step");
    assert_eq!(
        failure.to_string(),
        "no output at t = 0.7: the problem reports: not at t = 0.5"
    );
    assert!(failure.t == 1.0 && (failure.y[0] - 1.0).abs() < 1e-15);
}

/// The step size of the outcome is the size for a continuation, although the end of the interval
/// shortened the last step.
#[test]
fn an_integration_goes_on_with_the_step_size_of_its_outcome() {
    let options = Options::with_tolerance(1e-9, 1e-9);
    let run = |t0: f64, t_end: f64, initial_step| {
        let mut largest = 0.0_f64;
        let y0 = [t0.cos(), -t0.sin()];
        let options = Options {
            initial_step,
            ..options.clone()
        };
        let end = integrate(
            &Dopri5,
            &mut Function::new(2, oscillator),
            &Interval::new(t0, t_end),
            &y0,
            &options,
            |step| {
                largest = largest.max(step.t1() - step.t0());
                ControlFlow::Continue(())
            },
        )
        .expect("smooth problem");
        (end, largest)
    };
    let (there, largest) = run(0.0, 5.001, InitialStep::Automatic);
    let next = there.next_step.expect("steps were made");
    assert!(
        next > 0.8 * largest && next < 1.3 * largest,
        "{next} {largest}"
    );
    let (fresh, _) = run(5.001, 10.0, InitialStep::Automatic);
    let (continued, _) = run(5.001, 10.0, InitialStep::Given(next));
    assert_eq!(continued.statistics.rejected(), 0);
    assert!(continued.statistics.evaluations < fresh.statistics.evaluations);
}
