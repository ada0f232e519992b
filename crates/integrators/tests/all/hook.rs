//! Projection at the end of steps.

use crate::problems::{WEIGHT, distance, fixed_step, observed_orders};
use pfaff_integrators::{
    Cause, Dop853, Dopri5, IntegrationError, Interval, Method, Ode, Options, Outcome, StepEnd,
    StepInfo, Tsit5, integrate,
};
use std::convert::Infallible;
use std::ops::ControlFlow;

/// The harmonic oscillator with projection onto the unit circle; it rejects corrections above
/// `limit` in the norm of the error.
struct Circle {
    limit: f64,
}

impl Ode for Circle {
    type Error = Infallible;

    fn dim(&self) -> usize {
        2
    }

    fn rhs(&mut self, _t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), Infallible> {
        dy.copy_from_slice(&[y[1], -y[0]]);
        Ok(())
    }

    fn end_of_step(
        &mut self,
        step: &StepInfo<'_>,
        y: &mut [f64],
        dy: &mut [f64],
    ) -> Result<StepEnd, Infallible> {
        let radius = y[0].hypot(y[1]);
        let projected = [y[0] / radius, y[1] / radius];
        let correction = step.norm(&[projected[0] - y[0], projected[1] - y[1]]);
        if correction > self.limit {
            return Ok(StepEnd::Reject);
        }
        y.copy_from_slice(&projected);
        self.rhs(step.t_rhs, y, dy)?;
        Ok(StepEnd::Projected {
            correction,
            evaluations: 1,
        })
    }
}

/// Rounding of y/|y|.
const ON_CIRCLE: f64 = 4.0 * f64::EPSILON;

fn circle(t_end: f64, options: &Options) -> Outcome {
    let mut ode = Circle {
        limit: f64::INFINITY,
    };
    let mut previous: Option<([f64; 2], [f64; 2])> = None;
    integrate(
        &Dopri5,
        &mut ode,
        &Interval::new(0.0, t_end),
        &[1.0, 0.0],
        options,
        |step| {
            let (y1, f1) = ([step.y1()[0], step.y1()[1]], [step.f1()[0], step.f1()[1]]);
            assert!((y1[0].hypot(y1[1]) - 1.0).abs() < ON_CIRCLE);
            // The derivative belongs to the projected state and is the first stage of the next
            // step.
            assert_eq!(f1, [y1[1], -y1[0]]);
            if let Some((y, f)) = previous.replace((y1, f1)) {
                assert_eq!((&y[..], &f[..]), (step.y0(), step.f0()));
            }
            ControlFlow::Continue(())
        },
    )
    .expect("smooth problem")
}

#[test]
fn states_stay_on_the_circle_and_the_derivative_is_reused() {
    let end = circle(20.0, &Options::with_tolerance(1e-6, 1e-6));
    let s = end.statistics;
    assert_eq!(
        (s.projections, s.hook_evaluations),
        (s.accepted, s.accepted)
    );
    // The count is f at the start, one evaluation for the first step size, and six stages for every
    // trial.
    assert_eq!(s.evaluations, 2 + 6 * (s.accepted + s.rejected()));
    assert!(s.largest_correction > 0.0 && s.largest_correction < 1.0);
    assert!(distance(&end.y, &[20.0_f64.cos(), -20.0_f64.sin()]) < 1e-4);
}

/// For q'' = −q a step of size h multiplies q − i·v by R(ih). The stability function of the method
/// is R(z) = 1 + z + … + z⁵/120 + z⁶/600 (Hairer, Wanner II, IV.2). After projection only the angle
/// of R(ih) remains, whose error is of order 6.
#[test]
fn projected_steps_turn_by_the_angle_of_the_stability_function() {
    const ROUNDING: f64 = 1e-13; // some hundred steps
    let errors = [16.0, 32.0, 64.0].map(|n: f64| {
        let h = 4.0 / n;
        let y = circle(4.0, &fixed_step(h)).y;
        let re = 1.0 - h.powi(2) / 2.0 + h.powi(4) / 24.0 - h.powi(6) / 600.0;
        let im = h - h.powi(3) / 6.0 + h.powi(5) / 120.0;
        let angle = n * im.atan2(re);
        assert!(distance(&y, &[angle.cos(), -angle.sin()]) < ROUNDING);
        distance(&y, &[4.0_f64.cos(), -4.0_f64.sin()])
    });
    let orders = observed_orders(&errors);
    assert!(
        orders.iter().all(|p| (p - 6.0).abs() < 0.1),
        "{errors:?} {orders:?}"
    );
}

