//! Arithmetic modulo a prime, for tests without a tolerance whether a minor is zero.
//!
//! A determinant that is not zero modulo one prime is not zero. A determinant that is zero modulo
//! primes whose product exceeds Hadamard's bound is zero. Every finite `f64` is an integer times a
//! power of two, and a power of two is a unit modulo an odd prime, so the entries of constraint
//! matrices are mapped without error. The module `pfaff_rank::modular` chooses rows and minors.
//!
//! The primes have 62 bits and are drawn from a fixed pseudo-random stream. Primes of a special
//! form are not suitable. For example, modulo the convenient 2⁶¹ − 1 the determinant of [[1, 1],
//! [1, 2⁶¹]] is zero, and binary data contain many powers of two.
//!
//! Source: P. L. Montgomery, Modular multiplication without trial division, Math. Comp. 44 (1985)
//! 519–521; the bases of the primality test after J. Sorenson, J. Webster, Strong pseudoprimes to
//! twelve prime bases, Math. Comp. 86 (2017) 985–1003.

use crate::limits::PRIMES_READY;
use std::sync::LazyLock;

/// Integers modulo an odd prime below 2⁶². Elements are [`Residue`]s.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct PrimeField {
    p: u64,
    /// The value −p⁻¹ modulo 2⁶⁴.
    neg_inverse: u64,
    /// The value 2¹²⁸ modulo p.
    r_squared: u64,
}

/// An element x of a field, stored as `x·2⁶⁴ mod p`. Equal representations mean equal elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Residue(u64);

impl Residue {
    pub(crate) const ZERO: Self = Self(0);

    pub(crate) fn is_zero(self) -> bool {
        self.0 == 0
    }
}

impl PrimeField {
    /// Returns the field of the odd number `p < 2⁶²`. Inverses exist if `p` is a prime.
    fn new(p: u64) -> Self {
        // Newton's iteration doubles the number of correct bits, from 3 to 96.
        let mut inverse = p;
        for _ in 0..5 {
            inverse = inverse.wrapping_mul(2_u64.wrapping_sub(p.wrapping_mul(inverse)));
        }
        let r = (u128::from(u64::MAX) + 1) % u128::from(p);
        Self {
            p,
            neg_inverse: inverse.wrapping_neg(),
            r_squared: (r * r % u128::from(p)) as u64,
        }
    }

    pub(crate) fn p(self) -> u64 {
        self.p
    }

    /// Returns the class of `x`.
    pub(crate) fn integer(self, x: u64) -> Residue {
        self.times(Residue(x % self.p), Residue(self.r_squared))
    }

    /// Returns the representative in `0..p`.
    pub(crate) fn value(self, x: Residue) -> u64 {
        self.reduce(u128::from(x.0))
    }

    pub(crate) fn minus(self, x: Residue, y: Residue) -> Residue {
        let (difference, borrow) = x.0.overflowing_sub(y.0);
        Residue(if borrow {
            difference.wrapping_add(self.p)
        } else {
            difference
        })
    }

    pub(crate) fn plus(self, x: Residue, y: Residue) -> Residue {
        Residue(self.below_p(x.0 + y.0))
    }

    pub(crate) fn negative(self, x: Residue) -> Residue {
        self.minus(Residue::ZERO, x)
    }

    pub(crate) fn times(self, x: Residue, y: Residue) -> Residue {
        Residue(self.reduce(u128::from(x.0) * u128::from(y.0)))
    }

    /// Returns x·y, where x is a residue and y is an integer below 2⁶²; the result is an integer in
    /// `0..p`.
    pub(crate) fn times_plain(self, x: Residue, y: u64) -> u64 {
        self.reduce(u128::from(x.0) * u128::from(y))
    }

    /// Returns xᵉ.
    pub(crate) fn power(self, x: Residue, mut e: u64) -> Residue {
        let (mut square, mut product) = (x, self.integer(1));
        while e > 0 {
            if e & 1 == 1 {
                product = self.times(product, square);
            }
            square = self.times(square, square);
            e >>= 1;
        }
        product
    }

    /// Returns x⁻¹ by Fermat's theorem, or zero if x is zero.
    pub(crate) fn inverse(self, x: Residue) -> Residue {
        self.power(x, self.p - 2)
    }

    /// Computes `y ← y − s·x` over the shorter length.
    pub(crate) fn subtract(self, s: Residue, x: &[Residue], y: &mut [Residue]) {
        for (y, &x) in y.iter_mut().zip(x) {
            *y = self.minus(*y, self.times(s, x));
        }
    }

