//! Singular vectors of small matrices by one-sided Jacobi rotations. The rotations are used for
//! blocks between two null spaces, which have a few rows and columns. The results are not used as
//! evidence for ranks; `singular_values` computes this evidence.
//!
//! Source: M. R. Hestenes, Inversion of matrices by biorthogonalization and related results, J.
//! SIAM 6 (1958) 51–90.

use crate::limits::{JACOBI_SWEEPS, ORTHOGONAL};
use crate::{Matrix, kernels};

/// The decomposition `A = U·diag(σ)·Vᵀ` of an m×n matrix with k = min(m, n). The columns of U (m×k)
/// are the left singular vectors, and the columns of V (n×k) are the right singular vectors. The
/// singular values σ are sorted, largest first. If σ = 0, the column of U, or of V if A is wide, is
/// zero.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SmallSvd {
    /// Left singular vectors, m × k.
    pub u: Matrix,
    /// Singular values, largest first, k values.
    pub sigma: Vec<f64>,
    /// Right singular vectors, n × k.
    pub v: Matrix,
}

/// Computes the singular values and vectors of a small matrix of finite entries.
///
/// ```
/// use pfaff_linalg::{Matrix, small_svd};
/// let svd = small_svd(&Matrix::from_rows(&[[0.0, 2.0], [3.0, 0.0], [0.0, 0.0]]));
/// assert_eq!(svd.sigma, [3.0, 2.0]);
/// assert_eq!((svd.u[(1, 0)].abs(), svd.v[(0, 0)].abs()), (1.0, 1.0));
/// ```
#[must_use]
pub fn small_svd(a: &Matrix) -> SmallSvd {
    if a.nrows() < a.ncols() {
        let SmallSvd { u, sigma, v } = small_svd(&a.transpose());
        return SmallSvd { u: v, sigma, v: u };
    }
    let n = a.ncols();
    // Columns stored as rows, so that they are contiguous.
    let mut columns = a.transpose();
    let mut turned = Matrix::identity(n);
    for _ in 0..JACOBI_SWEEPS {
        let mut moved = false;
        for p in 0..n {
            for q in p + 1..n {
                moved |= rotate(&mut columns, &mut turned, p, q);
            }
        }
        if !moved {
            break;
        }
    }
    let size: Vec<f64> = (0..n).map(|j| kernels::norm(columns.row(j))).collect();
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| size[j].total_cmp(&size[i]));
    SmallSvd {
        u: Matrix::from_fn(a.nrows(), n, |i, k| match size[order[k]] {
            0.0 => 0.0,
            sigma => columns[(order[k], i)] / sigma,
        }),
        sigma: order.iter().map(|&j| size[j]).collect(),
        v: Matrix::from_fn(n, n, |i, k| turned[(order[k], i)]),
    }
}

/// Eigenvalues and eigenvectors of a small symmetric matrix.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SymmetricEigen {
    /// Eigenvalues, largest first.
    pub values: Vec<f64>,
    /// Orthonormal eigenvectors in columns.
    pub vectors: Matrix,
}

/// Returns eigenvalues and eigenvectors of a small symmetric matrix A with finite entries. The
/// eigenvalues and eigenvectors are computed from the singular values of `A + ‖A‖·I`. The errors of
/// the eigenvalues are a few rounding errors of ‖A‖.
///
/// ```
/// use pfaff_linalg::{Matrix, symmetric_eigen};
/// let eigen = symmetric_eigen(&Matrix::from_rows(&[[0.0, 2.0], [2.0, 3.0]]));
/// assert!((eigen.values[0] - 4.0).abs() < 1e-14 && (eigen.values[1] + 1.0).abs() < 1e-14);
/// ```
///
/// # Panics
/// Panics if A is not square.
#[must_use]
pub fn symmetric_eigen(a: &Matrix) -> SymmetricEigen {
    let n = a.nrows();
    assert_eq!(n, a.ncols(), "a square matrix");
    let shift = a.frobenius_norm();
    let shifted = Matrix::from_fn(n, n, |i, k| {
        let own = if i == k { shift } else { 0.0 };
        0.5 * (a[(i, k)] + a[(k, i)]) + own
    });
    let SmallSvd { sigma, v, .. } = small_svd(&shifted);
    SymmetricEigen {
        values: sigma.into_iter().map(|s| s - shift).collect(),
        vectors: v,
    }
}

