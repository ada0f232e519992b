//! Computes singular values by one-sided Jacobi rotations (Hestenes 1958, doi 10.1137/0106005). The
//! method is slow. Small singular values and their vectors are as accurate as large singular
//! values, even if many singular values are equal.

use nalgebra::{DMatrix, DVector};

/// Two columns are orthogonal if their scalar product is below this fraction of the product of
/// their lengths.
const ORTHOGONAL: f64 = 1e-15;

/// Largest number of sweeps over all pairs of columns; convergence is quadratic.
const SWEEPS: usize = 40;

/// `A = left·diag(values)·rightᵀ` with orthonormal columns, values descending and positive.
pub(super) struct Decomposition {
    pub(super) left: DMatrix<f64>,
    pub(super) values: Vec<f64>,
    pub(super) right: DMatrix<f64>,
}

impl Decomposition {
    /// Decomposes a matrix of finite numbers.
    pub(super) fn of(a: &DMatrix<f64>) -> Self {
        let (m, n) = a.shape();
        if m < n {
            let Self {
                left,
                values,
                right,
            } = Self::of(&a.transpose());
            return Self {
                left: right,
                values,
                right: left,
            };
        }
        let (mut u, mut v) = (a.clone(), DMatrix::identity(n, n));
        for _ in 0..SWEEPS {
            let mut is_done = true;
            for i in 0..n {
                for j in i + 1..n {
                    is_done &= !rotate(&mut u, &mut v, [i, j]);
                }
            }
            if is_done {
                break;
            }
        }
        let lengths: Vec<f64> = u.column_iter().map(|c| c.norm()).collect();
        let mut order: Vec<usize> = (0..n).filter(|&k| lengths[k] > 0.0).collect();
        order.sort_by(|a, b| lengths[*b].total_cmp(&lengths[*a]));
        Self {
            left: DMatrix::from_fn(m, order.len(), |i, k| u[(i, order[k])] / lengths[order[k]]),
            values: order.iter().map(|&k| lengths[k]).collect(),
            right: DMatrix::from_fn(n, order.len(), |i, k| v[(i, order[k])]),
        }
    }

    /// Returns the part of the decomposition with singular values above this fraction of the
    /// largest singular value.
    pub(super) fn above(self, share: f64) -> Self {
        let largest = self.values.first().copied().unwrap_or(0.0);
        let rank = self.values.iter().filter(|x| **x > share * largest).count();
        Self {
            left: self.left.columns(0, rank).into_owned(),
            right: self.right.columns(0, rank).into_owned(),
            values: self.values[..rank].to_vec(),
        }
    }

    pub(super) fn rank(&self) -> usize {
        self.values.len()
    }

    /// Returns the vector x of smallest norm that minimises `|A·x − b|`.
    pub(super) fn solve(&self, b: &DVector<f64>) -> DVector<f64> {
        let along = self.left.transpose() * b;
        &self.right * DVector::from_fn(self.rank(), |k, _| along[k] / self.values[k])
    }

    /// Returns the vector y of smallest norm that minimises `|Aᵀ·y − b|`.
    pub(super) fn solve_transposed(&self, b: &DVector<f64>) -> DVector<f64> {
        let along = self.right.transpose() * b;
        &self.left * DVector::from_fn(self.rank(), |k, _| along[k] / self.values[k])
    }
}

/// Rotates two columns of u so that they are orthogonal; returns whether they were not orthogonal
/// before.
fn rotate(u: &mut DMatrix<f64>, v: &mut DMatrix<f64>, [i, j]: [usize; 2]) -> bool {
    let [a, b] = [i, j].map(|k| u.column(k).norm_squared());
    let product = u.column(i).dot(&u.column(j));
    if product == 0.0 || product.abs() <= ORTHOGONAL * (a * b).sqrt() {
        return false;
    }
    let zeta = (b - a) / (2.0 * product);
    let t = zeta.signum() / (zeta.abs() + zeta.hypot(1.0));
    let c = 1.0 / t.hypot(1.0);
    for matrix in [u, v] {
        for k in 0..matrix.nrows() {
            let [x, y] = [matrix[(k, i)], matrix[(k, j)]];
            matrix[(k, i)] = c * (x - t * y);
            matrix[(k, j)] = c * (y + t * x);
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use suite::numbers::Numbers;

    /// The matrices are products of orthogonal reflections and known singular values, some of which
    /// are equal or tiny.
    #[test]
    fn planted_values_are_found() {
        let mut numbers = Numbers::new(7);
        for (m, n) in [(6, 4), (4, 6), (9, 9)] {
            let mut reflection = |n: usize| {
                let x = DVector::from_fn(n, |_, _| numbers.unit()).normalize();
                DMatrix::identity(n, n) - 2.0 * &x * x.transpose()
            };
            let planted = [3.0, 2.0, 2.0, 1e-7];
            let mut a = DMatrix::zeros(m, n);
            for (k, value) in planted.iter().enumerate() {
                a[(k, k)] = *value;
            }
            let a = reflection(m) * a * reflection(n);
            let found = Decomposition::of(&a).above(1e-12);
            assert_eq!(found.rank(), 4);
            for (value, right) in found.values.iter().zip(planted) {
                assert!((value - right).abs() < 1e-14, "{value:e} {right:e}");
            }
            let values = DMatrix::from_diagonal(&DVector::from_vec(found.values.clone()));
            let again = &found.left * values * found.right.transpose();
            assert!((again - &a).norm() < 1e-14);
            let x = DVector::from_fn(n, |_, _| numbers.unit());
            let b = &a * &x;
            assert!((&a * found.solve(&b) - b).norm() < 1e-14);
        }
    }
}
