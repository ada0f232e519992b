//! LU decomposition with partial pivoting of a dense real or complex matrix: P·A = L·U, row by row
//! in one array.
//!
//! This factorisation is intended for the small systems of plain problems, and has no blocking or
//! scaling.

use super::complex::Complex;
use std::ops::{Add, Div, Mul, Sub};

/// A number type for the decomposition.
pub(crate) trait Scalar:
    Copy + Default + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// Returns the size by which pivots are compared: |x|, or |Re x| + |Im x|.
    fn size(self) -> f64;
}

impl Scalar for f64 {
    fn size(self) -> f64 {
        self.abs()
    }
}

impl Scalar for Complex {
    fn size(self) -> f64 {
        self.re.abs() + self.im.abs()
    }
}

/// The factors of an n×n matrix. `Lu::new` allocates the factors, and [`Lu::factor`] computes them.
#[derive(Debug, Clone)]
pub(crate) struct Lu<T> {
    n: usize,
    /// Entries row by row. U is on and above the diagonal, and the multipliers of L are below it.
    a: Vec<T>,
    /// The row that is exchanged with row k in step k.
    exchanged: Vec<usize>,
}

impl<T: Scalar> Lu<T> {
    pub(crate) fn new(n: usize) -> Self {
        Self {
            n,
            a: vec![T::default(); n * n],
            exchanged: vec![0; n],
        }
    }

    /// Decomposes the matrix with the entries `entry(row, column)`. The result `Err(k)` means that
    /// column k has no pivot, because none of its entries is non-zero and finite.
    pub(crate) fn factor(&mut self, entry: impl Fn(usize, usize) -> T) -> Result<(), usize> {
        let n = self.n;
        for (i, row) in self.a.chunks_exact_mut(n.max(1)).enumerate() {
            for (j, x) in row.iter_mut().enumerate() {
                *x = entry(i, j);
            }
        }
        for k in 0..n {
            let (mut pivot, mut largest) = (k, self.a[k * n + k].size());
            for i in k + 1..n {
                let size = self.a[i * n + k].size();
                if size > largest {
                    (pivot, largest) = (i, size);
                }
            }
            if !(largest > 0.0 && largest.is_finite()) {
                return Err(k);
            }
            self.exchanged[k] = pivot;
            if pivot != k {
                for j in 0..n {
                    self.a.swap(k * n + j, pivot * n + j);
                }
            }
            let (upper, lower) = self.a.split_at_mut((k + 1) * n);
            let pivot_row = &upper[k * n..];
            for row in lower.chunks_exact_mut(n) {
                let factor = row[k] / pivot_row[k];
                row[k] = factor;
                for j in k + 1..n {
                    row[j] = row[j] - factor * pivot_row[j];
                }
            }
        }
        Ok(())
    }

    /// Overwrites `x` with A⁻¹·x.
    pub(crate) fn solve(&self, x: &mut [T]) {
        let n = self.n;
        for k in 0..n {
            x.swap(k, self.exchanged[k]);
        }
        for i in 0..n {
            for j in 0..i {
                x[i] = x[i] - self.a[i * n + j] * x[j];
            }
        }
        for i in (0..n).rev() {
            for j in i + 1..n {
                x[i] = x[i] - self.a[i * n + j] * x[j];
            }
            x[i] = x[i] / self.a[i * n + i];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A matrix with 1 + i on the diagonal. The decomposition of the matrix needs exchanges, and
    /// the solutions are known by construction.
    #[test]
    fn solves_with_exchanges_and_names_the_column_without_pivot() {
        let a = [[0.0, 2.0, 1.0], [4.0, 1.0, 0.0], [2.0, 0.0, 3.0]];
        let mut real = Lu::new(3);
        real.factor(|i, j| a[i][j]).expect("regular");
        let mut x = [4.0 + 3.0, 4.0 + 2.0, 2.0 + 9.0];
        real.solve(&mut x);
        for (x, expected) in x.iter().zip([1.0, 2.0, 3.0]) {
            assert!((x - expected).abs() < 1e-15, "{x}");
        }
        assert_eq!(real.factor(|_, j| if j == 1 { 0.0 } else { 1.0 }), Err(1));

        let entry = |i: usize, j: usize| Complex {
            re: a[i][j],
            im: if i == j { 1.0 } else { 0.0 },
        };
        let mut complex = Lu::new(3);
        complex.factor(entry).expect("regular");
        let expected = [(1.0, -2.0), (0.5, 3.0), (-1.0, 1.0)].map(|(re, im)| Complex { re, im });
        let mut x = [Complex::default(); 3];
        for i in 0..3 {
            for j in 0..3 {
                x[i] = x[i] + entry(i, j) * expected[j];
            }
        }
        complex.solve(&mut x);
        for (x, e) in x.iter().zip(expected) {
            assert!((*x - e).size() < 4e-15, "{x:?} {e:?}");
        }
    }

    #[test]
    fn nothing_overflows_before_the_quotient_does() {
        let big = Complex {
            re: 1e200,
            im: 1e200,
        };
        assert_eq!(big / big, Complex { re: 1.0, im: 0.0 });
    }
}
