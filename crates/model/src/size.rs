//! The length scale of a mechanism. The length scale is the extent of the bodies and joints.

use crate::mechanism::Mechanism;
use crate::rounding::are_apart;
use crate::space::norm;
use crate::system::{Scratch, System};

/// Returns the diagonal of the smallest box that contains the positions of all bodies and joints.
/// If these positions coincide, the function uses the points of the joints. If these points
/// coincide as well, it returns 1 m.
#[must_use]
pub fn scene_size(mechanism: &Mechanism, q: &[f64]) -> f64 {
    let mut s = mechanism.scratch();
    mechanism.pose(0.0, q, &mut s);
    size_of(mechanism, &s)
}

/// Works like [`scene_size`], at the configuration in the work space.
pub(crate) fn size_of(mechanism: &Mechanism, s: &Scratch) -> f64 {
    let bodies = s.bodies.origins();
    let places = mechanism
        .layout()
        .constraint_ids()
        .map(|id| mechanism.reactions(s).place(id));
    let mut points: Vec<[f64; 3]> = bodies.chain(places).collect();
    if let Some(size) = diagonal(&points) {
        return size;
    }
    let of_joints = mechanism
        .layout()
        .constraint_ids()
        .flat_map(|id| mechanism.points(id));
    points.extend(of_joints.map(|(body, [x, y, z])| match body.moving() {
        None => [x, y, z],
        Some(k) => {
            let ([u, v, w], origin) = (s.bodies.axes(k), s.bodies.origin(k));
            std::array::from_fn(|axis| origin[axis] + u[axis] * x + v[axis] * y + w[axis] * z)
        }
    }));
    diagonal(&points).unwrap_or(1.0)
}

/// Returns the diagonal of the smallest box that contains the points. Returns `None` if the points
/// coincide.
fn diagonal(points: &[[f64; 3]]) -> Option<f64> {
    let span = |k: usize| {
        let low = points.iter().fold(f64::INFINITY, |a, p| a.min(p[k]));
        let high = points.iter().fold(f64::NEG_INFINITY, |a, p| a.max(p[k]));
        high - low
    };
    let size = norm(&[0, 1, 2].map(span));
    let farthest = points.iter().map(|p| norm(p)).fold(0.0, f64::max);
    are_apart(size, farthest).then_some(size)
}
