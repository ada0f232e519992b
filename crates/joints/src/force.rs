//! Forces: the traits that a definition implements.
//!
//! Each force is a force law on relative coordinates: `Q = Σ law·∂coordinate/∂x`, so that internal
//! forces balance by construction. [`crate::constraint`] describes the slices.

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

    /// The force with these values for its parameters; initial values are zero until
    /// [`Definition::initialise`].
    ///
    /// # Errors
    /// Returns an error if a value is missing, has a wrong shape or is out of range.
    fn from_arguments(arguments: &[Argument]) -> Result<Self, ArgumentError>;

    /// The kernels in a number type.
    fn element<T: Real>(&self) -> &dyn ForceElement<T, S>;
}

/// The kernels of a force in closed form, for one number type.
pub trait ForceElement<T: Real = f64, S: Space = Plane>: Definition<S> {
    /// The specification of the definition.
    fn spec(&self) -> &'static ForceSpec;

    /// Entries of Q, with the pattern of the specification.
    fn q(&self, x: &[S::Pose<T>], v: &[S::Twist<T>], f: &[[T; 3]], out: &mut [T]);

    /// Entries of `∂Q/∂x`.
    fn dq_dx(&self, x: &[S::Pose<T>], v: &[S::Twist<T>], f: &[[T; 3]], out: &mut [T]);

    /// Entries of `∂Q/∂v`.
    fn dq_dv(&self, x: &[S::Pose<T>], v: &[S::Twist<T>], f: &[[T; 3]], out: &mut [T]);
}
