//! The arm of a joint is the distance of the joint from the centre of mass of the body. Positions
//! are differences of rounded numbers. Therefore an arm that is shorter than the accuracy of the
//! positions counts as zero. Otherwise this arm would be the length unit of the body.

use crate::element::PlacedConstraint;
use crate::group::ConstraintId;
use crate::mechanism::Mechanism;
use crate::rounding::are_apart;
use crate::size::size_of;
use crate::space::{difference, norm};
use crate::system::{Scratch, System};

/// Returns the longest arm of each body (m) at the configuration in the work space. The arm is
/// never zero. For a body with all joints at its centre, the function uses the arms of the
/// neighbouring bodies. If these arms are zero, too (for example for shafts with gears), the
/// function uses the size of the mechanism. The work space must contain C.
pub(crate) fn longest_arms(mechanism: &Mechanism, s: &Scratch) -> Vec<f64> {
    let own = own_arms(mechanism, s);
    let mut of_neighbours = vec![0.0_f64; own.len()];
    for c in &mechanism.elements.constraints {
        let longest = c.site.moving().map(|k| own[k]).fold(0.0, f64::max);
        for k in c.site.moving() {
            of_neighbours[k] = of_neighbours[k].max(longest);
        }
    }
    let size = size_of(mechanism, s);
    let first_length = |arms: (f64, f64)| match arms {
        (0.0, 0.0) => size,
        (0.0, neighbours) => neighbours,
        (own, _) => own,
    };
    own.into_iter()
        .zip(of_neighbours)
        .map(first_length)
        .collect()
}

/// Returns, for each body, the distance (m) from its centre of mass to its farthest joint of any
/// kind, at the configuration in the work space. The distance is zero if all joints are at the
/// centre.
pub(crate) fn farthest_joints(mechanism: &Mechanism, s: &Scratch) -> Vec<f64> {
    let mut arms = vec![0.0_f64; mechanism.bodies().len()];
    for (k, constraint) in mechanism.elements.constraints.iter().enumerate() {
        let farthest = farthest(mechanism, s, constraint);
        let place = mechanism.reactions(s).place(ConstraintId(k));
        for body in constraint.site.moving() {
            let arm = norm(&difference(place, s.bodies.origin(body)));
            if are_apart(arm, farthest) {
                arms[body] = arms[body].max(arm);
            }
        }
    }
    arms
}

/// Returns the longest arm of each body. The arm is zero if all joints are at the centre of mass.
fn own_arms(mechanism: &Mechanism, s: &Scratch) -> Vec<f64> {
    let layout = mechanism.layout();
    let mut arms = vec![0.0_f64; mechanism.bodies().len()];
    let places = |i: &usize| !layout.is_angular(*i);
    for (k, constraint) in mechanism.elements.constraints.iter().enumerate() {
        let mut rows = constraint.rows.holonomic.clone().filter(places).peekable();
        if rows.peek().is_none() {
            continue;
        }
        let farthest = farthest(mechanism, s, constraint);
        let mut take = |body: usize, arm: f64| {
            if are_apart(arm, farthest) {
                arms[body] = arms[body].max(arm);
            }
        };
        // For a pin in a slot, the row along the slot does not depend on the arm of the pin at this
        // configuration.
        let place = mechanism.reactions(s).place(ConstraintId(k));
        for body in constraint.site.moving() {
            let each = place.iter().zip(s.bodies.origin(body));
            each.for_each(|(x, at)| take(body, (x - at).abs()));
        }
        for (j, c) in rows.flat_map(|i| layout.row(s, i)) {
            if layout.space.is_rotation(j) {
                take(layout.space.body_of(j), c.abs());
            }
        }
    }
    arms
}

/// Returns the largest length (m) in the sum that gives the reference point of a joint. The sum
/// contains the points of the joint in its bodies, the positions of these bodies, and the positions
/// of the centres of mass in the body frames.
fn farthest(mechanism: &Mechanism, s: &Scratch, c: &PlacedConstraint) -> f64 {
    let points = c.kernels().points().into_iter().map(|point| norm(&point));
    let of_body = |k: usize| {
        let centre = mechanism.bodies()[k].centre();
        norm(&s.bodies.origin(k)).max(norm(&centre))
    };
    points
        .chain(c.site.moving().map(of_body))
        .fold(0.0, f64::max)
}
