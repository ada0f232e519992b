//! Values taken from the initial configuration of a mechanism: those stored by definitions, and the
//! distances of the joints of a body from its centre, which are the length scale of its position if
//! it is at the origin.
//!
//! The size of the whole mechanism is in [`crate::size`].

use super::Mechanism;
use crate::element::Bodies;
use crate::group::ConstraintId;
use crate::size::scene_size;
use crate::space::norm;
use crate::system::{Scratch, System};

/// Takes initial values of joints, drives and forces from a configuration.
pub(crate) fn initialise(mechanism: &mut Mechanism, q: &[f64]) {
    let bodies = Bodies::at(mechanism.space(), mechanism.of_bodies(q));
    for c in &mut mechanism.elements.constraints {
        c.initialise(&bodies);
    }
    for f in &mut mechanism.elements.forces {
        f.initialise(&bodies);
    }
    mechanism.reach = longest_arms(mechanism, q);
}

/// The first requirement of a definition that a configuration does not satisfy: name of the
/// element, and the requirement.
pub(crate) fn unmet_requirement(
    mechanism: &Mechanism,
    q: &[f64],
) -> Option<(String, &'static str)> {
    let bodies = Bodies::at(mechanism.space(), mechanism.of_bodies(q));
    let groups = mechanism.layout.groups.iter();
    let constraints = mechanism.elements.constraints.iter().zip(groups);
    let mut of_constraints = constraints
        .filter_map(|(c, group)| Some((group.name.clone(), c.unmet_requirement(&bodies)?)));
    let mut of_forces = mechanism
        .elements
        .forces
        .iter()
        .filter_map(|f| Some((f.name.clone(), f.unmet_requirement(&bodies)?)));
    of_constraints.next().or_else(|| of_forces.next())
}

/// Rows of the constraints with a requirement that a configuration does not satisfy, ascending.
pub(crate) fn unmet_rows(mechanism: &Mechanism, q: &[f64]) -> Vec<usize> {
    let bodies = Bodies::at(mechanism.space(), mechanism.of_bodies(q));
    let constraints = mechanism.elements.constraints.iter();
    let unmet = constraints.filter(|c| c.unmet_requirement(&bodies).is_some());
    unmet.flat_map(|c| c.rows.clone()).collect()
}

/// An arm below this many roundings of the position of its body counts as zero: it is the rounding
/// of a difference of positions.
const ROUNDINGS: f64 = 4.0;

/// The longest arm of each body at coordinates q (m), never zero. A body with all joints at its
/// centre takes the arms of its neighbours; if these have none either, like shafts with gears, the
/// size of the mechanism is used.
fn longest_arms(mechanism: &Mechanism, q: &[f64]) -> Vec<f64> {
    let mut s = mechanism.scratch();
    mechanism.pose(0.0, q, &mut s);
    mechanism.c(&mut s);
    let own = own_arms(mechanism, &s);
    let mut of_neighbours = vec![0.0_f64; own.len()];
    for c in &mechanism.elements.constraints {
        let longest = c.site.moving().map(|k| own[k]).fold(0.0, f64::max);
        for k in c.site.moving() {
            of_neighbours[k] = of_neighbours[k].max(longest);
        }
    }
    let size = scene_size(mechanism, q);
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

/// The longest arm of each body; zero if its joints are at its centre.
fn own_arms(mechanism: &Mechanism, s: &Scratch) -> Vec<f64> {
    let layout = mechanism.layout();
    let mut arms = vec![0.0_f64; mechanism.bodies().len()];
    let places = |i: &usize| !layout.is_angular(*i);
    for (k, constraint) in mechanism.elements.constraints.iter().enumerate() {
        let mut rows = constraint.rows.holonomic.clone().filter(places).peekable();
        if rows.peek().is_none() {
            continue;
        }
        // At this configuration, a row along a slot is independent of the arm of a pin that moves
        // along the slot.
        let place = mechanism.reactions(s).place(ConstraintId(k));
        for body in constraint.site.moving() {
            let each = place.iter().zip(s.bodies.origin(body));
            arms[body] = each.fold(arms[body], |arm, (x, at)| arm.max((x - at).abs()));
        }
        for (j, c) in rows.flat_map(|i| layout.row(s, i)) {
            if layout.space.is_rotation(j) {
                let arm = &mut arms[layout.space.body_of(j)];
                *arm = arm.max(c.abs());
            }
        }
    }
    for (arm, at) in arms.iter_mut().zip(s.bodies.origins()) {
        if *arm <= ROUNDINGS * f64::EPSILON * norm(&at) {
            *arm = 0.0;
        }
    }
    arms
}
