//! Tests of the integration methods of the laboratory: orders, stiff springs, break times.

use dynamics::PreparedMechanism;
use joints::SpringDamper;
use lab::comparators::{Comparator, Drift, Formulation, Method, Run, run};
use lab::mechanisms::cranks::cranks;
use model::{BodyRef, Description, Force};

use crate::known::{gap, started};

fn moved(p: &PreparedMechanism, method: Method, tolerance: f64, t_end: f64) -> Run {
    let way = Comparator {
        formulation: Formulation::KeptRows,
        method,
        drift: Drift::Projection,
    };
    run(p, way, tolerance, &[t_end]).unwrap_or_else(|e| panic!("{method:?}: {e}"))
}

fn falling_cranks() -> Description {
    let mut three = cranks(&[0.0, 1.0, 2.0], 0.8, 0.9);
    three.gravity = [0.0, -9.81];
    three
}

/// Errors are proportional to tolerances, and the number of steps depends on the order. To reduce
/// the error by a factor of a thousand, a method of order 2 needs ten times as many steps, and
/// methods of high order need only a few more.
#[test]
fn work_grows_with_the_order() {
    let p = started(&falling_cranks());
    let exact = moved(&p, Method::Dop853, 1e-13, 0.3);
    let error = |found: &Run| gap(&found.rows[0].q, &exact.rows[0].q);
    for (method, tight, least, most) in [
        (Method::GeneralizedAlpha, 1e-7, 5.0, 40.0),
        (Method::Gbs, 1e-10, 1.0, 4.0),
    ] {
        let (loose, found) = (
            moved(&p, method, 1e3 * tight, 0.3),
            moved(&p, method, tight, 0.3),
        );
        let [before, after] = [error(&loose), error(&found)];
        assert!(after < 0.1 * before, "{method:?}: {after:e} {before:e}");
        let work = found.evaluations as f64 / loose.evaluations as f64;
        assert!(work > least && work < most, "{method:?}: {work}");
    }
}

/// A spring of k = 10¹⁰ N/m supports the cranks against gravity. The period of its oscillation is a
/// hundred thousand times shorter than the steps of generalized-α. Newton's method would diverge
/// with wrong derivatives of the spring force, and Dormand–Prince would need a million steps.
#[test]
fn generalized_alpha_steps_over_the_oscillations_of_a_stiff_spring() {
    let mut held = falling_cranks();
    for body in &mut held.bodies {
        body.velocity = Some([0.0; 2]);
        body.angular_velocity = Some(0.0);
    }
    let spring = SpringDamper::new([0.3, 2.0], [0.2, 0.1], 1e10, 1e3);
    held.forces = vec![Force {
        name: "spring".into(),
        bodies: vec![BodyRef::Ground, BodyRef::Body(3)],
        element: Box::new(spring),
        functions: Vec::new(),
    }];
    let p = started(&held);
    for (tolerance, steps) in [(1e-3, 50), (1e-5, 500)] {
        let found = moved(&p, Method::GeneralizedAlpha, tolerance, 2.0);
        // The extension is the weight divided by the stiffness.
        let sag = gap(&found.rows[0].q, &p.q);
        assert!((1e-9..1e-8).contains(&sag), "{tolerance:e}: {sag:.2e}");
        let speed = gap(&found.rows[0].v, &p.v);
        assert!(speed < 0.1 * tolerance, "{tolerance:e}: {speed:.2e}");
        assert!(found.steps < steps, "{tolerance:e}: {} steps", found.steps);
    }
}
