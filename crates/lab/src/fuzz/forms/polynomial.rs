//! Polynomials in one unknown with integer coefficients, their common divisors and their number of
//! real roots.

use num_bigint::BigInt;
use num_traits::{Signed, Zero};

/// Coefficients in ascending order, without zeros at the end.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Polynomial(Vec<BigInt>);

impl Polynomial {
    /// Creates a polynomial with these coefficients, in ascending order.
    pub(super) fn new(mut coefficients: Vec<BigInt>) -> Self {
        while coefficients.last().is_some_and(Zero::is_zero) {
            coefficients.pop();
        }
        Self(coefficients)
    }

    /// Returns the degree; `None` for zero.
    pub(super) fn degree(&self) -> Option<usize> {
        self.0.len().checked_sub(1)
    }

    pub(super) fn times(&self, other: &Self) -> Self {
        let mut product = vec![BigInt::zero(); self.0.len() + other.0.len()];
        for (i, a) in self.0.iter().enumerate() {
            for (j, b) in other.0.iter().enumerate() {
                product[i + j] += a * b;
            }
        }
        Self::new(product)
    }

    pub(super) fn minus(&self, other: &Self) -> Self {
        let n = self.0.len().max(other.0.len());
        let at = |p: &Self, k: usize| p.0.get(k).cloned().unwrap_or_default();
        Self::new((0..n).map(|k| at(self, k) - at(other, k)).collect())
    }

    fn derivative(&self) -> Self {
        let terms = self.0.iter().enumerate().skip(1);
        Self::new(terms.map(|(k, a)| a * BigInt::from(k)).collect())
    }

    /// Returns the remainder of a division, multiplied by a positive factor.
    fn remainder(&self, divisor: &Self) -> Self {
        let Some(degree) = divisor.degree() else {
            return self.clone();
        };
        let leading = &divisor.0[degree];
        let mut left = self.clone();
        while let Some(n) = left.degree().filter(|n| *n >= degree) {
            let factor = left.0[n].clone();
            let mut next: Vec<BigInt> = left.0.iter().map(|a| a * leading.abs()).collect();
            let factor = if leading.is_negative() {
                -factor
            } else {
                factor
            };
            for (k, d) in divisor.0.iter().enumerate() {
                next[n - degree + k] -= d * &factor;
            }
            left = Self::new(next).reduced();
        }
        left
    }

    /// Divides by the largest integer that divides all coefficients.
    fn reduced(self) -> Self {
        let common = self
            .0
            .iter()
            .fold(BigInt::zero(), |a, b| divisor(a, b.clone()));
        if common.is_zero() {
            return self;
        }
        Self(self.0.into_iter().map(|a| a / &common).collect())
    }

    /// Returns the greatest common divisor, up to a factor.
    pub(super) fn common(&self, other: &Self) -> Self {
        let (mut a, mut b) = (self.clone().reduced(), other.clone().reduced());
        while b.degree().is_some() {
            (a, b) = (b.clone(), a.remainder(&b));
        }
        a
    }

    /// Whether the polynomial has no multiple root, real or complex.
    pub(super) fn is_square_free(&self) -> bool {
        self.common(&self.derivative()).degree() == Some(0)
    }

    /// Returns the number of different real roots, by Sturm's theorem.
    pub(super) fn real_roots(&self) -> usize {
        let mut chain = vec![self.clone(), self.derivative()];
        while let Some(last) = chain.last().filter(|p| p.degree().is_some()) {
            let next = chain[chain.len() - 2].remainder(last);
            chain.push(Self(next.0.into_iter().map(|a| -a).collect()));
        }
        chain.pop();
        let changes = |at_minus: bool| {
            let signs = chain.iter().filter_map(|p| {
                let degree = p.degree()?;
                Some(p.0[degree].is_negative() ^ (at_minus && degree % 2 == 1))
            });
            let signs: Vec<bool> = signs.collect();
            signs.windows(2).filter(|pair| pair[0] != pair[1]).count()
        };
        changes(true).abs_diff(changes(false))
    }
}

fn divisor(a: BigInt, b: BigInt) -> BigInt {
    let (mut a, mut b) = (a.abs(), b.abs());
    while !b.is_zero() {
        (a, b) = (b.clone(), a % &b);
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polynomial(coefficients: &[i64]) -> Polynomial {
        Polynomial::new(coefficients.iter().map(|a| BigInt::from(*a)).collect())
    }

    /// The polynomials are (x − 1)·(x + 2)·(x² + 1) and (x − 1)²·(x + 2)·(x² + 1).
    #[test]
    fn roots_are_counted() {
        let simple = polynomial(&[-1, 1]).times(&polynomial(&[2, 1]));
        let simple = simple.times(&polynomial(&[1, 0, 1]));
        assert_eq!((simple.real_roots(), simple.is_square_free()), (2, true));
        let double = simple.times(&polynomial(&[-1, 1]));
        assert_eq!((double.real_roots(), double.is_square_free()), (2, false));
        assert_eq!(polynomial(&[1, 0, 0, 0, 1]).real_roots(), 0);
        assert_eq!(polynomial(&[0, -1, 0, 1]).real_roots(), 3);
        let common = double.common(&polynomial(&[-3, 2, 1]));
        assert_eq!(common.degree(), Some(1));
    }
}
