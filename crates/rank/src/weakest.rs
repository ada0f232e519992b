//! Computes the combination of rows that is closest to zero. The combination shows which rows are
//! nearly dependent, and by how much.

use crate::limits::{DIRECTION_ROUNDING, INVERSE_ITERATIONS};
use linalg::{Matrix, PivotedQr, kernels};

/// Weights of rows that nearly cancel.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct WeakestCombination {
    /// Norm of the combination: about the smallest singular value of the rows.
    pub sigma: f64,
    /// Unit weights of the rows.
    pub weights: Vec<f64>,
}

/// Returns the smallest singular value of rows and its left singular vector, by inverse iteration
/// with `C·Cᵀ = P·Rᵀ·R·Pᵀ`. If rows are dependent to the last digit of `f64`, the iteration uses
/// `C·Cᵀ + δ²·I`, where δ is the rounding of the largest row. Returns `None` without rows.
///
/// ```
/// use linalg::Matrix;
/// use pfaff_rank::weakest_combination;
/// let c = Matrix::from_rows(&[[0.0, 1.0], [1e-9, 1.0]]);
/// let weakest = weakest_combination(&c).unwrap();
/// assert!((weakest.sigma / (1e-9 / 2f64.sqrt()) - 1.0).abs() < 1e-6);
/// assert!((weakest.weights[0] + weakest.weights[1]).abs() < 1e-6);
/// ```
#[must_use]
pub fn weakest_combination(rows: &Matrix) -> Option<WeakestCombination> {
    by_inverse_iteration(rows).or_else(|| by_inverse_iteration(&beside_rounding(rows)))
}

/// Appends δ·I to the rows: `[C, δ·I]`. δ is the rounding of the rows.
fn beside_rounding(rows: &Matrix) -> Matrix {
    let (r, n) = (rows.nrows(), rows.ncols());
    let largest = (0..r).map(|i| kernels::norm(rows.row(i)));
    let rounding = DIRECTION_ROUNDING * largest.fold(0.0, f64::max);
    Matrix::from_fn(r, n + r, |i, j| match j.checked_sub(n) {
        None => rows[(i, j)],
        Some(k) if k == i => rounding,
        Some(_) => 0.0,
    })
}

fn by_inverse_iteration(rows: &Matrix) -> Option<WeakestCombination> {
    let r = rows.nrows();
    let qr = PivotedQr::of_rows(rows.clone());
    if r == 0 || r > qr.steps() || qr.r_diagonal().any(|d| d == 0.0) {
        return None;
    }
    // Practically any initial vector has a component along the weakest combination.
    let mut y: Vec<f64> = (0..r).map(|i| 1.0 + i as f64 / 7.0).collect();
    let mut growth = 0.0;
    for _ in 0..INVERSE_ITERATIONS {
        let size = kernels::norm(&y);
        y.iter_mut().for_each(|y| *y /= size);
        qr.solve_r_transpose(&mut y);
        qr.solve_r(&mut y);
        growth = kernels::norm(&y);
    }
    let mut weights = vec![0.0; r];
    for (y, &row) in y.iter().zip(qr.permutation()) {
        weights[row] = y / growth;
    }
    Some(WeakestCombination {
        sigma: growth.sqrt().recip(),
        weights,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two equal rows and a third one: the weights are (1, −1, 0)/√2 for any scale.
    #[test]
    fn equal_rows_cancel() {
        for scale in [1e-100, 1.0, 1e100] {
            let rows = [[0.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.6, 0.8, 1.0]];
            let c = Matrix::from_rows(&rows.map(|row| row.map(|x| x * scale)));
            let weakest = weakest_combination(&c).expect("rows");
            let [a, b, other] = [0, 1, 2].map(|i| weakest.weights[i]);
            assert!((a.abs() - 0.5_f64.sqrt()).abs() < 1e-9 && (a + b).abs() < 1e-9);
            assert!(other.abs() < 1e-9, "{other}");
            assert!(
                weakest.sigma <= 2.0 * DIRECTION_ROUNDING * 1.5 * scale,
                "{}",
                weakest.sigma
            );
        }
        assert_eq!(weakest_combination(&Matrix::zeros(0, 3)), None);
    }
}
