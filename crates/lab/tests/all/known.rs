//! Compares every reference method with known motions, and with pfaff if the mechanism is
//! redundant.

use dynamics::{MotionOptions, PreparedMechanism, RowChoice, prepare, simulate};
use lab::comparators::{Comparator, Drift, Formulation, Method, run};
use lab::mechanisms::cranks::cranks;
use lab::mechanisms::robot::{robot, steering};
use model::{Description, Mechanism, StartOptions, System};
use std::ops::ControlFlow;
use suite::{Instant, Quantity};

pub(crate) fn started(d: &Description) -> PreparedMechanism {
    let mechanism = Mechanism::build(d).expect("builds");
    prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic).expect("starts")
}

/// Returns a case of the suite at its initial state, with the known values.
fn case(name: &str) -> (PreparedMechanism, Vec<Instant>) {
    let case = suite::find(name).expect("a case");
    let registry = model::Registry::standard();
    let study = pfaff::Study::read(
        case.name,
        case.scene,
        &registry,
        &pfaff::RunOptions::default(),
    );
    let instants = case.reference().instants;
    let later = instants.into_iter().filter(|i| i.t > 0.0).collect();
    (study.expect("starts").prepared, later)
}

/// Returns the largest difference from the known coordinates and velocities.
fn off(p: &PreparedMechanism, row: &lab::comparators::Row, instant: &Instant) -> f64 {
    assert_eq!(row.t, instant.t);
    let mechanism = &p.mechanism;
    let coordinate = |of: &str, name: &str| {
        (0..mechanism.layout().n_v).find(|&k| mechanism.coordinate(k) == (of, name))
    };
    let mut worst = 0.0_f64;
    for fact in &instant.facts {
        let (of, name) = match fact.quantity {
            Quantity::X | Quantity::Vx => (&fact.of, "x"),
            Quantity::Y | Quantity::Vy => (&fact.of, "y"),
            Quantity::Angle | Quantity::Omega => (&fact.of, "angle"),
            _ => continue,
        };
        let Some(k) = coordinate(of, name) else {
            continue;
        };
        let found = match fact.quantity {
            Quantity::X | Quantity::Y | Quantity::Angle => row.q[k],
            _ => row.v[k],
        };
        worst = worst.max((found - fact.value).abs());
    }
    worst
}

/// Returns all combinations of formulations and methods with projection, then every treatment of
/// drift with one method. Proximal iterations without a treatment of drift are omitted. There, a
/// redundant row with a residual δ causes an acceleration of k·δ²/μ, so that the drift increases
/// itself.
fn ways() -> Vec<Comparator> {
    let mut ways = Vec::new();
    for formulation in Formulation::ALL {
        for method in Method::ALL {
            let drift = Drift::Projection;
            ways.push(Comparator {
                formulation,
                method,
                drift,
            });
        }
        for drift in [Drift::BAUMGARTE, Drift::None] {
            if (formulation, drift) == (Formulation::Proximal, Drift::None) {
                continue;
            }
            let method = Method::Dop853;
            ways.push(Comparator {
                formulation,
                method,
                drift,
            });
        }
    }
    ways
}

/// Returns the error bound of a run: a multiple of the tolerance for the accurate methods, and a
/// multiple of the tolerance to the power 2/3 for order 2.
fn bound(way: Comparator, tolerance: f64, factor: f64) -> f64 {
    match way.method {
        Method::GeneralizedAlpha => factor * tolerance.powf(2.0 / 3.0),
        _ => factor * tolerance,
    }
}

/// Returns the tolerance of a run. It is looser for a method of order 2, which would otherwise need
/// a million steps.
fn tolerance(way: Comparator) -> f64 {
    match way.method {
        Method::GeneralizedAlpha => 1e-6,
        _ => 1e-9,
    }
}

fn check(name: &str, factor: f64) {
    let (p, instants) = case(name);
    let times: Vec<f64> = instants.iter().map(|i| i.t).collect();
    for way in ways() {
        let found = run(&p, way, tolerance(way), &times)
            .unwrap_or_else(|e| panic!("{name} by {way:?}: {e}"));
        assert_eq!(found.rows.len(), times.len());
        let errors = found.rows.iter().zip(&instants).map(|(r, i)| off(&p, r, i));
        let error = errors.fold(0.0, f64::max);
        let bound = bound(way, tolerance(way), factor);
        assert!(error < bound, "{name} by {way:?}: {error:.1e}, {bound:.1e}");
        assert!(error > 0.0, "{name} by {way:?} has the answer");
    }
}

#[test]
fn three_cranks_move_as_elliptic_functions_say() {
    check("three-cranks", 300.0);
}

#[test]
fn the_sleigh_moves_as_its_closed_form_says() {
    check("sleigh", 300.0);
}

#[test]
fn the_robot_moves_as_two_derivations_say() {
    check("robot-trolley", 3000.0);
}

/// Returns the last state of the motion computed by pfaff.
pub(crate) fn product(p: &PreparedMechanism, t_end: f64, tolerance: f64) -> (Vec<f64>, Vec<f64>) {
    let options = MotionOptions {
        rtol: tolerance,
        atol: tolerance,
        output_step: t_end,
        ..MotionOptions::to(t_end)
    };
    let mut end = (Vec::new(), Vec::new());
    simulate(p, &options, |row| {
        end = (row.q.to_vec(), row.v.to_vec());
        Ok(ControlFlow::Continue(()))
    })
    .expect("moves");
    end
}

pub(crate) fn gap(a: &[f64], b: &[f64]) -> f64 {
    let gaps = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    gaps.fold(0.0, f64::max)
}

/// The mechanisms are three cranks under gravity, and the robot with its drive and break times.
/// Both are redundant, and the unique reactions equal the reactions computed by pfaff.
#[test]
fn redundant_mechanisms_move_as_the_product_moves_them() {
    let mut swinging = cranks(&[-0.8, 0.0, 0.8], 0.5, -1.0);
    swinging.gravity = [0.0, -9.81];
    for (name, d, t_end) in [("cranks", swinging, 2.0), ("robot", robot(steering()), 3.0)] {
        let p = started(&d);
        assert!(p.decision.redundancy > 0);
        let (q, v) = product(&p, t_end, 1e-12);
        for way in ways() {
            let found = run(&p, way, tolerance(way), &[t_end])
                .unwrap_or_else(|e| panic!("{name} by {way:?}: {e}"));
            let row = &found.rows[0];
            let error = gap(&row.q, &q).max(gap(&row.v, &v));
            let bound = bound(way, tolerance(way), 3000.0);
            assert!(error < bound, "{name} by {way:?}: {error:.1e}");
        }
    }
}
