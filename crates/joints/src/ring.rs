//! Number types that kernels run on: `f64` for motion, double-double for certificates, dual numbers for
//! tests.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// What constraint kernels need: they are polynomials.
pub trait Ring:
    Copy + From<f64> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
}

impl<T> Ring for T where
    T: Copy + From<f64> + Add<Output = T> + Sub<Output = T> + Mul<Output = T> + Neg<Output = T>
{
}

/// What force kernels need in addition: distances have roots, directions have quotients.
pub trait Real: Ring + Div<Output = Self> {
    /// `√self`
    #[must_use]
    fn sqrt(self) -> Self;

    /// `1/self`, and 0 for 0: the direction of a vector of length zero is taken as zero.
    #[must_use]
    fn recip_or_zero(self) -> Self;
}

impl Real for f64 {
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }

    fn recip_or_zero(self) -> Self {
        if self == 0.0 { 0.0 } else { 1.0 / self }
    }
}
