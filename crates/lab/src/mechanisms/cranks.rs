//! Parallel cranks under one coupler.

use joints::{Revolute, RevoluteAngleDrive};
use model::{Body, BodyRef, Description, Drive, Function, Joint};

use super::{revolute, rod};

/// Returns cranks of length `length` at angle θ (from the x-axis) on ground pivots `(x, 0)`, under
/// one horizontal coupler. Body k is crank k, and the last body is the coupler. Joint 2k is the
/// ground pivot of crank k, and joint 2k + 1 is at the tip of crank k.
pub fn cranks(pivots: &[f64], length: f64, theta: f64) -> Description {
    cranks_at([0.0; 2], pivots, length, theta)
}

/// Returns the same mechanism, translated by `origin`.
pub fn cranks_at(origin: [f64; 2], pivots: &[f64], length: f64, theta: f64) -> Description {
    let pivot = |x: f64| [origin[0] + x, origin[1]];
    let tip = |x: f64| {
        let [x, y] = pivot(x);
        [x + length * theta.cos(), y + length * theta.sin()]
    };
    let mut bodies: Vec<Body> = pivots
        .iter()
        .enumerate()
        .map(|(k, &x)| rod(&format!("crank {}", k + 1), 1.0, pivot(x), tip(x)))
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
                    pivot(x),
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

/// Returns a drive of the angle of body k.
pub fn motor(name: &str, k: usize, motion: Function) -> Drive {
    // The angle needs no points.
    let element = RevoluteAngleDrive::new([0.0; 2], [0.0; 2]);
    Drive {
        name: name.into(),
        bodies: vec![BodyRef::Ground, BodyRef::Body(k)],
        element: Box::new(element),
        motion,
        tolerance: None,
    }
}

/// Returns a parallelogram at θ = 1 with the drives `one` and `other` on its two cranks. One drive
/// is redundant.
pub fn driven_parallelogram(motions: [Function; 2]) -> Description {
    let mut d = cranks(&[0.0, 1.0], 0.5, 1.0);
    let [one, other] = motions;
    d.drives = vec![motor("one", 0, one), motor("other", 1, other)];
    d
}

/// Returns three vertical cranks of 1 m under a coupler whose frame is at the tip of the third
/// crank. In both bodies, the position of this tip has the same error ε. Therefore all points
/// coincide, but the third crank is not parallel to the other cranks. In frames with the axes of
/// the ground, ε replaces a zero, so that the constraint matrix contains ε without rounding for any
/// value.
pub fn misaligned(error: f64) -> Description {
    let body = |name: String, position: [f64; 2]| Body {
        name,
        mass: 1.0,
        inertia: 0.1,
        position,
        ..Body::default()
    };
    let mut d = Description {
        name: "misaligned cranks".into(),
        ..Description::default()
    };
    for (k, x) in [-2.0, -1.0, 0.0].into_iter().enumerate() {
        let (crank, miss) = (BodyRef::Body(k), if k == 2 { error } else { 0.0 });
        d.bodies.push(body(format!("crank {k}"), [x, 0.5]));
        let (s_i, s_j) = ([x, 0.0], [0.0, -0.5]);
        let pivot = Revolute { s_i, s_j };
        d.joints.push(Joint::new(
            &format!("pivot {k}"),
            &[BodyRef::Ground, crank],
            pivot,
        ));
        let (s_i, s_j) = ([miss, 0.5], [x + miss, 0.0]);
        let tip = Revolute { s_i, s_j };
        let pair = [crank, BodyRef::Body(3)];
        d.joints.push(Joint::new(&format!("tip {k}"), &pair, tip));
    }
    d.bodies.push(body("coupler".into(), [0.0, 1.0]));
    d
}
