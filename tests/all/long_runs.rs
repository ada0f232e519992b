//! Runs that pass singular configurations many times have no drift and no failure.

use std::f64::consts::FRAC_PI_2;
use std::ops::ControlFlow;

use dynamics::{EventKind, Method, MotionOptions, RowChoice, Summary, prepare, simulate};
use model::{Description, Mechanism, StartOptions};
use tests::cranks::cranks;

/// Three cranks swing under gravity from rest at θ. The singular configurations are 0 and −π, and
/// the lowest position is −π/2.
fn swinging(theta: f64) -> Description {
    let mut d = cranks(&[0.0, 1.0, 1.7], 0.5, theta);
    d.gravity = [0.0, -9.81];
    d
}

fn run(theta: f64, options: &MotionOptions) -> (Summary, Vec<f64>) {
    let mechanism = Mechanism::build(&swinging(theta)).expect("builds");
    let p = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic).expect("starts");
    let mut q = Vec::new();
    let summary = simulate(&p, options, |s| {
        q = s.q.to_vec();
        Ok(ControlFlow::Continue(()))
    })
    .unwrap_or_else(|e| {
        panic!(
            "{:?}, rtol {}, max_step {}: {e}",
            options.method, options.rtol, options.max_step
        )
    });
    (summary, q)
}

/// The start is above or below a singular configuration.
const ABOVE: f64 = 0.5;
const BELOW: f64 = -0.7;

/// The runs take 300 s. A start above the singular configuration gives some 190 swings that pass a
/// singular configuration twice; there the drift of the energy is larger, because the rounding
/// errors are larger.
#[test]
fn three_cranks_swing_for_300_seconds() {
    for (theta, drift, passages) in [(BELOW, 1e-12, 0), (ABOVE, 1e-10, 300)] {
        let (summary, q) = run(
            theta,
            &MotionOptions {
                rtol: 1e-14,
                atol: 1e-14,
                output_step: 1.0,
                method: Method::Dop853,
                ..MotionOptions::to(300.0)
            },
        );
        assert!(
            summary.max_position_residual <= 1e-12,
            "{theta}: {summary:?}"
        );
        assert!(
            summary.max_velocity_residual <= 1e-12,
            "{theta}: {summary:?}"
        );
        assert!(
            summary.energy_balance <= drift,
            "{:.1e}",
            summary.energy_balance
        );
        let passed = summary
            .events
            .iter()
            .filter(|e| e.kind == EventKind::SingularPassage)
            .count();
        assert!(
            passed >= passages && (passages > 0 || passed == 0),
            "{passed}"
        );
        assert!(
            (q[2] - q[5]).abs() < 1e-10 && (q[2] - q[8]).abs() < 1e-10,
            "{q:?}"
        );
        let amplitude = (q[2] + FRAC_PI_2).abs();
        assert!(
            amplitude < theta + FRAC_PI_2 + 1e-9,
            "higher than the start: {q:?}"
        );
    }
}

/// For any maximum step size there is no NaN, and the cranks remain parallel.
#[test]
fn sixty_four_step_sizes_over_the_flat_pose() {
    let reference = run(
        ABOVE,
        &MotionOptions {
            rtol: 1e-12,
            atol: 1e-12,
            output_step: 3.0,
            method: Method::Dop853,
            ..MotionOptions::to(3.0)
        },
    )
    .1;
    for k in 0..64 {
        let options = MotionOptions {
            rtol: 1e-9,
            atol: 1e-9,
            max_step: 0.02 * 1.03_f64.powi(k),
            output_step: 3.0,
            method: [Method::Dop853, Method::Dopri5][k as usize % 2],
            ..MotionOptions::to(3.0)
        };
        let (summary, q) = run(ABOVE, &options);
        let error = q
            .iter()
            .zip(&reference)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        assert!(error < 1e-6, "max_step {}: {error:.1e}", options.max_step);
        assert!(
            summary.max_position_residual <= 1e-12 && summary.max_velocity_residual <= 1e-12,
            "{summary:?}"
        );
    }
}
