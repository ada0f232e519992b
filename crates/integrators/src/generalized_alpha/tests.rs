//! Orders of the step and its estimate on problems with closed-form solutions, damping, step control.

use super::GeneralizedAlpha;
use crate::constrained::problems::{
    FixedSteps, KnifeEdge, Oscillator, PENDULUM, Pendulum, Problem, SKATE_START, assert_orders,
    distance, knife_edge_at, run,
};
use crate::interval::Interval;
use crate::method::{Method, integrate};
use crate::options::Options;
use std::ops::ControlFlow;

#[test]
fn order_two_for_every_damping() {
    let skate = (&SKATE_START[..], 2.0, &knife_edge_at(2.0)[..]);
    for rho_inf in [0.0, 0.5, 0.8, 1.0] {
        let (method, name) = (GeneralizedAlpha { rho_inf }, format!("ρ∞ = {rho_inf}"));
        assert_orders(&name, [2.0, 3.0], |n| {
            run(&method, Pendulum, PENDULUM, n, 0.0)
        });
        assert_orders(&name, [2.0, 3.0], |n| {
            run(&method, KnifeEdge, skate, n, 0.0)
        });
    }
}

/// Steps that are in turn 1.5 times longer and shorter: a moves along with the step size, or the order would be 1.
#[test]
fn order_two_with_uneven_steps() {
    for rho_inf in [0.0, 0.5, 0.8] {
        let method = GeneralizedAlpha { rho_inf };
        let [long, short] = [320, 640].map(|n| run(&method, Pendulum, PENDULUM, n, 0.2).error);
        let order = (long / short).log2();
        assert!((order - 2.0).abs() < 0.2, "ρ∞ = {rho_inf}: {order}");
    }
}

#[test]
fn positions_obey_the_constraints_to_rounding() {
    for n in [10, 30] {
        let largest = run(&GeneralizedAlpha::default(), Pendulum, PENDULUM, n, 0.2);
        assert!(largest.residual < 1e-14, "{largest:?}");
    }
}

/// Of an oscillation a million times faster than the step, each step leaves ρ∞ (a triple eigenvalue: n²·ρ∞ⁿ after n steps).
#[test]
fn fast_oscillations_are_damped_as_chosen() {
    for rho_inf in [0.3, 0.6] {
        let ode = Problem::new(Oscillator { k: 1e12 });
        let stepper = GeneralizedAlpha { rho_inf }.stepper(&ode);
        let mut steps = FixedSteps::new(ode, stepper, &[1.0, 0.0, 0.0, 0.0, 0.0]);
        let mut size = [0.0; 21];
        for size in &mut size {
            steps.step(1.0);
            *size = steps.y[0].abs();
        }
        let rate = (size[20] / size[10]).powf(0.1);
        let expected = rho_inf * 4.0_f64.powf(0.1);
        assert!(
            (rate / expected - 1.0).abs() < 0.02,
            "{rate} {expected} {size:?}"
        );
    }
}

/// Local errors of the size of the tolerance are h³, so the error at the end is of the order of tolerance^(2/3), for positions and for
/// velocities, whose index-3 part is h², too.
#[test]
fn the_error_follows_the_tolerance() {
    let mut errors = Vec::new();
    for tolerance in [1e-4, 1e-7] {
        let options = Options::with_tolerance(tolerance, tolerance);
        let (y0, t_end, exact) = PENDULUM;
        let (mut ode, interval) = (Problem::new(Pendulum), Interval::new(0.0, t_end));
        let method = GeneralizedAlpha::default();
        let end = integrate(&method, &mut ode, &interval, y0, &options, |_| {
            ControlFlow::Continue(())
        })
        .expect("smooth");
        let s = end.statistics;
        assert!(
            s.rejected() == 0 && s.newton_iterations < 3 * s.accepted,
            "{s:?}"
        );
        errors.push(distance(&end.y, exact));
    }
    let exponent = (errors[0] / errors[1]).log10() / 3.0;
    assert!(
        (exponent - 2.0 / 3.0).abs() < 0.15,
        "{exponent}: {errors:?}"
    );
    assert!(errors[1] < 5e-5, "{errors:?}");
}
