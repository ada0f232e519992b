//! Deletions, structure and explanation of the robot and of small mechanisms, compared with results
//! derived by hand.

use model::{Description, Function, Mechanism, Scratch, StartOptions, System};
use rank::{Limits, StructureVerdict};
use solvability::{
    DeletableRows, Solvability, analyse_by_cycles, decide, explain, make_unique, structure,
};
use tests::cranks::cranks;
use tests::robot::robot;

/// A mechanism at a configuration, with its verdicts.
struct Case {
    mechanism: Mechanism,
    q: Vec<f64>,
    s: Scratch,
    solvability: Solvability,
}

fn case(mechanism: Mechanism, t: f64, q: Vec<f64>) -> Case {
    let mut s = mechanism.scratch();
    mechanism.pose(t, &q, &mut s);
    mechanism.phi(&mut s);
    mechanism.c(&mut s);
    let decision = decide(&mechanism, &s, &q).expect("C is finite");
    let c = mechanism.layout().dense(&s);
    // In this mechanism metres and radians differ by less than a factor of two.
    let solvability = Solvability::from_decision(&c, decision);
    Case {
        mechanism,
        q,
        s,
        solvability,
    }
}

fn described(d: &Description) -> Case {
    let mechanism = Mechanism::build(d).expect("the mechanism builds");
    let (q, _) = mechanism.described_state();
    case(mechanism, 0.0, q)
}

/// The robot at rest with its slider displaced and both knuckles rotated accordingly.
fn steered(displacement: f64) -> Case {
    let ramp = Function::steps(0.0, &[[0.0, 1.0, displacement]]).expect("a step");
    let mut d = robot(ramp);
    for body in &mut d.bodies {
        body.velocity = None;
    }
    let mechanism = Mechanism::build(&d).expect("the robot builds");
    let rows = dynamics::RowChoice::Automatic;
    let p = dynamics::prepare(mechanism, &StartOptions::default(), &rows).expect("starts");
    let options = dynamics::MotionOptions {
        output_step: 1.0,
        rtol: 1e-12,
        atol: 1e-12,
        ..dynamics::MotionOptions::to(1.0)
    };
    let mut q = Vec::new();
    dynamics::simulate(&p, &options, |s| {
        q = s.q.to_vec();
        Ok(std::ops::ControlFlow::Continue(()))
    })
    .expect("the robot steers at rest");
    case(p.mechanism, 1.0, q)
}

fn id(case: &Case, name: &str) -> model::ConstraintId {
    let groups = &case.mechanism.layout().groups;
    model::ConstraintId(
        groups
            .iter()
            .position(|g| g.name == name)
            .expect("the joint exists"),
    )
}

/// Returns the rows (from 1) of the sets that make a reaction unique.
fn sets(case: &Case, name: &str, allowed: &DeletableRows) -> Vec<Vec<usize>> {
    let found = make_unique(
        &case.mechanism,
        &case.solvability,
        id(case, name),
        allowed,
        Limits::default(),
    )
    .expect("decided");
    assert!(found.complete);
    let rows = found
        .ways
        .iter()
        .map(|way| way.rows.iter().map(|r| r + 1).collect());
    rows.collect()
}

fn with_w4(rows: &[usize]) -> Vec<Vec<usize>> {
    rows.iter().map(|&row| vec![row, 21]).collect()
}

#[test]
fn the_robot_straight_turned_and_at_right_angles() {
    for (displacement, pairs, alone) in [
        (0.0, 9, with_w4(&[4, 6, 18, 19])),
        (0.02, 13, with_w4(&[3, 4, 5, 6, 18, 19])),
        (-0.135_153_013_442_6, 8, vec![vec![21]]),
        (0.089_750_156_055_0, 8, vec![vec![21]]),
    ] {
        let robot = steered(displacement);
        let decision = robot.solvability.decision();
        assert_eq!(rank::count_deletions(decision), Ok(pairs), "{displacement}");
        assert_eq!(
            rank::deletions(decision, 99).expect("decided").len() as u128,
            pairs
        );
        assert_eq!(
            sets(&robot, "W3", &DeletableRows::Sensible),
            alone,
            "{displacement}"
        );
    }
}

