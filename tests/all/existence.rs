//! Redundant drives that are consistent, and drives that contradict each other: in velocities, in
//! accelerations, and at a later time.

use std::f64::consts::FRAC_PI_2;

use dynamics::{MotionError, RowChoice, prepare};
use model::start::{Metric, nearest_configuration};
use model::{BodyRef, Function, Mechanism, StartOptions, System};
use solvability::{
    ConstraintLevel, Contradiction, Ranks, StateError, contradictions, decide, decide_holonomic,
};
use tests::cranks::{cranks, driven_parallelogram, motor};

fn polynomial(coefficients: &[f64]) -> Function {
    Function::polynomial(coefficients).expect("finite")
}

fn refused(motions: [Function; 2]) -> Option<Contradiction> {
    let mechanism = Mechanism::build(&driven_parallelogram(motions)).expect("builds");
    match prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic) {
        Ok(_) => None,
        Err(MotionError::Contradiction(found)) => Some(found),
        Err(other) => panic!("{other}"),
    }
}

#[test]
fn drives_that_follow_the_same_law_agree() {
    let sin = Function::harmonic(0.3, 2.0, 0.0, 0.0).expect("finite");
    // Another law has the same velocity and acceleration at t = 0; 0.3·2.0 is rounded.
    let law = polynomial(&[0.0, 0.6]);
    for motions in [
        [polynomial(&[0.0, 1.0, 2.0]), polynomial(&[5.0, 1.0, 2.0])],
        [sin.clone(), sin.clone()],
        [sin, law],
        // The drives are at rest, and one of them has the rounding error of cos(π/2).
        [
            Function::harmonic(1.0, 1e-3, FRAC_PI_2, 0.0).expect("finite"),
            polynomial(&[0.0, 0.0, -0.5e-6]),
        ],
    ] {
        assert_eq!(refused(motions), None);
    }
}

#[test]
fn drives_that_differ_are_named_with_the_difference() {
    let tiny = 1e-9;
    for (coefficients, level, size) in [
        ([0.0, 1.25, 0.0], ConstraintLevel::Velocity, 0.25),
        ([0.0, 1.0, 0.1], ConstraintLevel::Acceleration, 0.2),
        ([0.0, 1.0, tiny], ConstraintLevel::Acceleration, 2.0 * tiny),
    ] {
        let found = refused([polynomial(&[0.0, 1.0]), polynomial(&coefficients)]).expect("differ");
        assert_eq!(found.level, level);
        assert!((found.size - size).abs() < 1e-12, "{found}");
        let text = found.to_string();
        for part in ["`one`", "`other`", "rad/s", "delete or correct one"] {
            assert!(text.contains(part), "{text}");
        }
    }
}

/// Near the singular configuration the coefficients by which redundant rows depend on independent
/// ones have errors of 1/σ roundings. This causes no false alarm, and a real difference is still
/// detected.
#[test]
fn nearly_singular_rows_give_no_false_alarm() {
    for theta in [1e-6, 1e-5, 1e-4, 1e-3, 1e-2] {
        for (second, agrees) in [([0.0, 3.0, 2.0], true), ([0.0, 3.0, 2.1], false)] {
            let mut d = cranks(&[0.0, 1.0, 1.7], 0.5, theta);
            d.drives = vec![
                motor("one", 0, polynomial(&[0.0, 3.0, 2.0])),
                motor("other", 1, polynomial(&second)),
            ];
            let mechanism = Mechanism::build(&d).expect("builds");
            let found = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic);
            match found {
                Ok(_) => assert!(agrees, "θ = {theta}: nothing found"),
                Err(MotionError::Contradiction(c)) => assert!(!agrees, "θ = {theta}: {c}"),
                Err(other) => panic!("θ = {theta}: {other}"),
            }
        }
    }
}

/// A check that compared rates with the largest function of the model would not detect this
/// contradiction.
#[test]
fn a_large_function_of_another_drive_hides_nothing() {
    let mut d = driven_parallelogram([polynomial(&[0.0, 1.0]), polynomial(&[0.0, 1.0, 1e-3])]);
    let far = cranks(&[10.0], 0.5, 1.0);
    d.bodies.push(far.bodies[0].clone());
    d.bodies[3].name = "far crank".into();
    let mut pivot = far.joints[0].clone();
    pivot.name = "far pivot".into();
    pivot.bodies = vec![BodyRef::Ground, BodyRef::Body(3)];
    d.joints.push(pivot);
    d.drives.push(motor("fast", 3, polynomial(&[0.0, 1e6])));
    let mechanism = Mechanism::build(&d).expect("builds");
    let error = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic).err();
    assert!(
        matches!(&error, Some(MotionError::Contradiction(c)) if c.rows.iter().all(|r| r.joint != "fast")),
        "{error:?}"
    );
}

