//! Points about which moments are unique, compared with manually derived free wrenches.

use joints::space3::{Axes, Distance, Fixed, Revolute};
use model::{BodyRef, ConstraintId, Mechanism, SpatialBody, SpatialDescription};

use crate::{Configuration, certify};

const TENSOR: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

fn hinge(d: &mut SpatialDescription, name: &str, pair: [BodyRef; 2], at: [f64; 3]) {
    let [s_i, s_j] = pair.map(|body| d.local(body, at));
    let axis = Axes::FRAME;
    let axis_j = axis;
    d.joint(
        name,
        &pair,
        Revolute {
            s_i,
            s_j,
            axis,
            axis_j,
        },
    );
}

fn asked(d: &SpatialDescription, ask: impl FnOnce(&Configuration<'_>)) {
    let mechanism = Mechanism::build(d).expect("a mechanism");
    let (q, _) = mechanism.described_state();
    let decision = certify(&mechanism, 0.0, &q).expect("a rank");
    assert!(decision.is_decided());
    ask(&Configuration::new(&mechanism, 0.0, &q, &decision).expect("a configuration"));
}

/// A body that is welded to the ground twice over one bar. The free wrench is a tension along the
/// bar, from (1, 1, 0) to (1, 3, 0). Therefore moments are unique about the points of the line x =
/// 1, z = 0.
#[test]
fn points_of_a_line_are_the_nearest() {
    let mut d = SpatialDescription::new("bar");
    let body = d.body(SpatialBody::new("body", 1.0, TENSOR));
    let pair = [BodyRef::Ground, body];
    let axes = Axes::FRAME;
    let weld = Fixed {
        s_i: [0.0, 0.0, 2.0],
        s_j: [0.0, 0.0, 2.0],
        axes,
        axes_j: axes,
    };
    d.joint("weld", &pair, weld);
    let (s_i, s_j) = ([1.0, 3.0, 0.0], [1.0, 1.0, 0.0]);
    d.joint("bar", &pair, Distance::new(s_i, s_j));
    asked(&d, |configuration| {
        let weld = ConstraintId(0);
        let centre = configuration.centre_of_moments(weld).expect("a reaction");
        let centre = centre.expect("a centre");
        let right = [1.0, 0.0, 0.0];
        assert!(
            centre.iter().zip(right).all(|(a, b)| (a - b).abs() < 1e-12),
            "{centre:?}"
        );
        let unique = |about| {
            configuration
                .moment(weld, about)
                .expect("finite")
                .is_unique()
        };
        assert!(unique([1.0, -7.0, 0.0]));
        assert!(!unique([1.0, -7.0, 1e-3]));
    });
}

/// Two coaxial hinges carry a door. The force along the axis is free, and two couples are free.
/// Therefore there is no point about which the moment is unique.
#[test]
fn a_couple_has_no_centre() {
    let mut d = SpatialDescription::new("door");
    let leaf = d.body(SpatialBody::new("leaf", 1.0, TENSOR));
    for (name, z) in [("lower", 0.0), ("upper", 2.0)] {
        hinge(&mut d, name, [BodyRef::Ground, leaf], [0.5, 0.0, z]);
    }
    asked(&d, |configuration| {
        let centre = configuration.centre_of_moments(ConstraintId(0));
        assert_eq!(centre.expect("a reaction"), None);
    });
}

/// If the force or the whole reaction is unique, no other point is reported.
#[test]
fn nothing_is_told_where_the_point_makes_no_difference() {
    let mut d = SpatialDescription::new("pendulum");
    let bob = d.body(SpatialBody::new("bob", 1.0, TENSOR));
    hinge(&mut d, "pivot", [BodyRef::Ground, bob], [0.0, 0.0, 1.0]);
    asked(&d, |configuration| {
        let centre = configuration.centre_of_moments(ConstraintId(0));
        assert_eq!(centre.expect("a reaction"), None);
        let moment = configuration
            .moment(ConstraintId(0), [5.0, 0.0, 0.0])
            .expect("finite");
        let names: Vec<&str> = moment.components.iter().map(|c| c.name).collect();
        assert_eq!((names, moment.is_unique()), (vec!["Tx", "Ty", "Tz"], true));
    });
}
