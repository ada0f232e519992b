//! The rows and the reaction of a constraint. These kernels are compiled in several number types.
//! [`crate::constraint`] describes the slices.

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

    /// Writes the entries of the block of C that depend only on parameters. The other entries do
    /// not change.
    fn c_constant(&self, _out: &mut [T]) {}

    /// Writes the other entries of the block of C: `C = ∂Φ̇/∂v` or `Ψ`.
    fn c(&self, x: &[S::Pose<T>], f: &[[T; 3]], out: &mut [T]);

    /// Writes `b = −Φt` or `−ψ`, one value for each row. Scleronomic constraints write nothing,
    /// because for these constraints b is zero.
    fn b(&self, _x: &[S::Pose<T>], _f: &[[T; 3]], _out: &mut [T]) {}

    /// Writes `Γ` in `C·a = Γ`, one value for each row.
    fn gamma(&self, x: &[S::Pose<T>], v: &[S::Twist<T>], f: &[[T; 3]], out: &mut [T]);

    /// Writes the coefficients of the named component of the reaction, `Σ out·λ`. Writes nothing if
    /// the definition names no component.
    fn component(&self, _x: &[S::Pose<T>], _f: &[[T; 3]], _out: &mut [T]) {}
}

/// The reaction of a constraint in closed form, for one number type.
pub trait Reaction<T: Real = f64, S: Space = Plane> {
    /// Writes the entries of the map `W` (components × rows) from multipliers to the wrench on the
    /// first body, `W·λ` = `[Fx, Fy, T]` or `[Fx, Fy, Fz, Tx, Ty, Tz]`. The torque is about the
    /// reference point.
    fn wrench(&self, x: &[S::Pose<T>], f: &[[T; 3]], out: &mut [T]);

    /// Returns the reference point of the reaction, in ground components.
    fn place(&self, x: &[S::Pose<T>]) -> S::Vector<T>;
}
