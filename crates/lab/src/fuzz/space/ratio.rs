//! Fractions of integers of any size, rounded to `f64` once. Drawings in space are rotated several
//! times, and 127 bits would not be sufficient for the results.

use std::ops::{Add, Div, Mul, Neg, Sub};

use num_bigint::{BigInt, Sign};
use num_traits::{One, Signed, ToPrimitive, Zero};

/// A fraction in lowest terms, with a positive denominator.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ratio {
    numerator: BigInt,
    denominator: BigInt,
}

impl Ratio {
    /// Returns an integer as a fraction.
    #[must_use]
    pub fn whole(n: i64) -> Self {
        Self::new(n, 1)
    }

    /// Returns `numerator/denominator`.
    ///
    /// # Panics
    /// Panics if the denominator is 0.
    #[must_use]
    pub fn new(numerator: impl Into<BigInt>, denominator: impl Into<BigInt>) -> Self {
        let (numerator, denominator) = (numerator.into(), denominator.into());
        assert!(!denominator.is_zero(), "{numerator}/0");
        let mut common = gcd(&numerator, &denominator);
        if denominator.is_negative() {
            common = -common;
        }
        Self {
            numerator: numerator / &common,
            denominator: denominator / &common,
        }
    }

    /// Returns the number 0.
    #[must_use]
    pub fn zero() -> Self {
        Self::whole(0)
    }

    /// Returns the number 1.
    #[must_use]
    pub fn one() -> Self {
        Self::whole(1)
    }

    /// Returns the numerator.
    #[must_use]
    pub fn numerator(&self) -> &BigInt {
        &self.numerator
    }

    /// Returns the denominator, which is positive.
    #[must_use]
    pub fn denominator(&self) -> &BigInt {
        &self.denominator
    }

    /// Whether the fraction is 0.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.numerator.is_zero()
    }

    /// Returns the absolute value.
    #[must_use]
    pub fn abs(&self) -> Self {
        Self {
            numerator: self.numerator.abs(),
            denominator: self.denominator.clone(),
        }
    }

    /// Whether the fraction is less than another fraction.
    #[must_use]
    pub fn is_below(&self, other: &Self) -> bool {
        (self - other).numerator.is_negative()
    }

    /// Returns the nearest `f64`.
    #[must_use]
    pub fn rounded(&self) -> f64 {
        quotient(&self.numerator, &self.denominator)
    }

    /// Returns the square root of the absolute value as `f64`, accurate to one unit in the last
    /// place.
    #[must_use]
    pub fn root(&self) -> f64 {
        self.abs().rounded().sqrt()
    }
}

/// Returns `n/d`, rounded to the nearest `f64`. The integers n and d may be larger than any `f64`.
#[must_use]
pub fn quotient(n: &BigInt, d: &BigInt) -> f64 {
    const BITS: i64 = 100;
    if n.is_zero() {
        return 0.0;
    }
    // The quotient has at least 100 bits, and its last bit is set if any following bit is set. The
    // conversion of this integer then rounds to nearest.
    let shift = BITS + d.bits() as i64 - n.bits() as i64;
    let (n_size, d_size) = (n.abs(), d.abs());
    let (n_size, d_size) = if shift >= 0 {
        (n_size << shift as usize, d_size)
    } else {
        (n_size, d_size << (-shift) as usize)
    };
    let (whole, rest) = (&n_size / &d_size, &n_size % &d_size);
    let sticky = u128::from(!rest.is_zero());
    let size = (whole.to_u128().unwrap_or(u128::MAX) | sticky) as f64 * power_of_two(-shift);
    if n.sign() == d.sign() { size } else { -size }
}

/// Returns 2^e as a product of two factors that are both in the range of `f64`.
fn power_of_two(e: i64) -> f64 {
    let e = e.clamp(-2100, 2000) as i32;
    2_f64.powi(e / 2) * 2_f64.powi(e - e / 2)
}

/// Returns the greatest common divisor, at least 1.
#[must_use]
pub fn gcd(a: &BigInt, b: &BigInt) -> BigInt {
    let (mut a, mut b) = (a.abs(), b.abs());
    while !b.is_zero() {
        let rest = &a % &b;
        a = std::mem::replace(&mut b, rest);
    }
    if a.sign() == Sign::NoSign {
        BigInt::one()
    } else {
        a
    }
}

/// Multiplies fractions by a factor so that they become integers without a common divisor. Returns
/// the integers and the factor. If all fractions are zero, the integers are zero.
#[must_use]
pub fn whole_multiples(fractions: &[Ratio]) -> (Vec<BigInt>, Ratio) {
    let multiple = fractions.iter().fold(BigInt::one(), |m, x| {
        &m / gcd(&m, &x.denominator) * &x.denominator
    });
    let whole = fractions
        .iter()
        .map(|x| &x.numerator * (&multiple / &x.denominator));
    let whole: Vec<BigInt> = whole.collect();
    let zero = BigInt::zero();
    let live = whole.iter().filter(|x| !x.is_zero());
    let common = live.fold(zero, |g, x| gcd(&g, x));
    if common.is_zero() {
        return (whole, Ratio::one());
    }
    let parts = whole.iter().map(|x| x / &common).collect();
    (parts, Ratio::new(multiple, common))
}

impl Add for &Ratio {
    type Output = Ratio;

    fn add(self, other: Self) -> Ratio {
        Ratio::new(
            &self.numerator * &other.denominator + &other.numerator * &self.denominator,
            &self.denominator * &other.denominator,
        )
    }
}

impl Sub for &Ratio {
    type Output = Ratio;

    fn sub(self, other: Self) -> Ratio {
        self + &-other
    }
}

impl Neg for &Ratio {
    type Output = Ratio;

    fn neg(self) -> Ratio {
        Ratio {
            numerator: -&self.numerator,
            denominator: self.denominator.clone(),
        }
    }
}

impl Mul for &Ratio {
    type Output = Ratio;

    fn mul(self, other: Self) -> Ratio {
        Ratio::new(
            &self.numerator * &other.numerator,
            &self.denominator * &other.denominator,
        )
    }
}

impl Div for &Ratio {
    type Output = Ratio;

    /// # Panics
    /// Panics if the divisor is 0.
    fn div(self, other: Self) -> Ratio {
        Ratio::new(
            &self.numerator * &other.denominator,
            &self.denominator * &other.numerator,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fractions_are_rounded_once() {
        assert_eq!(Ratio::new(3, 10).rounded(), 0.3);
        assert_eq!(Ratio::new(-2, -6), Ratio::new(1, 3));
        // The number 2⁶⁰ + 2⁷ is halfway between two neighbouring doubles, so a much smaller bit
        // determines the rounding.
        let middle = Ratio::new((1_i64 << 60) + (1 << 7), 1);
        assert_eq!(middle.rounded(), 2_f64.powi(60));
        let above = &middle + &Ratio::new(1, BigInt::one() << 300_u32);
        assert_eq!(above.rounded(), 2_f64.powi(60) + 256.0);
        let far = BigInt::one() << 400_u32;
        let third = Ratio::new(-far.clone(), 3);
        assert_eq!(third.rounded(), -(2_f64.powi(400) / 3.0));
        assert_eq!(Ratio::new(1, far).rounded(), 2_f64.powi(-400));
    }

    #[test]
    fn rows_become_small_whole_numbers() {
        let row = [Ratio::new(2, 3), Ratio::zero(), Ratio::new(-4, 5)];
        let (whole, factor) = whole_multiples(&row);
        assert_eq!(whole, [5, 0, -6].map(BigInt::from));
        assert_eq!(factor, Ratio::new(15, 2));
    }
}
