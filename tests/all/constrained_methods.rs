//! Methods that treat the constraints as equations of their own give the motion of those that see accelerations.

use std::ops::ControlFlow;

use dynamics::{Method, MotionOptions, Prepared, RowChoice, Summary, prepare, simulate};
use joints::SpringDamper;
use model::{BodyRef, Description, Force, Mechanism, StartOptions};
use tests::cranks::cranks;
use tests::robot::{robot, steering};

fn prepared(d: &Description) -> Prepared {
    let mechanism = Mechanism::build(d).expect("a mechanism");
    prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic).expect("a start")
}

/// State at the end and the numbers of the run.
fn run(p: &Prepared, method: Method, tolerance: f64, t_end: f64) -> (Vec<f64>, Summary) {
    let options = MotionOptions {
        method,
        rtol: tolerance,
        atol: tolerance,
        output_step: t_end,
        ..MotionOptions::to(t_end)
    };
    let mut end = Vec::new();
    let summary = simulate(p, &options, |row| {
        end = [row.q, row.v].concat();
        Ok(ControlFlow::Continue(()))
    });
    (
        end,
        summary.unwrap_or_else(|e| panic!("{method:?} at {tolerance:e}: {e}")),
    )
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

fn falling_cranks() -> Description {
    let mut three = cranks(&[0.0, 1.0, 2.0], 0.8, 0.9);
    three.gravity = [0.0, -9.81];
    three
}

/// Both mechanisms are redundant. Generalized-α sees no acceleration of a constraint; the reference does.
#[test]
fn the_motion_is_that_of_the_index_one_equations() {
    for (name, p, t_end) in [
        ("cranks", prepared(&falling_cranks()), 0.3),
        ("robot", prepared(&robot(steering())), 3.0),
    ] {
        let (exact, _) = run(&p, Method::Dop853, 1e-12, t_end);
        // A method of order 2 with steps of the size tolerance^(1/3).
        let alpha =
            [1e-3, 1e-5, 1e-7].map(|t: f64| (Method::GeneralizedAlpha, t, 2.0 * t.powf(2.0 / 3.0)));
        for (method, tolerance, bound) in alpha {
            let (end, s) = run(&p, method, tolerance, t_end);
            let error = distance(&end, &exact);
            assert!(
                error < bound,
                "{name}, {method:?} at {tolerance:e}: {error:.2e}"
            );
            assert!(
                s.energy_balance < bound,
                "{name}, {method:?} at {tolerance:e}: {s:?}"
            );
            let residual = s.max_position_residual.max(s.max_velocity_residual);
            assert!(
                residual < 1e-14,
                "{name}, {method:?} at {tolerance:e}: {residual:.1e}"
            );
        }
    }
}

/// A spring of k = 10¹⁰ N/m holds the cranks against gravity; it swings a hundred thousand times faster than the steps that generalized-α takes. Were
/// the derivatives of its force wrong, Newton's method would diverge; Dormand-Prince would need a million steps.
#[test]
fn generalized_alpha_steps_over_the_oscillations_of_a_stiff_spring() {
    let mut held = falling_cranks();
    for body in &mut held.bodies {
        body.velocity = Some([0.0; 2]);
        body.angular_velocity = Some(0.0);
    }
    let spring = SpringDamper {
        s_i: [0.3, 2.0],
        s_j: [0.2, 0.1],
        stiffness: 1e10,
        damping: 1e3,
        free_length: None,
        free_length_0: 0.0,
    };
    held.forces = vec![Force {
        name: "spring".into(),
        bodies: vec![BodyRef::Ground, BodyRef::Body(3)],
        element: Box::new(spring),
        functions: Vec::new(),
    }];
    let p = prepared(&held);
    for (tolerance, steps, velocity) in [(1e-3, 50, 5e-5), (1e-5, 500, 5e-6)] {
        let (end, s) = run(&p, Method::GeneralizedAlpha, tolerance, 2.0);
        // The weight over the stiffness.
        let sag = distance(&end[..12], &p.q);
        assert!((1e-9..1e-8).contains(&sag), "{tolerance:e}: {sag:.2e}");
        let speed = distance(&end[12..], &p.v);
        assert!(speed < velocity, "{tolerance:e}: {speed:.2e}");
        assert!(s.steps < steps, "{tolerance:e}: {s:?}");
    }
}
