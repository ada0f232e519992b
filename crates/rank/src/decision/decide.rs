//! The standard decision: the rank, the rows to keep, and the other rows in terms of the kept rows.

use super::exact::certify_exact;
use super::{Accuracy, RankDecision, RankError, read};
use linalg::Matrix;

/// Decides the rank of C, chooses the rows to keep, and expresses the other rows by the kept rows.
///
/// | argument | shape | meaning |
/// | --- | --- | --- |
/// | `c` | m×n | constraint matrix; `0×n` and `m×0` have rank 0 |
/// | `accuracy` | – or m×n | accuracy of the entries; see [`Accuracy`] |
///
/// ```
/// use linalg::Matrix;
/// use pfaff_rank::{Accuracy, RankStatus, decide};
/// // The third constraint is the sum of the other two.
/// let c = Matrix::from_rows(&[[1.0, 0.0, 2.0], [0.0, 1.0, 0.0], [1.0, 1.0, 2.0]]);
/// let decision = decide(&c, Accuracy::Rounding)?;
/// assert_eq!((decision.rank, decision.redundancy), (2, 1));
/// assert_eq!(decision.status, RankStatus::Decided);
/// assert!(decision.evidence.gap > 1e15);
/// # Ok::<(), pfaff_rank::RankError>(())
/// ```
///
/// # Errors
/// - [`RankError::NonFinite`]: an entry is NaN or infinite.
/// - [`RankError::Uncertainty`], [`RankError::UncertaintyShape`]: the uncertainty is negative, NaN,
///   infinite or of another shape.
///
/// Source: the module docs describe the rank rule and the scaling. The rows are chosen by pivoted
/// QR of `(D_r·C·D_c)ᵀ` and strong exchanges (Gu and Eisenstat 1996).
pub fn decide<'a>(
    c: &Matrix,
    accuracy: impl Into<Accuracy<'a>>,
) -> Result<RankDecision, RankError> {
    let accuracy = accuracy.into();
    if matches!(accuracy, Accuracy::Exact) {
        return certify_exact(c);
    }
    let (scaling, scaled, reading) = read(c, accuracy)?;
    Ok(reading.with_strong_basis(scaling, &scaled))
}
