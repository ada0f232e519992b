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
    for (j, &dropped) in decision.dropped.iter().enumerate() {
        let mut moved = u.row(dropped).to_vec();
        for (i, &kept) in decision.kept.iter().enumerate() {
            kernels::axpy(decision.coefficients[(j, i)].abs(), u.row(kept), &mut moved);
        }
        for (i, &kept) in decision.kept.iter().enumerate() {
            let shift: f64 = moved
                .iter()
                .zip(inverse.row(i))
                .map(|(u, x)| u * x.abs())
                .sum();
            noise[kept] = noise[kept].hypot(shift);
        }
    }
    noise
}
