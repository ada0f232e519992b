//! Tests drives with force laws, and forces with callbacks, in a description and in the built
//! mechanism.

use joints::{Direction, Revolute, RevoluteAngleDrive, Torque, Translational};
use joints::{TranslationalDisplacementDrive, space3};

use super::*;
use crate::mechanism::{Derivatives, Mechanism};
use crate::system::System;

const O: [f64; 2] = [0.0, 0.0];

/// A wheel with a force-law drive, a crank and a carriage with prescribed motions, and a torque.
fn described() -> Description {
    let mut d = Description::new("bench");
    let [wheel, crank, carriage] =
        ["wheel", "crank", "carriage"].map(|name| d.body(Body::new(name, 2.0, 0.5)));
    for (name, body) in [("shaft", wheel), ("pin", crank)] {
        d.joint(name, &[BodyRef::Ground, body], Revolute::new(O, O));
    }
    let guide = Translational::new(O, O, Direction::X);
    d.joint("guide", &[BodyRef::Ground, carriage], guide);
    let law = Law::called(|at| Ok(at.time));
    let angle = || RevoluteAngleDrive::new(O, O);
    d.drive_by_law("motor", &[BodyRef::Ground, wheel], angle(), law)
        .expect("one row");
    let along = TranslationalDisplacementDrive::new(O, O, Direction::X);
    let still = || Function::constant(0.0).expect("finite");
    d.drive("sweep", &[BodyRef::Ground, crank], angle(), still());
    d.drive("push", &[BodyRef::Ground, carriage], along, still());
    d.force("brake", &[crank], Torque::new()).functions = vec![still()];
    d
}

#[test]
fn a_law_is_replaced_by_the_name_of_its_drive() {
    let mut d = AnyDescription::from(described());
    assert_eq!(d.laws().collect::<Vec<_>>(), ["motor"]);
    let law = Law::called(|at| Ok(2.0 + at.measure + 3.0 * at.rate + 4.0 * at.time));
    assert_eq!(d.set_law("motor", &law), Ok(()));
    let mechanism = Mechanism::build(&d).expect("builds");
    let mut s = mechanism.scratch();
    let mut q = vec![0.0; 9];
    let mut v = q.clone();
    (q[2], v[2]) = (0.25, 0.5);
    mechanism.pose(0.125, &q, &mut s);
    mechanism.twist(&v, &mut s);
    mechanism.force(&mut s);
    assert_eq!(s.force[2], 2.0 + 0.25 + 1.5 + 0.5);
    let told = |name: &str| {
        let error = described().set_law(name, &law).expect_err("no law");
        error.to_string()
    };
    assert_eq!(told("moter"), "there is no drive `moter`");
    assert!(told("sweep").contains("drive `sweep` prescribes a motion, and its torque"));
    assert!(
        told("sweep").ends_with("to give it a law, write `torque = 0` in place of its `motion`")
    );
    assert!(told("push").contains("write `force = 0`"));
    assert_eq!(told("brake"), "`brake` is a force, not a drive by a law");
}

#[test]
fn forces_that_call_a_function_have_no_derivatives() {
    let mechanism = Mechanism::build(&described()).expect("builds");
    let refused = Derivatives::of(&mechanism).expect_err("`motor` calls a function");
    assert_eq!((refused.name.as_str(), refused.kind()), ("motor", "drive"));
    let mut d = SpatialDescription::new("stone");
    let stone = d.body(SpatialBody::new(
        "stone",
        1.0,
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    ));
    d.called_force("wind", stone, |_| Err("calm".into()));
    let mechanism = Mechanism::build(&d).expect("builds");
    let mut s = mechanism.scratch();
    let refused = Derivatives::of_forces(&mechanism, &s).expect_err("`wind` calls a function");
    assert_eq!(
        refused.to_string(),
        "force `wind` calls a function, which has no derivatives"
    );
    let at = space3::Pose::GROUND;
    mechanism.pose(0.0, &[at.r[0], 0.0, 0.0, 1.0, 0.0, 0.0, 0.0], &mut s);
    mechanism.twist(&[0.0; 6], &mut s);
    let undefined = mechanism.applied_forces().undefined(&mut s);
    let undefined = undefined.expect("it fails");
    assert!(undefined.is_of_function());
    assert_eq!(
        undefined.to_string(),
        "the force `wind` (its function failed: calm)"
    );
}