    /// Returns t·2⁻⁶⁴ mod p, for t < p·2⁶⁴.
    fn reduce(self, t: u128) -> u64 {
        let m = (t as u64).wrapping_mul(self.neg_inverse);
        self.below_p(((t + u128::from(m) * u128::from(self.p)) >> 64) as u64)
    }

    fn below_p(self, x: u64) -> u64 {
        if x >= self.p { x - self.p } else { x }
    }
}

/// Fields of different primes, always in the same order.
pub(crate) fn fields() -> impl Iterator<Item = PrimeField> {
    static FIRST: LazyLock<(Vec<PrimeField>, Stream)> = LazyLock::new(|| {
        let mut stream = Stream(0x243f_6a88_85a3_08d3); // digits of π
        ((&mut stream).take(PRIMES_READY).collect(), stream)
    });
    let (ready, more) = &*FIRST;
    ready.iter().copied().chain(more.clone())
}

/// SplitMix64 (Steele, Lea, Flood 2014), filtered for primes. Two equal primes among n have
/// probability n²/2⁵⁶. The reconstruction detects this case, because the second prime has no
/// inverse of the first.
#[derive(Debug, Clone)]
struct Stream(u64);

impl Iterator for Stream {
    type Item = PrimeField;

    fn next(&mut self) -> Option<PrimeField> {
        loop {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            let candidate = ((z ^ (z >> 31)) >> 2) | (1 << 61) | 1;
            if is_prime(candidate) {
                return Some(PrimeField::new(candidate));
            }
        }
    }
}

/// Performs the Miller–Rabin test with the first twelve primes as bases. No composite number below
/// 3.1e23 passes this test.
fn is_prime(n: u64) -> bool {
    const BASES: [u64; 12] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37];
    if BASES.iter().any(|b| n.is_multiple_of(*b)) {
        return BASES.contains(&n);
    }
    if n < 2 {
        return false;
    }
    let field = PrimeField::new(n);
    let twos = (n - 1).trailing_zeros();
    let one = field.integer(1);
    let minus_one = field.negative(one);
    BASES.iter().all(|&base| {
        let mut x = field.power(field.integer(base), (n - 1) >> twos);
        if x == one {
            return true;
        }
        for _ in 0..twos {
            if x == minus_one {
                return true;
            }
            x = field.times(x, x);
        }
        false
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::PRIME_BITS;

    /// Compares with `u128` remainders, and with Fermat's theorem for the inverse.
    #[test]
    fn arithmetic_agrees_with_remainders() {
        for field in fields().take(4).chain([PrimeField::new(7)]) {
            let p = u128::from(field.p());
            for (a, b) in [
                (3, 5),
                (field.p() - 1, field.p() - 1),
                (1 << 61, 123_456_789_123),
            ] {
                let (x, y) = (field.integer(a), field.integer(b));
                let (a, b) = (u128::from(a), u128::from(b));
                assert_eq!(u128::from(field.value(field.times(x, y))), a * b % p);
                assert_eq!(u128::from(field.value(field.plus(x, y))), (a + b) % p);
                assert_eq!(
                    u128::from(field.value(field.minus(x, y))),
                    (a % p + p - b % p) % p
                );
                if !x.is_zero() {
                    assert_eq!(field.value(field.times(x, field.inverse(x))), 1);
                }
            }
        }
    }

    #[test]
    fn primes_by_trial_division() {
        let prime = |n: u64| {
            n > 1
                && (2..n)
                    .take_while(|d| d * d <= n)
                    .all(|d| !n.is_multiple_of(d))
        };
        assert!((0..2000).all(|n| is_prime(n) == prime(n)));
        // Examples: a Carmichael number, a strong pseudoprime to 2, 3, 5 and 7, the Mersenne prime,
        // and its neighbour.
        assert!(!is_prime(561) && !is_prime(3_215_031_751));
        assert!(is_prime((1 << 61) - 1) && !is_prime((1 << 61) + 1));
    }

    #[test]
    fn primes_differ_and_have_their_bits() {
        let mut primes: Vec<u64> = fields().take(PRIMES_READY + 3).map(PrimeField::p).collect();
        assert!(
            primes
                .iter()
                .all(|&p| p.ilog2() == PRIME_BITS && is_prime(p))
        );
        primes.sort_unstable();
        primes.dedup();
        assert_eq!(primes.len(), PRIMES_READY + 3);
    }
}
