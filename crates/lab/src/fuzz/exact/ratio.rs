//! Fractions, and sums `a + b·√k` of fractions, rounded to `f64` once.

use std::ops::{Add, Mul, Neg, Sub};

/// A fraction in lowest terms, with a positive denominator. The integers in drawings are small; an
/// overflow is a bug of the drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ratio {
    numerator: i128,
    denominator: i128,
}

const FITS: &str = "the numbers of a drawing have at most 127 bits";

impl Ratio {
    /// The number 0.
    pub const ZERO: Self = Self::whole(0);
    /// The number 1.
    pub const ONE: Self = Self::whole(1);

    /// Returns an integer as a fraction.
    #[must_use]
    pub const fn whole(n: i64) -> Self {
        Self {
            numerator: n as i128,
            denominator: 1,
        }
    }

    /// Returns `numerator/denominator`.
    ///
    /// # Panics
    /// Panics if the denominator is 0.
    #[must_use]
    pub fn new(numerator: i128, denominator: i128) -> Self {
        assert!(denominator != 0, "{numerator}/0");
        let common = gcd(numerator, denominator) * denominator.signum();
        Self {
            numerator: numerator / common,
            denominator: denominator / common,
        }
    }

    /// Returns the numerator.
    #[must_use]
    pub fn numerator(self) -> i128 {
        self.numerator
    }

    /// Returns the denominator, which is positive.
    #[must_use]
    pub fn denominator(self) -> i128 {
        self.denominator
    }

    /// Whether the fraction is 0.
    #[must_use]
    pub fn is_zero(self) -> bool {
        self.numerator == 0
    }

    /// Returns `1/self`.
    ///
    /// # Panics
    /// Panics if the fraction is 0.
    #[must_use]
    pub fn inverse(self) -> Self {
        Self::new(self.denominator, self.numerator)
    }

    /// Returns the nearest `f64`.
    #[must_use]
    pub fn rounded(self) -> f64 {
        const EXACT: u128 = 1 << 53;
        let (n, d) = (self.numerator, self.denominator);
        if n.unsigned_abs() <= EXACT && d.unsigned_abs() <= EXACT {
            return n as f64 / d as f64;
        }
        // The quotient has as many bits as possible, and its last bit is set if any following bit
        // is set. The conversion of this integer then rounds to nearest.
        let shift = n.unsigned_abs().leading_zeros() - 1;
        let scaled = n.unsigned_abs() << shift;
        let (quotient, rest) = (scaled / d.unsigned_abs(), scaled % d.unsigned_abs());
        let size = (quotient | u128::from(rest != 0)) as f64 * 2_f64.powi(-(shift as i32));
        size.copysign(n.signum() as f64)
    }

    /// Returns the rounding error, rounded: `self − rounded`.
    fn rest(self) -> f64 {
        let (n, d) = (self.numerator as f64, self.denominator as f64);
        if n as i128 == self.numerator && d as i128 == self.denominator {
            -self.rounded().mul_add(d, -n) / d
        } else {
            0.0
        }
    }
}

fn gcd(a: i128, b: i128) -> i128 {
    let (mut a, mut b) = (a.abs(), b.abs());
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

impl Add for Ratio {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let common = gcd(self.denominator, other.denominator);
        let (a, b) = (other.denominator / common, self.denominator / common);
        let left = self.numerator.checked_mul(a).expect(FITS);
        let right = other.numerator.checked_mul(b).expect(FITS);
        Self::new(
            left.checked_add(right).expect(FITS),
            self.denominator.checked_mul(a).expect(FITS),
        )
    }
}

impl Neg for Ratio {
    type Output = Self;

    fn neg(self) -> Self {
        Self {
            numerator: -self.numerator,
            denominator: self.denominator,
        }
    }
}

impl Sub for Ratio {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Ratio {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let first = gcd(self.numerator, other.denominator).max(1);
        let second = gcd(other.numerator, self.denominator).max(1);
        let n = (self.numerator / first).checked_mul(other.numerator / second);
        let d = (self.denominator / second).checked_mul(other.denominator / first);
        Self::new(n.expect(FITS), d.expect(FITS))
    }
}

/// The number `a + b·√k`; k is given by the drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Surd {
    /// The rational part.
    pub a: Ratio,
    /// The factor of √k.
    pub b: Ratio,
}

impl Surd {
    /// Returns the product with a fraction.
    #[must_use]
    pub fn times(self, factor: Ratio) -> Self {
        Self {
            a: self.a * factor,
            b: self.b * factor,
        }
    }

    /// Returns the nearest `f64`, except for rounding errors of second order.
    #[must_use]
    pub fn rounded(self, k: u32) -> f64 {
        if self.b.is_zero() {
            return self.a.rounded();
        }
        let root = f64::from(k).sqrt();
        let root_rest = -root.mul_add(root, -f64::from(k)) / (2.0 * root);
        let (b, b_rest) = (self.b.rounded(), self.b.rest());
        let product = b * root;
        let product_rest = b.mul_add(root, -product) + (b * root_rest + b_rest * root);
        let (a, a_rest) = (self.a.rounded(), self.a.rest());
        let sum = a + product;
        let taken = sum - a;
        let sum_rest = (a - (sum - taken)) + (product - taken);
        sum + (sum_rest + (a_rest + product_rest))
    }
}

impl Add for Surd {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            a: self.a + other.a,
            b: self.b + other.b,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fractions_are_rounded_once() {
        assert_eq!(Ratio::new(3, 10).rounded(), 0.3);
        assert_eq!(Ratio::new(-2, -6), Ratio::new(1, 3));
        // A sum of powers of two at the midpoint of two neighbouring doubles is rounded to even. If
        // a much smaller bit is added, the sum is rounded upwards.
        let middle = (1_i128 << 60) + (1 << 7);
        assert_eq!(Ratio::new(middle, 1).rounded(), 2_f64.powi(60));
        let above = Ratio::new(middle, 1) + Ratio::new(1, 1 << 20);
        assert_eq!(above.rounded(), 2_f64.powi(60) + 256.0);
        assert_eq!(Ratio::new(-(1 << 70), 3).rounded(), -(2_f64.powi(70) / 3.0));
    }

    #[test]
    fn roots_are_rounded_once() {
        let surd = |a, b| Surd {
            a: Ratio::whole(a),
            b: Ratio::whole(b),
        };
        assert_eq!(surd(0, 1).rounded(3), 3_f64.sqrt());
        // 97² − 3·56² = 1, so 97 − 56·√3 = 1/(97 + 56·√3): four digits cancel.
        let cancelled = surd(97, -56).rounded(3);
        let expected = (97.0 + 56.0 * 3_f64.sqrt()).recip();
        assert!((cancelled / expected - 1.0).abs() < 1e-15, "{cancelled:e}");
    }
}
