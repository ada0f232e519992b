//! Singular values, as evidence for rank decisions.
//!
//! Householder reflections from both sides make a matrix bidiagonal, and Givens rotations with
//! Wilkinson's shift make it diagonal. Errors are a small multiple of `eps·σ₁`, which is the
//! reference of decisions. Singular vectors are not computed, because null spaces come from the row
//! basis. Matrices of several hundred rows are passed to faer if that feature is enabled.
//!
//! Source: G. H. Golub, C. F. Van Loan, Matrix Computations, 4th ed. (2013), §8.6. If the rotations
//! do not converge, which has never been observed, one-sided Jacobi rotations are used: Z. Drmač,
//! K. Veselić, New fast and accurate Jacobi SVD algorithm I, SIAM J. Matrix Anal. Appl. 29 (2008)
//! 1322–1342.

use crate::limits::{JACOBI_SWEEPS, ZERO_SQUARED};
use crate::{Matrix, PivotedQr, kernels, powers, qr};

mod diagonal;

/// Returns all `min(m, n)` singular values of `a`, largest first. The singular values are accurate
/// to a small multiple of `eps·σ₁`.
///
/// Entries must be finite; otherwise the values are meaningless (but their number is the same).
///
/// ```
/// use pfaff_linalg::{Matrix, singular_values};
/// let sigma = singular_values(&Matrix::from_rows(&[[3.0, 0.0], [4.0, 5.0]]));
/// assert!((sigma[0] - 45f64.sqrt()).abs() < 1e-14); // AᵀA has eigenvalues 45 and 5
/// assert!((sigma[1] - 5f64.sqrt()).abs() < 1e-14);
/// ```
pub fn singular_values(a: &Matrix) -> Vec<f64> {
    #[cfg(feature = "faer")]
    if a.nrows().min(a.ncols()) >= crate::limits::FAER_FROM
        && let Some(sigma) = crate::large::singular_values(a)
    {
        return sigma;
    }
    own(a)
}

/// Works like [`singular_values`], with our own kernels for every size.
pub(crate) fn own(a: &Matrix) -> Vec<f64> {
    let e = powers::unit_exponent(a.as_slice());
    let mut scaled = if a.nrows() < a.ncols() {
        a.transpose()
    } else {
        a.clone()
    };
    for x in scaled.as_mut_slice() {
        *x = powers::scale(*x, e);
    }
    let (mut d, mut f) = kernels::vectorised(
        #[inline(always)]
        || bidiagonal(scaled),
    );
    let mut sigma = if diagonal::iterate(&mut d, &mut f) {
        d
    } else {
        by_jacobi(upper(&d, &f))
    };
    for x in &mut sigma {
        *x = powers::scale(x.abs(), -e);
    }
    sigma.sort_by(|x, y| y.total_cmp(x));
    sigma
}

/// Returns diagonal and superdiagonal of `Uᵀ·A·V` for an m×n matrix, m ≥ n.
#[inline(always)]
fn bidiagonal(mut a: Matrix) -> (Vec<f64>, Vec<f64>) {
    let (m, n) = (a.nrows(), a.ncols());
    let (mut d, mut f) = (vec![0.0; n], vec![0.0; n.saturating_sub(1)]);
    let (mut column, mut image) = (vec![0.0; m], vec![0.0; n]);
    for k in 0..n {
        let column = &mut column[k..];
        for (x, i) in column.iter_mut().zip(k..m) {
            *x = a[(i, k)];
        }
        let tau = qr::reflect(column);
        d[k] = column[0];
        if k + 1 == n {
            break;
        }
        // Computes τ·vᵀ·A, row by row.
        let image = &mut image[k + 1..];
        image.copy_from_slice(&a.row(k)[k + 1..]);
        for (v, i) in column[1..].iter().zip(k + 1..m) {
            if *v != 0.0 {
                kernels::axpy(*v, &a.row(i)[k + 1..], image);
            }
        }
        kernels::axpy(-tau, image, &mut a.row_mut(k)[k + 1..]);
        let right = qr::reflect(&mut a.row_mut(k)[k + 1..]);
        f[k] = a[(k, k + 1)];
        // Applies both reflections of a row in one pass.
        let along = image[0] + kernels::dot(&a.row(k)[k + 2..], &image[1..]);
        for (v, i) in column[1..].iter().zip(k + 1..m) {
            let (u, row) = a.two_rows_mut(k, i);
            let (u, row) = (&u[k + 2..], &mut row[k + 1..]);
            let from_left = -tau * v;
            let own = row[0] + kernels::dot(u, &row[1..]);
            let from_right = -right * (own + from_left * along);
            row[0] += from_left * image[0] + from_right;
            kernels::axpy_both([from_left, from_right], [&image[1..], u], &mut row[1..]);
        }
    }
    (d, f)
}

