//! Constraints: the traits that a definition implements.
//!
//! A block is a matrix with one row for each constraint row. It has one column for each velocity
//! component of each body: x, y, rotation in the plane; x, y, z and three rotations in space. The
//! slices `x` and `v` contain the poses and twists of the bodies in the order of the definition.
//! The slice `f` contains the values and derivatives `[f, ḟ, f̈]` of the functions of time. Output
//! slices are overwritten. Sparse outputs follow the pattern of the [`ConstraintSpec`].

use crate::arguments::{Argument, ArgumentError};
use crate::element::{Element, Reaction};
use crate::program::Programs;
use crate::ring::{Real, Scalar};
use crate::slopes::{self, At, OfKind, SlopedOutputs, Slopes};
use crate::space::{Plane, Space};
use crate::spec::ConstraintSpec;
use crate::visitor::Visitor;

/// A constraint definition as a type: its specification, its constructor and its kernels in any
/// number type. Only generated code implements this trait.
pub trait Constraint<S: Space = Plane>: ConstraintKernels<S> + Clone + 'static {
    /// The specification of the definition.
    const SPEC: ConstraintSpec;

    /// Creates the constraint with these values of the parameters. Initial values are zero until
    /// [`crate::Definition::initialise`] is called.
    ///
    /// # Errors
    /// Returns an error if a value is missing, has a wrong shape or is out of range.
    fn from_arguments(arguments: &[Argument]) -> Result<Self, ArgumentError>;

    /// Calls a visitor with the drives of the joint coordinates, in the order of the `measures`.
    fn visit_drives<V: Visitor<S>>(_visitor: &mut V) {}

    /// Returns the rows in a number type.
    fn element<T: Scalar>(&self) -> &dyn Element<T, S>;

    /// Returns the reaction in a number type.
    fn reaction<T: Real>(&self) -> &dyn Reaction<T, S>;
}

/// All kernels of a constraint as a trait object: rows and reaction in `f64`, the derivatives of
/// both, and the rows in any other number type.
///
/// The derivatives with respect to poses and velocities are closed forms. Definitions with long
/// closed forms use the dual numbers of [`crate::slopes`] instead.
pub trait ConstraintKernels<S: Space = Plane>: Element<f64, S> + Reaction<f64, S> {
    /// Returns the rows for all constraints of this kind as programs. The programs run in any
    /// number type.
    fn programs(&self) -> &Programs;

    /// Appends the values of this constraint that the programs need to `out`.
    fn stored(&self, out: &mut Vec<f64>);

    /// Calls `entry` for each nonzero derivative of the stored values with respect to the values of
    /// [`crate::Definition::data`]. The arguments of `entry` are the index of the stored value, the
    /// index of the datum in `data`, and the derivative of the stored value with respect to the
    /// datum.
    fn d_stored_dp(&self, entry: &mut dyn FnMut(usize, usize, f64));

    /// Computes the entries of `∂(Cᵀλ)/∂x` with respect to displacements along the velocity
    /// components of the bodies.
    fn d_force_dx(&self, x: &[S::Pose<f64>], f: &[[f64; 3]], lambda: &[f64], out: &mut [f64]) {
        slopes::d_force_dx::<S>(&of_kind(self), (x, f), lambda, out);
    }

    /// Computes the entries of `∂(C·a − Γ)/∂x`.
    fn d_residual_dx(
        &self,
        x: &[S::Pose<f64>],
        v: &[S::Twist<f64>],
        a: &[S::Twist<f64>],
        f: &[[f64; 3]],
        out: &mut [f64],
    ) {
        slopes::d_residual_dx::<S>(&of_kind(self), At { x, v: Some(v), f }, a, out);
    }

    /// Computes the entries of `∂Γ/∂v`.
    fn d_gamma_dv(&self, x: &[S::Pose<f64>], v: &[S::Twist<f64>], f: &[[f64; 3]], out: &mut [f64]) {
        slopes::d_gamma_dv::<S>(&of_kind(self), At { x, v: Some(v), f }, out);
    }

    /// Computes the entries of `∂(C·v − b)/∂x`.
    fn d_velocity_dx(
        &self,
        x: &[S::Pose<f64>],
        v: &[S::Twist<f64>],
        f: &[[f64; 3]],
        out: &mut [f64],
    ) {
        slopes::d_velocity_dx::<S>(&of_kind(self), At { x, v: Some(v), f }, out);
    }

    /// Computes the derivatives of the rows with respect to the values of
    /// [`crate::Definition::data`].
    fn slopes(&self, x: &[S::Pose<f64>], f: &[[f64; 3]], of: SlopedOutputs<'_, S>) -> Slopes {
        let mut of_stored = Vec::new();
        self.d_stored_dp(&mut |place, number, slope| of_stored.push((place, number, slope)));
        Slopes::of(&of_kind(self), &of_stored, (x, f), of)
    }

    /// Returns a copy.
    fn boxed(&self) -> Box<dyn ConstraintKernels<S>>;
}

/// Returns the programs of a constraint together with the stored values of the constraint.
fn of_kind<S: Space>(kernels: &(impl ConstraintKernels<S> + ?Sized)) -> OfKind<'_> {
    let mut stored = Vec::new();
    kernels.stored(&mut stored);
    OfKind {
        spec: kernels.spec(),
        programs: kernels.programs(),
        stored,
    }
}

impl<S: Space> Clone for Box<dyn ConstraintKernels<S>> {
    fn clone(&self) -> Self {
        self.as_ref().boxed()
    }
}
