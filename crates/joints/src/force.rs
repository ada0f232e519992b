//! Forces: the trait that a definition expands to, and its face as an object.
//!
//! Each force is a law on relative coordinates: `Q = Σ law·∂coordinate/∂x`, so that internal forces
//! balance by construction. Slices as in [`crate::constraint`].

use crate::arguments::{Argument, ArgumentError};
use crate::plane::{Pose, Twist};
use crate::ring::Real;
use crate::spec::ForceSpec;

/// A force definition in closed form. Implemented by generated code only.
pub trait Force: Clone + Send + Sync + Sized + 'static {
    /// The facts of the definition.
    const SPEC: ForceSpec;

    /// The force with these values for its parameters; initial values are zero until
    /// [`Force::initialise`].
    ///
    /// # Errors
    /// If a value is missing, of another shape or out of range.
    fn from_arguments(arguments: &[Argument]) -> Result<Self, ArgumentError>;

    /// Takes the values that the definition keeps from the assembled start.
    fn initialise(&mut self, x: &[Pose]);

    /// Whether requirement `k` of the definition holds at the assembled start.
    fn requirement(&self, k: usize, x: &[Pose]) -> bool;

    /// Points that the definition takes hold of, each in the frame of its body: values of the
    /// parameters of this shape, in their order. None where a definition does not say.
    fn points(&self) -> Vec<[f64; 2]> {
        Vec::new()
    }

    /// Entries of Q, by the pattern of the spec.
    fn q<T: Real>(&self, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]], out: &mut [T]);

    /// Entries of `∂Q/∂x`.
    fn dq_dx<T: Real>(&self, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]], out: &mut [T]);

    /// Entries of `∂Q/∂v`.
    fn dq_dv<T: Real>(&self, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]], out: &mut [T]);
}

/// A force as an object, for one number type.
pub trait ForceElement<T: Real = f64>: Send + Sync {
    /// The facts of the definition.
    fn spec(&self) -> &'static ForceSpec;
    /// See [`Force::initialise`].
    fn initialise(&mut self, x: &[Pose]);
    /// See [`Force::requirement`].
    fn requirement(&self, k: usize, x: &[Pose]) -> bool;
    /// See [`Force::points`].
    fn points(&self) -> Vec<[f64; 2]>;
    /// See [`Force::q`].
    fn q(&self, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]], out: &mut [T]);
    /// See [`Force::dq_dx`].
    fn dq_dx(&self, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]], out: &mut [T]);
    /// See [`Force::dq_dv`].
    fn dq_dv(&self, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]], out: &mut [T]);
}

impl<T: Real, K: Force> ForceElement<T> for K {
    fn spec(&self) -> &'static ForceSpec {
        &K::SPEC
    }
    fn initialise(&mut self, x: &[Pose]) {
        Force::initialise(self, x);
    }
    fn requirement(&self, k: usize, x: &[Pose]) -> bool {
        Force::requirement(self, k, x)
    }
    fn points(&self) -> Vec<[f64; 2]> {
        Force::points(self)
    }
    fn q(&self, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]], out: &mut [T]) {
        Force::q(self, x, v, f, out);
    }
    fn dq_dx(&self, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]], out: &mut [T]) {
        Force::dq_dx(self, x, v, f, out);
    }
    fn dq_dv(&self, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]], out: &mut [T]) {
        Force::dq_dv(self, x, v, f, out);
    }
}
