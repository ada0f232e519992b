//! Tests which stated tolerance takes precedence, and tests invalid tolerances.

use joints::{Direction, Gear, KnifeEdge, Line, PointOnLine, Revolute, RevoluteAngleDrive};

use super::*;
use crate::description::Description;
use crate::{Body, BodyRef, DataBlock, Function, Mechanism, System};

/// The distance between the bodies (m). All joints are between the bodies, so this is the size of
/// the mechanism.
const SIZE: f64 = 4.0;

fn body(name: &str, x: f64) -> Body {
    Body {
        position: [x, 0.0],
        ..Body::new(name, 1.0, 1.0)
    }
}

/// A pin with a motor between two bodies, and a gear. The second body has a roller on a line of the
/// ground, and a knife edge.
fn description() -> Description {
    let mut d = Description::new("stated");
    let i = d.body(body("left", 0.0));
    let j = d.body(body("right", SIZE));
    let (s_i, s_j) = ([1.0, 0.0], [-3.0, 0.0]);
    d.joint("pin", &[i, j], Revolute { s_i, s_j });
    let line = Line::new([0.0, 0.0], [1.0, 0.0]).expect("two points");
    d.joint("roller", &[j], PointOnLine { s: [0.0; 2], line });
    let gear = Gear::new(-2.0);
    d.joint("mesh", &[i, j, BodyRef::Ground], gear);
    let edge = KnifeEdge {
        s: s_j,
        normal: Direction::Y,
    };
    d.joint("edge", &[j], edge);
    let motor = RevoluteAngleDrive::new(s_i, s_j);
    let rest = Function::constant(0.0).expect("finite");
    d.drive("motor", &[i, j], motor, rest);
    d
}

fn built(d: &Description) -> Mechanism {
    Mechanism::build(d).unwrap_or_else(|faults| panic!("{faults:?}"))
}

fn blocks(mechanism: &Mechanism) -> Vec<DataBlock> {
    let mut s = mechanism.scratch();
    mechanism.pose(0.0, &mechanism.described_state().0, &mut s);
    mechanism.data().blocks(&s)
}

/// Returns the tolerances of the data of a joint or drive, in the order of the data. For a line,
/// the tolerance of the point comes before the tolerance of the direction.
fn stated(mechanism: &Mechanism, joint: &str) -> Vec<Option<f64>> {
    let groups = &mechanism.layout().groups;
    let own = blocks(mechanism).into_iter();
    own.filter(|block| groups[block.group].name == joint)
        .map(|block| block.tolerance)
        .collect()
}

const NAMES: [&str; 5] = ["pin", "roller", "mesh", "edge", "motor"];

#[test]
fn without_a_statement_there_is_none() {
    let mechanism = built(&description());
    assert_eq!(mechanism.tolerance(), Tolerance::default());
    assert!(blocks(&mechanism).len() >= 12);
    assert!(
        blocks(&mechanism)
            .iter()
            .all(|block| block.tolerance.is_none())
    );
}

#[test]
fn a_joint_goes_before_a_body_and_a_body_before_the_scene() {
    let mut d = description();
    d.tolerance.length = Some(1e-3);
    let (scene, scene_angle) = (Some(1e-3), Some(1e-3 / SIZE));
    let whole = built(&d);
    assert_eq!(stated(&whole, "pin"), [scene; 2]);
    assert_eq!(stated(&whole, "roller"), [scene, scene, scene_angle]);
    // A ratio has the tolerance of an angle.
    assert_eq!(stated(&whole, "mesh"), [scene_angle; 2]);
    assert_eq!(stated(&whole, "edge"), [scene, scene_angle]);
    assert_eq!(stated(&whole, "motor"), [scene, scene, scene_angle]);

    // The tolerance applies to points and directions in the body frame, but not to scalars or to
    // the line of the ground.
    d.bodies[1].tolerance = Some(2e-4);
    let (body, body_angle) = (Some(2e-4), Some(2e-4 / SIZE));
    let measured = built(&d);
    assert_eq!(stated(&measured, "pin"), [scene, body]);
    assert_eq!(stated(&measured, "roller"), [body, scene, scene_angle]);
    assert_eq!(stated(&measured, "mesh"), [scene_angle; 2]);
    assert_eq!(stated(&measured, "edge"), [body, body_angle]);
    assert_eq!(stated(&measured, "motor"), [scene, body, scene_angle]);

    // The tolerance applies to all data of the joint. The tolerance of a joint does not apply to a
    // separate drive, and vice versa.
    d.joints[0].tolerance = Some(5e-5);
    d.joints[2].tolerance = Some(8e-5);
    let fitted = built(&d);
    assert_eq!(stated(&fitted, "pin"), [Some(5e-5); 2]);
    assert_eq!(stated(&fitted, "mesh"), [Some(8e-5 / SIZE); 2]);
    assert_eq!(stated(&fitted, "motor"), [scene, body, scene_angle]);
    d.drives[0].tolerance = Some(5e-5);
    let driven = stated(&built(&d), "motor");
    assert_eq!(driven, [Some(5e-5), Some(5e-5), Some(5e-5 / SIZE)]);
}

