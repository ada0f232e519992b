//! The rows of a constraint and its reaction: the kernels that are compiled in several number
//! types. Slices are those of [`crate::constraint`].

use crate::definition::Definition;
use crate::ring::{Real, Scalar};
use crate::space::{Plane, Space};
use crate::spec::ConstraintSpec;

/// The rows of a constraint in closed form, for one number type.
pub trait Element<T: Scalar = f64, S: Space = Plane>: Definition<S> {
    /// The specification of the definition.
    fn spec(&self) -> &'static ConstraintSpec;

    /// Writes `Φ`, one value for each holonomic row.
    fn phi(&self, x: &[S::Pose<T>], f: &[[T; 3]], out: &mut [T]);

    /// Writes the entries of the block of C that depend on parameters only; the others are not
    /// changed.
    fn c_constant(&self, _out: &mut [T]) {}

    /// Writes the other entries of the block of C: `C = ∂Φ̇/∂v` or `Ψ`.
    fn c(&self, x: &[S::Pose<T>], f: &[[T; 3]], out: &mut [T]);

    /// Writes `b = −Φt` or `−ψ`, one value for each row; nothing for scleronomic constraints, whose
    /// b is zero.
    fn b(&self, _x: &[S::Pose<T>], _f: &[[T; 3]], _out: &mut [T]) {}

    /// Writes `Γ` of `C·a = Γ`, one value for each row.
    fn gamma(&self, x: &[S::Pose<T>], v: &[S::Twist<T>], f: &[[T; 3]], out: &mut [T]);

    /// Writes the coefficients of the named component of the reaction, `Σ out·λ`; nothing if there
    /// is none.
    fn component(&self, _x: &[S::Pose<T>], _f: &[[T; 3]], _out: &mut [T]) {}
}

/// The reaction of a constraint in closed form, for one number type.
pub trait Reaction<T: Real = f64, S: Space = Plane> {
    /// Entries of the map `W` (components × rows) of the wrench on the first body, `W·λ` =
    /// `[Fx, Fy, T]` or `[Fx, Fy, Fz, Tx, Ty, Tz]`, with the moment about the place.
    fn wrench(&self, x: &[S::Pose<T>], f: &[[T; 3]], out: &mut [T]);

    /// The point at which the reaction is reported, global components.
    fn place(&self, x: &[S::Pose<T>]) -> S::Vector<T>;
}
