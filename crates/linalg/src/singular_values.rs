//! Singular values, as evidence for rank decisions.
//!
//! One-sided Jacobi rotations on the rows of R from a pivoted QR: slower than bidiagonalisation but
//! accurate for graded matrices, short, and without iteration limits that fail. Large matrices go to
//! faer where that feature is on. No singular vectors: null spaces come from the row basis.
//!
//! Source: Z. Drmač, K. Veselić, New fast and accurate Jacobi SVD algorithm I, SIAM J. Matrix
//! Anal. Appl. 29 (2008) 1322–1342.

use crate::{Matrix, PivotedQr, equilibrate, kernels};

/// Sweeps at most; after a pivoted QR four to six are needed, convergence is quadratic.
const SWEEPS_MAX: usize = 40;

/// Squared rows below this (relative to a largest entry of one) are zero for every purpose; keeps
/// the products of two of them clear of underflow.
const ZERO_SQUARED: f64 = 1e-150;

/// All `min(m, n)` singular values of `a`, largest first.
///
/// Entries must be finite; otherwise the values are meaningless (but there are still as many).
///
/// ```
/// use linalg::{Matrix, singular_values};
/// let sigma = singular_values(&Matrix::from_rows(&[[3.0, 0.0], [4.0, 5.0]]));
/// assert!((sigma[0] - 45f64.sqrt()).abs() < 1e-14); // AᵀA has eigenvalues 45 and 5
/// assert!((sigma[1] - 5f64.sqrt()).abs() < 1e-14);
/// ```
pub fn singular_values(a: &Matrix) -> Vec<f64> {
    #[cfg(feature = "faer")]
    if a.nrows().min(a.ncols()) >= crate::large::CROSS_OVER
        && let Some(sigma) = crate::large::singular_values(a)
    {
        return sigma;
    }
    by_jacobi(a)
}

/// [`singular_values`] by our own kernels at every size.
pub(crate) fn by_jacobi(a: &Matrix) -> Vec<f64> {
    let e = equilibrate::unit_exponent(a.as_slice());
    let mut scaled = a.clone();
    for x in scaled.as_mut_slice() {
        *x = equilibrate::scale(*x, e);
    }
    // The second QR makes a wide R square and moves it closer to a diagonal: fewer sweeps.
    let r = PivotedQr::of_rows(scaled).r();
    let mut r = PivotedQr::of_rows(r).r();
    orthogonalise_rows(&mut r);
    let mut sigma: Vec<f64> = (0..r.nrows())
        .map(|i| equilibrate::scale(kernels::norm(r.row(i)), -e))
        .collect();
    sigma.sort_by(|x, y| y.total_cmp(x));
    sigma
}

/// Rotates pairs of rows until all are orthogonal to working precision.
fn orthogonalise_rows(r: &mut Matrix) {
    let n = r.nrows();
    // The rounding error of a dot product: below it there is nothing left to rotate.
    let tolerance = f64::EPSILON * r.ncols() as f64;
    let mut squares = vec![0.0; n];
    for _ in 0..SWEEPS_MAX {
        for i in 0..n {
            squares[i] = kernels::dot(r.row(i), r.row(i));
        }
        let mut rotated = false;
        for i in 0..n {
            for j in i + 1..n {
                let (a, b) = (squares[i], squares[j]);
                if a.min(b) <= ZERO_SQUARED {
                    continue;
                }
                let (x, y) = r.two_rows_mut(i, j);
                let g = kernels::dot(x, y);
                if g.abs() <= tolerance * (a * b).sqrt() {
                    continue;
                }
                rotated = true;
                let zeta = (b - a) / (2.0 * g);
                // An overflow of ζ² turns into t = 0, a rotation too small to matter.
                let t = zeta.signum() / (zeta.abs() + (1.0 + zeta * zeta).sqrt());
                let c = 1.0 / (1.0 + t * t).sqrt();
                let s = c * t;
                for (x, y) in x.iter_mut().zip(y) {
                    let (x_0, y_0) = (*x, *y);
                    *x = c * x_0 - s * y_0;
                    *y = s * x_0 + c * y_0;
                }
                squares[i] = (a - t * g).max(0.0);
                squares[j] = b + t * g;
            }
        }
        if !rotated {
            break;
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn hilbert_of_order_three() {
        // Eigenvalues of the Hilbert matrix H₃ (symmetric, so also singular values); digits from
        // the roots of λ³ − (23/15)λ² + (127/720)λ − 1/2160.
        let h = Matrix::from_fn(3, 3, |i, j| 1.0 / (i + j + 1) as f64);
        let sigma = singular_values(&h);
        let product = sigma[0] * sigma[1] * sigma[2] * 2160.0;
        let sum = sigma.iter().sum::<f64>() * 15.0 / 23.0;
        assert!(
            (product - 1.0).abs() < 1e-13,
            "determinant off by {product}"
        );
        assert!((sum - 1.0).abs() < 1e-15, "trace off by {sum}");
    }

    #[test]
    fn graded_values_keep_their_relative_accuracy() {
        // diag(1, 1e-10, 1e-20)·rotation: exact singular values are the diagonal.
        let (s, c) = 0.3_f64.sin_cos();
        let a = Matrix::from_rows(&[[c, s, 0.0], [-1e-10 * s, 1e-10 * c, 0.0], [0.0, 0.0, 1e-20]]);
        for (sigma, exact) in singular_values(&a).iter().zip([1.0, 1e-10, 1e-20]) {
            assert!((sigma / exact - 1.0).abs() < 1e-14, "{sigma:e}");
        }
    }

    #[test]
    fn extreme_and_empty() {
        assert_eq!(singular_values(&Matrix::zeros(3, 0)), [] as [f64; 0]);
        assert_eq!(singular_values(&Matrix::zeros(2, 3)), [0.0, 0.0]);
        let sigma = singular_values(&Matrix::from_rows(&[[3e300, 4e300]]));
        assert!((sigma[0] / 5e300 - 1.0).abs() < 1e-15);
    }

    proptest! {
        #[test]
        fn agrees_with_nalgebra(
            m in 1..20_usize, n in 1..20_usize, data in prop::collection::vec(-1.0..1.0_f64, 400)
        ) {
            let a = Matrix::from_fn(m, n, |i, j| data[20 * i + j]);
            let sigma = singular_values(&a);
            let oracle = nalgebra::DMatrix::from_row_slice(m, n, a.as_slice()).singular_values();
            let mut oracle: Vec<f64> = oracle.iter().copied().collect();
            oracle.sort_by(|x, y| y.total_cmp(x));
            prop_assert_eq!(sigma.len(), oracle.len());
            for (x, y) in sigma.iter().zip(&oracle) {
                // Bidiagonalisation is accurate to a multiple of eps·σ₁.
                prop_assert!((x - y).abs() <= 1e-13 * oracle[0]);
            }
        }
    }
}
