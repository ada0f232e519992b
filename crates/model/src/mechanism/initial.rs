//! Values taken from the initial configuration of a mechanism. The values are the initial values
//! stored by definitions, and the arms of the bodies. The arms are the length scales of positions
//! near the origin.
//!
//! The module [`crate::arms`] computes the arms, and [`crate::size`] computes the size of the whole
//! mechanism.

use super::Mechanism;
use crate::arms::longest_arms;
use crate::element::Bodies;
use crate::system::System;

/// Takes the initial values of joints, drives and forces from a configuration.
pub(crate) fn initialise(mechanism: &mut Mechanism, q: &[f64]) {
    let bodies = Bodies::at(mechanism.space(), mechanism.of_bodies(q));
    for c in &mut mechanism.elements.constraints {
        c.initialise(&bodies);
    }
    for f in &mut mechanism.elements.forces {
        f.initialise(&bodies);
    }
    for armature in &mut mechanism.elements.armatures {
        armature.initialise(&bodies);
    }
    let mut s = mechanism.scratch();
    mechanism.pose(0.0, q, &mut s);
    mechanism.c(&mut s);
    mechanism.reach = longest_arms(mechanism, &s);
}

/// Returns the first requirement of a definition that a configuration does not satisfy, with the
/// name of the element.
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

/// Returns the rows of the constraints that have an unsatisfied requirement at a configuration, in
/// ascending order.
pub(crate) fn unmet_rows(mechanism: &Mechanism, q: &[f64]) -> Vec<usize> {
    let bodies = Bodies::at(mechanism.space(), mechanism.of_bodies(q));
    let constraints = mechanism.elements.constraints.iter();
    let unmet = constraints.filter(|c| c.unmet_requirement(&bodies).is_some());
    unmet.flat_map(|c| c.rows.clone()).collect()
}
