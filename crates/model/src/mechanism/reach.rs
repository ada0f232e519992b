//! How far the joints of a body are from its centre: by this its position is measured where it
//! stands at the origin.
//!
//! Not here: the size of the whole mechanism (`start::scene_size`).

use super::{Mechanism, N_BODY, PlacedConstraint};
use crate::description::BodyRef;
use crate::reaction::ConstraintId;
use crate::start::scene_size;
use crate::system::{Scratch, System};

/// An arm below this many roundings of its body's position is none: it is what is left of a
/// difference of places.
const ROUNDINGS: f64 = 4.0;

/// The longest arm of each body at coordinates q (m), never zero: a body held at its centre is
/// where its neighbours' arms put it, and where these have none either, as on shafts with gears,
/// only the mechanism as a whole has a length.
pub(super) fn longest_arms(mechanism: &Mechanism, q: &[f64]) -> Vec<f64> {
    let mut s = mechanism.scratch();
    mechanism.pose(0.0, q, &mut s);
    mechanism.c(&mut s);
    let own = own_arms(mechanism, &s);
    let mut of_neighbours = vec![0.0_f64; own.len()];
    for c in mechanism.constraints() {
        let longest = moving(c).map(|k| own[k]).fold(0.0, f64::max);
        for k in moving(c) {
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

/// The longest arm of each body; zero where its joints are at its centre.
fn own_arms(mechanism: &Mechanism, s: &Scratch) -> Vec<f64> {
    let layout = mechanism.layout();
    let mut arms = vec![0.0_f64; mechanism.bodies().len()];
    let places = |i: &usize| *i < layout.m && !mechanism.is_angular(*i);
    for (k, constraint) in mechanism.constraints().iter().enumerate() {
        let mut rows = constraint.rows.clone().filter(places).peekable();
        if rows.peek().is_none() {
            continue;
        }
        // A row along a slot does not feel the arm of a pin that moves along the slot here.
        let [x, y] = mechanism.place(ConstraintId(k), s);
        for body in moving(constraint) {
            let at = &s.poses[body];
            arms[body] = arms[body].max((x - at.x).abs()).max((y - at.y).abs());
        }
        for (j, c) in rows.flat_map(|i| layout.row(s, i)) {
            if j % N_BODY == 2 {
                arms[j / N_BODY] = arms[j / N_BODY].max(c.abs());
            }
        }
    }
    for (arm, at) in arms.iter_mut().zip(&s.poses) {
        if *arm <= ROUNDINGS * f64::EPSILON * at.x.hypot(at.y) {
            *arm = 0.0;
        }
    }
    arms
}

/// The bodies of a constraint but the ground.
fn moving(constraint: &PlacedConstraint) -> impl Iterator<Item = usize> + '_ {
    constraint.bodies.iter().filter_map(|b| match *b {
        BodyRef::Body(k) => Some(k),
        BodyRef::Ground => None,
    })
}
