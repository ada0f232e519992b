//! Small mechanisms whose verdicts can be derived by hand.

use joints::plane::Direction;
use joints::{KnifeEdge, RevoluteAngleDrive};
use model::{Body, BodyRef, Description, Drive, Function, Joint, Mechanism, System};
use solvability::{Analysis, Solvability, analyse, is_permanent};
use tests::cranks::cranks;
use tests::{revolute, rod};

fn drive(name: &str, bodies: [BodyRef; 2]) -> Drive {
    // The angle needs no points.
    let element = RevoluteAngleDrive::new([0.0; 2], [0.0; 2]);
    Drive {
        tolerance: None,
        name: name.into(),
        bodies: bodies.to_vec(),
        element: Box::new(element),
        motion: Function::constant_rate(1.0).expect("finite"),
    }
}

fn driven_cranks(pivots: &[f64], theta: f64) -> Description {
    let mut d = cranks(pivots, 0.5, theta);
    d.drives
        .push(drive("motor", [BodyRef::Ground, BodyRef::Body(0)]));
    d
}

fn analysed(d: &Description) -> Analysis {
    let mechanism = Mechanism::build(d).expect("the mechanism builds");
    let (q, _) = mechanism.described_state();
    analyse(&mechanism, 0.0, &q).expect("C is finite")
}

fn assert_ranks(a: &Analysis, rows: usize, rank: usize) {
    assert_eq!(a.holonomic_rows + a.nonholonomic_rows, rows);
    assert_eq!(
        (a.decision.rank, a.decision.redundancy),
        (rank, rows - rank)
    );
    assert!(a.decision.is_decided());
}

fn words(a: &Analysis) -> Vec<(&str, &str)> {
    a.reactions
        .iter()
        .map(|r| (r.name.as_str(), r.wrench.verdict.word()))
        .collect()
}

fn components<'a>(a: &'a Analysis, name: &str) -> Vec<(&'a str, &'a str)> {
    let r = a
        .reactions
        .iter()
        .find(|r| r.name == name)
        .expect("the joint exists");
    r.components
        .iter()
        .map(|c| (c.name, c.judgement.verdict.word()))
        .collect()
}

/// Case P1 at θ = 1: all reactions of a driven parallelogram are determined.
#[test]
fn two_cranks_at_an_angle() {
    let a = analysed(&driven_cranks(&[0.0, 1.0], 1.0));
    assert_ranks(&a, 9, 9);
    assert!(words(&a).iter().all(|(_, word)| *word == "unique"));
}

/// Case P1 at θ = 0: in the singular configuration the four revolutes can have forces along the
/// line.
#[test]
fn two_flat_cranks() {
    let a = analysed(&driven_cranks(&[0.0, 1.0], 0.0));
    assert_ranks(&a, 9, 8);
    for joint in ["pivot 1", "tip 1", "pivot 2", "tip 2"] {
        assert_eq!(
            components(&a, joint),
            [("Fx", "not_unique"), ("Fy", "unique")],
            "{joint}"
        );
    }
    assert_eq!(words(&a).last(), Some(&("motor", "unique")));
}

/// Case P2 at θ = 1: in every joint the component across the crank is unique, and the component
/// along it is not.
#[test]
fn three_cranks_at_an_angle() {
    let theta = 1.0_f64;
    let a = analysed(&driven_cranks(&[0.0, 1.0, 1.7], theta));
    assert_ranks(&a, 13, 12);
    for r in a.reactions.iter().filter(|r| r.name != "motor") {
        assert_eq!(r.wrench.verdict.word(), "not_unique", "{}", r.name);
        assert!(
            r.rows
                .iter()
                .all(|row| row.judgement.verdict.word() == "not_unique")
        );
        let [direction] = r.unique_directions.as_slice() else {
            panic!("one direction: {r:?}")
        };
        // Perpendicular to the crank, up to sign.
        let across = direction[0] * theta.cos() + direction[1] * theta.sin();
        assert!(across.abs() < 1e-12, "{}: {direction:?}", r.name);
    }
    assert_eq!(words(&a).last(), Some(&("motor", "unique")));
}

/// Case P2 at θ = 0, the singular configuration.
#[test]
fn three_flat_cranks() {
    assert_ranks(&analysed(&driven_cranks(&[0.0, 1.0, 1.7], 0.0)), 13, 11);
}

/// The four-bar has the points A(0, 0), B(0.3, 0.8), C(1.5, 1.1), D(1.4, 0).
fn four_bar(drives: &[BodyRef]) -> Description {
    let points = [[0.0, 0.0], [0.3, 0.8], [1.5, 1.1], [1.4, 0.0]];
    let bodies: Vec<Body> = (0..3)
        .map(|k| rod(&format!("bar {}", k + 1), 1.0, points[k], points[k + 1]))
        .collect();
    let body = BodyRef::Body;
    let pairs = [
        [BodyRef::Ground, body(0)],
        [body(0), body(1)],
        [body(1), body(2)],
        [BodyRef::Ground, body(2)],
    ];
    let joints: Vec<Joint> = ["A", "B", "C", "D"]
        .iter()
        .zip(pairs.iter().zip(points))
        .map(|(name, (pair, at))| revolute(name, &bodies, *pair, at))
        .collect();
    let drives = drives
        .iter()
        .enumerate()
        .map(|(k, &b)| drive(&format!("drive {}", k + 1), [BodyRef::Ground, b]))
        .collect();
    Description {
        name: "four-bar".into(),
        bodies,
        joints,
        drives,
        ..Description::default()
    }
}

