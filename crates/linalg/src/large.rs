//! The one file that knows faer: singular values of large matrices.
//!
//! Why no more of it: up to some 150 rows our own pivoted QR is as fast, saddle solves of that size
//! are called for every evaluation and must not allocate, and row choices should not depend on a
//! feature. Singular values are only compared with limits well above the rounding error of either
//! routine (tested below), so decisions are the same with and without faer. Functions are not
//! generic on purpose: faer is compiled here and nowhere else.

use faer::MatRef;

use crate::Matrix;

/// Singular values, largest first; `None` if faer's iteration did not converge.
pub(crate) fn singular_values(a: &Matrix) -> Option<Vec<f64>> {
    let view = MatRef::from_row_major_slice(a.as_slice(), a.nrows(), a.ncols());
    let mut sigma = view.singular_values().ok()?;
    sigma.sort_by(|x, y| y.total_cmp(x));
    Some(sigma)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::singular_values::own as by_rotations;

    /// Both sides of a decision must read the same numbers: agreement far below the smallest
    /// tolerance τ = 10·eps·√(m·n) ≈ 2e-13 of this size.
    #[test]
    fn agrees_with_our_own_kernel() {
        const RANK: usize = 70;
        let wave = |i: usize, k: usize| ((i * i + 3 * k) as f64 * (1.0 + k as f64).sqrt()).sin();
        let a = Matrix::from_fn(96, RANK, wave).product(&Matrix::from_fn(RANK, 90, wave));
        let (own, faer) = (by_rotations(&a), singular_values(&a).unwrap());
        assert_eq!(own.len(), faer.len());
        for (x, y) in own.iter().zip(&faer) {
            assert!((x - y).abs() < 2e-14 * own[0], "{x:e} {y:e}");
        }
        assert!(own[RANK - 1] > 1e-6 * own[0] && own[RANK] < 1e-14 * own[0]);
    }
}
