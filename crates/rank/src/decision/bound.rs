//! A lower bound on the smallest singular value, proved in floating point.
//!
//! Let X be an approximate right inverse of A (r×n), and `E = I − A·X`. If `‖E‖ < 1`, then `σ_r(A)
//! ≥ (1 − ‖E‖)/‖X‖`. X may be any matrix; only E needs a bound, and the error of a product in
//! floating point is at most `γ_n·|A|·|X|`.
//!
//! Source: N. J. Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed. (2002), section
//! 3.1 for γ_n.

use crate::limits::BOUND_SLACK;
use linalg::Matrix;

/// Returns a lower bound on σ_r of every matrix whose distance from the r×n matrix `a` is at most
/// `perturbation` (Frobenius norm). The right inverse X is given by its r columns. The bound is 0
/// if X does not give a bound.
pub(super) fn smallest_singular_value(a: &Matrix, x: &Matrix, perturbation: f64) -> f64 {
    let (r, n) = (a.nrows(), a.ncols());
    if r == 0 {
        return f64::INFINITY;
    }
    if r > n {
        return 0.0;
    }
    let mut e = a.product(&x.transpose());
    for i in 0..r {
        e[(i, i)] -= 1.0;
    }
    // Norms ignore NaN, so NaN is tested separately.
    if x.first_non_finite().is_some() || e.first_non_finite().is_some() {
        return 0.0;
    }
    let unit = 0.5 * f64::EPSILON * (n as f64 + 2.0);
    let gamma = unit / (1.0 - unit);
    let norm_x = x.frobenius_norm();
    let e = e.frobenius_norm() + gamma * (a.frobenius_norm() * norm_x + (r as f64).sqrt());
    let bound = (1.0 - e * (1.0 + BOUND_SLACK)) / norm_x * (1.0 - BOUND_SLACK)
        - perturbation * (1.0 + BOUND_SLACK);
    bound.max(0.0)
}

#[cfg(test)]
mod tests {
    use linalg::PivotedQr;

    use super::*;

    fn smallest_singular_value(a: &Matrix, perturbation: f64) -> f64 {
        let x = PivotedQr::of_rows(a.clone()).transposed_pseudo_inverse();
        super::smallest_singular_value(a, &x, perturbation)
    }

    #[test]
    fn bounds_are_below_and_near_the_truth() {
        // For diag(1, s)·rotation, σ₂ = s.
        let (sin, cos) = 0.7_f64.sin_cos();
        for s in [0.5, 1e-3, 1e-8, 1e-12] {
            let a = Matrix::from_rows(&[[cos, sin, 0.0], [-s * sin, s * cos, 0.0]]);
            let bound = smallest_singular_value(&a, 0.0);
            assert!(
                bound <= s * (1.0 + 1e-15) && bound > 0.7 * s,
                "{s:e}: {bound:e}"
            );
            assert!(smallest_singular_value(&a, 0.1 * s) < 0.9 * s);
            // Without rounding, the bound would be 1/‖A⁺‖ = 1/√(1 + 1/s²).
            let exact = s.recip().hypot(1.0).recip();
            assert!(s < 1e-9 || bound > (1.0 - 1e-5) * exact, "{s:e}: {bound:e}");
        }
    }

    #[test]
    fn nothing_is_claimed_where_nothing_is_proved() {
        assert_eq!(
            smallest_singular_value(&Matrix::from_rows(&[[1.0, 2.0], [2.0, 4.0]]), 0.0),
            0.0
        );
        assert_eq!(smallest_singular_value(&Matrix::zeros(2, 2), 0.0), 0.0);
        assert_eq!(smallest_singular_value(&Matrix::identity(2), 2.0), 0.0);
        assert_eq!(
            smallest_singular_value(&Matrix::from_rows(&[[f64::NAN]]), 0.0),
            0.0
        );
        assert_eq!(
            smallest_singular_value(&Matrix::from_rows(&[[1.0], [1.0]]), 0.0),
            0.0
        );
        // The rows contain 1/3. The rows differ from dependent rows only in the last bit, so f64
        // cannot prove that they are independent.
        let a = Matrix::from_rows(&[[1.0, 1.0 / 3.0], [3.0, 1.0]]);
        assert_eq!(smallest_singular_value(&a, 0.0), 0.0);
    }
}