/// Case P6 with one drive.
#[test]
fn four_bar_with_one_drive() {
    let a = analysed(&four_bar(&[BodyRef::Body(0)]));
    assert_ranks(&a, 9, 9);
    assert!(words(&a).iter().all(|(_, word)| *word == "unique"));
}

/// Case P6: drives at A and at D can have opposing torques, which load every joint.
#[test]
fn four_bar_with_two_drives() {
    let a = analysed(&four_bar(&[BodyRef::Body(0), BodyRef::Body(2)]));
    assert_ranks(&a, 10, 9);
    assert!(
        words(&a).iter().all(|(_, word)| *word == "not_unique"),
        "{:?}",
        words(&a)
    );
}

/// One body has four knife edges; the front pair is steered in parallel.
fn four_edges(steering: f64) -> (Analysis, Solvability) {
    let normal = |x: f64| {
        let angle = if x > 0.0 { steering } else { 0.0 };
        Direction::new([-angle.sin(), angle.cos()]).expect("a unit vector")
    };
    let places = [
        ("front left", 1.0, 0.4),
        ("front right", 1.0, -0.4),
        ("rear left", -1.0, 0.4),
        ("rear right", -1.0, -0.4),
    ];
    let joints = places.map(|(name, x, y)| {
        Joint::new(
            name,
            &[BodyRef::Body(0)],
            KnifeEdge {
                s: [x, y],
                normal: normal(x),
            },
        )
    });
    let body = Body {
        name: "cart".into(),
        mass: 1.0,
        inertia: 1.0,
        ..Body::default()
    };
    let d = Description {
        bodies: vec![body],
        joints: joints.to_vec(),
        ..Description::default()
    };
    let mechanism = Mechanism::build(&d).expect("the cart builds");
    let mut s = mechanism.scratch();
    mechanism.pose(0.0, &[0.0; 3], &mut s);
    mechanism.c(&mut s);
    let solvability = Solvability::of(&mechanism.layout().dense(&s), rank::Accuracy::Rounding)
        .expect("C is finite");
    (
        analyse(&mechanism, 0.0, &[0.0; 3]).expect("C is finite"),
        solvability,
    )
}

/// Case N1: four parallel edges.
#[test]
fn four_parallel_edges() {
    let (a, s) = four_edges(0.0);
    assert_ranks(&a, 4, 2);
    assert!(words(&a).iter().all(|(_, word)| *word == "not_unique"));
    let word = |l: [f64; 4]| s.combination(&l).expect("four rows").verdict.word();
    assert_eq!(word([1.0, 1.0, 0.0, 0.0]), "unique", "front pair");
    assert_eq!(word([0.0, 0.0, 1.0, 1.0]), "unique", "rear pair");
    assert_eq!(word([1.0, 0.0, 1.0, 0.0]), "not_unique", "left pair");
}

/// Case N3: the front pair steered by 0.3 rad in parallel locks the body.
#[test]
fn parallel_steered_edges() {
    let (a, s) = four_edges(0.3);
    assert_ranks(&a, 4, 3);
    assert_eq!(a.mobility(), 0);
    let expected = ["unique", "unique", "not_unique", "not_unique"];
    assert!(
        words(&a)
            .iter()
            .zip(expected)
            .all(|((_, word), e)| *word == e),
        "{:?}",
        words(&a)
    );
    assert_eq!(
        s.combination(&[0.0, 0.0, 1.0, 1.0])
            .expect("rows exist")
            .verdict
            .word(),
        "unique"
    );
}

/// The horizontal configurations are singular, and the third crank is redundant everywhere.
#[test]
fn permanent_and_transient_redundancy() {
    let permanent = |d: &Description| {
        let mechanism = Mechanism::build(d).expect("the mechanism builds");
        let (q, _) = mechanism.described_state();
        let a = analyse(&mechanism, 0.0, &q).expect("C is finite");
        is_permanent(&mechanism, 0.0, &q, &a.whole().expect("one part"))
    };
    assert_eq!(permanent(&driven_cranks(&[0.0, 1.0], 1.0)), Some(true));
    assert_eq!(permanent(&driven_cranks(&[0.0, 1.0], 0.0)), Some(false));
    assert_eq!(permanent(&driven_cranks(&[0.0, 1.0, 1.7], 1.0)), Some(true));
    assert_eq!(
        permanent(&driven_cranks(&[0.0, 1.0, 1.7], 0.0)),
        Some(false)
    );
    assert_eq!(
        permanent(&four_bar(&[BodyRef::Body(0), BodyRef::Body(2)])),
        Some(true)
    );
}
