//! Fractions of integers with 128 bits, and the kernels of matrices of such fractions.

use std::ops::{Add, Mul, Sub};

/// A fraction in lowest terms; the denominator is positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Fraction {
    over: i128,
    under: i128,
}

fn common(a: i128, b: i128) -> i128 {
    let (mut a, mut b) = (a.abs(), b.abs());
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

fn times(a: i128, b: i128) -> i128 {
    a.checked_mul(b).expect("small numbers")
}

impl Fraction {
    pub(super) const ZERO: Self = Self { over: 0, under: 1 };
    pub(super) const ONE: Self = Self { over: 1, under: 1 };

    pub(super) fn new(over: i128, under: i128) -> Self {
        assert_ne!(under, 0, "a denominator");
        let factor = common(over, under) * under.signum();
        Self {
            over: over / factor,
            under: under / factor,
        }
    }

    pub(super) fn signum(self) -> i128 {
        self.over.signum()
    }

    pub(super) fn inverse(self) -> Self {
        Self::new(self.under, self.over)
    }

    pub(super) fn to_f64(self) -> f64 {
        self.over as f64 / self.under as f64
    }
}

impl From<i128> for Fraction {
    fn from(over: i128) -> Self {
        Self { over, under: 1 }
    }
}

impl Mul for Fraction {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        // Common factors are removed before the products can overflow.
        let [a, b] = [
            common(self.over, other.under).max(1),
            common(other.over, self.under).max(1),
        ];
        Self::new(
            times(self.over / a, other.over / b),
            times(self.under / b, other.under / a),
        )
    }
}

impl Add for Fraction {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let factor = common(self.under, other.under);
        let [left, right] = [self.under / factor, other.under / factor];
        let over = times(self.over, right).checked_add(times(other.over, left));
        Self::new(over.expect("small numbers"), times(self.under, right))
    }
}

impl Sub for Fraction {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + other * Self::from(-1)
    }
}

pub(super) type Row = Vec<Fraction>;

pub(super) fn dot(a: &[Fraction], b: &[Fraction]) -> Fraction {
    let products = a.iter().zip(b).map(|(a, b)| *a * *b);
    products.fold(Fraction::ZERO, |sum, x| sum + x)
}

/// Returns a basis of the vectors of length n that all rows map to zero.
pub(super) fn kernel(rows: &[&Row], n: usize) -> Vec<Row> {
    let mut rows: Vec<Row> = rows.iter().map(|row| (*row).clone()).collect();
    let mut pivots: Vec<usize> = Vec::new();
    for j in 0..n {
        let step = pivots.len();
        let Some(i) = (step..rows.len()).find(|i| rows[*i][j].signum() != 0) else {
            continue;
        };
        rows.swap(step, i);
        let factor = rows[step][j].inverse();
        rows[step].iter_mut().for_each(|x| *x = *x * factor);
        let own = rows[step].clone();
        for (k, row) in rows.iter_mut().enumerate() {
            let factor = row[j];
            if k != step && factor.signum() != 0 {
                row.iter_mut()
                    .zip(&own)
                    .for_each(|(x, own)| *x = *x - factor * *own);
            }
        }
        pivots.push(j);
    }
    let free = (0..n).filter(|j| !pivots.contains(j));
    let vector = |free: usize| {
        let mut x = vec![Fraction::ZERO; n];
        x[free] = Fraction::ONE;
        for (row, &j) in rows.iter().zip(&pivots) {
            x[j] = Fraction::ZERO - row[free];
        }
        x
    };
    free.map(vector).collect()
}

/// Returns all sets of k numbers below n.
pub(super) fn sets(n: usize, k: usize) -> Vec<Vec<usize>> {
    if k == 0 {
        return vec![Vec::new()];
    }
    let with_last = |last: usize| {
        sets(last, k - 1).into_iter().map(move |mut set| {
            set.push(last);
            set
        })
    };
    (k - 1..n).flat_map(with_last).collect()
}
