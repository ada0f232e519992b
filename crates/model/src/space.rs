//! Spaces define how the pose of a body is computed from its coordinates, and how a configuration
//! is displaced along velocities.
//!
//! Coordinates and velocities are different: a body has n_q coordinates and n_v velocities, and no
//! code outside this module adds a velocity to a coordinate. [`Space::displace`] moves a
//! configuration, and [`Space::difference`] compares two configurations. Both functions use the
//! directions of velocities: `(x, y)` along the axes of the ground, then the rotation.
//!
//! Constraints and their kernels use only poses and twists.
//!
//! Therefore C always has n_v columns, and no joint depends on Euler parameters. Verdicts use the C
//! of twists, not columns of quaternions.
//!
//! In space a body has the coordinates r and a quaternion of any length, and the velocities ṙ and
//! ω. The components of ω are along the principal axes of the body, so M is diagonal. The
//! gyroscopic torque is part of Q.

mod number;
mod plane;
mod space3;
mod traits;
mod vector;

pub use number::Number;
pub use plane::Plane;
#[cfg(feature = "unit-circle")]
pub use plane::UnitCircle;
pub use space3::Space3;
pub(crate) use space3::{normalised, quaternion, quaternion_product};
pub use traits::{PlanarSpace, Space};
pub use vector::{difference, norm, unit_cross};

pub use joints::space3::{cross, dot};

use std::ops::{Range, RangeInclusive};

use joints::Ring;

/// Axes in which the force of a reaction is expressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum Frame {
    /// The axes of the ground.
    Global,
    /// The axes of the first body of the joint. For the ground, these are the global axes.
    FirstBody,
    /// The axes u, v and w of a joint in space, fixed in the first body of the joint. The axis w is
    /// along the axis of the joint, or normal to its plane. Joints without an axis, and joints in
    /// the plane, do not have this frame.
    Joint,
    /// The only direction in which the joint can transmit a force, followed by this direction
    /// rotated by +90°. These directions are normal and tangent for a knife edge, and the
    /// directions across and along the axis for a slot. Joints without a row with a force, or with
    /// several such rows, do not have this frame.
    Edge,
}

impl Frame {
    /// All frames.
    pub const ALL: [Self; 4] = [Self::Global, Self::FirstBody, Self::Joint, Self::Edge];
}

/// The space of a mechanism.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum SpaceKind {
    /// The plane, [`Plane`].
    #[default]
    Plane,
    /// Three-dimensional space, [`Space3`].
    Space3,
    /// The plane with unit-circle coordinates, [`UnitCircle`].
    #[cfg(feature = "unit-circle")]
    UnitCircle,
}

/// Evaluates an expression in which `$space` is the type of a [`SpaceKind`].
macro_rules! in_space {
    ($kind:expr, $space:ident => $body:expr) => {
        match $kind {
            $crate::space::SpaceKind::Plane => {
                type $space = $crate::space::Plane;
                $body
            }
            $crate::space::SpaceKind::Space3 => {
                type $space = $crate::space::Space3;
                $body
            }
            #[cfg(feature = "unit-circle")]
            $crate::space::SpaceKind::UnitCircle => {
                type $space = $crate::space::UnitCircle;
                $body
            }
        }
    };
}
pub(crate) use in_space;

/// Evaluates an expression for the spaces whose bodies have planar poses. The second expression is
/// for space.
macro_rules! in_plane {
    ($kind:expr, $space:ident => $body:expr, $other:expr) => {
        match $kind {
            $crate::space::SpaceKind::Plane => {
                type $space = $crate::space::Plane;
                $body
            }
            #[cfg(feature = "unit-circle")]
            $crate::space::SpaceKind::UnitCircle => {
                type $space = $crate::space::UnitCircle;
                $body
            }
            $crate::space::SpaceKind::Space3 => $other,
        }
    };
}
pub(crate) use in_plane;

impl SpaceKind {
    /// Returns the number of coordinates of a body.
    #[must_use]
    pub fn n_q(self) -> usize {
        in_space!(self, S => S::N_Q)
    }

    /// Returns the number of velocities of a body, translations first. This number is also the
    /// number of columns of C of a body, and of components of a force and a torque on it.
    #[must_use]
    pub fn n_v(self) -> usize {
        in_space!(self, S => S::N_V)
    }

    /// Returns the number of translational velocities of a body, which is also the number of
    /// components of a force.
    #[must_use]
    pub fn n_translations(self) -> usize {
        in_space!(self, S => S::N_TRANSLATIONS)
    }

    /// Returns the number of rotational velocities of a body, which is also the number of
    /// components of a torque.
    #[must_use]
    pub fn n_rotations(self) -> usize {
        in_space!(self, S => S::N_V - S::N_TRANSLATIONS)
    }

