//! The two spaces in which bodies move, as types that define the types of poses, twists and
//! vectors.
//!
//! The traits and the tests of kernels are generic over the space. Each definition belongs to one
//! space.

use std::fmt::Debug;

use crate::ring::Ring;
use crate::{plane, space3};

/// A space in which bodies move.
pub trait Space: Copy + Debug + Send + Sync + 'static {
    /// Number of components of a vector.
    const DIM: usize;
    /// Number of velocity components of a body.
    const N_DOF: usize;
    /// Components of a vector.
    type Vector<T: Ring>: Copy + AsRef<[T]>;
    /// Position and orientation of a body.
    type Pose<T: Ring>: Copy;
    /// Velocity of a body.
    type Twist<T: Ring>: Copy;
    /// Number of values in a pose.
    const N_POSE: usize;

    /// Returns the pose with these values.
    fn pose<T: Ring>(numbers: &[T]) -> Self::Pose<T>;

    /// Appends the values of a pose to `out`.
    fn numbers_of_pose<T: Ring>(pose: &Self::Pose<T>, out: &mut Vec<T>);

    /// Writes the rates of the values of a pose for the case that one velocity component of the
    /// body is 1 m/s or 1 rad/s and all other components are zero.
    fn rates_of_pose(pose: &Self::Pose<f64>, dof: usize, out: &mut [f64]);

    /// Returns the twist with these velocity components.
    fn twist<T: Ring>(velocities: &[T]) -> Self::Twist<T>;

    /// Returns the velocity components of a twist.
    fn velocities<T: Ring>(twist: &Self::Twist<T>) -> impl Iterator<Item = T>;
}

/// The plane: bodies have three velocity components.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plane;

/// Space: bodies have six velocity components.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Space3;

impl Space for Plane {
    const DIM: usize = 2;
    const N_DOF: usize = plane::N_DOF;
    type Vector<T: Ring> = [T; 2];
    type Pose<T: Ring> = plane::Pose<T>;
    type Twist<T: Ring> = plane::Twist<T>;
    const N_POSE: usize = 5;

    fn pose<T: Ring>(numbers: &[T]) -> plane::Pose<T> {
        plane::Pose {
            x: numbers[0],
            y: numbers[1],
            angle: numbers[2],
            cos: numbers[3],
            sin: numbers[4],
        }
    }

    fn numbers_of_pose<T: Ring>(pose: &plane::Pose<T>, out: &mut Vec<T>) {
        out.extend([pose.x, pose.y, pose.angle, pose.cos, pose.sin]);
    }

    fn rates_of_pose(pose: &plane::Pose, dof: usize, out: &mut [f64]) {
        out.fill(0.0);
        out[dof] = 1.0;
        if dof == 2 {
            (out[3], out[4]) = (-pose.sin, pose.cos);
        }
    }

    fn twist<T: Ring>(velocities: &[T]) -> plane::Twist<T> {
        plane::Twist {
            x: velocities[0],
            y: velocities[1],
            omega: velocities[2],
        }
    }

    fn velocities<T: Ring>(twist: &plane::Twist<T>) -> impl Iterator<Item = T> {
        [twist.x, twist.y, twist.omega].into_iter()
    }
}

impl Space for Space3 {
    const DIM: usize = 3;
    const N_DOF: usize = space3::N_DOF;
    type Vector<T: Ring> = [T; 3];
    type Pose<T: Ring> = space3::Pose<T>;
    type Twist<T: Ring> = space3::Twist<T>;
    const N_POSE: usize = 12;

    fn pose<T: Ring>(numbers: &[T]) -> space3::Pose<T> {
        space3::Pose {
            r: [numbers[0], numbers[1], numbers[2]],
            rot: [3, 6, 9].map(|k| [numbers[k], numbers[k + 1], numbers[k + 2]]),
        }
    }

    fn numbers_of_pose<T: Ring>(pose: &space3::Pose<T>, out: &mut Vec<T>) {
        out.extend(pose.r);
        out.extend(pose.rot.iter().flatten());
    }

    /// The rates of the rotation matrix are `Ṙ = R·[ω]×`.
    fn rates_of_pose(pose: &space3::Pose, dof: usize, out: &mut [f64]) {
        out.fill(0.0);
        let Some(axis) = dof.checked_sub(3) else {
            out[dof] = 1.0;
            return;
        };
        // For a rotation about e_a, the rates of the other two axes b and c are c and −b.
        let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
        for (row, out) in pose.rot.iter().zip(out[3..].chunks_exact_mut(3)) {
            (out[b], out[c]) = (row[c], -row[b]);
        }
    }

    fn twist<T: Ring>(velocities: &[T]) -> space3::Twist<T> {
        space3::Twist {
            v: [velocities[0], velocities[1], velocities[2]],
            omega: [velocities[3], velocities[4], velocities[5]],
        }
    }

    fn velocities<T: Ring>(twist: &space3::Twist<T>) -> impl Iterator<Item = T> {
        twist.v.into_iter().chain(twist.omega)
    }
}
