//! Singular values of large matrices with faer. No other file uses faer.
//!
//! faer is used only for this purpose. Up to about 150 rows our own pivoted QR is as fast. Saddle
//! solves of this size are called for every evaluation and must not allocate memory, and the choice
//! of rows should not depend on a feature. Singular values are only compared with limits well above
//! the rounding error of both routines (tested below), so decisions are the same with and without
//! faer. The functions are deliberately not generic: faer is compiled here only.

use faer::MatRef;

use crate::Matrix;

/// Computes the singular values, largest first. Returns `None` if the iteration of faer did not
/// converge.
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

    /// Decisions must be the same with both routines. Their results agree far below the smallest
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