fn upper(d: &[f64], f: &[f64]) -> Matrix {
    Matrix::from_fn(d.len(), d.len(), |i, j| match j.checked_sub(i) {
        Some(0) => d[i],
        Some(1) => f[i],
        _ => 0.0,
    })
}

/// Computes singular values of a matrix with entries near one by one-sided Jacobi rotations. The
/// rotations act on the rows of R from a pivoted QR. The method is slower, but cannot fail, and
/// small singular values also have small errors.
pub(crate) fn by_jacobi(a: Matrix) -> Vec<f64> {
    // The second QR makes a wide R square and closer to a diagonal, which reduces the number of
    // sweeps.
    let r = PivotedQr::of_rows(a).r();
    let mut r = PivotedQr::of_rows(r).r();
    orthogonalise_rows(&mut r);
    let mut sigma: Vec<f64> = (0..r.nrows()).map(|i| kernels::norm(r.row(i))).collect();
    sigma.sort_by(|x, y| y.total_cmp(x));
    sigma
}

/// Rotates pairs of rows until all rows are orthogonal to working precision.
fn orthogonalise_rows(r: &mut Matrix) {
    let n = r.nrows();
    // The tolerance is the rounding error of a dot product; below it no rotation is needed.
    let tolerance = f64::EPSILON * r.ncols() as f64;
    let mut squares = vec![0.0; n];
    for _ in 0..JACOBI_SWEEPS {
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
                // If ζ² overflows, t = 0, which corresponds to a negligible rotation.
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
        // The eigenvalues of the Hilbert matrix H₃ (symmetric, so also its singular values) are the
        // roots of λ³ − (23/15)λ² + (127/720)λ − 1/2160.
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
    fn graded_values_are_known_to_rounding_of_the_largest() {
        // For diag(1, 1e-10, 1e-20)·rotation, the exact singular values are the diagonal.
        let (s, c) = 0.3_f64.sin_cos();
        let a = Matrix::from_rows(&[[c, s, 0.0], [-1e-10 * s, 1e-10 * c, 0.0], [0.0, 0.0, 1e-20]]);
        for (sigma, exact) in singular_values(&a).iter().zip([1.0, 1e-10, 1e-20]) {
            assert!((sigma - exact).abs() < 4.0 * f64::EPSILON, "{sigma:e}");
        }
        for (sigma, exact) in by_jacobi(a).iter().zip([1.0, 1e-10, 1e-20]) {
            assert!((sigma / exact - 1.0).abs() < 1e-14, "{sigma:e}");
        }
    }

    /// The singular values of [1 1; 0 1] are the golden ratio and its inverse. Squares of the small
    /// rows are 1e-149 and their products 1e-298, which are still numbers of full precision.
    #[test]
    fn rotations_keep_the_digits_of_rows_whose_squares_are_tiny() {
        let (size, golden) = (5e-75, (1.0 + 5f64.sqrt()) / 2.0);
        let a = Matrix::from_rows(&[[1.0, 0.0, 0.0], [0.0, size, size], [0.0, 0.0, size]]);
        for (sigma, exact) in by_jacobi(a).iter().zip([1.0, size * golden, size / golden]) {
            assert!((sigma / exact - 1.0).abs() < 1e-14, "{sigma:e} {exact:e}");
        }
    }

    #[test]
    fn zeros_on_the_diagonal_cut_the_matrix() {
        // Jordan blocks with eigenvalue 0 have singular values 1, and one 0 for each block.
        let jordan = |cuts: &[usize]| {
            Matrix::from_fn(7, 7, |i, j| {
                f64::from(u8::from(j == i + 1 && !cuts.contains(&j)))
            })
        };
        for (cuts, zeros) in [(&[] as &[usize], 1), (&[3], 2), (&[2, 5], 3)] {
            let sigma = singular_values(&jordan(cuts));
            let expected = (0..7).map(|k| f64::from(u8::from(k < 7 - zeros)));
            assert!(sigma.iter().copied().eq(expected), "{sigma:?}");
        }
        // The zero is inside, at the end and at the beginning of a full bidiagonal matrix.
        for zero in [0, 2, 5] {
            let a = Matrix::from_fn(6, 6, |i, j| match j.checked_sub(i) {
                Some(0) if i == zero => 0.0,
                Some(0 | 1) => 1.0 + (i + j) as f64 / 4.0,
                _ => 0.0,
            });
            let (own, other) = (own(&a), by_jacobi(a));
            let off = own.iter().zip(&other).map(|(x, y)| (x - y).abs());
            assert!(
                off.fold(0.0, f64::max) < 1e-15 * 8.0 * own[0],
                "{own:?} {other:?}"
            );
        }
    }

    #[test]
    fn numbers_that_are_none_end() {
        assert_eq!(
            singular_values(&Matrix::from_rows(&[[f64::NAN, 1.0], [1.0, 2.0]])).len(),
            2
        );
        assert_eq!(
            singular_values(&Matrix::from_rows(&[[f64::INFINITY, 1.0], [1.0, 2.0]])).len(),
            2
        );
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
