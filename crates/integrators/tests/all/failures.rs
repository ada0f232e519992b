//! Tests all errors: their names and the last good state, without panic.

use crate::problems::{oscillator, run, run_function};
use pfaff_integrators::{
    Cause, Dopri5, End, Failure, Function, InitialStep, IntegrationError, Interval, Ode, Options,
    OutputError, Tolerance, integrate,
};
use std::convert::Infallible;
use std::ops::ControlFlow;
use thiserror::Error;

fn fails<F: FnMut(f64, &[f64], &mut [f64])>(
    f: F,
    interval: &Interval<'_>,
    y0: &[f64],
    options: &Options,
) -> Failure<Infallible> {
    let mut ode = Function::new(1, f);
    *integrate(&Dopri5, &mut ode, interval, y0, options, |_| {
        ControlFlow::Continue(())
    })
    .expect_err("this must fail")
}

fn decay(_t: f64, y: &[f64], dy: &mut [f64]) {
    dy[0] = -y[0];
}

/// The equation y' = y², y(0) = 1 has the solution y = 1/(1 − t), which ends at t = 1.
#[test]
fn blow_up_is_a_collapse_at_its_time() {
    let square = |_t: f64, y: &[f64], dy: &mut [f64]| dy[0] = y[0] * y[0];
    let failure = fails(
        square,
        &Interval::new(0.0, 2.0),
        &[1.0],
        &Options::default(),
    );
    assert!(
        matches!(failure.error, IntegrationError::StepSizeCollapsed { .. }),
        "{failure}"
    );
    // Near the end y = 1/(t* − t), with t* accurate to the tolerance.
    assert!((failure.t - 1.0).abs() < 1e-7, "{}", failure.t);
    assert!(failure.y[0] > 1e7 && failure.y[0].is_finite());
    assert!(failure.statistics.accepted > 50);
    let text = failure.to_string();
    assert!(
        text.starts_with("step size collapsed at t = ") && text.contains("singularity"),
        "{text}"
    );
}

#[test]
fn nan_is_avoided_by_shorter_steps_or_named() {
    // The right-hand side −√(1 − t) is NaN for t > 1, so the solution ends at t = 1.
    let root = |t: f64, _y: &[f64], dy: &mut [f64]| dy[0] = -(1.0 - t).sqrt();
    let failure = fails(root, &Interval::new(0.0, 2.0), &[1.0], &Options::default());
    let IntegrationError::StepSizeCollapsed {
        t, cause, failures, ..
    } = &failure.error
    else {
        panic!("{failure}")
    };
    assert!((t - 1.0).abs() < 1e-5, "{t}");
    assert!(*failures > 0);
    assert_eq!(*cause, Cause::NonFinite { component: 0 });
    assert!(failure.statistics.rejected_by_failure > 0);

    let nan = |_t: f64, _y: &[f64], dy: &mut [f64]| dy[0] = f64::NAN;
    let failure = fails(nan, &Interval::new(0.0, 2.0), &[1.0], &Options::default());
    let cause = Cause::NonFinite { component: 0 };
    assert_eq!(
        failure.error,
        IntegrationError::StartFailed { t: 0.0, cause }
    );
    assert_eq!(
        (failure.t, failure.y, failure.statistics.evaluations),
        (0.0, vec![1.0], 1)
    );
}

/// The equation is y' = −y. For y below `refuses_below`, the first `refusals_left` evaluations
/// return an error.
struct Guarded {
    refuses_below: f64,
    refusals_left: u32,
}

#[derive(Debug, PartialEq, Error)]
#[error("y = {y} is below the limit")]
struct Below {
    y: f64,
}

impl Ode for Guarded {
    type Error = Below;

    fn dim(&self) -> usize {
        1
    }

    fn rhs(&mut self, _t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), Below> {
        if y[0] < self.refuses_below && self.refusals_left > 0 {
            self.refusals_left -= 1;
            return Err(Below { y: y[0] });
        }
        dy[0] = -y[0];
        Ok(())
    }
}

#[test]
fn errors_of_the_problem_are_kept_when_steps_collapse() {
    let mut ode = Guarded {
        refuses_below: 0.5,
        refusals_left: u32::MAX,
    };
    let mut last = 0.0;
    let failure = integrate(
        &Dopri5,
        &mut ode,
        &Interval::new(0.0, 2.0),
        &[1.0],
        &Options::default(),
        |step| {
            last = step.t1();
            ControlFlow::Continue(())
        },
    )
    .expect_err("y = 0.5 is reached at t = ln 2");
    let IntegrationError::StepSizeCollapsed {
        t,
        h,
        cause: Cause::Problem(below),
        ..
    } = &failure.error
    else {
        panic!("{failure}")
    };
    assert!((t - std::f64::consts::LN_2).abs() < 1e-7, "{t}");
    assert!(h.abs() < 1e-13 && below.y < 0.5);
    assert_eq!((failure.t, *t), (last, last));
    assert!(failure.y[0] >= 0.5);
}

#[test]
fn a_passing_error_of_the_problem_costs_only_a_shorter_step() {
    let mut ode = Guarded {
        refuses_below: 0.5,
        refusals_left: 3,
    };
    let end = run(
        &mut ode,
        &Interval::new(0.0, 2.0),
        &[1.0],
        &Options::default(),
    );
    assert_eq!(end.statistics.rejected_by_failure, 3);
    assert!((end.y[0] - (-2.0_f64).exp()).abs() < 1e-7);
}

