//! Double-double numbers: an unevaluated sum `hi + lo` of two `f64`, about 32 digits.
//!
//! The format is used for residuals and certificates. A singular value that is exactly zero is
//! computed as about 1e-16 in `f64` and as about 1e-32 in this format. A small nonzero singular
//! value does not change. The type `Dd` is not a general numeric type: it has no transcendental
//! functions, and no formatting of all digits.
//!
//! Products are computed by Dekker's splitting instead of `f64::mul_add`. Both methods are exact,
//! so both give the same bits on every platform. However, on x86-64 without the FMA target feature
//! `mul_add` is a call into a software routine, some twenty times slower. The disadvantage is a
//! smaller range: the low part is correct only if the operands of a product are below 2⁹⁹⁶ in
//! absolute value and the product is above 2⁻⁹⁶⁷.
//!
//! Sources: T. J. Dekker, A floating-point technique for extending the available precision, Numer.
//! Math. 18 (1971) 224–242; M. Joldes, J.-M. Muller, V. Popescu, Tight and rigorous error bounds
//! for basic building blocks of double-word arithmetic, ACM TOMS 44 (2017) 15res.

use std::cmp::Ordering;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use crate::powers::scale;

/// A double-double number.
///
/// ```
/// use pfaff_linalg::Dd;
/// let third = Dd::from(1.0) / Dd::from(3.0);
/// let left = third * Dd::from(3.0) - Dd::from(1.0);
/// assert!(left.abs() < Dd::from(1e-31));
/// // Far below the resolution of f64:
/// assert_eq!((Dd::from(1.0) + Dd::from(1e-25) - Dd::from(1.0)).to_f64(), 1e-25);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Dd {
    hi: f64,
    lo: f64,
}

/// Computes `a + b = s + e` exactly, where s is the rounded sum. The operands may have any order of
/// size (Knuth).
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    let b_part = s - a;
    let a_part = s - b_part;
    (s, (a - a_part) + (b - b_part))
}

/// Computes `a·b = p + e` exactly, where p is the rounded product. The module docs state the range
/// of the operands.
pub fn two_product(a: f64, b: f64) -> (f64, f64) {
    let p = a * b;
    let (a_hi, a_lo) = split(a);
    let (b_hi, b_lo) = split(b);
    let e = ((a_hi * b_hi - p) + a_hi * b_lo + a_lo * b_hi) + a_lo * b_lo;
    (p, e)
}

/// Computes `a + b = s + e` exactly if `|a| ≥ |b|` or a = 0 (Dekker).
fn fast_two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    (s, b - (s - a))
}

/// Splits a number into two halves of at most 26 bits each (Veltkamp).
fn split(a: f64) -> (f64, f64) {
    const FACTOR: f64 = 134_217_729.0; // 2²⁷ + 1
    let t = FACTOR * a;
    let hi = t - (t - a);
    (hi, a - hi)
}

impl Dd {
    /// The number zero.
    pub const ZERO: Self = Self { hi: 0.0, lo: 0.0 };
    /// The number one.
    pub const ONE: Self = Self { hi: 1.0, lo: 0.0 };
    /// Bound on the relative rounding error of one operation: 2⁻¹⁰².
    pub const EPSILON: f64 = 1.972_152_263_052_53e-31;

    /// Returns the exact sum of two numbers.
    pub fn from_sum(a: f64, b: f64) -> Self {
        Self::from_pair(two_sum(a, b))
    }

    /// Returns the exact product of two numbers.
    pub fn from_product(a: f64, b: f64) -> Self {
        Self::from_pair(two_product(a, b))
    }

    /// Returns the leading part, which is the value rounded to `f64`.
    pub fn hi(self) -> f64 {
        self.hi
    }

    /// Returns the trailing part, which is at most half a unit in the last place of `hi`.
    pub fn lo(self) -> f64 {
        self.lo
    }

    /// Returns the value rounded to `f64`.
    pub fn to_f64(self) -> f64 {
        self.hi
    }

