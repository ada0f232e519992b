//! Drives with kinks and jumps: a jump of the rate is an impulse with a known energy, and a jump of
//! the position is rejected with an error. Rows at a break time contain the values just before it.

use std::ops::ControlFlow;

use dynamics::{
    EventKind, Method, MotionError, MotionFault, MotionOptions, PreparedMechanism, RowChoice,
    prepare, simulate,
};
use joints::{
    Direction, Revolute, RevoluteAngleDrive, Translational, TranslationalDisplacementDrive,
};
use model::{Body, BodyRef, Description, Drive, Function, Joint, Mechanism, StartOptions};

const MASS: f64 = 2.0;
const INERTIA: f64 = 0.3;

/// A wheel on a pin with a driven angle.
fn wheel(motion: Function) -> PreparedMechanism {
    let d = Description {
        name: "wheel".into(),
        bodies: vec![Body {
            name: "wheel".into(),
            mass: MASS,
            inertia: INERTIA,
            ..Body::default()
        }],
        joints: vec![Joint::new(
            "pin",
            &[BodyRef::Ground, BodyRef::Body(0)],
            Revolute {
                s_i: [0.0; 2],
                s_j: [0.0; 2],
            },
        )],
        drives: vec![Drive {
            tolerance: None,
            name: "motor".into(),
            bodies: vec![BodyRef::Ground, BodyRef::Body(0)],
            element: Box::new(RevoluteAngleDrive::new([0.0; 2], [0.0; 2])),
            motion,
        }],
        ..Description::default()
    };
    let mechanism = Mechanism::build(&d).expect("builds");
    prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic).expect("starts")
}

const METHODS: [Method; 3] = [Method::Dop853, Method::Dopri5, Method::Radau5];

#[test]
fn a_jump_of_the_rate_is_an_impulse_with_its_energy() {
    // The rate is 2 rad/s up to t = 1, then −1 rad/s: T falls from 0.6 J to 0.15 J.
    let motion = Function::lines(&[0.0, 1.0, 3.0], &[0.0, 2.0, 0.0]).expect("two lines");
    for method in METHODS {
        let mut rows = Vec::new();
        let options = MotionOptions {
            method,
            output_step: 0.5,
            ..MotionOptions::to(2.0)
        };
        let summary = simulate(&wheel(motion.clone()), &options, |s| {
            rows.push((s.t, s.q[2], s.v[2]));
            Ok(ControlFlow::Continue(()))
        })
        .unwrap_or_else(|e| panic!("{method:?}: {e}"));
        let expected = [
            (0.0, 0.0, 2.0),
            (0.5, 1.0, 2.0),
            (1.0, 2.0, 2.0), // values just before the break
            (1.5, 1.5, -1.0),
            (2.0, 1.0, -1.0),
        ];
        for (row, e) in rows.iter().zip(expected) {
            let close = (row.1 - e.1).abs() < 1e-9 && (row.2 - e.2).abs() < 1e-9;
            assert!(row.0 == e.0 && close, "{method:?}: {row:?}, expected {e:?}");
        }
        let [event] = summary.events.as_slice() else {
            panic!("{method:?}: one event: {:?}", summary.events);
        };
        assert_eq!(event.kind, EventKind::Impulse);
        assert!(
            (event.time - 1.0).abs() < 1e-12 && event.text.contains("-4.5"),
            "{event:?}"
        );
        assert!(
            summary.energy_balance < 1e-9,
            "{method:?}: {:.1e}",
            summary.energy_balance
        );
    }
}

/// A wheel with an eccentric centre is driven at 2 rad/s and from t = 1 at −1 rad/s, on one pin or
/// on two coincident pins.
fn eccentric(pins: usize) -> PreparedMechanism {
    let both = [BodyRef::Ground, BodyRef::Body(0)];
    let mut d = Description {
        name: "eccentric wheel".into(),
        bodies: vec![Body {
            name: "wheel".into(),
            mass: MASS,
            inertia: INERTIA,
            position: [0.5, 0.0],
            ..Body::default()
        }],
        ..Description::default()
    };
    for k in 0..pins {
        let pin = Revolute {
            s_i: [0.0; 2],
            s_j: [-0.5, 0.0],
        };
        d.joints.push(Joint::new(&format!("pin {k}"), &both, pin));
    }
    d.drives.push(Drive {
        tolerance: None,
        name: "motor".into(),
        bodies: both.to_vec(),
        element: Box::new(RevoluteAngleDrive::new([0.0; 2], [-0.5, 0.0])),
        motion: Function::lines(&[0.0, 1.0, 3.0], &[0.0, 2.0, 0.0]).expect("two lines"),
    });
    let mechanism = Mechanism::build(&d).expect("builds");
    prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic).expect("starts")
}

/// Returns the components of the impulse of the run for each joint and drive.
fn impulses(prepared: &PreparedMechanism) -> Vec<Vec<(&'static str, Option<f64>, &'static str)>> {
    let options = MotionOptions::to(2.0);
    let summary = simulate(prepared, &options, |_| Ok(ControlFlow::Continue(())));
    let summary = summary.unwrap_or_else(|e| panic!("{e}"));
    let [event] = summary.events.as_slice() else {
        panic!("one event: {:?}", summary.events);
    };
    let each = event.impulses.iter().map(|impulse| {
        let components = impulse.components.iter();
        components
            .map(|(name, value)| (*name, value.determined(), value.verdict().word()))
            .collect()
    });
    each.collect()
}

