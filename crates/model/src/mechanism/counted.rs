//! Angles in space with their full turns. A rotation knows an angle up to full turns only; a screw,
//! a gear or a spring need the angle itself. So the configuration has one coordinate for each such
//! angle, after those of the bodies: the angle since the start. It moves with the rate of the
//! angle, and only the number of its turns is read from it, so that it need not be exact: the angle
//! itself is that of the poses.

use std::f64::consts::TAU;

use joints::space3::{Pose, Twist};
use linalg::Dd;

use super::Mechanism;
use crate::element::{Site, Slots};
use crate::system::System;

/// An angle that counts its turns.
#[derive(Clone)]
pub(crate) struct CountedAngle {
    pub(super) owner: Owner,
    /// Its number among the counted angles of its element.
    pub(super) number: usize,
    /// The first of its three values among those that are given to kernels.
    pub(super) first: usize,
}

/// The element of a counted angle.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Owner {
    Constraint(usize),
    Force(usize),
}

/// The angle with this cosine and sine that is closest to one that is nearly known (rad). Both are
/// zero where axes are across each other; then the known one stays.
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

impl Mechanism {
    /// The coordinates of the bodies among those of a configuration: all but the counted angles.
    pub fn of_bodies<'q, T>(&self, q: &'q [T]) -> &'q [T] {
        &q[..self.first_counted().min(q.len())]
    }

    /// The same to be changed.
    pub fn of_bodies_mut<'q, T>(&self, q: &'q mut [T]) -> &'q mut [T] {
        let n = self.first_counted().min(q.len());
        &mut q[..n]
    }

    /// Index of the first counted angle in q.
    fn first_counted(&self) -> usize {
        self.layout.n_q - self.layout.turns
    }

    /// Name of the joint, drive or force of counted angle `k`.
    pub(super) fn counted_name(&self, k: usize) -> &str {
        match self.elements.counted[k].owner {
            Owner::Constraint(k) => &self.layout.groups[k].name,
            Owner::Force(k) => &self.elements.forces[k].name,
        }
    }

    /// Coordinates of the counted angles of some groups and forces, both ascending.
    pub(super) fn counted_of(&self, groups: &[usize], forces: &[usize]) -> Vec<usize> {
        let is_there = |owner| match owner {
            Owner::Constraint(k) => groups.binary_search(&k).is_ok(),
            Owner::Force(k) => forces.binary_search(&k).is_ok(),
        };
        let all = self.elements.counted.iter().enumerate();
        let there = all.filter(|(_, angle)| is_there(angle.owner));
        there.map(|(k, _)| self.first_counted() + k).collect()
    }

    fn site_of(&self, angle: &CountedAngle) -> &Site {
        match angle.owner {
            Owner::Constraint(k) => &self.elements.constraints[k].site,
            Owner::Force(k) => &self.elements.forces[k].site,
        }
    }

    /// Cosine, sine and rate of an angle.
    fn turned(&self, angle: &CountedAngle, x: &[Pose], v: &[Twist]) -> [f64; 3] {
        match angle.owner {
            Owner::Constraint(k) => self.elements.constraints[k].counted(angle.number, x, v),
            Owner::Force(k) => self.elements.forces[k].counted(angle.number, x, v),
        }
    }

    /// Gives the kernels their counted angles at the poses of the slots, with the turns of q.
    #[inline]
    pub(super) fn count_turns(&self, q: &[f64], slots: &mut Slots) {
        let known = &q[self.first_counted()..self.layout.n_q];
        for (angle, &known) in self.elements.counted.iter().zip(known) {
            let (x, v) = self.site_of(angle).in_space(slots);
            let [cos, sin, _] = self.turned(angle, x, v);
            let theta = closest(cos, sin, known);
            let (sin, cos) = theta.sin_cos();
            for (jet, value) in slots.jets[angle.first..].iter_mut().zip([theta, cos, sin]) {
                *jet = [value, 0.0, 0.0];
            }
        }
    }

    /// The same in double-double: the angle of the rounded coordinates, whose cosine and sine are
    /// known to all digits. Kernels add what is left of the angle.
    pub(crate) fn extended_angles(&self, t: f64, q: &[Dd], jets: &mut [[Dd; 3]]) {
        if self.layout.turns == 0 {
            return;
        }
        let rounded: Vec<f64> = q.iter().map(|q| q.to_f64()).collect();
        let mut s = self.scratch();
        self.pose(t, &rounded, &mut s);
        for angle in &self.elements.counted {
            let theta = Dd::from(s.slots.jets[angle.first][0]);
            let (sin, cos) = theta.sin_cos();
            for (jet, value) in jets[angle.first..].iter_mut().zip([theta, cos, sin]) {
                *jet = [value, Dd::ZERO, Dd::ZERO];
            }
        }
    }

    /// Rates of the counted angles at velocities v.
    #[inline]
    pub(super) fn rate_of_angles(&self, q: &[f64], v: &[f64], qd: &mut [f64]) {
        let rates = &mut qd[self.first_counted()..];
        for (rate, angle) in rates.iter_mut().zip(&self.elements.counted) {
            let site = self.site_of(angle);
            *rate = site.with_spatial((q, Some(v)), |x, v| self.turned(angle, x, v)[2]);
        }
    }

    /// Moves the counted angles of q, whose bodies have not yet moved, by what they turn along d.
    #[inline]
    pub(super) fn displace_angles(&self, q: &mut [f64], d: &[f64]) {
        for (k, angle) in (self.first_counted()..).zip(&self.elements.counted) {
            let site = self.site_of(angle);
            q[k] += site.with_spatial((q, Some(d)), |x, v| self.turned(angle, x, v)[2]);
        }
    }

    /// Sets the counted angles of q to those of its bodies, with their turns.
    #[inline]
    pub(crate) fn settle_angles(&self, q: &mut [f64]) {
        for (k, angle) in (self.first_counted()..).zip(&self.elements.counted) {
            let site = self.site_of(angle);
            let [cos, sin, _] = site.with_spatial((q, None), |x, v| self.turned(angle, x, v));
            q[k] = closest(cos, sin, q[k]);
        }
    }
}
