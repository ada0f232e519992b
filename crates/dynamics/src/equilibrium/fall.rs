//! Free fall: sets of bodies that have no connection to the ground and on which a load acts at
//! every configuration.
//!
//! A common translation of all bodies of a set along a straight line does not change the joints and
//! forces between these bodies. Such a translation does not change joints and forces that depend on
//! angles, either. Suppose that, in addition, only the weight and constant forces act on the set.
//! The sum of these forces then acts at every pose. A set of bodies with such a force has no
//! equilibrium.

use linalg::DisjointSets;
use linalg::kernels::norm;
use model::words::listed;
use model::{BodyRef, Mechanism, System};

use super::UnbalancedForce;
use super::balance::Statics;
use super::words::{of_bodies, parts};
use crate::limits::{DEAD_LOAD, UNRESISTED_FORCE};

/// Displacements at which forces are evaluated, to find dead loads (constant forces). The entries
/// belong to the directions of a body: translations of its centre of mass (in sizes of the
/// mechanism), and rotations (rad).
const ELSEWHERE: [[f64; 6]; 2] = [
    [0.7, -1.3, 0.9, 0.8, -0.5, 0.4],
    [-2.1, 1.9, -3.2, -1.1, 0.9, 1.7],
];

/// Returns the sets of bodies that fall at every configuration, with one entry for each set.
pub(super) fn falls(statics: &mut Statics<'_>, q: &[f64]) -> Vec<UnbalancedForce> {
    let n = statics.bodies();
    let mechanism = statics.mechanism;
    let mut sets = DisjointSets::new(n);
    let mut tied = vec![false; n];
    let mut tie = |bodies: &[BodyRef], ties: bool| {
        let moving: Vec<usize> = bodies.iter().filter_map(|body| body.moving()).collect();
        for pair in moving.windows(2) {
            sets.join(pair[0], pair[1]);
        }
        if ties || bodies.len() == 1 || moving.len() < bodies.len() {
            moving.iter().for_each(|k| tied[*k] = true);
        }
    };
    statics.evaluate(q);
    let (layout, space) = (mechanism.layout(), mechanism.space());
    for group in &layout.groups {
        let mut entries = group
            .rows
            .iter()
            .flat_map(|row| layout.row(&statics.s, row));
        if entries.any(|(column, _)| !space.is_rotation(column)) {
            tie(&group.bodies, false);
        }
    }
    let mut load = mechanism.weight().to_vec();
    let dead = dead_loads(statics, q);
    for (force, part) in mechanism.applied_forces().iter().zip(dead) {
        let mut pushes = force.spec.q.iter().map(|k| space.dof_of(*k));
        let turns = !force.spec.q.is_empty() && !pushes.any(|dof| space.forces().contains(&dof));
        match part {
            Some(part) => load.iter_mut().zip(part).for_each(|(x, f)| *x += f),
            None if turns => {}
            None => tie(force.bodies, force.bodies.len() == 1),
        }
    }
    let forces = parts(statics, q);
    let translations = |body: usize| {
        let columns = space.columns_of(body);
        columns.filter(|j| !space.is_rotation(*j))
    };
    let mut found = Vec::new();
    for own in sets.sets() {
        if own.iter().any(|k| tied[*k]) {
            continue;
        }
        let mut sum = vec![0.0; space.n_translations()];
        let mut largest = 0.0_f64;
        for &body in &own {
            for (sum, j) in sum.iter_mut().zip(translations(body)) {
                *sum += load[j];
                largest = largest.max(load[j].abs());
            }
        }
        let size = norm(&sum);
        if size.is_nan() || size <= UNRESISTED_FORCE * largest {
            continue;
        }
        let along: Vec<f64> = sum.iter().map(|x| x / size).collect();
        let mut v = vec![0.0; load.len()];
        for &body in &own {
            for (j, x) in translations(body).zip(&along) {
                v[j] = *x;
            }
        }
        let motion = slides(mechanism, &own, &along);
        found.push(of_bodies(statics, &forces, &v, (&motion, &own)));
    }
    found
}

/// Describes a translation of some bodies.
fn slides(mechanism: &Mechanism, bodies: &[usize], along: &[f64]) -> String {
    let name = |k: &usize| format!("`{}`", mechanism.bodies()[*k].name);
    let names: Vec<String> = bodies.iter().map(name).collect();
    let verb = match bodies {
        [_] => "slides",
        _ => "slide together",
    };
    let names = match &names[..] {
        [first, second] => format!("{first} and {second}"),
        names => listed(names),
    };
    // The numbers have four digits, and −0 is printed as 0.
    let shown = along.iter().map(|x| (x * 1e4).round() / 1e4 + 0.0);
    let shown = shown.map(|x| x.to_string().replace('-', "−"));
    format!(
        "{names} {verb} along ({})",
        shown.collect::<Vec<_>>().join(", ")
    )
}

/// Returns the contribution of each applied force on one body to Q if the force is constant at
/// other poses. The value is `None` for other forces.
fn dead_loads(statics: &mut Statics<'_>, q: &[f64]) -> Vec<Option<Vec<f64>>> {
    let mechanism = statics.mechanism;
    let (space, size) = (mechanism.space(), statics.size);
    let on_one: Vec<bool> = mechanism
        .applied_forces()
        .iter()
        .map(|force| matches!(force.bodies, [BodyRef::Body(_)]))
        .collect();
    if !on_one.contains(&true) {
        return vec![None; on_one.len()];
    }
    let mut at = |q: &[f64]| -> Vec<Vec<f64>> {
        statics.evaluate(q);
        let parts = mechanism.applied_forces().parts(&mut statics.s);
        parts
            .map(|(_, mut part)| {
                let turns = (0..part.len()).filter(|j| space.is_rotation(*j));
                turns.for_each(|j| part[j] = 0.0);
                part
            })
            .collect()
    };
    let here = at(q);
    let elsewhere = ELSEWHERE.map(|way| {
        let n = mechanism.layout().n_v;
        let step = |j: usize| {
            let unit = space.unit(j, size);
            unit * way[space.dof_of(j) % way.len()]
        };
        let step: Vec<f64> = (0..n).map(step).collect();
        at(&space.displaced(q, 1.0, &step))
    });
    let is_dead = |k: usize| {
        let part = &here[k];
        let changed = |other: &Vec<Vec<f64>>| {
            let change: Vec<f64> = part.iter().zip(&other[k]).map(|(a, b)| a - b).collect();
            norm(&change)
        };
        let bound = DEAD_LOAD * norm(part);
        // A force that is zero at a few poses may be nonzero at other poses.
        bound > 0.0 && elsewhere.iter().all(|other| changed(other) <= bound)
    };
    let kept: Vec<bool> = (0..here.len()).map(|k| on_one[k] && is_dead(k)).collect();
    let parts = here.into_iter().zip(kept);
    parts.map(|(part, kept)| kept.then_some(part)).collect()
}