    /// Returns |x|.
    #[must_use]
    pub fn abs(self) -> Self {
        if self.hi < 0.0 { -self } else { self }
    }

    /// Returns √x, or NaN for negative numbers.
    #[must_use]
    pub fn sqrt(self) -> Self {
        if self.hi <= 0.0 || !self.hi.is_finite() {
            return Self::from(self.hi.sqrt());
        }
        // One Newton step doubles the number of correct digits of the rounded root.
        let root = self.hi.sqrt();
        let left = self - Self::from_product(root, root);
        Self::from_pair(fast_two_sum(root, left.hi / (2.0 * root)))
    }

    /// Returns `x·2^e`. The result is exact unless a part leaves the range of normal numbers.
    #[must_use]
    pub fn scaled(self, e: i32) -> Self {
        Self::from_pair((scale(self.hi, e), scale(self.lo, e)))
    }

    fn from_pair((hi, lo): (f64, f64)) -> Self {
        Self { hi, lo }
    }
}

impl From<f64> for Dd {
    fn from(x: f64) -> Self {
        Self { hi: x, lo: 0.0 }
    }
}

impl Neg for Dd {
    type Output = Self;

    fn neg(self) -> Self {
        Self {
            hi: -self.hi,
            lo: -self.lo,
        }
    }
}

impl Add for Dd {
    type Output = Self;

    /// Computes the sum with an algorithm that is accurate even under cancellation:
    /// `AccurateDWPlusDW`, algorithm 6 of Joldes et al.
    fn add(self, y: Self) -> Self {
        let (s_hi, s_lo) = two_sum(self.hi, y.hi);
        let (t_hi, t_lo) = two_sum(self.lo, y.lo);
        let (v_hi, v_lo) = fast_two_sum(s_hi, s_lo + t_hi);
        Self::from_pair(fast_two_sum(v_hi, t_lo + v_lo))
    }
}

impl Sub for Dd {
    type Output = Self;

    fn sub(self, y: Self) -> Self {
        self + -y
    }
}

impl Mul for Dd {
    type Output = Self;

    /// Computes the product by `DWTimesDW1`, algorithm 10 of Joldes et al.
    fn mul(self, y: Self) -> Self {
        let (p, e) = two_product(self.hi, y.hi);
        let cross = self.hi * y.lo + self.lo * y.hi;
        Self::from_pair(fast_two_sum(p, e + cross))
    }
}

impl Mul<f64> for Dd {
    type Output = Self;

    /// Computes the product by `DWTimesFP2`, algorithm 8 of Joldes et al.
    fn mul(self, y: f64) -> Self {
        let (p, e) = two_product(self.hi, y);
        Self::from_pair(fast_two_sum(p, e + self.lo * y))
    }
}

impl Div for Dd {
    type Output = Self;

    /// Divides by long division with three quotient digits of 53 bits. The last digit is used for
    /// rounding.
    fn div(self, y: Self) -> Self {
        let q_1 = self.hi / y.hi;
        if !q_1.is_finite() {
            return Self::from(q_1);
        }
        let left = self - y * Self::from(q_1);
        let q_2 = left.hi / y.hi;
        let left = left - y * Self::from(q_2);
        let q_3 = left.hi / y.hi;
        Self::from_pair(fast_two_sum(q_1, q_2)) + Self::from(q_3)
    }
}

impl AddAssign for Dd {
    fn add_assign(&mut self, y: Self) {
        *self = *self + y;
    }
}

impl SubAssign for Dd {
    fn sub_assign(&mut self, y: Self) {
        *self = *self - y;
    }
}

impl MulAssign for Dd {
    fn mul_assign(&mut self, y: Self) {
        *self = *self * y;
    }
}

impl PartialOrd for Dd {
    fn partial_cmp(&self, y: &Self) -> Option<Ordering> {
        match self.hi.partial_cmp(&y.hi)? {
            Ordering::Equal => self.lo.partial_cmp(&y.lo),
            unequal => Some(unequal),
        }
    }
}

mod trigonometry;

#[cfg(test)]
mod tests;
