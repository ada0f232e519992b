//! Number types for the expected values: `f64` for differences, and dual numbers for exact
//! derivatives. Another type records whether the value of a force law is undefined.

use std::cell::RefCell;
use std::ops::{Add, Div, Mul, Neg, Sub};

use joints::{Real, Scalar};
use num_dual::{Dual2_64, DualNum};

/// A number type for poses. The type provides cosine and sine.
pub trait Number: Real {
    /// Returns the sine and the cosine.
    fn sin_cos(self) -> (Self, Self);
}

impl Number for f64 {
    fn sin_cos(self) -> (Self, Self) {
        f64::sin_cos(self)
    }
}

/// A dual number of `num-dual` as a number type of kernels, with first and second derivative. The
/// same type is used for both derivatives, because all kernels must be compiled for each type.
#[derive(Clone, Copy)]
pub(crate) struct Dual(pub(crate) Dual2_64);

thread_local! {
    /// Derivatives of the values that a constraint stores, by their indices.
    static SLOPES: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) };
}

/// Returns the result of `ask` if the values stored by constraints have these derivatives. The
/// derivatives are in the order of the indices of the values. All other values are constant.
pub(crate) fn with_slopes<R>(slopes: Vec<f64>, ask: impl FnOnce() -> R) -> R {
    SLOPES.set(slopes);
    let answer = ask();
    SLOPES.take();
    answer
}

impl Scalar for Dual {
    fn stored(value: f64, place: usize) -> Self {
        let slope = SLOPES.with_borrow(|slopes| slopes.get(place).copied());
        Self(Dual2_64::new(value, slope.unwrap_or(0.0), 0.0))
    }
}

impl Number for Dual {
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.0.sin_cos();
        (Self(sin), Self(cos))
    }
}

/// Square root and reciprocal of zero are zero, as for `f64`, and their derivatives are zero.
impl Real for Dual {
    fn sqrt(self) -> Self {
        self.unless_zero(DualNum::sqrt)
    }

    fn recip_or_zero(self) -> Self {
        self.unless_zero(DualNum::recip)
    }

    /// Uses the Taylor series about the real part; at most three terms of the series are nonzero.
    fn angle_over_sine(self, order: u8) -> Self {
        let c = self.0.re;
        let of = |more: u8| Self::from(rotation::angle_over_sine(c, order + more));
        let d = self - Self::from(c);
        of(0) + d * (of(1) + d * (Self::from(0.5) * of(2) + d * Self::from(1.0 / 6.0) * of(3)))
    }
}

impl Dual {
    fn unless_zero(self, function: impl Fn(&Dual2_64) -> Dual2_64) -> Self {
        if self.0.re == 0.0 {
            Self::from(0.0)
        } else {
            Self(function(&self.0))
        }
    }
}

impl From<f64> for Dual {
    fn from(x: f64) -> Self {
        Self(Dual2_64::from(x))
    }
}

impl Add for Dual {
    type Output = Self;

    fn add(self, y: Self) -> Self {
        Self(self.0 + y.0)
    }
}

impl Sub for Dual {
    type Output = Self;

    fn sub(self, y: Self) -> Self {
        Self(self.0 - y.0)
    }
}

impl Mul for Dual {
    type Output = Self;

    fn mul(self, y: Self) -> Self {
        Self(self.0 * y.0)
    }
}

impl Div for Dual {
    type Output = Self;

    fn div(self, y: Self) -> Self {
        Self(self.0 / y.0)
    }
}

impl Neg for Dual {
    type Output = Self;

    fn neg(self) -> Self {
        Self(-self.0)
    }
}

/// A number that records whether it was computed from a rotation vector near half a revolution. A
/// force law has no value for such a rotation vector. A result that is NaN for another reason, for
/// example 0/0, is still an error.
#[derive(Clone, Copy)]
pub(crate) struct Traced {
    value: f64,
    pub(crate) is_near_half_a_turn: bool,
}

impl Traced {
    fn with(self, y: Self, operation: impl Fn(f64, f64) -> f64) -> Self {
        Self {
            value: operation(self.value, y.value),
            is_near_half_a_turn: self.is_near_half_a_turn || y.is_near_half_a_turn,
        }
    }

    fn map(self, function: impl Fn(f64) -> f64) -> Self {
        let value = function(self.value);
        Self { value, ..self }
    }
}

impl From<f64> for Traced {
    fn from(value: f64) -> Self {
        let is_near_half_a_turn = false;
        Self {
            value,
            is_near_half_a_turn,
        }
    }
}

impl Number for Traced {
    fn sin_cos(self) -> (Self, Self) {
        (self.map(f64::sin), self.map(f64::cos))
    }
}

impl Real for Traced {
    fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }

    fn recip_or_zero(self) -> Self {
        self.map(Real::recip_or_zero)
    }

    fn angle_over_sine(self, order: u8) -> Self {
        let value = rotation::angle_over_sine(self.value, order);
        Self {
            value,
            is_near_half_a_turn: self.is_near_half_a_turn
                || self.value.is_finite() && value.is_nan(),
        }
    }
}

impl Add for Traced {
    type Output = Self;

    fn add(self, y: Self) -> Self {
        self.with(y, |x, y| x + y)
    }
}

impl Sub for Traced {
    type Output = Self;

    fn sub(self, y: Self) -> Self {
        self.with(y, |x, y| x - y)
    }
}

impl Mul for Traced {
    type Output = Self;

    fn mul(self, y: Self) -> Self {
        self.with(y, |x, y| x * y)
    }
}

impl Div for Traced {
    type Output = Self;

    fn div(self, y: Self) -> Self {
        self.with(y, |x, y| x / y)
    }
}

impl Neg for Traced {
    type Output = Self;

    fn neg(self) -> Self {
        self.map(|x| -x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_and_reciprocals_have_their_textbook_derivatives() {
        // √x at x = 4, with derivatives: 2, 1/4, −1/32.
        let root = Real::sqrt(Dual(Dual2_64::new(4.0, 1.0, 0.0))).0;
        assert_eq!((root.re, root.v1, root.v2), (2.0, 0.25, -0.03125));
        // 1/x at x = 2, with derivatives: 1/2, −1/4, 1/4.
        let inverse = Dual(Dual2_64::new(2.0, 1.0, 0.0)).recip_or_zero().0;
        assert_eq!((inverse.re, inverse.v1, inverse.v2), (0.5, -0.25, 0.25));
    }

    #[test]
    fn at_zero_both_are_zero_with_derivative_zero() {
        let x = Dual(Dual2_64::new(0.0, 3.0, 1.0));
        for found in [Real::sqrt(x).0, x.recip_or_zero().0] {
            assert_eq!((found.re, found.v1, found.v2), (0.0, 0.0, 0.0));
        }
    }

    #[test]
    fn half_a_turn_is_told_from_other_numbers_that_are_none() {
        let [one, zero, half_a_turn] = [1.0, 0.0, -1.0].map(Traced::from);
        let undefined = half_a_turn.angle_over_sine(0);
        assert!(undefined.is_near_half_a_turn && undefined.value.is_nan());
        assert!((one - zero * undefined).is_near_half_a_turn);
        let quotient = zero / zero;
        for other in [
            quotient,
            quotient.angle_over_sine(0),
            one.angle_over_sine(1),
        ] {
            assert!(!other.is_near_half_a_turn);
        }
    }
}
