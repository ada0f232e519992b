//! The linearised motion.

use linalg::Matrix;

use super::coordinate::Coordinate;
use super::inputs::Input;

/// The linearised motion about a state.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Linearisation {
    /// Time (s).
    pub time: f64,
    /// Coordinates of the state, n_q.
    pub q: Vec<f64>,
    /// The positions in the state vector x. The positions are the first components of x.
    pub positions: Vec<Coordinate>,
    /// The velocities in the state vector x. The velocities follow the positions.
    pub velocities: Vec<Coordinate>,
    /// The inputs u.
    pub inputs: Vec<Input>,
    /// Drives and joints whose functions of time would accelerate them. These drives and joints are
    /// locked because the state is at rest.
    pub held: Vec<String>,
    /// The square matrix A.
    pub a: Matrix,
    /// The matrix B, with one column for each input.
    pub b: Matrix,
    /// Mass, damping and stiffness of `M·ÿ + D·ẏ + K·y = …` for the positions y. The matrices exist
    /// only for a state at rest without nonholonomic rows and without cyclic coordinates.
    pub second_order: Option<SecondOrder>,
    /// Displacements of all bodies for a unit change of each position. Each row has n_v values.
    pub shapes: Matrix,
    /// Difference between the results of two orders of approximation, as a share of the largest
    /// entries of A.
    pub accuracy: f64,
}

/// Matrices of `M·ÿ + D·ẏ + K·y`.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SecondOrder {
    /// Masses and moments of inertia.
    pub mass: Matrix,
    /// Damping.
    pub damping: Matrix,
    /// Stiffness due to springs, the weight and the joint reactions.
    pub stiffness: Matrix,
}
