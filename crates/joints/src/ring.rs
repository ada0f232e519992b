//! Number types of kernels: `f64` for motion, recording numbers for all other calculations, dual
//! numbers for tests. Programs run in any type with the operations of a ring.

use std::ops::{Add, Div, Mul, Neg, Sub};

use rotation::angle_over_sine;

/// Operations that constraint kernels need. These kernels are polynomials.
pub trait Ring:
    Copy + From<f64> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
}

impl<T> Ring for T where
    T: Copy + From<f64> + Add<Output = T> + Sub<Output = T> + Mul<Output = T> + Neg<Output = T>
{
}

/// A number type in which the kernels for the rows of constraints are compiled.
pub trait Scalar: Ring {
    /// Returns a value stored by a constraint, in the form in which the rows of the constraint read
    /// it. `_place` is the index in [`crate::ConstraintKernels::stored`].
    #[must_use]
    fn stored(value: f64, _place: usize) -> Self {
        Self::from(value)
    }
}

impl Scalar for f64 {}

/// Additional operations that force kernels need: square roots for distances, quotients for
/// directions.
pub trait Real: Ring + Div<Output = Self> {
    /// `√self`
    #[must_use]
    fn sqrt(self) -> Self;

    /// `1/self`, and 0 for 0, so that the direction of a vector of length zero is zero.
    #[must_use]
    fn recip_or_zero(self) -> Self;

    /// The derivative of θ/sin θ with respect to c = cos θ, of this order; see [`angle_over_sine`].
    #[must_use]
    fn angle_over_sine(self, order: u8) -> Self;
}

impl Real for f64 {
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }

    fn recip_or_zero(self) -> Self {
        if self == 0.0 { 0.0 } else { 1.0 / self }
    }

    fn angle_over_sine(self, order: u8) -> Self {
        angle_over_sine(self, order)
    }
}

/// The size of the terms of a polynomial. Every operation is applied to absolute values, and
/// differences become sums. For each result, a kernel with this number type returns a bound on the
/// terms that cancel in the result. The product of this bound and the relative error of the data is
/// a bound on the error of the result.
///
/// ```
/// use pfaff_joints::Magnitude;
/// let (x, y) = (Magnitude::from(-3.0), Magnitude::from(3.0));
/// assert_eq!((x + y).value(), 6.0); // −3 + 3 is 0, a sum of terms of size 3
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct Magnitude(f64);

impl Magnitude {
    /// The value, which is never negative.
    #[must_use]
    pub fn value(self) -> f64 {
        self.0
    }
}

impl From<f64> for Magnitude {
    fn from(x: f64) -> Self {
        Self(x.abs())
    }
}

impl Add for Magnitude {
    type Output = Self;

    fn add(self, y: Self) -> Self {
        Self(self.0 + y.0)
    }
}

impl Sub for Magnitude {
    type Output = Self;

    fn sub(self, y: Self) -> Self {
        self.add(y)
    }
}

impl Mul for Magnitude {
    type Output = Self;

    fn mul(self, y: Self) -> Self {
        Self(self.0 * y.0)
    }
}

impl Neg for Magnitude {
    type Output = Self;

    fn neg(self) -> Self {
        self
    }
}
