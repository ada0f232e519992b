//! Spaces: how the coordinates of a body make its pose, and how a configuration moves along
//! velocities.
//!
//! Coordinates and velocities are two things: a body has n_q of the ones and n_v of the others, and
//! nothing outside this module adds a velocity to a coordinate. A configuration is moved by
//! [`Space::displace`] and compared by [`Space::difference`], both in the directions of velocities:
//! `(x, y)` along the axes of the ground, then the rotation.
//!
//! Not here: constraints and their kernels, which see poses and twists only.

use joints::{Pose, Ring};
use linalg::Dd;

use crate::description::Body;

/// Velocities of a planar body: (ẋ, ẏ, ω).
pub(crate) const N_BODY: usize = 3;

/// Coordinates of a body at most.
const MOST_COORDINATES: usize = 4;

/// A number that angles can be made of.
pub trait Number: Ring {
    /// Sine and cosine.
    #[must_use]
    fn sin_cos(self) -> (Self, Self);

    /// The angle of the direction (x, y), from −π to π.
    #[must_use]
    fn atan2(y: Self, x: Self) -> Self;

    /// (x, y) at length one; it must not be zero.
    #[must_use]
    fn normalised(x: Self, y: Self) -> (Self, Self);
}

impl Number for f64 {
    fn sin_cos(self) -> (Self, Self) {
        f64::sin_cos(self)
    }

    fn atan2(y: Self, x: Self) -> Self {
        y.atan2(x)
    }

    fn normalised(x: Self, y: Self) -> (Self, Self) {
        let length = x.hypot(y);
        (x / length, y / length)
    }
}

impl Number for Dd {
    fn sin_cos(self) -> (Self, Self) {
        Dd::sin_cos(self)
    }

    /// The angle in `f64`, turned on by what is left: its square is below the last digit.
    fn atan2(y: Self, x: Self) -> Self {
        let (x, y) = Self::normalised(x, y);
        let near = Self::from(y.to_f64().atan2(x.to_f64()));
        let (sin, cos) = near.sin_cos();
        near + (y * cos - x * sin)
    }

    fn normalised(x: Self, y: Self) -> (Self, Self) {
        let length = (x * x + y * y).sqrt();
        (x / length, y / length)
    }
}

/// A space that bodies move in. All slices are those of one body: `q` has [`Space::N_Q`] values,
/// `v` and `d` have three.
pub trait Space {
    /// Coordinates of a body; its place comes first.
    const N_Q: usize;

    /// What they are called.
    const COORDINATES: &'static [&'static str];

    /// Coordinates of a body as described.
    fn described(body: &Body, q: &mut [f64]);

    /// The angle of a body (rad).
    #[must_use]
    fn angle<T: Number>(q: &[T]) -> T;

    /// Sine and cosine of this angle.
    #[must_use]
    fn sin_cos<T: Number>(q: &[T]) -> (T, T);

    /// The pose of a body.
    #[must_use]
    fn pose<T: Number>(q: &[T]) -> Pose<T> {
        let (sin, cos) = Self::sin_cos(q);
        Pose {
            x: q[0],
            y: q[1],
            angle: Self::angle(q),
            cos,
            sin,
        }
    }

    /// q̇ = T(q)·v.
    fn rate(q: &[f64], v: &[f64], qd: &mut [f64]);

    /// The velocity of one freedom, 0 … 2, as factors of q̇ = T(q)·v; what of q̇ leaves the poses
    /// does not count. Factors beyond the coordinates are zero.
    #[must_use]
    fn velocity_from_rate(q: &[f64], dof: usize) -> [f64; MOST_COORDINATES];

    /// The direction of q̇ in which no pose changes, of length one; none where every q̇ is that of
    /// a velocity.
    #[must_use]
    fn normal(_q: &[f64]) -> Option<[f64; MOST_COORDINATES]> {
        None
    }

    /// Moves q by d: a translation along the axes of the ground (m), and a rotation (rad).
    fn displace<T: Number>(q: &mut [T], d: &[T]);

    /// The d by which [`Space::displace`] moves `from` to `q`.
    fn difference(q: &[f64], from: &[f64], d: &mut [f64]);

    /// Takes one freedom of velocity, 0 … 2, over from another configuration: exactly, where a
    /// difference would round.
    fn take(q: &mut [f64], from: &[f64], dof: usize);
}

/// The plane: q = (x, y, φ), q̇ = v.
#[derive(Clone, Copy, Debug)]
pub struct Plane;

