//! Constraints: the traits that a definition implements.
//!
//! A block has one row for each constraint row, and for each body slot as many columns as a body
//! has velocities: x, y, rotation in the plane; x, y, z and three rotations in space. Slices `x`
//! and `v` hold the poses and twists of the slots in order, `f` the values and derivatives `[f, ḟ,
//! f̈]` of the functions of time. Output slices are overwritten. Sparse outputs follow the pattern
//! of the [`ConstraintSpec`].

use crate::arguments::{Argument, ArgumentError};
use crate::definition::Definition;
use crate::program::Programs;
use crate::ring::{Real, Scalar};
use crate::slopes::{self, At, Sloped, Slopes};
use crate::space::{Plane, Space};
use crate::spec::ConstraintSpec;
use crate::visitor::Visitor;

/// A constraint definition as a type: its specification, its constructor and its kernels in any
/// number type. Implemented by generated code only.
pub trait Constraint<S: Space = Plane>: ConstraintKernels<S> + Clone + 'static {
    /// The specification of the definition.
    const SPEC: ConstraintSpec;

    /// The constraint with these values for its parameters; initial values are zero until
    /// [`Definition::initialise`].
    ///
    /// # Errors
    /// If a value is missing, of another shape or out of range.
    fn from_arguments(arguments: &[Argument]) -> Result<Self, ArgumentError>;

    /// Calls a visitor with the drives of the measures, in the order of the measures.
    fn visit_drives<V: Visitor<S>>(_visitor: &mut V) {}

    /// Its rows in a number type.
    fn element<T: Scalar>(&self) -> &dyn Element<T, S>;

    /// Its reaction in a number type.
    fn reaction<T: Real>(&self) -> &dyn Reaction<T, S>;
}

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

/// All kernels of a constraint as a trait object: rows and reaction in `f64`, their derivatives,
/// and the rows in any other number type.
///
/// The derivatives by poses and velocities are closed forms, except in definitions whose closed
/// forms are long: those have the dual numbers of [`crate::slopes`].
pub trait ConstraintKernels<S: Space = Plane>: Element<f64, S> + Reaction<f64, S> {
    /// The rows of all constraints of this kind, which run in any number type.
    fn programs(&self) -> &Programs;

    /// Adds the numbers that the programs take of this constraint to `out`.
    fn stored(&self, out: &mut Vec<f64>);

    /// Tells the derivatives of these numbers by those of [`Definition::data`] that are not zero:
    /// index among the former, index among the latter, value.
    fn d_stored_dp(&self, entry: &mut dyn FnMut(usize, usize, f64));

    /// Entries of `∂(Cᵀλ)/∂x`, by the degrees of freedom of the slots.
    fn d_force_dx(&self, x: &[S::Pose<f64>], f: &[[f64; 3]], lambda: &[f64], out: &mut [f64]) {
        slopes::d_force_dx(self, (x, f), lambda, out);
    }

    /// Entries of `∂(C·a − Γ)/∂x`.
    fn d_residual_dx(
        &self,
        x: &[S::Pose<f64>],
        v: &[S::Twist<f64>],
        a: &[S::Twist<f64>],
        f: &[[f64; 3]],
        out: &mut [f64],
    ) {
        slopes::d_residual_dx(self, At { x, v: Some(v), f }, a, out);
    }

    /// Entries of `∂Γ/∂v`.
    fn d_gamma_dv(&self, x: &[S::Pose<f64>], v: &[S::Twist<f64>], f: &[[f64; 3]], out: &mut [f64]) {
        slopes::d_gamma_dv(self, At { x, v: Some(v), f }, out);
    }

    /// Entries of `∂(C·v − b)/∂x`.
    fn d_velocity_dx(
        &self,
        x: &[S::Pose<f64>],
        v: &[S::Twist<f64>],
        f: &[[f64; 3]],
        out: &mut [f64],
    ) {
        slopes::d_velocity_dx(self, At { x, v: Some(v), f }, out);
    }

    /// Derivatives of the rows by the numbers of [`Definition::data`].
    fn slopes(&self, x: &[S::Pose<f64>], f: &[[f64; 3]], of: Sloped<'_, S>) -> Slopes {
        Slopes::of(self, (x, f), of)
    }

    /// A copy.
    fn boxed(&self) -> Box<dyn ConstraintKernels<S>>;
}

impl<S: Space> Clone for Box<dyn ConstraintKernels<S>> {
    fn clone(&self) -> Self {
        self.as_ref().boxed()
    }
}
