//! The two spaces in which bodies move, as types: what a pose, a twist and a vector are.
//!
//! Kernels, their traits and their tests are generic over the space; a definition belongs to one.

use std::fmt::Debug;

use crate::ring::Ring;
use crate::{plane, space3};

/// A space in which bodies move.
pub trait Space: Copy + Debug + Send + Sync + 'static {
    /// Number of components of a vector.
    const DIM: usize;
    /// Number of velocities of a body.
    const N_DOF: usize;
    /// Components of a vector.
    type Vector<T: Ring>: Copy + AsRef<[T]>;
    /// Position and orientation of a body.
    type Pose<T: Ring>: Copy;
    /// Velocity of a body.
    type Twist<T: Ring>: Copy;
}

/// The plane: bodies have three velocities.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plane;

/// Space: bodies have six velocities.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Space3;

impl Space for Plane {
    const DIM: usize = 2;
    const N_DOF: usize = plane::N_DOF;
    type Vector<T: Ring> = [T; 2];
    type Pose<T: Ring> = plane::Pose<T>;
    type Twist<T: Ring> = plane::Twist<T>;
}

impl Space for Space3 {
    const DIM: usize = 3;
    const N_DOF: usize = space3::N_DOF;
    type Vector<T: Ring> = [T; 3];
    type Pose<T: Ring> = space3::Pose<T>;
    type Twist<T: Ring> = space3::Twist<T>;
}
