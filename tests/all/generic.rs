//! Permanent or only here: what is compared with other configurations, and what they say.

use joints::{Revolute, RevoluteAngleDrive, Velocity, plane::Direction};
use model::{Body, BodyRef, Description, Drive, Function, Joint, Mechanism};
use solvability::{Generic, analyse, generic, is_permanent};
use tests::cranks::cranks;
use tests::robot::{robot, steering};

fn at_start(d: &Description) -> (usize, Option<Generic>) {
    let mechanism = Mechanism::build(d).expect("builds");
    let (q, _) = mechanism.described_state();
    let analysis = analyse(&mechanism, 0.0, &q).expect("finite");
    let found = generic(&mechanism, 0.0, &q);
    let permanent = is_permanent(&mechanism, 0.0, &q, &analysis.decision);
    let redundancy = analysis.decision.redundancy;
    let expected = found.as_ref().map(|g| g.redundancy == redundancy);
    assert_eq!(permanent, expected);
    (redundancy, found)
}

fn driven(mut d: Description) -> Description {
    let element = RevoluteAngleDrive {
        s_i: [0.0; 2],
        s_j: [0.0; 2],
        measure_0: 0.0,
    };
    d.drives.push(Drive {
        name: "motor".into(),
        bodies: vec![BodyRef::Ground, BodyRef::Body(0)],
        element: Box::new(element),
        motion: Function::constant_rate(1.0).expect("finite"),
    });
    d
}

/// n cranks: n − 2 redundant rows, and one more where they are flat, with a drive (no freedom left) or without.
#[test]
fn cranks_are_compared_with_themselves_elsewhere() {
    for (pivots, usual) in [
        (&[0.0, 1.0][..], 0),
        (&[0.0, 1.0, 1.7], 1),
        (&[0.0, 0.3, 1.0, 1.7], 2),
    ] {
        for theta in [0.0, 0.4, 1.5] {
            let d = cranks(pivots, 0.5, theta);
            for d in [d.clone(), driven(d)] {
                let (here, found) = at_start(&d);
                let found = found.expect("cranks move");
                assert_eq!(here, usual + usize::from(theta == 0.0));
                assert_eq!(found.redundancy, usual);
                assert!(found.points.len() >= 3, "{}", found.points.len());
                let mut angles = vec![theta];
                for point in &found.points {
                    assert_eq!((point.redundancy, point.time), (usual, 0.0));
                    assert!(
                        angles.iter().all(|a| (a - point.q[2]).abs() > 0.05),
                        "{found:?}"
                    );
                    angles.push(point.q[2]);
                }
            }
        }
    }
}

/// The robot with straight wheels: rank 20 there and elsewhere.
#[test]
fn the_robot_is_redundant_everywhere() {
    let (here, found) = at_start(&robot(steering()));
    let found = found.expect("the robot moves");
    assert_eq!((here, found.redundancy), (2, 2));
    assert!(found.points.iter().all(|p| p.rank == 20));
}

/// A structure has no other configuration, so nothing can be said.
#[test]
fn a_structure_cannot_be_compared() {
    let hinge = |name: &str, x: f64| {
        let element = Revolute {
            s_i: [x, 0.0],
            s_j: [x, 0.0],
        };
        Joint::new(name, &[BodyRef::Ground, BodyRef::Body(0)], element)
    };
    let d = Description {
        bodies: vec![beam()],
        joints: vec![hinge("left", -1.0), hinge("right", 1.0)],
        ..Description::default()
    };
    assert_eq!(at_start(&d), (1, None));
}

fn beam() -> Body {
    Body {
        name: "beam".into(),
        mass: 1.0,
        inertia: 1.0,
        ..Body::default()
    }
}

/// A constraint that prescribes a velocity stays, and time moves with the mechanism.
#[test]
fn time_moves_where_a_joint_depends_on_it() {
    let pull = |name: &str| Joint {
        name: name.into(),
        bodies: vec![BodyRef::Body(0)],
        element: Box::new(Velocity {
            s: [0.0, 0.0],
            direction: Direction::X,
        }),
        functions: vec![Function::constant_rate(1.0).expect("finite")],
    };
    let d = Description {
        bodies: vec![beam()],
        joints: vec![pull("one"), pull("other")],
        ..Description::default()
    };
    let (here, found) = at_start(&d);
    let found = found.expect("a free body");
    assert_eq!((here, found.redundancy), (1, 1));
    assert!(found.points.iter().all(|p| p.time > 0.0));
}
