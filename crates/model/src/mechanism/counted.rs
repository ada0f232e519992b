//! Unwrapped angles in space. A rotation determines an angle only up to full revolutions. A screw,
//! a gear or a spring needs the angle including full revolutions. Therefore the configuration has
//! one coordinate for each of these angles, after the coordinates of the bodies. The coordinate is
//! the change of the angle since the start. The time derivative of the coordinate is the rate of
//! the angle. Only the number of revolutions is taken from the coordinate. The coordinate need not
//! be exact, because the angle within the revolution is computed from the poses.

use std::f64::consts::TAU;

use joints::space3::{Pose, Twist};

use super::elements::{CountedAngle, Elements, Owner};
use crate::element::{Site, Slots};
use crate::group::ConstraintGroup;

/// Returns the angle with this cosine and sine that is closest to an approximate value `known`
/// (rad). If the axes are perpendicular, cosine and sine are both zero. The function then returns
/// the approximate value.
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
    /// Returns the name of the joint, drive or force to which unwrapped angle `k` belongs.
    pub(super) fn counted_name<'a>(&'a self, k: usize, groups: &'a [ConstraintGroup]) -> &'a str {
        match self.counted[k].owner {
            Owner::Constraint(k) => &groups[k].name,
            Owner::Force(k) => &self.forces[k].name,
        }
    }

    /// Returns the unwrapped angles of some groups and forces. Groups and forces are both in
    /// ascending order.
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

    /// Computes the unwrapped angles at the current poses for the kernels. The approximate angles
    /// `known` determine the numbers of revolutions.
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

    /// Computes the rates of the unwrapped angles at velocities v.
    #[inline]
    pub(super) fn rate_of_angles(&self, q: &[f64], v: &[f64], rates: &mut [f64]) {
        for (rate, angle) in rates.iter_mut().zip(&self.counted) {
            let site = self.site_of(angle);
            *rate = site.with_spatial((q, Some(v)), |x, v| self.turned(angle, x, v)[2]);
        }
    }

    /// Adds the rotations of a displacement d to the unwrapped angles, which start at index `first`
    /// of q. This function must be called before the coordinates of the bodies in q are displaced.
    #[inline]
    pub(super) fn displace_angles(&self, first: usize, q: &mut [f64], d: &[f64]) {
        for (k, angle) in (first..).zip(&self.counted) {
            let site = self.site_of(angle);
            q[k] += site.with_spatial((q, Some(d)), |x, v| self.turned(angle, x, v)[2]);
        }
    }

    /// Recomputes the unwrapped angles from the poses of the bodies. The values already in q
    /// determine the numbers of revolutions. The angles start at index `first` of q.
    #[inline]
    pub(crate) fn settle_angles(&self, first: usize, q: &mut [f64]) {
        for (k, angle) in (first..).zip(&self.counted) {
            let site = self.site_of(angle);
            let [cos, sin, _] = site.with_spatial((q, None), |x, v| self.turned(angle, x, v));
            q[k] = closest(cos, sin, q[k]);
        }
    }
}