impl Space for Plane {
    const N_Q: usize = 3;
    const COORDINATES: &'static [&'static str] = &["x", "y", "angle"];

    fn described(body: &Body, q: &mut [f64]) {
        q.copy_from_slice(&[body.position[0], body.position[1], body.angle]);
    }

    fn angle<T: Number>(q: &[T]) -> T {
        q[2]
    }

    fn sin_cos<T: Number>(q: &[T]) -> (T, T) {
        q[2].sin_cos()
    }

    fn rate(_q: &[f64], v: &[f64], qd: &mut [f64]) {
        qd.copy_from_slice(v);
    }

    fn velocity_from_rate(_q: &[f64], dof: usize) -> [f64; MOST_COORDINATES] {
        std::array::from_fn(|k| if k == dof { 1.0 } else { 0.0 })
    }

    fn displace<T: Number>(q: &mut [T], d: &[T]) {
        for (q, d) in q.iter_mut().zip(d) {
            *q = *q + *d;
        }
    }

    fn difference(q: &[f64], from: &[f64], d: &mut [f64]) {
        for (d, (q, from)) in d.iter_mut().zip(q.iter().zip(from)) {
            *d = q - from;
        }
    }

    fn take(q: &mut [f64], from: &[f64], dof: usize) {
        q[dof] = from[dof];
    }
}

/// The plane with a point of the unit circle in the place of the angle: q = (x, y, cos φ, sin φ),
/// n_q = 4. For tests alone: a space in which coordinates and velocities differ, as quaternions and
/// angular velocities do.
///
/// Of (c, s) only the direction counts, so that a stage of an integrator off the circle does no
/// harm; a displacement leaves it on the circle. Angles are known up to full turns, so that rows
/// which measure them hold within half a turn only.
#[cfg(feature = "unit-circle")]
#[derive(Clone, Copy, Debug)]
pub struct UnitCircle;

#[cfg(feature = "unit-circle")]
impl Space for UnitCircle {
    const N_Q: usize = 4;
    const COORDINATES: &'static [&'static str] = &["x", "y", "cosine", "sine"];

    fn described(body: &Body, q: &mut [f64]) {
        let (sin, cos) = body.angle.sin_cos();
        q.copy_from_slice(&[body.position[0], body.position[1], cos, sin]);
    }

    fn angle<T: Number>(q: &[T]) -> T {
        T::atan2(q[3], q[2])
    }

    fn sin_cos<T: Number>(q: &[T]) -> (T, T) {
        let (cos, sin) = T::normalised(q[2], q[3]);
        (sin, cos)
    }

    fn rate(q: &[f64], v: &[f64], qd: &mut [f64]) {
        qd.copy_from_slice(&[v[0], v[1], -q[3] * v[2], q[2] * v[2]]);
    }

    fn velocity_from_rate(q: &[f64], dof: usize) -> [f64; MOST_COORDINATES] {
        let [c, s] = [q[2], q[3]];
        let square = c * c + s * s;
        match dof {
            2 => [0.0, 0.0, -s / square, c / square],
            _ => std::array::from_fn(|k| if k == dof { 1.0 } else { 0.0 }),
        }
    }

    fn normal(q: &[f64]) -> Option<[f64; MOST_COORDINATES]> {
        let (c, s) = f64::normalised(q[2], q[3]);
        Some([0.0, 0.0, c, s])
    }

    fn displace<T: Number>(q: &mut [T], d: &[T]) {
        q[0] = q[0] + d[0];
        q[1] = q[1] + d[1];
        let (sin, cos) = d[2].sin_cos();
        let turned = (q[2] * cos - q[3] * sin, q[3] * cos + q[2] * sin);
        (q[2], q[3]) = T::normalised(turned.0, turned.1);
    }

    fn difference(q: &[f64], from: &[f64], d: &mut [f64]) {
        let along = q[2] * from[2] + q[3] * from[3];
        let across = q[3] * from[2] - q[2] * from[3];
        d.copy_from_slice(&[q[0] - from[0], q[1] - from[1], across.atan2(along)]);
    }

    fn take(q: &mut [f64], from: &[f64], dof: usize) {
        match dof {
            2 => q[2..4].copy_from_slice(&from[2..4]),
            _ => q[dof] = from[dof],
        }
    }
}

/// The space of a mechanism.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SpaceKind {
    /// [`Plane`]
    #[default]
    Plane,
    /// [`UnitCircle`]
    #[cfg(feature = "unit-circle")]
    UnitCircle,
}

/// Evaluates an expression with `$space` standing for the type of a [`SpaceKind`].
macro_rules! in_space {
    ($kind:expr, $space:ident => $body:expr) => {
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
        }
    };
}
pub(crate) use in_space;

impl SpaceKind {
    /// Coordinates of a body.
    pub(crate) fn n_q(self) -> usize {
        in_space!(self, S => S::N_Q)
    }
}