/// The laws agree in all derivatives at t = 0 and differ later: then positions contradict each
/// other.
#[test]
fn positions_contradict_later() {
    let late = Function::steps(0.0, &[[1.0, 2.0, 1e-5]]).expect("ordered");
    let mechanism =
        Mechanism::build(&driven_parallelogram([late, polynomial(&[0.0])])).expect("builds");
    let p = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic).expect("agree");
    let m = &p.mechanism;
    let holds = &p.position_decision.kept;
    let found = |t: f64| {
        let q =
            nearest_configuration(m, t, holds, &p.q, Metric::Mass).expect("kept rows can be met");
        let mut s = m.scratch();
        m.pose(t, &q, &mut s);
        m.phi(&mut s);
        m.c(&mut s);
        // The rank is that of C; the residual of the redundant row does not affect it.
        s.phi.fill(0.0);
        let all = decide(m, &s, &q).expect("finite");
        let holonomic = decide_holonomic(m, &s, &q).expect("finite");
        let ranks = Ranks {
            all: &all,
            holonomic: &holonomic,
        };
        contradictions(m, t, &q, &[0.0; 9], ranks).expect("a state")
    };
    assert_eq!(found(1.0), []);
    let later = found(2.0);
    let [one] = later.as_slice() else {
        panic!("{later:?}");
    };
    assert_eq!(one.level, ConstraintLevel::Position);
    // The size is that of the linearised rows.
    assert!((one.size - 1e-5).abs() < 1e-9 && one.unit == "rad", "{one}");
}

/// Two horizontal cranks rotate in the same or in opposite directions at equal speed; for other
/// velocities no motion exists.
#[test]
fn velocities_that_cannot_leave_a_flat_pose() {
    let (length, pitch) = (0.5, 1.0);
    let mechanism = Mechanism::build(&cranks(&[0.0, pitch], length, 0.0)).expect("builds");
    let (q, _) = mechanism.described_state();
    let mut s = mechanism.scratch();
    mechanism.pose(0.0, &q, &mut s);
    mechanism.phi(&mut s);
    mechanism.c(&mut s);
    let decision = decide(&mechanism, &s, &q).expect("finite");
    let ranks = Ranks {
        all: &decision,
        holonomic: &decision,
    };
    // The tips move at speeds v1 and v2 across the line.
    let found = |v1: f64, v2: f64| {
        let crank = |v: f64| [0.0, 0.5 * v, v / length];
        let coupler = [0.0, 0.5 * (v1 + v2), (v2 - v1) / pitch];
        let v = [crank(v1), crank(v2), coupler].concat();
        contradictions(&mechanism, 0.0, &q, &v, ranks).expect("a state")
    };
    assert_eq!(found(1.0, 1.0), []);
    // The second-order condition (v2 − v1)·[(v2 + v1)/L − (v2 − v1)/d] = 0 describes the other
    // branch.
    assert_eq!(found(length - pitch, length + pitch), []);
    let wrong = found(1.0, 2.0);
    assert_eq!(wrong.len(), 1);
    assert_eq!(wrong[0].level, ConstraintLevel::Acceleration);
    assert!(
        (wrong[0].size - (3.0 / length - 1.0 / pitch)).abs() < 1e-12,
        "{}",
        wrong[0]
    );
    assert!(
        wrong[0]
            .to_string()
            .contains("m/s². The configuration is singular")
    );
}

#[test]
fn a_state_of_another_mechanism_is_refused() {
    let mechanism = Mechanism::build(&cranks(&[0.0, 1.0], 0.5, 1.0)).expect("builds");
    let (q, _) = mechanism.described_state();
    let mut s = mechanism.scratch();
    mechanism.pose(0.0, &q, &mut s);
    mechanism.c(&mut s);
    let decision = decide(&mechanism, &s, &q).expect("finite");
    let ranks = Ranks {
        all: &decision,
        holonomic: &decision,
    };
    let with = |q: &[f64], v: &[f64]| contradictions(&mechanism, 0.0, q, v, ranks).unwrap_err();
    assert!(matches!(
        with(&q, &[0.0]),
        StateError::Length {
            found: 1,
            expected: 9,
            ..
        }
    ));
    assert!(matches!(
        with(&[f64::NAN; 9], &[0.0; 9]),
        StateError::NotFinite { index: 0, .. }
    ));
}
