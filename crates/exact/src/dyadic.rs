//! Numbers `mantissa·2^exponent`. Every finite `f64` is such a number, and so are sums and products
//! of these numbers.

use num_bigint::BigInt;
use num_traits::Zero;

/// The number `mantissa·2^exponent` with an odd or zero mantissa.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Dyadic {
    mantissa: BigInt,
    exponent: i64,
}

impl Dyadic {
    /// Creates the number `mantissa·2^exponent`.
    #[must_use]
    pub fn new(mantissa: BigInt, exponent: i64) -> Self {
        match mantissa.trailing_zeros() {
            None => Self {
                mantissa,
                exponent: 0,
            },
            Some(zeros) => Self {
                mantissa: mantissa >> zeros,
                exponent: exponent + zeros as i64,
            },
        }
    }

    /// Returns the exponent of the odd mantissa, or `None` for zero.
    #[must_use]
    pub fn exponent(&self) -> Option<i64> {
        (!self.is_zero()).then_some(self.exponent)
    }

    /// Returns whether the number is zero.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.mantissa.is_zero()
    }

    /// Returns the sum.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        let exponent = self.exponent.min(other.exponent);
        let sum = self.shifted(exponent) + other.shifted(exponent);
        Self::new(sum, exponent)
    }

    /// Returns the difference.
    #[must_use]
    pub fn minus(&self, other: &Self) -> Self {
        self.plus(&Self::new(-&other.mantissa, other.exponent))
    }

    /// Returns the product.
    #[must_use]
    pub fn times(&self, other: &Self) -> Self {
        Self::new(
            &self.mantissa * &other.mantissa,
            self.exponent + other.exponent,
        )
    }

    /// Returns the integer `self/2^exponent`.
    ///
    /// # Panics
    /// Panics if the result is not an integer.
    #[must_use]
    pub fn over_power(&self, exponent: i64) -> BigInt {
        if self.is_zero() {
            return BigInt::zero();
        }
        assert!(self.exponent >= exponent, "{self:?} over 2^{exponent}");
        self.shifted(exponent)
    }

    fn shifted(&self, exponent: i64) -> BigInt {
        if self.is_zero() {
            return BigInt::zero();
        }
        &self.mantissa << (self.exponent - exponent) as usize
    }
}

impl From<f64> for Dyadic {
    /// # Panics
    /// Panics if `x` is NaN or infinite.
    fn from(x: f64) -> Self {
        assert!(x.is_finite(), "{x} is no number");
        const FIELD: u64 = (1 << 52) - 1;
        let (bits, biased) = (x.to_bits() & FIELD, (x.to_bits() >> 52) & 0x7ff);
        // Subnormal numbers have no hidden bit, and their exponent is the exponent of the smallest
        // normal numbers.
        let hidden = if biased == 0 { 0 } else { FIELD + 1 };
        let mantissa = BigInt::from(bits + hidden);
        let mantissa = if x < 0.0 { -mantissa } else { mantissa };
        Self::new(mantissa, biased.max(1) as i64 - 1075)
    }
}
