//! Computes how much each row of the dependencies of a matrix changes with the entries of the
//! matrix. In a model of mixed sizes, the uncertainty of the large part may exceed the entries of
//! the small part. A single tolerance for all rows would therefore treat small coefficients as
//! zero.

use super::{Accuracy, RankDecision};
use linalg::{Matrix, PivotedQr, kernels};

/// Returns bounds on the norms of the rows of `δ[−T̃, I]`, m values, to first order in the
/// uncertainty of the entries: `|δT| ≤ (U_D + |T|·U_K)·|C_K⁺|`. All matrices are equilibrated.
/// `inverse` is `(C_K⁺)ᵀ` if it is known.
pub(super) fn row_noise(
    decision: &RankDecision,
    c: &Matrix,
    known: Accuracy<'_>,
    inverse: Option<Matrix>,
) -> Vec<f64> {
    let mut noise = vec![0.0; c.nrows()];
    if decision.redundancy == 0 {
        return noise;
    }
    let u = known.of_entries(&decision.scaling);
    let inverse = inverse.unwrap_or_else(|| {
        let kept = decision.scaling.apply(c).select_rows(&decision.kept);
        PivotedQr::of_rows(kept).transposed_pseudo_inverse()
    });
    let sizes = |of: &Matrix| Matrix::from_fn(of.nrows(), of.ncols(), |i, j| of[(i, j)].abs());
    let mut moved = sizes(&decision.coefficients).product(&u.select_rows(&decision.kept));
    for (j, &dropped) in decision.dropped.iter().enumerate() {
        kernels::axpy(1.0, u.row(dropped), moved.row_mut(j));
    }
    let shifts = moved.product(&sizes(&inverse.transpose()));
    for j in 0..shifts.nrows() {
        for (&kept, shift) in decision.kept.iter().zip(shifts.row(j)) {
            noise[kept] = noise[kept].hypot(*shift);
        }
    }
    noise
}