/// Makes columns p and q orthogonal. Returns whether a rotation was necessary.
fn rotate(columns: &mut Matrix, turned: &mut Matrix, p: usize, q: usize) -> bool {
    let (a, b) = (kernels::norm(columns.row(p)), kernels::norm(columns.row(q)));
    let c = kernels::dot(columns.row(p), columns.row(q));
    if c.is_nan() || c.abs() <= ORTHOGONAL * a * b || a == 0.0 || b == 0.0 {
        return false;
    }
    let zeta = (b / a - a / b) / (2.0 * (c / a / b));
    let t = zeta.signum() / (zeta.abs() + zeta.hypot(1.0));
    let cos = t.hypot(1.0).recip();
    let sin = cos * t;
    for of in [columns, turned] {
        for k in 0..of.ncols() {
            let (x, y) = (of[(p, k)], of[(q, k)]);
            of[(p, k)] = cos * x - sin * y;
            of[(q, k)] = sin * x + cos * y;
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_give_the_matrix_back() {
        for (m, n) in [(1, 1), (3, 2), (2, 5), (6, 6)] {
            let a = Matrix::from_fn(m, n, |i, j| (1.0 + (3 * i + 7 * j) as f64).sin());
            let SmallSvd { u, sigma, v } = small_svd(&a);
            assert!(sigma.is_sorted_by(|a, b| a >= b));
            let scaled = Matrix::from_fn(n, sigma.len(), |j, k| v[(j, k)] * sigma[k]);
            let back = u.product(&scaled.transpose());
            for (x, y) in back.as_slice().iter().zip(a.as_slice()) {
                assert!((x - y).abs() < 1e-14, "{m}×{n}: {x} {y}");
            }
        }
    }

    /// For an indefinite and singular matrix, A·W = W·diag(λ) and WᵀW = I.
    #[test]
    fn eigenvectors_of_symmetric_matrices_are_put_back() {
        let given = [5.0, 1e-3, 0.0, 0.0, -2.0];
        let frame = small_svd(&Matrix::from_fn(5, 5, |i, j| {
            (1.0 + (3 * i + 7 * j * j) as f64).sin()
        }))
        .u;
        let scaled = Matrix::from_fn(5, 5, |i, k| frame[(i, k)] * given[k]);
        let SymmetricEigen { values, vectors } =
            symmetric_eigen(&scaled.product(&frame.transpose()));
        for (value, exact) in values.iter().zip(given) {
            assert!((value - exact).abs() < 1e-14, "{values:?}");
        }
        let square = vectors.transpose().product(&vectors);
        for (i, k) in (0..5).flat_map(|i| (0..5).map(move |k| (i, k))) {
            let one = f64::from(u8::from(i == k));
            assert!((square[(i, k)] - one).abs() < 1e-14);
        }
    }

    #[test]
    fn graded_columns_keep_their_digits() {
        let a = Matrix::from_rows(&[[1.0, 1e-12], [1.0, -1e-12]]);
        let svd = small_svd(&a);
        assert!((svd.sigma[1] / (1e-12 * 2f64.sqrt()) - 1.0).abs() < 1e-14);
    }

    /// For AᵀA = [1 c; c 1 + c²], σ = √(1 + c²/4) ± c/2. The columns are orthogonal to 256 rounding
    /// errors.
    #[test]
    fn nearly_orthogonal_columns_are_turned_too() {
        let c = 256.0 * f64::EPSILON;
        let svd = small_svd(&Matrix::from_rows(&[[1.0, c], [0.0, 1.0]]));
        for (sigma, exact) in svd.sigma.iter().zip([1.0 + c / 2.0, 1.0 - c / 2.0]) {
            assert!((sigma - exact).abs() <= 4.0 * f64::EPSILON, "{sigma}");
        }
    }
}
