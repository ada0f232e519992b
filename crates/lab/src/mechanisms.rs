//! Mechanisms for cases and tests, built with the library only, without scene files.

pub mod cranks;
pub mod robot;
pub mod sketch;
pub mod space;

use joints::{Pose, Revolute};
use model::{Body, BodyRef, Joint};

/// Returns the pose of a body or the ground at the described initial state.
fn pose(bodies: &[Body], body: BodyRef) -> Pose {
    match body {
        BodyRef::Ground => Pose::GROUND,
        BodyRef::Body(k) => bodies[k].pose(),
    }
}

/// Returns a revolute joint at a global point of the described initial state.
pub fn revolute(name: &str, bodies: &[Body], pair: [BodyRef; 2], at: [f64; 2]) -> Joint {
    let [s_i, s_j] = pair.map(|b| pose(bodies, b).to_local(at));
    Joint::new(name, &pair, Revolute { s_i, s_j })
}

/// Returns a uniform rod between two points.
pub fn rod(name: &str, mass: f64, from: [f64; 2], to: [f64; 2]) -> Body {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    Body {
        name: name.into(),
        mass,
        inertia: mass * (dx * dx + dy * dy) / 12.0,
        position: [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])],
        angle: dy.atan2(dx),
        ..Body::default()
    }
}
