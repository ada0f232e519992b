//! Forces: the traits that a definition implements.
//!
//! Each force is a law on relative coordinates: `Q = Σ law·∂coordinate/∂x`, so that internal forces
//! balance by construction. The slices are those of [`crate::constraint`].

use crate::arguments::{Argument, ArgumentError};
use crate::definition::Definition;
use crate::ring::Real;
use crate::space::{Plane, Space};
use crate::spec::ForceSpec;

/// A force definition as a type: its specification, its constructor and its kernels in any number
/// type. Implemented by generated code only.
pub trait Force<S: Space = Plane>: ForceElement<f64, S> + Clone + 'static {
    /// The specification of the definition.
    const SPEC: ForceSpec;

    /// The force with these values for its parameters; initial values are zero until
    /// [`Definition::initialise`].
    ///
    /// # Errors
    /// If a value is missing, of another shape or out of range.
    fn from_arguments(arguments: &[Argument]) -> Result<Self, ArgumentError>;

    /// Its kernels in a number type.
    fn element<T: Real>(&self) -> &dyn ForceElement<T, S>;
}

/// The kernels of a force in closed form, for one number type.
pub trait ForceElement<T: Real = f64, S: Space = Plane>: Definition<S> {
    /// The specification of the definition.
    fn spec(&self) -> &'static ForceSpec;

    /// Entries of Q, by the pattern of the spec.
    fn q(&self, x: &[S::Pose<T>], v: &[S::Twist<T>], f: &[[T; 3]], out: &mut [T]);

    /// Entries of `∂Q/∂x`.
    fn dq_dx(&self, x: &[S::Pose<T>], v: &[S::Twist<T>], f: &[[T; 3]], out: &mut [T]);

    /// Entries of `∂Q/∂v`.
    fn dq_dv(&self, x: &[S::Pose<T>], v: &[S::Twist<T>], f: &[[T; 3]], out: &mut [T]);
}
