//! Number types of the oracles: plain numbers for differences, dual numbers for exact derivatives.

use num_dual::{Dual2_64, Dual64, DualNum};

use crate::ring::{Real, Ring};

/// A number type for poses: cosine and sine are computed from the number itself.
pub(super) trait Number: Real {
    /// Sine and cosine.
    fn sin_cos(self) -> (Self, Self);
}

impl Number for f64 {
    fn sin_cos(self) -> (Self, Self) {
        f64::sin_cos(self)
    }
}

impl Number for Dual64 {
    fn sin_cos(self) -> (Self, Self) {
        DualNum::sin_cos(&self)
    }
}

impl Number for Dual2_64 {
    fn sin_cos(self) -> (Self, Self) {
        DualNum::sin_cos(&self)
    }
}

/// As for plain numbers, the square root of zero has derivative zero.
impl Real for Dual64 {
    fn sqrt(self) -> Self {
        let root = self.re.sqrt();
        Self::new(root, self.eps * (0.5 * root.recip_or_zero()))
    }

    fn recip_or_zero(self) -> Self {
        if self.re == 0.0 {
            zero()
        } else {
            DualNum::recip(&self)
        }
    }
}

/// As for plain numbers, the square root of zero has derivatives zero.
impl Real for Dual2_64 {
    fn sqrt(self) -> Self {
        let root = self.re.sqrt();
        let first = 0.5 * root.recip_or_zero();
        let second = -0.5 * first * self.re.recip_or_zero();
        Self::new(
            root,
            self.v1 * first,
            self.v2 * first + self.v1 * self.v1 * second,
        )
    }

    fn recip_or_zero(self) -> Self {
        if self.re == 0.0 {
            zero()
        } else {
            DualNum::recip(&self)
        }
    }
}

fn zero<T: Ring>() -> T {
    T::from(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_and_reciprocals_have_their_textbook_derivatives() {
        // √x at 4: 2, 1/4, −1/32.
        let root = Real::sqrt(Dual2_64::new(4.0, 1.0, 0.0));
        assert_eq!((root.re, root.v1, root.v2), (2.0, 0.25, -0.03125));
        // 1/x at 2: 1/2, −1/4, 1/4.
        let inverse = Dual2_64::new(2.0, 1.0, 0.0).recip_or_zero();
        assert_eq!((inverse.re, inverse.v1, inverse.v2), (0.5, -0.25, 0.25));
        let inverse = Dual64::new(2.0, 1.0).recip_or_zero();
        assert_eq!((inverse.re, inverse.eps), (0.5, -0.25));
    }

    #[test]
    fn at_zero_both_are_zero_with_derivative_zero() {
        let x = Dual64::new(0.0, 3.0);
        assert_eq!((Real::sqrt(x).re, Real::sqrt(x).eps), (0.0, 0.0));
        assert_eq!((x.recip_or_zero().re, x.recip_or_zero().eps), (0.0, 0.0));
    }
}
