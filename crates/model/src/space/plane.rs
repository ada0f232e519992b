//! The plane with angles as coordinates, and the plane with points of the unit circle in place of
//! angles.

use joints::Ring;

use super::number::Number;
use super::traits::{MOST_COORDINATES, PlanarSpace, Space};

/// Names of the output values of a planar frame.
const PLANE_COLUMNS: &[&str] = &["x", "y", "angle", "vx", "vy", "omega"];
const PLANE_ACCELERATIONS: &[&str] = &["ax", "ay", "alpha"];
const PLANE_DIRECTIONS: &[&str] = &["x", "y", "angle"];
const PLANE_COMPONENTS: &[&str] = &["Fx", "Fy", "T"];
const PLANE_BODY_COMPONENTS: &[&str] = &["Fx'", "Fy'", "T"];
const PLANE_EDGE_COMPONENTS: &[&str] = &["Fn", "Ft", "T"];

/// The plane: q = (x, y, φ), q̇ = v.
#[derive(Clone, Copy, Debug)]
pub struct Plane;

impl Space for Plane {
    const N_Q: usize = 3;
    const N_V: usize = 3;
    const N_TRANSLATIONS: usize = 2;
    const COORDINATES: &'static [&'static str] = &["x", "y", "angle"];
    const COLUMNS: &'static [&'static str] = PLANE_COLUMNS;
    const ACCELERATIONS: &'static [&'static str] = PLANE_ACCELERATIONS;
    const DIRECTIONS: &'static [&'static str] = PLANE_DIRECTIONS;
    const COMPONENTS: &'static [&'static str] = PLANE_COMPONENTS;
    const BODY_COMPONENTS: &'static [&'static str] = PLANE_BODY_COMPONENTS;
    const JOINT_COMPONENTS: &'static [&'static str] = PLANE_COMPONENTS;
    const EDGE_COMPONENTS: &'static [&'static str] = PLANE_EDGE_COMPONENTS;

    fn position(q: &[f64], dof: usize) -> f64 {
        q[dof]
    }

    fn rate<T: Ring>(_q: &[T], v: &[T], qd: &mut [T]) {
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

impl PlanarSpace for Plane {
    fn angle<T: Number>(q: &[T]) -> T {
        q[2]
    }

    fn sin_cos<T: Number>(q: &[T]) -> (T, T) {
        q[2].sin_cos()
    }
}

/// The plane with a point of the unit circle in place of the angle: q = (x, y, cos φ, sin φ), so
/// that n_q = 4. This space is only for tests. The coordinates and velocities of this space have
/// different dimensions, like quaternions and angular velocities.
///
/// Only the direction of (c, s) is used. Therefore the point may leave the circle at a stage of an
/// integrator; a displacement returns it to the circle. Angles are determined only up to full
/// revolutions. Therefore rows that contain angles are valid only within half a revolution.
#[cfg(feature = "unit-circle")]
#[derive(Clone, Copy, Debug)]
pub struct UnitCircle;

#[cfg(feature = "unit-circle")]
impl Space for UnitCircle {
    const N_Q: usize = 4;
    const N_V: usize = 3;
    const N_TRANSLATIONS: usize = 2;
    const COORDINATES: &'static [&'static str] = &["x", "y", "cosine", "sine"];
    const COLUMNS: &'static [&'static str] = PLANE_COLUMNS;
    const ACCELERATIONS: &'static [&'static str] = PLANE_ACCELERATIONS;
    const DIRECTIONS: &'static [&'static str] = PLANE_DIRECTIONS;
    const COMPONENTS: &'static [&'static str] = PLANE_COMPONENTS;
    const BODY_COMPONENTS: &'static [&'static str] = PLANE_BODY_COMPONENTS;
    const JOINT_COMPONENTS: &'static [&'static str] = PLANE_COMPONENTS;
    const EDGE_COMPONENTS: &'static [&'static str] = PLANE_EDGE_COMPONENTS;

    fn position(q: &[f64], dof: usize) -> f64 {
        match dof {
            2 => Self::angle(q),
            _ => q[dof],
        }
    }

    fn rate<T: Ring>(q: &[T], v: &[T], qd: &mut [T]) {
        qd.copy_from_slice(&[v[0], v[1], -q[3] * v[2], q[2] * v[2]]);
    }

    fn velocity_from_rate(q: &[f64], dof: usize) -> [f64; MOST_COORDINATES] {
        let [c, s] = [q[2], q[3]];
        let square = c * c + s * s;
        match dof {
            2 => [0.0, 0.0, -s / square, c / square, 0.0, 0.0, 0.0],
            _ => std::array::from_fn(|k| if k == dof { 1.0 } else { 0.0 }),
        }
    }

    fn normal(q: &[f64]) -> Option<[f64; MOST_COORDINATES]> {
        let (c, s) = f64::normalised(q[2], q[3]);
        Some([0.0, 0.0, c, s, 0.0, 0.0, 0.0])
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

#[cfg(feature = "unit-circle")]
impl PlanarSpace for UnitCircle {
    fn angle<T: Number>(q: &[T]) -> T {
        T::atan2(q[3], q[2])
    }

    fn sin_cos<T: Number>(q: &[T]) -> (T, T) {
        let (cos, sin) = T::normalised(q[2], q[3]);
        (sin, cos)
    }
}
