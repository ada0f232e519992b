//! Forces: the traits that a definition implements.
//!
//! Each force is a sum over force laws of relative coordinates, `Q = Σ law·∂coordinate/∂x`.
//! Therefore internal forces always balance. [`crate::constraint`] describes the slices.

use crate::arguments::{Argument, ArgumentError};
use crate::definition::Definition;
use crate::ring::Real;
use crate::space::{Plane, Space};
use crate::spec::ForceSpec;

/// A force definition as a type: its specification, its constructor and its kernels in any number
/// type. Only generated code implements this trait.
pub trait Force<S: Space = Plane>: ForceElement<f64, S> + Clone + 'static {
    /// The specification of the definition.
    const SPEC: ForceSpec;

    /// Creates the force with these values of the parameters. Initial values are zero until
    /// [`Definition::initialise`] is called.
    ///
    /// # Errors
    /// Returns an error if a value is missing, has a wrong shape or is out of range.
    fn from_arguments(arguments: &[Argument]) -> Result<Self, ArgumentError>;

    /// Returns the kernels in a number type.
    fn element<T: Real>(&self) -> &dyn ForceElement<T, S>;
}

/// The kernels of a force in closed form, for one number type.
pub trait ForceElement<T: Real = f64, S: Space = Plane>: Definition<S> {
    /// The specification of the definition.
    fn spec(&self) -> &'static ForceSpec;

    /// Writes the entries of Q, in the pattern of the specification.
    fn q(&self, x: &[S::Pose<T>], v: &[S::Twist<T>], f: &[[T; 3]], out: &mut [T]);

    /// Writes the entries of `∂Q/∂x`.
    fn dq_dx(&self, x: &[S::Pose<T>], v: &[S::Twist<T>], f: &[[T; 3]], out: &mut [T]);

    /// Writes the entries of `∂Q/∂v`.
    fn dq_dv(&self, x: &[S::Pose<T>], v: &[S::Twist<T>], f: &[[T; 3]], out: &mut [T]);
}