    /// Returns the body that moves with a column of C.
    // The divisors are constants of each space, because this function is called entry by entry.
    #[must_use]
    pub fn body_of(self, column: usize) -> usize {
        in_space!(self, S => column / S::N_V)
    }

    /// Returns the index of the velocity component within the body, below [`Self::n_v`].
    #[must_use]
    pub fn dof_of(self, column: usize) -> usize {
        in_space!(self, S => column % S::N_V)
    }

    /// Returns whether a column of C belongs to a rotation.
    #[must_use]
    pub fn is_rotation(self, column: usize) -> bool {
        in_space!(self, S => column % S::N_V >= S::N_TRANSLATIONS)
    }

    /// Returns the columns of C of a body.
    #[must_use]
    pub fn columns_of(self, body: usize) -> Range<usize> {
        let n = self.n_v();
        n * body..n * (body + 1)
    }

    /// Returns the columns of C of the translations of a body.
    #[must_use]
    pub fn translations_of(self, body: usize) -> Range<usize> {
        let first = self.n_v() * body;
        first..first + self.n_translations()
    }

    /// Returns the columns of C of the rotations of a body.
    #[must_use]
    pub fn rotations_of(self, body: usize) -> Range<usize> {
        let first = self.n_v() * body;
        first + self.n_translations()..first + self.n_v()
    }

    /// Returns the unit of motions along a column of C. The unit is `size` for lengths and one
    /// radian for angles.
    #[must_use]
    pub fn unit(self, column: usize, size: f64) -> f64 {
        if self.is_rotation(column) { 1.0 } else { size }
    }

    /// Scales quaternions in the coordinates q to length one if their length is outside the allowed
    /// range. The rates of the quaternions are scaled as well. Returns the number of scaled
    /// quaternions. The motion does not change, because a rotation depends only on the direction of
    /// its quaternion.
    ///
    /// ```
    /// let (mut q, mut qd) = ([0.0; 7], [0.0; 7]);
    /// (q[3], qd[4]) = (4.0, 2.0);
    /// assert_eq!(pfaff_model::SpaceKind::Space3.normalise(&mut q, &mut qd, &(0.5..=2.0)), 1);
    /// assert_eq!((q[3], qd[4]), (1.0, 0.5));
    /// ```
    pub fn normalise(self, q: &mut [f64], qd: &mut [f64], allowed: &RangeInclusive<f64>) -> u64 {
        if self != Self::Space3 {
            return 0;
        }
        let mut count = 0;
        let bodies = q.chunks_exact_mut(Space3::N_Q);
        for (q, qd) in bodies.zip(qd.chunks_exact_mut(Space3::N_Q)) {
            let [own, rate] = [&mut q[3..], &mut qd[3..]];
            let length = own.iter().map(|e| e * e).sum::<f64>().sqrt();
            if !allowed.contains(&length) && length > 0.0 && length.is_finite() {
                own.iter_mut().chain(rate).for_each(|x| *x /= length);
                count += 1;
            }
        }
        count
    }

    /// Returns the error of the angle (rad) for this residual of a row of angles. Rows in space are
    /// products of directions, which equal sines of the remaining angle.
    #[must_use]
    pub(crate) fn angle_of_row(self, residual: f64) -> f64 {
        match self {
            Self::Space3 => residual.clamp(-1.0, 1.0).asin(),
            _ => residual,
        }
    }

