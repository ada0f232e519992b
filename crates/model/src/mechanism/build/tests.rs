//! Tests that all errors in a description are found together.

use joints::{Revolute, RevoluteAngleDrive};

use super::*;
use crate::body::Body;
use crate::description::{Description, Drive, Joint};

fn body(name: &str) -> Body {
    Body {
        name: name.into(),
        mass: 1.0,
        inertia: 1.0,
        ..Body::default()
    }
}

const PAIR: [BodyRef; 2] = [BodyRef::Ground, BodyRef::Body(0)];

#[test]
fn joints_and_drives_stand_in_their_own_lists() {
    let pivot = Revolute {
        s_i: [0.0; 2],
        s_j: [0.0; 2],
    };
    let motor = RevoluteAngleDrive::new([0.0; 2], [0.0; 2]);
    let motion = Function::constant(0.0).expect("finite");
    let mut joint = Joint::new("motor", &PAIR, motor);
    joint.functions.push(motion.clone());
    let drive = Drive {
        name: "pivot".into(),
        bodies: PAIR.to_vec(),
        element: Box::new(pivot),
        motion,
        tolerance: None,
    };
    let d = Description {
        bodies: vec![body("crank")],
        joints: vec![joint],
        drives: vec![drive],
        ..Description::default()
    };
    let errors = Mechanism::build(&d)
        .err()
        .expect("both are in the wrong list");
    let text: Vec<String> = errors.iter().map(ToString::to_string).collect();
    assert!(
        text.iter().any(|e| e
            == "`motor` is in the list of joints, but `RevoluteAngleDrive` does not belong there"),
        "{text:?}"
    );
    assert!(
        text.iter()
            .any(|e| e == "`pivot` is in the list of drives, but `Revolute` does not belong there"),
        "{text:?}"
    );
}

#[test]
fn all_faults_of_a_description_come_together() {
    let mut crank = body("crank");
    crank.mass = -1.0;
    let d = Description {
        gravity: [f64::NAN, 0.0],
        bodies: vec![crank, body("crank")],
        joints: vec![Joint::new(
            "pivot",
            &[BodyRef::Body(1), BodyRef::Body(7)],
            Revolute {
                s_i: [0.0; 2],
                s_j: [0.0; 2],
            },
        )],
        ..Description::default()
    };
    let errors = Mechanism::build(&d).err().expect("four faults");
    assert_eq!(errors.len(), 4, "{errors:?}");
}
