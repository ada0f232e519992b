//! How the configuration of a mechanism moves along velocities, body by body in its space. Nothing
//! else moves or compares coordinates.

use std::ops::Range;

use joints::Pose;

use super::{Mechanism, N_BODY};
use crate::space::{Number, Space, SpaceKind, in_space};
use crate::system::System;

impl Mechanism {
    /// The space that its bodies move in.
    #[must_use]
    pub fn space(&self) -> SpaceKind {
        self.space
    }

    /// The same mechanism with planar bodies whose coordinates are (x, y, cos φ, sin φ), not yet
    /// started.
    #[cfg(feature = "unit-circle")]
    #[must_use]
    pub fn on_unit_circle(mut self) -> Self {
        self.space = SpaceKind::UnitCircle;
        self.layout.n_q = self.space.n_q() * self.bodies.len();
        self
    }

    /// As [`System::displace`], in any number type.
    pub(crate) fn displace_number<T: Number>(&self, q: &mut [T], d: &[T]) {
        in_space!(self.space, S => {
            for (q, d) in q.chunks_exact_mut(S::N_Q).zip(d.chunks_exact(N_BODY)) {
                S::displace(q, d);
            }
        });
    }

    /// A copy of q, moved by `factor` times d; allocates.
    #[must_use]
    pub fn displaced(&self, q: &[f64], factor: f64, d: &[f64]) -> Vec<f64> {
        let mut moved = q.to_vec();
        let d: Vec<f64> = d.iter().map(|d| factor * d).collect();
        self.displace(&mut moved, &d);
        moved
    }

    /// [`System::difference`] as a vector; allocates.
    #[must_use]
    pub fn difference_of(&self, q: &[f64], from: &[f64]) -> Vec<f64> {
        let mut d = vec![0.0; self.layout.n_v];
        self.difference(q, from, &mut d);
        d
    }

    /// Takes the freedoms of these columns of C over from another configuration, exactly.
    pub fn take(&self, q: &mut [f64], from: &[f64], columns: &[usize]) {
        in_space!(self.space, S => {
            for column in columns {
                let body = S::N_Q * (column / N_BODY);
                let body = body..body + S::N_Q;
                S::take(&mut q[body.clone()], &from[body], column % N_BODY);
            }
        });
    }

    /// The velocity of a column of C as a sum over q̇ at the configuration q: places in q̇ with
    /// their coefficients, into `terms`.
    pub fn read_velocity(&self, q: &[f64], column: usize, terms: &mut Vec<(usize, f64)>) {
        let (body, dof) = (column / N_BODY, column % N_BODY);
        terms.clear();
        in_space!(self.space, S => {
            let first = S::N_Q * body;
            let factors = S::velocity_from_rate(&q[first..first + S::N_Q], dof);
            terms.extend(factors.into_iter().enumerate().filter(|(_, factor)| *factor != 0.0));
            terms.iter_mut().for_each(|(place, _)| *place += first);
        });
    }

    /// Directions of q̇ in which no pose changes at the configuration q, of length one: places in
    /// q̇ with their entries.
    #[must_use]
    pub fn normals(&self, q: &[f64]) -> Vec<Vec<(usize, f64)>> {
        in_space!(self.space, S => {
            let bodies = q.chunks_exact(S::N_Q).enumerate();
            let of_body = |(body, q): (usize, &[f64])| {
                let entries = S::normal(q)?.into_iter().enumerate();
                let places = entries.filter(|(_, entry)| *entry != 0.0);
                Some(places.map(|(k, entry)| (S::N_Q * body + k, entry)).collect())
            };
            bodies.filter_map(of_body).collect()
        })
    }

    /// Where a body is at coordinates q, in the direction of a column of C: a place (m) or an angle
    /// (rad).
    #[must_use]
    pub fn position(&self, q: &[f64], column: usize) -> f64 {
        let (body, dof) = (column / N_BODY, column % N_BODY);
        in_space!(self.space, S => {
            let q = &q[S::N_Q * body..S::N_Q * (body + 1)];
            match dof {
                2 => S::angle(q),
                _ => q[dof],
            }
        })
    }

    /// Coordinates of a body.
    #[must_use]
    pub fn coordinates(&self, body: usize) -> Range<usize> {
        let n = self.space.n_q();
        n * body..n * (body + 1)
    }

    /// Name of the body and of one of the coordinates q.
    #[must_use]
    pub fn coordinate_name(&self, k: usize) -> (&str, &'static str) {
        in_space!(self.space, S => {
            (self.bodies[k / S::N_Q].name.as_str(), S::COORDINATES[k % S::N_Q])
        })
    }

    /// Poses of all bodies at coordinates q; allocates.
    #[must_use]
    pub fn poses(&self, q: &[f64]) -> Vec<Pose> {
        self.poses_of(q)
    }

    /// The same in any number type.
    pub(crate) fn poses_of<T: Number>(&self, q: &[T]) -> Vec<Pose<T>> {
        in_space!(self.space, S => q.chunks_exact(S::N_Q).map(S::pose).collect())
    }
}
