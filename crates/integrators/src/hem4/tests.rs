//! Orders of the step, its estimate and its dense output on problems with closed-form solutions; step control.

use super::Hem4;
use crate::constrained::problems::{
    KnifeEdge, PENDULUM, Pendulum, Problem, SKATE_START, assert_orders, distance, knife_edge_at,
    run,
};
use crate::interval::Interval;
use crate::method::integrate;
use crate::options::{InitialStep, Options};
use std::ops::ControlFlow;

#[test]
fn order_four_and_an_estimate_of_order_three() {
    assert_orders("pendulum", [4.0, 4.0], |n| {
        run(&Hem4, Pendulum, PENDULUM, n, 0.0)
    });
    let skate = (&SKATE_START[..], 2.0, &knife_edge_at(2.0)[..]);
    assert_orders("skate", [4.0, 4.0], |n| {
        run(&Hem4, KnifeEdge, skate, n, 0.0)
    });
}

#[test]
fn velocities_obey_the_constraints_to_rounding() {
    for n in [3, 30] {
        let pendulum = run(&Hem4, Pendulum, PENDULUM, n, 0.2);
        assert!(pendulum.velocity_residual < 2e-15, "{pendulum:?}");
    }
}

/// The error follows the tolerance over its whole range, and the work of the constant force is its potential to rounding.
#[test]
fn step_control_keeps_the_error_in_proportion() {
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
        let options = Options::with_tolerance(tolerance, tolerance);
        let mut ode = Problem::new(KnifeEdge);
        let interval = Interval::new(0.0, 10.0);
        let end = integrate(&Hem4, &mut ode, &interval, &SKATE_START, &options, |_| {
            ControlFlow::Continue(())
        })
        .expect("smooth");
        let (error, s) = (distance(&end.y, &knife_edge_at(10.0)), end.statistics);
        // Six evaluations a step and few rejections, at the start or where the tolerance is loose.
        assert!(
            (10.0..60.0).contains(&(error / tolerance)),
            "{error:.2e} {s:?}"
        );
        assert!(
            s.evaluations <= 6 * (s.accepted + s.rejected()) + 2,
            "{s:?}"
        );
        assert!(8 * s.rejected() < s.accepted + 10, "{s:?}");
        assert!((end.y[6] - 9.81 * end.y[0]).abs() < 1e-12, "{:?}", end.y);
    }
}

/// Errors inside one step from an exact state: of order h⁴, and of order h⁵ with the extra evaluation.
#[test]
fn dense_outputs_have_local_orders_four_and_five() {
    let errors = |h: f64| {
        let mut errors = [0.0; 2];
        let options = Options {
            initial_step: InitialStep::Given(h),
            ..Options::with_tolerance(0.0, 1e100)
        };
        let mut ode = Problem::new(KnifeEdge);
        let interval = Interval::new(0.0, 1.0);
        integrate(&Hem4, &mut ode, &interval, &SKATE_START, &options, |step| {
            let (t, mut y) = (0.6 * h, [0.0; 7]);
            step.interpolate(t, &mut y).expect("inside");
            errors[0] = distance(&y, &knife_edge_at(t));
            step.interpolate_accurately(t, &mut y).expect("inside");
            errors[1] = distance(&y, &knife_edge_at(t));
            assert_eq!(step.statistics().output_evaluations, 1);
            ControlFlow::Break(())
        })
        .expect("one step");
        errors
    };
    let (long, short) = (errors(0.1), errors(0.05));
    for (i, claimed) in [4.0, 5.0].into_iter().enumerate() {
        let order = (long[i] / short[i]).log2();
        assert!((order - claimed).abs() < 0.2, "{order}: {long:?} {short:?}");
    }
}