#[test]
fn a_joint_or_a_body_may_be_the_only_one() {
    let mut d = description();
    d.joints[0].tolerance = Some(1e-5);
    let mechanism = built(&d);
    assert_eq!(stated(&mechanism, "pin"), [Some(1e-5); 2]);
    for other in &NAMES[1..] {
        assert!(
            stated(&mechanism, other).iter().all(Option::is_none),
            "{other}"
        );
    }
    d.joints[0].tolerance = None;
    d.bodies[0].tolerance = Some(1e-5);
    assert_eq!(stated(&built(&d), "pin"), [Some(1e-5), None]);
}

#[test]
fn an_angle_that_is_stated_holds_for_all_angles() {
    let mut d = description();
    d.tolerance.angle = Some(1e-6);
    let only = built(&d);
    assert_eq!(stated(&only, "pin"), [None; 2]);
    assert_eq!(stated(&only, "edge"), [None, Some(1e-6)]);
    d.tolerance.length = Some(1e-3);
    d.bodies[1].tolerance = Some(2e-4);
    d.joints[2].tolerance = Some(8e-5);
    let both = built(&d);
    assert_eq!(stated(&both, "edge"), [Some(2e-4), Some(1e-6)]);
    assert_eq!(stated(&both, "mesh"), [Some(1e-6); 2]);
}

#[test]
fn parts_have_the_tolerances_of_the_whole() {
    let mut d = description();
    d.tolerance = Tolerance {
        length: Some(1e-3),
        angle: Some(1e-6),
    };
    d.bodies[1].tolerance = Some(2e-4);
    d.joints[0].tolerance = Some(5e-5);
    let whole = built(&d);
    let groups: Vec<usize> = (0..NAMES.len()).collect();
    for part in [whole.part(&[0, 1]), whole.part_of_groups(&groups)] {
        assert_eq!(part.mechanism.tolerance(), d.tolerance);
        for name in NAMES {
            assert_eq!(
                stated(&part.mechanism, name),
                stated(&whole, name),
                "{name}"
            );
        }
    }
    // The part consists of the knife edge and its body.
    let edge = whole.part_of_groups(&groups[4..]).mechanism;
    assert_eq!(stated(&edge, "edge"), [Some(2e-4), Some(1e-6)]);
}

#[test]
fn what_is_stated_later_replaces_that_of_the_scene_alone() {
    let mut d = description();
    d.tolerance.length = Some(1e-3);
    d.bodies[0].tolerance = Some(2e-4);
    let mut mechanism = built(&d);
    let stated_later = Tolerance {
        length: Some(1e-2),
        angle: None,
    };
    mechanism.set_tolerance(stated_later).expect("> 0");
    assert_eq!(stated(&mechanism, "pin"), [Some(2e-4), Some(1e-2)]);
    let wrong = Tolerance {
        length: Some(1e-2),
        angle: Some(0.0),
    };
    let refused = mechanism
        .set_tolerance(wrong)
        .expect_err("0 is not a tolerance");
    assert_eq!(
        refused.to_string(),
        "the scene: angle tolerance is 0.0, need a finite number > 0 up to 1e60"
    );
    assert_eq!(mechanism.tolerance(), stated_later);
}

#[test]
fn what_is_no_tolerance_is_named_with_its_owner() {
    for wrong in [0.0, -1e-4, f64::NAN, f64::INFINITY] {
        let mut d = description();
        d.tolerance.length = Some(wrong);
        d.bodies[1].tolerance = Some(wrong);
        d.joints[3].tolerance = Some(wrong);
        d.drives[0].tolerance = Some(wrong);
        let faults = Mechanism::build(&d).err().expect("four faults");
        let told: Vec<String> = faults.iter().map(ToString::to_string).collect();
        let expected = ["the scene", "body `right`", "joint `edge`", "drive `motor`"]
            .map(|of| format!("{of}: tolerance is {wrong:?}, need a finite number > 0 up to 1e60"));
        assert_eq!(told, expected);
    }
}
