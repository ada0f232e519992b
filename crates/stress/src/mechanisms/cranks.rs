//! Parallel cranks under one coupler.

use model::{Body, BodyRef, Description, Joint};

use super::{revolute, rod};

/// Cranks of length `length` at angle θ (from the x-axis) on ground pivots `(x, 0)`, under one horizontal coupler.
/// Body k is crank k, the last one the coupler; joint 2k is the ground pivot of crank k, joint 2k + 1 its tip.
pub fn cranks(pivots: &[f64], length: f64, theta: f64) -> Description {
    let tip = |x: f64| [x + length * theta.cos(), length * theta.sin()];
    let mut bodies: Vec<Body> = pivots
        .iter()
        .enumerate()
        .map(|(k, &x)| rod(&format!("crank {}", k + 1), 1.0, [x, 0.0], tip(x)))
        .collect();
    bodies.push(rod(
        "coupler",
        2.0,
        tip(pivots[0]),
        tip(pivots[pivots.len() - 1]),
    ));
    let coupler = BodyRef::Body(pivots.len());
    let joints: Vec<Joint> = pivots
        .iter()
        .enumerate()
        .flat_map(|(k, &x)| {
            let crank = BodyRef::Body(k);
            [
                revolute(
                    &format!("pivot {}", k + 1),
                    &bodies,
                    [BodyRef::Ground, crank],
                    [x, 0.0],
                ),
                revolute(&format!("tip {}", k + 1), &bodies, [crank, coupler], tip(x)),
            ]
        })
        .collect();
    Description {
        name: "cranks".into(),
        bodies,
        joints,
        ..Description::default()
    }
}
