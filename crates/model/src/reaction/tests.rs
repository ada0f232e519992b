//! Tests reactions of mechanisms in space by action and reaction.

use joints::space3::{Axes, Revolute};

use crate::description::{BodyRef, SpatialBody, SpatialDescription};
use crate::mechanism::Mechanism;
use crate::reaction::ConstraintId;
use crate::system::System;

/// Two bodies with rotated frames, a hinge on the ground, and a hinge between the bodies.
fn two_hinges() -> Mechanism {
    let unit = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut d = SpatialDescription::new("two hinges");
    let turned = [[0.5, 0.5, -0.5, 0.5], [0.8, 0.0, 0.6, 0.0]];
    let bodies = turned.map(|orientation| {
        d.body(SpatialBody {
            position: [0.3, -0.2, 0.9],
            orientation,
            ..SpatialBody::new("body", 1.0, unit)
        })
    });
    d.bodies[1].name.push('2');
    let pairs = [[BodyRef::Ground, bodies[0]], bodies];
    for (name, pair) in ["first", "second"].into_iter().zip(pairs) {
        let [s_i, s_j] = pair.map(|body| d.local(body, [0.7, 0.1, 0.4]));
        let axis = Axes::FRAME;
        let hinge = Revolute {
            s_i,
            s_j,
            axis,
            axis_j: axis,
        };
        d.joint(name, &pair, hinge);
    }
    Mechanism::build(&d).expect("builds")
}

#[test]
fn the_total_on_a_body_is_the_opposite_of_the_reaction_of_its_only_other_joint() {
    let mechanism = two_hinges();
    let (q, _) = mechanism.described_state();
    let mut s = mechanism.scratch();
    mechanism.pose(0.0, &q, &mut s);
    mechanism.c(&mut s);
    let lambda: Vec<f64> = (0..10).map(|k| f64::from(k * k) - 7.5).collect();
    let reactions = mechanism.reactions(&s);
    // Only the second hinge acts on the second body, but its reaction is reported for the first
    // body.
    let second = ConstraintId(1);
    let place = reactions.place(second);
    let total = reactions.body_wrench_map(1, place).expect("a body");
    let own = reactions.wrench_map(second);
    for k in 0..6 {
        let on_body: f64 = (0..10).map(|j| total[(k, j)] * lambda[j]).sum();
        let on_first: f64 = (0..5).map(|j| own[(k, j)] * lambda[5 + j]).sum();
        assert!(
            (on_body + on_first).abs() < 1e-12,
            "{k}: {on_body} {on_first}"
        );
    }
}

#[test]
fn only_the_hinge_on_the_ground_acts_on_it() {
    let mechanism = two_hinges();
    let (q, _) = mechanism.described_state();
    let mut s = mechanism.scratch();
    mechanism.pose(0.0, &q, &mut s);
    mechanism.c(&mut s);
    let acts = [0, 1].map(|k| mechanism.reactions(&s).acts_on_ground(ConstraintId(k)));
    assert_eq!(acts, [true, false]);
}