#[test]
fn proposals_are_sentences_and_can_be_restricted() {
    let straight = described(&robot(Function::constant(0.0).expect("finite")));
    let w3 = |allowed: &DeletableRows| {
        let (m, s) = (&straight.mechanism, &straight.solvability);
        let found = make_unique(m, s, id(&straight, "W3"), allowed, Limits::default());
        found
            .expect("decided")
            .ways
            .into_iter()
            .map(|way| way.text)
            .collect::<Vec<_>>()
    };
    assert_eq!(
        w3(&DeletableRows::Sensible)[0],
        "relax row 4 (`B`, y) and delete `W4`"
    );
    assert_eq!(
        w3(&DeletableRows::Whole),
        ["delete `W1` and `W4`", "delete `W2` and `W4`"]
    );
    assert!(w3(&DeletableRows::Rows(vec![3, 17])).is_empty());
    assert_eq!(sets(&straight, "A", &DeletableRows::Sensible), [[0; 0]]);
}

#[test]
fn structure_settles_the_trolley_and_parts_agree_with_the_whole() {
    let turned = steered(0.02);
    let found = structure(&turned.mechanism, &turned.s, &turned.q).expect("C is finite");
    for name in ["A", "W5"] {
        assert_eq!(
            found.groups[id(&turned, name).0],
            StructureVerdict::Peeled,
            "{name}"
        );
    }
    let mut two = cranks(&[0.0, 1.0, 1.7], 0.5, 1.0);
    let other = cranks(&[5.0, 6.0], 0.5, 0.0);
    let n = two.bodies.len();
    for mut body in other.bodies {
        body.name.push('\'');
        two.bodies.push(body);
    }
    for mut joint in other.joints {
        joint.name.push('\'');
        for b in &mut joint.bodies {
            if let model::BodyRef::Body(k) = b {
                *k += n;
            }
        }
        two.joints.push(joint);
    }
    for c in [
        turned,
        steered(0.0),
        steered(-0.135_153_013_442_6),
        described(&cranks(&[0.0, 1.0], 0.5, 1.0)),
        described(&cranks(&[0.0, 1.0, 1.7], 0.5, 0.0)),
        described(&two),
    ] {
        let found = structure(&c.mechanism, &c.s, &c.q).expect("C is finite");
        let parts = analyse_by_cycles(&c.mechanism, c.s.t, &c.q).expect("C is finite");
        let groups = c.mechanism.layout().groups.iter();
        for ((group, settled), part) in groups.zip(&found.groups).zip(&parts.reactions) {
            let whole = c
                .solvability
                .group(group.rows.clone())
                .expect("rows exist")
                .verdict;
            assert_eq!(part.wrench.verdict.word(), whole.word(), "{}", group.name);
            if !matches!(settled, StructureVerdict::Open(_)) {
                assert_eq!(whole.word(), "unique", "{}", group.name);
            }
        }
    }
    let c = described(&two);
    let found = structure(&c.mechanism, &c.s, &c.q).expect("C is finite");
    assert_eq!(found.parts.len(), 2);
}

#[test]
fn the_robot_is_explained() {
    let c = steered(0.02);
    let e = explain(&c.mechanism, &c.s, &c.q, &c.solvability).expect("C is finite");
    assert_eq!(
        e.stresses[0].text,
        "`W3` and `W4` both prevent `platform` from slipping sideways along the same line: `W3.N` = 1 N and `W4.N` = −1 N cancel; `W3.N + W4.N` is not determined, either"
    );
    // A picture needs opposite unit forces on one line.
    let [a, b] = &e.stresses[0].directions[..] else {
        panic!("two edges")
    };
    assert!((a.force[0] + b.force[0]).abs() < 1e-12 && (a.force[1] + b.force[1]).abs() < 1e-12);
    assert!((a.force[0].hypot(a.force[1]) - 1.0).abs() < 1e-12);
    let names = ["B", "C", "W1", "W2", "W3", "W4"].map(|name| id(&c, name));
    assert_eq!(e.mixing.len(), 1);
    assert_eq!(
        (e.mixing[0].redundancy, e.mixing[0].reactions.as_slice()),
        (2, &names[..])
    );
    assert_eq!(e.reactions.iter().map(|r| r.id).collect::<Vec<_>>(), names);
    // Every self-stress is in equilibrium on every body, for forces and for torques about the
    // origin.
    for stress in &e.stresses {
        for body in 0..c.mechanism.bodies().len() {
            let mut sum = [0.0_f64; 3];
            for d in &stress.directions {
                for (slot, b) in d.bodies.iter().enumerate() {
                    if *b == model::BodyRef::Body(body) {
                        let sign = if slot == 0 { 1.0 } else { -1.0 };
                        let moment =
                            d.place[0] * d.force[1] - d.place[1] * d.force[0] + d.torque[2];
                        for (s, x) in sum.iter_mut().zip([d.force[0], d.force[1], moment]) {
                            *s += sign * x;
                        }
                    }
                }
            }
            assert!(sum.iter().all(|x| x.abs() < 1e-9), "body {body}: {sum:?}");
        }
    }
}
