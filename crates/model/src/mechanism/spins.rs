//! Rotations about a principal axis without inertia that influence nothing. Examples are the
//! rotations of a point mass on a rope, and the rotation of a thin rod about its own axis between
//! two spherical joints.
//!
//! The equations of motion do not determine such a rotation, because it has neither an inertia nor
//! a load. Every angular acceleration is a solution, and all other motions are the same for all
//! solutions. The mechanism uses the solution without angular acceleration: the entry of M of this
//! rotation is a positive number. The kinetic energy and the gyroscopic torques use the moment of
//! inertia zero.

use super::Mechanism;
use linalg::kernels::dot;

use crate::element::{Bodies, PlacedConstraint, PlacedForce, Site, Slots};
use crate::system::{Scratch, System};

/// A value that depends on the rotation of a body differs by more than this amount (fraction of the
/// largest value of the element) after a rotation by one radian. Entries of C and loads below this
/// fraction are zero. Too small: rounding errors count as a dependency, and a mechanism is
/// rejected. Too large: a small dependency is neglected. Test:
/// `a_thin_rod_depends_on_its_rotation_if_its_force_is_not_along_its_axis`.
const DEPENDS: f64 = 1e-12;

/// Returns the columns of C of the rotations without inertia that influence nothing, in ascending
/// order. The definitions are evaluated at a general configuration near q. At such a configuration
/// no entry is zero by chance.
pub(super) fn free_spins(mechanism: &Mechanism, q: &[f64]) -> Vec<usize> {
    let (space, layout) = (mechanism.space(), &mechanism.layout);
    let is_light = |j: usize| space.is_rotation(j) && mechanism.mass[j] == 0.0;
    let mut free: Vec<bool> = (0..layout.n_v).map(is_light).collect();
    if !free.contains(&true) {
        return Vec::new();
    }
    let q = moved(mechanism, q, &general(layout.n_v, 1.0));
    let v = general(layout.n_v, 2.0);
    let mut here = mechanism.scratch();
    mechanism.pose(layout.start_time, &q, &mut here);
    mechanism.twist(&v, &mut here);
    let inputs = &mechanism.elements.given;
    let jets = here.slots.jets.iter_mut().zip(inputs);
    for ((jet, input), value) in jets.zip(general(inputs.len(), 3.0)) {
        if !input.function().is_some_and(|of| of.function.is_constant()) {
            *jet = [value, value + 0.5, value - 0.5];
        }
    }
    mechanism.c(&mut here);
    for i in 0..layout.rows() {
        let largest = layout
            .row(&here, i)
            .fold(0.0, |a: f64, (_, c)| a.max(c.abs()));
        let entries = layout
            .row(&here, i)
            .filter(|(_, c)| c.abs() > DEPENDS * largest);
        entries.for_each(|(column, _)| free[column] = false);
    }
    for (_, columns, g) in mechanism.inertia(&here).added().rows() {
        let entries = columns.iter().zip(g).filter(|(_, g)| **g != 0.0);
        entries.for_each(|(&column, _)| free[column] = false);
    }
    for k in space.torques() {
        let mut d = vec![0.0; layout.n_v];
        d.chunks_exact_mut(space.n_v()).for_each(|own| own[k] = 1.0);
        let mut there = mechanism.scratch();
        mechanism.pose(layout.start_time, &moved(mechanism, &q, &d), &mut there);
        // The angular velocities change about the axis of the rotation only.
        let mut spun = v.clone();
        for (body, own) in spun.chunks_exact_mut(space.n_v()).enumerate() {
            let mut omega = [0.0; 3];
            space
                .torques()
                .for_each(|k| omega[space.axis_of(k)] = own[k]);
            let omega = here.bodies.turned(body, omega);
            let axes = there.bodies.axes(body);
            space
                .torques()
                .for_each(|k| own[k] = dot(&axes[space.axis_of(k)], &omega));
            own[k] += 1.0;
        }
        mechanism.twist(&spun, &mut there);
        for element in elements_with_loads(mechanism) {
            for body in element.site().moving() {
                let column = space.columns_of(body).start + k;
                let mut depends = || element.depends_on(column, [&mut here, &mut there]);
                free[column] = free[column] && !depends();
            }
        }
    }
    (0..layout.n_v).filter(|&column| free[column]).collect()
}

/// An element that can depend on the rotation of a body although all its entries of C for this
/// rotation are zero.
#[derive(Clone, Copy)]
enum LoadingElement<'m> {
    Nonholonomic(&'m PlacedConstraint, &'m [f64]),
    Force(&'m PlacedForce),
}

