//! Motions do not depend on units: a mechanism that is `L` times as large moves √L times as slowly
//! under the same gravity.

use std::ops::ControlFlow;

use dynamics::{Method, MotionOptions, RowChoice, Summary, prepare, simulate};
use model::{BodyRef, Description, Mechanism, StartOptions};
use tests::{revolute, rod};

/// Two rods of length L in series start at rest and horizontal, on a pivot at the origin.
fn double_pendulum(length: f64) -> Description {
    let at = |k: f64| [k * length, 0.0];
    let bodies = vec![
        rod("upper", 1.0, at(0.0), at(1.0)),
        rod("lower", 1.0, at(1.0), at(2.0)),
    ];
    let joints = vec![
        revolute(
            "pivot",
            &bodies,
            [BodyRef::Ground, BodyRef::Body(0)],
            at(0.0),
        ),
        revolute(
            "elbow",
            &bodies,
            [BodyRef::Body(0), BodyRef::Body(1)],
            at(1.0),
        ),
    ];
    Description {
        name: "double pendulum".into(),
        bodies,
        joints,
        gravity: [0.0, -9.81],
        ..Description::default()
    }
}

/// Returns the end of a fall of 2·√L seconds, with lengths in units of L and times in units of √L.
fn fallen(length: f64, method: Method) -> (Vec<f64>, Summary) {
    let mechanism = Mechanism::build(&double_pendulum(length)).expect("builds");
    let p = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic).expect("starts");
    let time = length.sqrt();
    let options = MotionOptions {
        rtol: 1e-9,
        atol: 1e-15 * length.min(1.0 / length),
        method,
        ..MotionOptions::to(2.0 * time)
    };
    let mut end = Vec::new();
    let summary = simulate(&p, &options, |s| {
        let scaled =
            |(j, x): (usize, &f64), rate: f64| x * rate / if j % 3 == 2 { 1.0 } else { length };
        let q = s.q.iter().enumerate().map(|x| scaled(x, 1.0));
        end = q
            .chain(s.v.iter().enumerate().map(|x| scaled(x, time)))
            .collect();
        Ok(ControlFlow::Continue(()))
    })
    .unwrap_or_else(|e| panic!("L = {length:e}, {method:?}: {e}"));
    (end, summary)
}

#[test]
fn the_length_of_a_pendulum_does_not_matter() {
    for method in [Method::Dop853, Method::Dopri5, Method::Radau5] {
        let (expected, _) = fallen(1.0, method);
        for exponent in [-12, -6, -3, 2, 4, 6, 8, 12] {
            let length = 10_f64.powi(exponent);
            let (found, summary) = fallen(length, method);
            for (a, b) in found.iter().zip(&expected) {
                assert!(
                    (a - b).abs() < 1e-7,
                    "L = {length:e}, {method:?}: {a} for {b}"
                );
            }
            assert!(summary.events.is_empty(), "{:?}", summary.events);
        }
    }
}