    /// Returns the names of the output numbers of a frame: first its position and orientation, then
    /// its velocities.
    ///
    /// ```
    /// let plane = pfaff_model::SpaceKind::Plane;
    /// assert_eq!(plane.columns(), ["x", "y", "angle", "vx", "vy", "omega"]);
    /// assert_eq!(plane.velocities(), ["vx", "vy", "omega"]);
    /// assert_eq!(plane.directions(), ["x", "y", "angle"]);
    /// assert_eq!(&plane.components()[plane.torques()], ["T"]);
    /// ```
    #[must_use]
    pub fn columns(self) -> &'static [&'static str] {
        in_space!(self, S => S::COLUMNS)
    }

    /// Returns the names of the velocities of a body.
    #[must_use]
    pub fn velocities(self) -> &'static [&'static str] {
        in_space!(self, S => &S::COLUMNS[S::COLUMNS.len() - S::N_V..])
    }

    /// Returns the names of the output numbers of the accelerations of a frame, in the order of
    /// [`Self::velocities`].
    ///
    /// ```
    /// let plane = pfaff_model::SpaceKind::Plane;
    /// assert_eq!(plane.accelerations(), ["ax", "ay", "alpha"]);
    /// ```
    #[must_use]
    pub fn accelerations(self) -> &'static [&'static str] {
        in_space!(self, S => S::ACCELERATIONS)
    }

    /// Returns the SI unit of an output number of a frame. The result is empty for components of a
    /// quaternion and for other names.
    #[must_use]
    pub fn column_unit(self, name: &str) -> &'static str {
        match name {
            "x" | "y" | "z" => "m",
            "angle" | "roll" | "pitch" | "yaw" => "rad",
            "vx" | "vy" | "vz" => "m/s",
            "omega" | "wx" | "wy" | "wz" => "rad/s",
            "ax" | "ay" | "az" => "m/s²",
            "alpha" | "alphax" | "alphay" | "alphaz" => "rad/s²",
            _ => "",
        }
    }

    /// Returns the names of the directions in which a body moves with its velocities.
    #[must_use]
    pub fn directions(self) -> &'static [&'static str] {
        in_space!(self, S => S::DIRECTIONS)
    }

    /// Returns the names of the components of a force and a torque.
    #[must_use]
    pub fn components(self) -> &'static [&'static str] {
        in_space!(self, S => S::COMPONENTS)
    }

    /// Returns the names of the components of a force and a torque in the axes of a frame.
    #[must_use]
    pub fn components_in(self, frame: Frame) -> &'static [&'static str] {
        in_space!(self, S => match frame {
            Frame::Global => S::COMPONENTS,
            Frame::FirstBody => S::BODY_COMPONENTS,
            Frame::Joint => S::JOINT_COMPONENTS,
            Frame::Edge => S::EDGE_COMPONENTS,
        })
    }

    /// Returns the component of this name in the axes of the ground.
    #[must_use]
    pub fn component(self, name: &str) -> Option<usize> {
        self.components()
            .iter()
            .position(|component| *component == name)
    }

    /// Returns the SI unit of the component of this name in the axes of the ground.
    #[must_use]
    pub fn load_unit(self, name: &str) -> Option<&'static str> {
        let is_torque = self.torques().contains(&self.component(name)?);
        Some(if is_torque { "N·m" } else { "N" })
    }

    /// Returns the axis of the ground, 0 for x to 2 for z, along or about which a component of a
    /// force or a torque acts.
    #[must_use]
    pub fn axis_of(self, component: usize) -> usize {
        if component < self.n_translations() {
            component
        } else {
            3 + component - self.n_v()
        }
    }

    /// Returns the velocities of a body in one of the [`Self::n_v`] rigid motions. The rigid
    /// motions are translations along the axes of the ground at 1 m/s, and rotations about the axes
    /// of the ground at 1 rad/s. `arm` is the arm of the body from the axis. `axes` are the axes of
    /// the body in ground components. Angular velocities in space are given in these axes.
    ///
    /// ```
    /// let plane = pfaff_model::SpaceKind::Plane;
    /// assert_eq!(plane.rigid_motion(1, [2.0, 3.0, 0.0], [[0.0; 3]; 3]), [0.0, 1.0, 0.0]);
    /// assert_eq!(plane.rigid_motion(2, [2.0, 3.0, 0.0], [[0.0; 3]; 3]), [-3.0, 2.0, 1.0]);
    /// ```
    #[must_use]
    pub fn rigid_motion(self, motion: usize, arm: [f64; 3], axes: [[f64; 3]; 3]) -> Vec<f64> {
        let mut v = vec![0.0; self.n_v()];
        let axis = self.axis_of(motion);
        if self.torques().contains(&motion) {
            let moved = unit_cross(axis, arm);
            v[self.forces()].copy_from_slice(&moved[self.forces()]);
            if self.n_rotations() > 1 {
                for k in self.torques() {
                    v[k] = axes[self.axis_of(k)][axis];
                }
                return v;
            }
        }
        v[motion] = 1.0;
        v
    }

    /// Returns the range of the components of a force in [`Self::components`].
    #[must_use]
    pub fn forces(self) -> Range<usize> {
        0..self.n_translations()
    }

    /// Returns the range of the components of a torque in [`Self::components`].
    #[must_use]
    pub fn torques(self) -> Range<usize> {
        self.n_translations()..self.n_v()
    }

    /// Returns the indices of the coordinates of a body in q.
    #[must_use]
    pub fn coordinates(self, body: usize) -> Range<usize> {
        let n = self.n_q();
        n * body..n * (body + 1)
    }

    /// Computes q̇ = T(q)·v of all bodies.
    pub(crate) fn rate<T: Ring>(self, q: &[T], v: &[T], qd: &mut [T]) {
        in_space!(self, S => {
            let bodies = q.chunks_exact(S::N_Q).zip(v.chunks_exact(S::N_V));
            for ((q, v), qd) in bodies.zip(qd.chunks_exact_mut(S::N_Q)) {
                S::rate(q, v, qd);
            }
        });
    }

    /// Moves the configuration q by d (n_v).
    pub(crate) fn displace<T: Number>(self, q: &mut [T], d: &[T]) {
        in_space!(self, S => {
            for (q, d) in q.chunks_exact_mut(S::N_Q).zip(d.chunks_exact(S::N_V)) {
                S::displace(q, d);
            }
        });
    }

    /// Returns a copy of q, moved by `factor` times d. The function allocates memory.
    #[must_use]
    pub fn displaced(self, q: &[f64], factor: f64, d: &[f64]) -> Vec<f64> {
        let mut moved = q.to_vec();
        let d: Vec<f64> = d.iter().map(|d| factor * d).collect();
        self.displace(&mut moved, &d);
        moved
    }

    /// Computes the displacement (n_v) that moves the configuration `from` to q.
    pub(crate) fn difference(self, q: &[f64], from: &[f64], d: &mut [f64]) {
        in_space!(self, S => {
            let bodies = q.chunks_exact(S::N_Q).zip(from.chunks_exact(S::N_Q));
            for ((q, from), d) in bodies.zip(d.chunks_exact_mut(S::N_V)) {
                S::difference(q, from, d);
            }
        });
    }

    /// Returns the column of C along which two configurations differ most, and the difference.
    /// Lengths are given as a fraction of `size`, and angles in radians.
    #[must_use]
    pub(crate) fn largest_difference(self, a: &[f64], b: &[f64], size: f64) -> (usize, f64) {
        let mut largest = (0, 0.0);
        let mut d = vec![0.0; self.n_v()];
        let n = self.n_q();
        for (body, (a, b)) in a.chunks_exact(n).zip(b.chunks_exact(n)).enumerate() {
            self.difference(a, b, &mut d);
            for (dof, d) in d.iter().enumerate() {
                let j = self.n_v() * body + dof;
                let difference = d.abs() / self.unit(j, size);
                if difference > largest.1 {
                    largest = (j, difference);
                }
            }
        }
        largest
    }

    /// Copies the coordinates that belong to these columns of C from another configuration, without
    /// rounding.
    pub(crate) fn take(self, q: &mut [f64], from: &[f64], columns: &[usize]) {
        in_space!(self, S => {
            for column in columns {
                let body = self.coordinates(column / S::N_V);
                S::take(&mut q[body.clone()], &from[body], column % S::N_V);
            }
        });
    }

    /// Writes the velocity of a column of C at the configuration q to `terms`, as a sum over q̇.
    /// The terms are indices of q̇ with their coefficients.
    pub fn read_velocity(self, q: &[f64], column: usize, terms: &mut Vec<(usize, f64)>) {
        let body = self.coordinates(self.body_of(column));
        let first = body.start;
        terms.clear();
        in_space!(self, S => {
            let factors = S::velocity_from_rate(&q[body], column % S::N_V);
            terms.extend(factors.into_iter().enumerate().filter(|(_, factor)| *factor != 0.0));
            terms.iter_mut().for_each(|(place, _)| *place += first);
        });
    }

    /// Returns unit directions of q̇ along which no pose changes at the configuration q. Each
    /// direction is a list of indices of q̇ with their entries.
    #[must_use]
    pub fn normals(self, q: &[f64]) -> Vec<Vec<(usize, f64)>> {
        in_space!(self, S => {
            let bodies = q.chunks_exact(S::N_Q).enumerate();
            let of_body = |(body, q): (usize, &[f64])| {
                let entries = S::normal(q)?.into_iter().enumerate();
                let places = entries.filter(|(_, entry)| *entry != 0.0);
                Some(places.map(|(k, entry)| (S::N_Q * body + k, entry)).collect())
            };
            bodies.filter_map(of_body).collect()
        })
    }

    /// Returns numbers that are equal if and only if the poses are equal. The numbers are the
    /// coordinates in the plane, and the position and the axes of each body in space. (A quaternion
    /// and its negative represent the same pose.)
    #[must_use]
    pub fn pose_numbers(self, q: &[f64]) -> Vec<f64> {
        if self != Self::Space3 {
            return q.to_vec();
        }
        let of = |own: &[f64]| {
            let place = [own[0], own[1], own[2]];
            let pose = joints::space3::Pose::new(place, quaternion(own));
            [place.to_vec(), pose.rot.concat()].concat()
        };
        q.chunks_exact(self.n_q()).flat_map(of).collect()
    }

    /// Returns the position of a body at coordinates q in the direction of a column of C. The
    /// position is a coordinate (m) or an angle (rad).
    #[must_use]
    pub fn position(self, q: &[f64], column: usize) -> f64 {
        let own = &q[self.coordinates(self.body_of(column))];
        in_space!(self, S => S::position(own, column % S::N_V))
    }
}
