//! Transforms the angular velocities of bodies in space for which only some ground components are
//! kept.
//!
//! The columns of C for rotations refer to the axes in which the inertia J of the body is diagonal.
//! For a body with kept components, the angular velocity is replaced by y with `ω = E·y`. The kept
//! components are components of y. The kinetic energy does not contain products of a kept component
//! and a dependent component, or products of two different dependent components. Let a be the
//! directions of the kept components, in the axes of J. For one direction, `e₁ = J⁻¹·a/(aᵀ·J⁻¹·a)`,
//! and e₂, e₃ are perpendicular to a with `e₂ᵀ·J·e₃ = 0`. For two directions, e₃ is the direction
//! of the third ground axis, and `e_k = a_k − (a_kᵀ·J·e₃/e₃ᵀ·J·e₃)·e₃`.

use std::ops::Range;

use joints::space3::{cross, dot};

use super::options::{KeepLevel, StartOptions};
use crate::mechanism::Mechanism;
use crate::space::SpaceKind;
use crate::system::{Scratch, System};

/// The transformed angular velocity of one body.
pub(super) struct Components {
    columns: Range<usize>,
    /// Columns e of E, in the axes of J.
    basis: [[f64; 3]; 3],
    /// Rows of E⁻¹.
    inverse: [[f64; 3]; 3],
    /// The inertia eᵀ·J·e for each column.
    inertia: [f64; 3],
}

impl Components {
    /// Returns the bodies with one or two kept components of the angular velocity. `weights` is the
    /// diagonal of M⁻¹.
    pub(super) fn kept(
        mechanism: &Mechanism,
        options: &StartOptions,
        s: &Scratch,
        weights: &[f64],
    ) -> Vec<Self> {
        let space = mechanism.space();
        if space != SpaceKind::Space3 {
            return Vec::new();
        }
        let of_body = |body: usize| {
            let columns = space.rotations_of(body);
            let kept = [0, 1, 2].map(|axis| {
                options.keep.iter().any(|c| {
                    c.level == KeepLevel::Velocity
                        && (c.body, c.dof) == (body, space.n_translations() + axis)
                })
            });
            let [x, y, z] = s.bodies.axes(body);
            // Directions of the ground axes in the axes of the body.
            let ground = [0, 1, 2].map(|axis| [x[axis], y[axis], z[axis]]);
            let inertia = [0, 1, 2].map(|k| weights[columns.start + k].recip());
            let (basis, inverse) = match kept.iter().filter(|kept| **kept).count() {
                1 => {
                    let at = kept.iter().position(|kept| *kept)?;
                    one(at, ground[at], inertia)
                }
                2 => {
                    let at = kept.iter().position(|kept| !*kept)?;
                    two(at, ground, inertia)
                }
                _ => return None,
            };
            let energy = |e: [f64; 3]| dot(e, product(inertia, e));
            Some(Self {
                columns,
                basis,
                inverse,
                inertia: basis.map(energy),
            })
        };
        let bodies = 0..mechanism.bodies().len();
        bodies.filter_map(of_body).collect()
    }

    /// Transforms the entries of C in the work space, and the weights.
    pub(super) fn take_over(&self, mechanism: &Mechanism, s: &mut Scratch, weights: &mut [f64]) {
        for (k, j) in self.columns.clone().enumerate() {
            weights[j] = self.inertia[k].recip();
        }
        let layout = mechanism.layout();
        let pattern = &layout.pattern;
        for i in 0..layout.rows() {
            let mut places = [None; 3];
            for at in pattern.row(i) {
                if let Some(k) = pattern.column[at].checked_sub(self.columns.start)
                    && let Some(place) = places.get_mut(k)
                {
                    *place = Some(pattern.entry[at]);
                }
            }
            if places == [None; 3] {
                continue;
            }
            let old = places.map(|place| place.map_or(0.0, |entry| s.entries[entry]));
            for (place, e) in places.into_iter().zip(self.basis) {
                if let Some(entry) = place {
                    s.entries[entry] = dot(old, e);
                }
            }
        }
    }

    /// Replaces the angular velocity in v by y.
    pub(super) fn replace(&self, v: &mut [f64]) {
        self.apply(v, |omega| self.inverse.map(|row| dot(row, omega)));
    }