fn elements_with_loads(mechanism: &Mechanism) -> impl Iterator<Item = LoadingElement<'_>> {
    let elements = &mechanism.elements;
    let constraints = elements.constraints.iter();
    let constraints = constraints.filter(|c| !c.rows.nonholonomic.is_empty());
    let constraints =
        constraints.map(|c| LoadingElement::Nonholonomic(c, &elements.entries[c.entries.clone()]));
    constraints.chain(elements.forces.iter().map(LoadingElement::Force))
}

impl<'m> LoadingElement<'m> {
    fn site(self) -> &'m Site {
        match self {
            Self::Nonholonomic(c, _) => &c.site,
            Self::Force(f) => &f.site,
        }
    }

    /// Returns the values of the kernels. Torques are in ground axes, as their components along the
    /// axes of a body change if the body rotates. `bodies` returns the current pose of a body.
    fn values<'b>(self, s: &Slots, bodies: impl Fn(usize) -> &'b Bodies) -> Vec<f64> {
        let space = self.site().space;
        let (mut rows, mut values) = (Vec::new(), Vec::new());
        match self {
            Self::Nonholonomic(c, constant) => {
                let mut entries = constant.to_vec();
                if c.has_varying_entries() {
                    c.c(s, &mut entries);
                }
                let n = space.n_v();
                rows.resize(c.spec().rows.len(), Vec::new());
                for (at, entry) in c.spec().c.iter().zip(entries) {
                    rows[at.row].push((c.site.column(n * at.slot + at.dof), entry));
                }
                let mut own = vec![0.0; rows.len()];
                c.b(s, &mut own);
                values.extend_from_slice(&own);
                c.gamma(s, &mut own);
                values.extend(own);
            }
            Self::Force(f) => {
                let mut own = vec![0.0; f.columns.len()];
                f.q(s, &mut own);
                rows.push(f.columns.iter().copied().zip(own).collect());
            }
        }
        for body in self.site().moving() {
            let columns = space.columns_of(body);
            for row in &rows {
                let mut load = [0.0; 6];
                for (column, value) in row {
                    if let Some(k) = column.filter(|column| columns.contains(column)) {
                        load[k - columns.start] += value;
                    }
                }
                let mut torque = [0.0; 3];
                for k in space.torques() {
                    torque[space.axis_of(k)] = std::mem::take(&mut load[k]);
                }
                values.extend(load);
                values.extend(bodies(body).turned(body, torque));
            }
        }
        values
    }

    /// Returns whether the values depend on the rotation of a body that belongs to a column of C,
    /// or contain a torque in this column. The rotated body has its pose and its velocity in the
    /// second work space. The values of a callback are unknown.
    fn depends_on(self, column: usize, [here, there]: [&mut Scratch; 2]) -> bool {
        let site = self.site();
        let body = site.space.body_of(column);
        if let Self::Force(f) = self {
            let mut loads = vec![0.0; f.columns.len()];
            f.q(&here.slots, &mut loads);
            let size = largest(&loads);
            let own = f.columns.iter().zip(&loads);
            let mut torques = own.filter(|(own, _)| **own == Some(column));
            if f.is_called() || torques.any(|(_, torque)| torque.abs() > DEPENDS * size) {
                return true;
            }
        }
        let before = self.values(&here.slots, |_| &here.bodies);
        here.slots.exchange(&mut there.slots, site, body);
        let now = |k: usize| {
            if k == body {
                &there.bodies
            } else {
                &here.bodies
            }
        };
        let after = self.values(&here.slots, now);
        here.slots.exchange(&mut there.slots, site, body);
        let size = largest(&before);
        let mut pairs = before.iter().zip(&after);
        // A value that is not finite counts as a dependency.
        !pairs.all(|(a, b)| (a - b).abs() <= DEPENDS * size)
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |a: f64, x| a.max(x.abs()))
}

/// Returns a displaced configuration.
fn moved(mechanism: &Mechanism, q: &[f64], d: &[f64]) -> Vec<f64> {
    let mut moved = q.to_vec();
    mechanism.displace(&mut moved, d);
    moved
}

/// Returns numbers between −1 and 1 without a pattern; no number is near zero.
fn general(n: usize, seed: f64) -> Vec<f64> {
    let number = |k: usize| {
        let x = (12.9898 * (k as f64 + 1.0) + 78.233 * seed).sin();
        x.signum() * (0.3 + 0.7 * x.abs())
    };
    (0..n).map(number).collect()
}

#[cfg(test)]
mod tests;