fn is_close(found: Option<f64>, expected: f64) -> bool {
    found.is_some_and(|found| (found - expected).abs() < 1e-9)
}

/// The rate jumps by −3 rad/s after a rotation of 2 rad. The velocity of the centre, 0.5 m off the
/// pin, jumps by −1.5 m/s across the arm. The angular momentum about the pin jumps by −3·(0.3 +
/// 2·0.25) N·m·s. The impulses on the ground have the opposite sign.
#[test]
fn an_impulse_has_components_with_verdicts() {
    let (s, c) = 2f64.sin_cos();
    let found = impulses(&eccentric(1));
    let [pin, motor] = found.as_slice() else {
        panic!("{found:?}");
    };
    assert!(pin.iter().chain(motor).all(|(.., word)| *word == "unique"));
    let [(_, x, _), (_, y, _)] = pin[..] else {
        panic!("{pin:?}");
    };
    assert!(is_close(x, -3.0 * s) && is_close(y, 3.0 * c), "{pin:?}");
    let names: Vec<&str> = motor.iter().map(|(name, ..)| *name).collect();
    assert_eq!(names, ["T", "drive"]);
    assert!(
        motor.iter().all(|(_, value, _)| is_close(*value, 2.4)),
        "{motor:?}"
    );
}

/// Two coincident pins share the impulse in an undetermined way; the impulse of the motor is
/// unique.
#[test]
fn an_impulse_that_is_not_unique_has_no_number() {
    let found = impulses(&eccentric(2));
    let [first, second, motor] = found.as_slice() else {
        panic!("{found:?}");
    };
    for pin in [first, second] {
        let expected = [("Fx", None, "not_unique"), ("Fy", None, "not_unique")];
        assert_eq!(pin[..], expected);
    }
    for (_, value, word) in motor {
        assert!(is_close(*value, 2.4) && *word == "unique", "{motor:?}");
    }
}

#[test]
fn a_jump_of_the_position_is_refused_with_the_drive_and_the_time() {
    let jump = Function::lines(&[0.0, 1.0, 1.0, 2.0], &[0.0, 0.5, 0.75, 1.0]).expect("a jump");
    for method in METHODS {
        let options = MotionOptions {
            method,
            ..MotionOptions::to(2.0)
        };
        let mut last = 0.0;
        let failure = simulate(&wheel(jump.clone()), &options, |s| {
            last = s.t;
            Ok(ControlFlow::Continue(()))
        })
        .expect_err("nothing can follow");
        let MotionError::Fault(MotionFault::PositionJump { time, row, jump }) = &failure.error
        else {
            panic!("{method:?}: {failure}");
        };
        assert!(
            (time - 1.0).abs() < 1e-12 && row.joint == "motor",
            "{failure}"
        );
        assert!(
            (jump - 0.25).abs() < 1e-12 && last == 1.0,
            "{failure}, rows to {last}"
        );
    }
}

/// A slide is at rest and moves at 1 m/s from t = 1 on.
#[test]
fn a_start_at_once_takes_half_m_v_squared() {
    let motion = Function::lines(&[0.0, 1.0, 2.0], &[0.0, 0.0, 1.0]).expect("a kink");
    let d = Description {
        name: "slide".into(),
        bodies: vec![Body {
            name: "slide".into(),
            mass: MASS,
            inertia: INERTIA,
            ..Body::default()
        }],
        joints: vec![Joint::new(
            "guide",
            &[BodyRef::Ground, BodyRef::Body(0)],
            Translational::new([0.0; 2], [0.0; 2], Direction::X),
        )],
        drives: vec![Drive {
            tolerance: None,
            name: "push".into(),
            bodies: vec![BodyRef::Ground, BodyRef::Body(0)],
            element: Box::new(TranslationalDisplacementDrive::new(
                [0.0; 2],
                [0.0; 2],
                Direction::X,
            )),
            motion,
        }],
        ..Description::default()
    };
    let mechanism = Mechanism::build(&d).expect("builds");
    let p = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic).expect("starts");
    let mut v = 0.0;
    let summary = simulate(&p, &MotionOptions::to(2.0), |s| {
        v = s.v[0];
        Ok(ControlFlow::Continue(()))
    })
    .expect("moves");
    assert!((v - 1.0).abs() < 1e-12);
    let kinds: Vec<EventKind> = summary.events.iter().map(|e| e.kind).collect();
    assert_eq!(kinds, [EventKind::Impulse]);
    // The velocity jumps from zero to 1 m/s.
    assert!(
        summary.events[0].text.contains("1.000000e0 J"),
        "{:?}",
        summary.events
    );
}

/// The drive has smooth steps from rest: rates of 1e-32 after the break times are not jumps.
#[test]
fn smooth_steps_are_no_jumps() {
    let steps = Function::steps(0.0, &[[1.0, 2.0, 0.5], [2.0, 2.5, 1.0]]).expect("two steps");
    let summary = simulate(&wheel(steps), &MotionOptions::to(4.0), |_| {
        Ok(ControlFlow::Continue(()))
    })
    .expect("moves");
    assert!(summary.events.is_empty(), "{:?}", summary.events);
}
