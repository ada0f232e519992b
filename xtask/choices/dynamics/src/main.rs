//! A door on two hinges in the plane swings for a second; the mechanism is described in code,
//! without scenes and reports.

use std::ops::ControlFlow;

use dynamics::{MotionOptions, RowChoice, prepare, simulate};
use joints::Revolute;
use model::{Body, BodyRef, Description, Joint, Mechanism, StartOptions};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let hinge = |name| {
        let (s_i, s_j) = ([0.0, 0.0], [-0.5, 0.0]);
        Joint::new(
            name,
            &[BodyRef::Ground, BodyRef::Body(0)],
            Revolute { s_i, s_j },
        )
    };
    let door = Description {
        gravity: [0.0, -9.81],
        bodies: vec![Body {
            name: "door".into(),
            mass: 10.0,
            inertia: 1.0,
            position: [0.5, 0.0],
            ..Body::default()
        }],
        joints: vec![hinge("upper"), hinge("lower")],
        ..Description::default()
    };
    let mechanism = Mechanism::build(&door).map_err(|e| format!("{e:?}"))?;
    let prepared = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic)?;
    simulate(&prepared, &MotionOptions::to(1.0), |row| {
        let reactions = row.reactions()?;
        println!("{} {reactions:?}", row.t);
        Ok(ControlFlow::Continue(()))
    })?;
    Ok(())
}
