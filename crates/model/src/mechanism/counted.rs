//! Unwrapped angles in space, which include full revolutions. A rotation determines an angle only
//! up to full revolutions, but a screw, a gear or a spring needs the unwrapped angle. Therefore the
//! configuration has one coordinate for each such angle, after the coordinates of the bodies: the
//! angle since the start. The coordinate changes with the rate of the angle, and only its number of
//! revolutions is used. It therefore need not be exact: the angle itself follows from the poses.

use std::f64::consts::TAU;

use joints::space3::{Pose, Twist};

use super::elements::{CountedAngle, Elements, Owner};
use crate::element::{Site, Slots};
use crate::group::ConstraintGroup;

/// Returns the angle with this cosine and sine that is closest to an approximately known angle
/// (rad). Both are zero if the axes are perpendicular; then the known angle is returned.
fn closest(cos: f64, sin: f64, known: f64) -> f64 {
    if cos == 0.0 && sin == 0.0 {
        return known;
    }
    let angle = sin.atan2(cos);
    let turns = ((known - angle) / TAU).round();
    if turns == 0.0 {
        angle
    } else {
        angle + turns * TAU
    }
}

impl Elements {
    /// Returns the name of the joint, drive or force of unwrapped angle `k`.
    pub(super) fn counted_name<'a>(&'a self, k: usize, groups: &'a [ConstraintGroup]) -> &'a str {
        match self.counted[k].owner {
            Owner::Constraint(k) => &groups[k].name,
            Owner::Force(k) => &self.forces[k].name,
        }
    }

    /// Returns the unwrapped angles of some groups and forces, both in ascending order.
    pub(super) fn counted_of(
        &self,
        groups: &[usize],
        forces: &[usize],
    ) -> impl Iterator<Item = usize> {
        let is_there = move |owner| match owner {
            Owner::Constraint(k) => groups.binary_search(&k).is_ok(),
            Owner::Force(k) => forces.binary_search(&k).is_ok(),
        };
        let all = self.counted.iter().enumerate();
        let there = all.filter(move |(_, angle)| is_there(angle.owner));
        there.map(|(k, _)| k)
    }

    fn site_of(&self, angle: &CountedAngle) -> &Site {
        match angle.owner {
            Owner::Constraint(k) => &self.constraints[k].site,
            Owner::Force(k) => &self.forces[k].site,
        }
    }

    /// Returns the cosine, sine and rate of an angle.
    fn turned(&self, angle: &CountedAngle, x: &[Pose], v: &[Twist]) -> [f64; 3] {
        match angle.owner {
            Owner::Constraint(k) => self.constraints[k].counted(angle.number, x, v),
            Owner::Force(k) => self.forces[k].counted(angle.number, x, v),
        }
    }

    /// Sets the unwrapped angles of the kernels at the poses of the slots, with the revolutions of
    /// these approximately known angles.
    #[inline]
    pub(super) fn count_turns(&self, known: &[f64], slots: &mut Slots) {
        for (angle, &known) in self.counted.iter().zip(known) {
            let (x, v) = self.site_of(angle).in_space(slots);
            let [cos, sin, _] = self.turned(angle, x, v);
            let theta = closest(cos, sin, known);
            let (sin, cos) = theta.sin_cos();
            for (jet, value) in slots.jets[angle.first..].iter_mut().zip([theta, cos, sin]) {
                *jet = [value, 0.0, 0.0];
            }
        }
    }

    /// Rates of the unwrapped angles at velocities v.
    #[inline]
    pub(super) fn rate_of_angles(&self, q: &[f64], v: &[f64], rates: &mut [f64]) {
        for (rate, angle) in rates.iter_mut().zip(&self.counted) {
            let site = self.site_of(angle);
            *rate = site.with_spatial((q, Some(v)), |x, v| self.turned(angle, x, v)[2]);
        }
    }

    /// Changes the unwrapped angles, from index `first` of q, by their rotation along d. Their
    /// bodies have not yet moved.
    #[inline]
    pub(super) fn displace_angles(&self, first: usize, q: &mut [f64], d: &[f64]) {
        for (k, angle) in (first..).zip(&self.counted) {
            let site = self.site_of(angle);
            q[k] += site.with_spatial((q, Some(d)), |x, v| self.turned(angle, x, v)[2]);
        }
    }

    /// Sets the unwrapped angles, from index `first` of q, to those of the bodies, with their
    /// revolutions.
    #[inline]
    pub(crate) fn settle_angles(&self, first: usize, q: &mut [f64]) {
        for (k, angle) in (first..).zip(&self.counted) {
            let site = self.site_of(angle);
            let [cos, sin, _] = site.with_spatial((q, None), |x, v| self.turned(angle, x, v));
            q[k] = closest(cos, sin, q[k]);
        }
    }
}
