//! Descriptions of free motions, and of the loads that act along them.

use solvability::motions_among;

use super::UnbalancedForce;
use super::balance::{Balance, Statics};
use crate::limits::{MOSTLY_TURNS, TAKES_PART, UNRESISTED};

/// Returns descriptions of free motions, each of which is given by d components.
pub(super) fn motions(statics: &Statics<'_>, at: &Balance, of: &[Vec<f64>]) -> Vec<String> {
    let velocities: Vec<Vec<f64>> = of.iter().map(|y| statics.velocity(at, y)).collect();
    let told = motions_among(statics.mechanism, statics.t, &at.q, &velocities);
    let told = told.unwrap_or_default().into_iter();
    told.map(|motion| motion.text).collect()
}

/// Returns the loads along a free motion, separately for each set of moving bodies.
pub(super) fn pushed(
    statics: &mut Statics<'_>,
    at: &Balance,
    along: &[f64],
) -> Vec<UnbalancedForce> {
    let v = statics.velocity(at, along);
    let told = motions_among(
        statics.mechanism,
        statics.t,
        &at.q,
        std::slice::from_ref(&v),
    );
    let told = told.unwrap_or_default();
    let forces = parts(statics, &at.q);
    let all: Vec<UnbalancedForce> = told
        .iter()
        .map(|motion| {
            let bodies: Vec<usize> = motion
                .velocities
                .iter()
                .flatten()
                .map(|(b, _)| *b)
                .collect();
            of_bodies(statics, &forces, &v, (&motion.text, &bodies))
        })
        .collect();
    if all.is_empty() {
        let bodies: Vec<usize> = (0..statics.bodies()).collect();
        return vec![of_bodies(statics, &forces, &v, ("a free motion", &bodies))];
    }
    let largest = all.iter().fold(0.0, |a: f64, p| a.max(p.force.abs()));
    let takes_part = |p: &UnbalancedForce| p.force.abs() > UNRESISTED * largest;
    all.into_iter().filter(takes_part).collect()
}

/// Returns descriptions of the weight and of the applied forces at the configuration q, with the
/// contributions of these forces to Q.
pub(super) fn parts(statics: &mut Statics<'_>, q: &[f64]) -> Vec<(String, Vec<f64>)> {
    statics.evaluate(q);
    let weight = ("the weight".to_owned(), statics.mechanism.weight().to_vec());
    let forces = statics.mechanism.applied_forces().parts(&mut statics.s);
    let forces = forces.map(|(name, q)| (format!("`{name}`"), q));
    std::iter::once(weight).chain(forces).collect()
}

/// Returns the loads that act on some bodies along the motion of these bodies.
pub(super) fn of_bodies(
    statics: &Statics<'_>,
    forces: &[(String, Vec<f64>)],
    v: &[f64],
    (motion, bodies): (&str, &[usize]),
) -> UnbalancedForce {
    let space = statics.mechanism.space();
    let own = |j: &usize| bodies.contains(&space.body_of(*j));
    let columns: Vec<usize> = (0..v.len()).filter(own).collect();
    let fastest = |turns: bool| {
        let speed = |&body: &usize| {
            let of_body = space
                .columns_of(body)
                .filter(|j| space.is_rotation(*j) == turns);
            of_body.map(|j| v[j]).fold(0.0, f64::hypot)
        };
        bodies.iter().map(speed).fold(0.0, f64::max)
    };
    let (turn, slide) = (fastest(true), fastest(false));
    // The load is a force per metre of the translation. If the motion is mostly a rotation, it is a
    // moment per radian.
    let (largest, unit) = if turn * statics.size > MOSTLY_TURNS * slide {
        (turn, "N·m")
    } else {
        (slide, "N")
    };
    let power = |q: &[f64]| columns.iter().map(|&j| q[j] * v[j] / largest).sum::<f64>();
    let parts: Vec<(&String, f64)> = forces.iter().map(|(name, q)| (name, power(q))).collect();
    let force: f64 = parts.iter().map(|(_, power)| power).sum();
    let by = parts
        .into_iter()
        .filter(|(_, power)| power.abs() > TAKES_PART * force.abs())
        .map(|(name, _)| name.clone());
    UnbalancedForce {
        motion: motion.to_owned(),
        force,
        unit,
        by: by.collect(),
    }
}