#[test]
fn work_limit_keeps_what_was_done() {
    let options = Options {
        max_steps: 10,
        ..Options::default()
    };
    let failure = fails(decay, &Interval::new(0.0, 100.0), &[1.0], &options);
    assert!(
        matches!(
            failure.error,
            IntegrationError::TooManySteps { steps: 10, .. }
        ),
        "{failure}"
    );
    let s = failure.statistics;
    assert_eq!(s.accepted + s.rejected(), 10);
    assert!(failure.t > 0.0 && (failure.y[0] - (-failure.t).exp()).abs() < 1e-7);
}

#[test]
fn nothing_to_do() {
    let options = Options::default();
    let end = run_function(oscillator, (3.0, 3.0), &[1.0, 0.0], &options);
    assert_eq!(
        (end.t, &end.y[..], end.end),
        (3.0, &[1.0, 0.0][..], End::Reached)
    );
    assert_eq!(end.statistics.total_evaluations(), 0);
}

#[test]
fn dimension_zero_runs_to_the_end() {
    let end = run_function(|_, _, _| {}, (0.0, 1.0), &[], &Options::default());
    assert_eq!(end.t, 1.0);
    assert_eq!(end.statistics.rejected(), 0);
}

#[test]
fn zero_state_with_relative_tolerance_only() {
    let options = Options::with_tolerance(1e-8, 0.0);
    let end = run_function(decay, (0.0, 1.0), &[0.0], &options);
    assert_eq!(end.y, [0.0]);
    // The state starts at 0, so its value at the end of the first step determines the weight.
    let end = run_function(|_, _, dy| dy[0] = 1.0, (0.0, 1.0), &[0.0], &options);
    assert!((end.y[0] - 1.0).abs() < 1e-8);
}

#[test]
fn bad_input_is_refused_before_the_first_evaluation() {
    let good = Options::default();
    let interval = Interval::new(0.0, 1.0);
    let tolerance = |rtol: Vec<f64>, atol: Vec<f64>| Options {
        tolerance: Tolerance::PerComponent { rtol, atol },
        ..Options::default()
    };
    let breaks = [f64::NAN];
    let cases: [(&str, Interval<'_>, &[f64], Options); 10] = [
        (
            "the initial state has 2 components, the problem has 1",
            interval,
            &[1.0, 2.0],
            good.clone(),
        ),
        (
            "component 0 (counted from 0) of the initial state is NaN",
            interval,
            &[f64::NAN],
            good.clone(),
        ),
        (
            "t_end = inf is not a time",
            Interval::new(0.0, f64::INFINITY),
            &[1.0],
            good.clone(),
        ),
        (
            "t0 = NaN is not a time",
            Interval::new(f64::NAN, 1.0),
            &[1.0],
            good.clone(),
        ),
        (
            "break time = NaN",
            Interval {
                break_times: &breaks,
                ..interval
            },
            &[1.0],
            good.clone(),
        ),
        (
            "rtol = -1, expected",
            interval,
            &[1.0],
            Options::with_tolerance(-1.0, 1.0),
        ),
        (
            "expected rtol > 0 or atol > 0",
            interval,
            &[1.0],
            Options::with_tolerance(0.0, 0.0),
        ),
        (
            "2 values for atol, the problem has 1",
            interval,
            &[1.0],
            tolerance(vec![0.1], vec![0.1, 0.1]),
        ),
        (
            "max_step = 0, expected",
            interval,
            &[1.0],
            Options {
                max_step: 0.0,
                ..good.clone()
            },
        ),
        (
            "initial_step = NaN, expected",
            interval,
            &[1.0],
            Options {
                initial_step: InitialStep::Given(f64::NAN),
                ..good
            },
        ),
    ];
    for (expected, interval, y0, options) in cases {
        let failure = fails(decay, &interval, y0, &options);
        assert!(
            failure.to_string().contains(expected),
            "{expected}: {failure}"
        );
        assert_eq!(failure.statistics.total_evaluations(), 0);
    }
}

#[test]
fn dense_output_does_not_extrapolate() {
    let mut ode = Function::new(1, decay);
    let interval = Interval::new(0.0, 1.0);
    integrate(
        &Dopri5,
        &mut ode,
        &interval,
        &[1.0],
        &Options::default(),
        |step| {
            let mut y = [0.0];
            for t in [step.t1().next_up(), step.t0() - 1e-3, f64::NAN] {
                let refused = step.interpolate_accurately(t, &mut y);
                assert!(
                    matches!(refused, Err(OutputError::OutsideStep { .. })),
                    "{t}"
                );
            }
            let refused = step.interpolate(step.t1(), &mut []);
            assert_eq!(
                refused,
                Err(OutputError::Length {
                    expected: 1,
                    found: 0
                })
            );
            ControlFlow::Continue(())
        },
    )
    .expect("smooth problem");
}

#[test]
fn tolerances_per_component_replace_the_uniform_one() {
    let uniform = run_function(
        oscillator,
        (0.0, 5.0),
        &[1.0, 0.0],
        &Options::with_tolerance(1e-6, 1e-6),
    );
    let options = |rtol: [f64; 2]| Options {
        tolerance: Tolerance::PerComponent {
            rtol: rtol.to_vec(),
            atol: vec![1e-6; 2],
        },
        ..Options::default()
    };
    let same = run_function(oscillator, (0.0, 5.0), &[1.0, 0.0], &options([1e-6; 2]));
    assert_eq!(uniform, same);
    let looser = run_function(oscillator, (0.0, 5.0), &[1.0, 0.0], &options([1e-6, 1.0]));
    assert!(looser.statistics.accepted < same.statistics.accepted);
}