    /// Replaces y in v by the angular velocity.
    pub(super) fn restore(&self, v: &mut [f64]) {
        let basis = self.basis;
        self.apply(v, |y| {
            [0, 1, 2].map(|k| (0..3).map(|l| basis[l][k] * y[l]).sum())
        });
    }

    fn apply(&self, v: &mut [f64], map: impl Fn([f64; 3]) -> [f64; 3]) {
        let own = &mut v[self.columns.clone()];
        let new = map([own[0], own[1], own[2]]);
        own.copy_from_slice(&new);
    }
}

/// Computes J·e.
fn product(inertia: [f64; 3], e: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| inertia[k] * e[k])
}

type Pair = ([[f64; 3]; 3], [[f64; 3]; 3]);

/// Returns the basis in which component `at` of y is the component of ω along the unit vector a.
fn one(at: usize, a: [f64; 3], inertia: [f64; 3]) -> Pair {
    let along = [0, 1, 2].map(|k| a[k] / inertia[k]);
    let first = along.map(|x| x / dot(a, along));
    // Two directions perpendicular to a. The directions are rotated so that their product of
    // inertia is zero.
    let least = (1..3).fold(0, |k, j| if a[j].abs() < a[k].abs() { j } else { k });
    let unit = [0, 1, 2].map(|k| if k == least { 1.0 } else { 0.0 });
    let p = cross(a, unit);
    let p = p.map(|x| x / dot(p, p).sqrt());
    let q = cross(a, p);
    let [jp, jq] = [p, q].map(|e| product(inertia, e));
    let turn = 0.5 * (2.0 * dot(p, jq)).atan2(dot(p, jp) - dot(q, jq));
    let (sin, cos) = turn.sin_cos();
    let second = [0, 1, 2].map(|k| cos * p[k] + sin * q[k]);
    let third = cross(a, second);
    let component = |e: [f64; 3]| {
        let own = product(inertia, e);
        own.map(|x| x / dot(e, own))
    };
    let (mut basis, mut inverse) = ([[0.0; 3]; 3], [[0.0; 3]; 3]);
    (basis[at], inverse[at]) = (first, a);
    for (k, e) in [(1, second), (2, third)] {
        let k = (at + k) % 3;
        (basis[k], inverse[k]) = (e, component(e));
    }
    (basis, inverse)
}

/// Returns the basis in which all components of y except component `at` are components along ground
/// axes.
fn two(at: usize, ground: [[f64; 3]; 3], inertia: [f64; 3]) -> Pair {
    let free = ground[at];
    let own = product(inertia, free);
    let row = own.map(|x| x / dot(free, own));
    let (mut basis, mut inverse) = (ground, ground);
    for (k, e) in basis.iter_mut().enumerate() {
        if k != at {
            let share = dot(row, *e);
            *e = [0, 1, 2].map(|l| e[l] - share * free[l]);
        }
    }
    inverse[at] = row;
    (basis, inverse)
}

#[cfg(test)]
mod tests {
    use super::*;

    const INERTIA: [f64; 3] = [0.3, 1.7, 0.9];
    const AXES: [[f64; 3]; 3] = [[0.48, 0.64, 0.6], [-0.8, 0.6, 0.0], [-0.36, -0.48, 0.8]];

    /// Checks that E⁻¹·E is the identity, that kept components are ground components, and that the
    /// energy has no products with dependent components.
    fn check((basis, inverse): Pair, kept: &[usize]) {
        for k in 0..3 {
            for l in 0..3 {
                let unit = if k == l { 1.0 } else { 0.0 };
                assert!((dot(inverse[k], basis[l]) - unit).abs() < 1e-15);
                let product = dot(basis[k], product(INERTIA, basis[l]));
                let are_kept = kept.contains(&k) && kept.contains(&l);
                assert!(k == l || are_kept || product.abs() < 1e-15, "{k}, {l}");
            }
        }
        for &k in kept {
            assert_eq!(inverse[k], AXES[k]);
        }
    }

    #[test]
    fn kept_components_are_numbers_of_their_own() {
        for at in 0..3 {
            check(one(at, AXES[at], INERTIA), &[at]);
            let kept: Vec<usize> = (0..3).filter(|k| *k != at).collect();
            check(two(at, AXES, INERTIA), &kept);
        }
    }
}