/// Compares value and slope of the dense outputs at step ends, by one-sided differences inside
/// steps of size h, with large corrections.
fn check_smoothness(name: &str, method: &impl Method<Circle>, h: f64) {
    let mut ode = Circle {
        limit: f64::INFINITY,
    };
    let mut y = [[0.0; 2]; 2];
    let interval = Interval::new(0.0, 8.0 * h);
    let end = integrate(
        method,
        &mut ode,
        &interval,
        &[1.0, 0.0],
        &fixed_step(h),
        |step| {
            let small = 1e-6 * (step.t1() - step.t0());
            let (start, end) = (step.t0() + small, step.t1() - small);
            for accurate in [false, true] {
                for (t, y) in [start, end].into_iter().zip(&mut y) {
                    if accurate {
                        step.interpolate_accurately(t, y).expect("inside");
                    } else {
                        step.interpolate(t, y).expect("inside");
                    }
                }
                for i in 0..2 {
                    let slope_0 = (y[0][i] - step.y0()[i]) / (start - step.t0());
                    let slope_1 = (step.y1()[i] - y[1][i]) / (step.t1() - end);
                    // The differences use 1e-6 of a step: the truncation error is about 1e-6, the
                    // rounding error 1e-16/1e-6.
                    let gap = (slope_0 - step.f0()[i])
                        .abs()
                        .max((slope_1 - step.f1()[i]).abs());
                    assert!(gap < 2e-5, "{name}, accurate: {accurate}: {gap:e}");
                }
            }
            for (t, ends) in [(step.t0(), step.y0()), (step.t1(), step.y1())] {
                step.interpolate(t, &mut y[0]).expect("an end");
                step.interpolate_accurately(t, &mut y[1]).expect("an end");
                assert_eq!((ends, ends), (&y[0][..], &y[1][..]));
            }
            ControlFlow::Continue(())
        },
    )
    .expect("smooth problem");
    // With smaller corrections, the slopes would agree even if the outputs ignored the projection.
    let correction = WEIGHT * end.statistics.largest_correction;
    assert!(correction > 1e-4, "{name}: {correction:e}");
}

#[test]
fn dense_output_passes_smoothly_through_projected_states() {
    check_smoothness("dopri5", &Dopri5, 1.25);
    check_smoothness("tsit5", &Tsit5, 1.25);
    check_smoothness("dop853", &Dop853, 2.5);
}

/// Each method runs for twenty units of time on the circle; `evaluations` is the number of
/// evaluations per trial, without the evaluation in the hook.
#[test]
fn all_methods_stay_on_the_circle() {
    fn check(name: &str, method: &impl Method<Circle>) {
        let mut ode = Circle {
            limit: f64::INFINITY,
        };
        let options = Options::with_tolerance(1e-9, 1e-9);
        let interval = Interval::new(0.0, 20.0);
        let end = integrate(method, &mut ode, &interval, &[1.0, 0.0], &options, |step| {
            let (y1, f1) = (step.y1(), step.f1());
            assert!((y1[0].hypot(y1[1]) - 1.0).abs() < ON_CIRCLE);
            assert_eq!(f1, [y1[1], -y1[0]]);
            ControlFlow::Continue(())
        })
        .expect("smooth problem");
        let s = end.statistics;
        assert_eq!(
            (s.projections, s.hook_evaluations),
            (s.accepted, s.accepted),
            "{name}"
        );
        let error = distance(&end.y, &[20.0_f64.cos(), -20.0_f64.sin()]);
        assert!(error < 1e-7, "{name}: {error:e}, {s:?}");
    }
    check("dopri5", &Dopri5);
    check("tsit5", &Tsit5);
    check("dop853", &Dop853);
}

#[test]
fn rejection_by_the_hook_halves_the_step() {
    let interval = Interval::new(0.0, 10.0);
    let options = Options::with_tolerance(1e-3, 1e-3);
    let free = circle(10.0, &options).statistics;
    let limit = 0.5 * free.largest_correction;
    let mut ode = Circle { limit };
    let end = integrate(&Dopri5, &mut ode, &interval, &[1.0, 0.0], &options, |_| {
        ControlFlow::Continue(())
    })
    .expect("shorter steps have smaller corrections");
    let s = end.statistics;
    assert!(
        s.rejected_by_hook > 0 && s.largest_correction <= limit,
        "{s:?}"
    );
    assert!(s.accepted > free.accepted);

    let mut ode = Circle { limit: -1.0 };
    let failure = integrate(&Dopri5, &mut ode, &interval, &[1.0, 0.0], &options, |_| {
        ControlFlow::Continue(())
    })
    .expect_err("no step is good enough");
    assert!(
        matches!(
            failure.error,
            IntegrationError::StepSizeCollapsed {
                cause: Cause::RejectedByHook,
                ..
            }
        ),
        "{failure}"
    );
    assert_eq!((failure.t, &failure.y[..]), (0.0, &[1.0, 0.0][..]));
}
