//! Results of a rank decision: the rank, the rows to keep, the evidence for them, and the reasons
//! why a rank is undecided or cannot be decided.

use super::certificate::{Certificate, NearlyRedundant};
use linalg::{Matrix, Scaling, powers::scale};

/// Rank of a constraint matrix C (m×n), with the rows to keep and the evidence for the rank.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct RankDecision {
    /// Rank r of C. If the rank is undecided, the candidate with the larger gap.
    pub rank: usize,
    /// Degree of redundancy p = m − r.
    pub redundancy: usize,
    /// Independent rows K, ascending; their number is r.
    pub kept: Vec<usize>,
    /// Redundant rows D, ascending; their number is p.
    pub dropped: Vec<usize>,
    /// T̃ = C̃_D·C̃_K⁺ (p×r) between the equilibrated rows: row `dropped[j]` = Σ T̃_ji · row
    /// `kept[i]`. The entries are at most 2 unless the caller chose the rows.
    pub coefficients: Matrix,
    /// The scaling under which the rank was decided.
    pub scaling: Scaling,
    /// The singular values and errors that justify the decision.
    pub evidence: Evidence,
    /// Whether the rank is decided, or the reason why it is undecided.
    pub status: RankStatus,
}

/// The values that justify a rank decision. All values refer to the equilibrated matrix.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Evidence {
    /// All `min(m, n)` singular values, largest first; empty for a sparse decision.
    pub singular_values: Vec<f64>,
    /// σ_r, infinite for rank 0.
    pub sigma_r: f64,
    /// σ_{r+1}, zero if r = min(m, n).
    pub sigma_next: f64,
    /// σ_r / σ_{r+1}, infinite if σ_{r+1} = 0.
    pub gap: f64,
    /// Tolerance τ: a smaller singular value counts as zero.
    pub tolerance: f64,
    /// The largest uncertainty of an equilibrated entry that the caller stated; 0 for exact
    /// entries.
    pub constraint_residual: f64,
    /// Largest `‖row of C_D − T·C_K‖₂`, the error of the dependencies.
    pub dependence_residual: f64,
    /// The proof, if one was requested.
    pub certificate: Option<Certificate>,
}

/// Whether the singular values allow another rank.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum RankStatus {
    /// The rank is decided: `σ_{r+1} ≤ τ` and `σ_r ≥ max(10³·τ, 10⁻⁷)`. With a certificate, the
    /// [`Grounds`](super::Grounds) of the certificate state the criterion.
    Decided,
    /// Two ranks are compatible with the singular values. Neither rank should be used.
    Undecided(Doubt),
}

/// Reason why a rank is undecided, with the relevant values.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum Doubt {
    /// A singular value is between "certainly zero" and "certainly not zero".
    #[error(
        "singular value {sigma:.3e} lies between the tolerance {tolerance:.3e} and {required:.3e}: \
         rank {lower} or {upper}; polish the point or decide in higher precision"
    )]
    NoClearGap {
        /// Number of singular values that are certainly not zero.
        lower: usize,
        /// Number of singular values above the tolerance.
        upper: usize,
        /// The smallest singular value above the tolerance.
        sigma: f64,
        /// Tolerance τ.
        tolerance: f64,
        /// Required size of a nonzero singular value, max(10³·τ, 10⁻⁷).
        required: f64,
    },
    /// A singular value is the same at every precision and about as large as the uncertainty of the
    /// data.
    #[error(
        "singular value {sigma:.3e} is the same at every precision and lies between {tolerance:.3e} and {required:.3e}, the limits set by the uncertainty of the data: rank {lower} or {upper}; use more accurate data, or change them by more than their uncertainty"
    )]
    NearUncertainty {
        /// Number of singular values larger than the uncertainty of the data.
        lower: usize,
        /// Number of singular values above the tolerance.
        upper: usize,
        /// The smallest singular value above the tolerance.
        sigma: f64,
        /// Tolerance τ.
        tolerance: f64,
        /// Required size of a nonzero singular value, 4·τ.
        required: f64,
    },
    /// The rank would be lower if the data were wrong by about their rounding.
    #[error(
        "singular value {sigma:.3e}: an error of the data of {share:.2} times their rounding would change the rank from {upper} to {lower}; give the data with more digits, or place the mechanism nearer to the origin"
    )]
    WithinRounding {
        /// The rank for other data within the rounding of the data.
        lower: usize,
        /// The rank of the data as read.
        upper: usize,
        /// The singular value that would vanish.
        sigma: f64,
        /// Largest change of one datum, as a fraction of its rounding error.
        share: f64,
    },
    /// The rank depends on the exact values of the data within the tolerance.
    #[error(
        "with data accurate to {tolerance:.1e} {unit} the rank is {lower} or {upper}: one row is redundant above about {from:.1e} {unit}; state a tolerance below {:.1e} {unit} or above {:.1e} {unit}",
        from / 3.0,
        3.0 * from
    )]
    WithinTolerance {
        /// The rank of data within the tolerance.
        lower: usize,
        /// The rank of the data as read.
        upper: usize,
        /// The change of the data at which the rank changes.
        from: f64,
        /// The stated tolerance.
        tolerance: f64,
        /// The unit of `from` and `tolerance`: `m`, or `rad` if a tolerance is stated for angles
        /// only.
        unit: &'static str,
    },
    /// At this configuration, data within the tolerance have a lower rank. Too few other
    /// configurations could be examined to decide whether the rank is also lower at other
    /// configurations.
    #[error(
        "with data accurate to {tolerance:.1e} {unit} the rank at this pose is {lower}; at other poses it may be {lower} or {upper}: too few poses can be reached on the remaining rows with sufficient accuracy; move the start, or use more accurate data"
    )]
    OtherPoses {
        /// The rank of data within the tolerance at this configuration.
        lower: usize,
        /// The possible rank of these data at other configurations.
        upper: usize,
        /// The stated tolerance.
        tolerance: f64,
        /// Unit of the tolerance: `m`, or `rad` if a tolerance is stated for angles only.
        unit: &'static str,
    },
    /// The uncertainty of the data hides rows that are not zero.
    #[error(
        "singular value {sigma:.3e} is above rounding but below {tolerance:.3e}, the limit set by the uncertainty of the data (matrix scaled to norm one): these rows are undecided; place the mechanism nearer to the origin, or use more accurate data"
    )]
    Hidden {
        /// The largest singular value below the tolerance.
        sigma: f64,
        /// Tolerance τ.
        tolerance: f64,
    },
    /// The tolerance exceeds every singular value of a matrix that is not zero.
    #[error(
        "tolerance {tolerance:.3e} exceeds the largest singular value {sigma_max:.3e} of a non-zero \
         matrix: the constraint residual is too large for a decision; polish the point first"
    )]
    NotPolished {
        /// Largest singular value σ₁.
        sigma_max: f64,
        /// Tolerance τ.
        tolerance: f64,
    },
}

/// Invalid input for a rank decision.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum RankError {
    /// An entry of C is NaN or infinite.
    #[error("constraint matrix: entry in row {row}, column {col} is {value}, need a finite number")]
    NonFinite {
        /// Row of the entry.
        row: usize,
        /// Column of the entry.
        col: usize,
        /// The entry.
        value: f64,
    },
    /// The stated uncertainty is invalid.
    #[error("uncertainty is {value}, need a finite number that is not negative")]
    Uncertainty {
        /// The given value.
        value: f64,
    },
    /// The stated uncertainty has another shape than the matrix.
    #[error("uncertainty of {rows}×{cols} entries for a matrix of {expected_rows}×{expected_cols}")]
    UncertaintyShape {
        /// Number of given rows.
        rows: usize,
        /// Number of given columns.
        cols: usize,
        /// Number of rows of the matrix.
        expected_rows: usize,
        /// Number of columns of the matrix.
        expected_cols: usize,
    },
}

impl RankDecision {
    /// Returns T = C_D·C_K⁺ (p×r) in the row scaling of C: row `dropped[j]` = Σ T_ji · row
    /// `kept[i]`. The result overflows if the rows differ by more than the range of `f64`;
    /// [`RankDecision::coefficients`] does not overflow.
    pub fn dependence(&self) -> Matrix {
        // D_r,D·C_D = T̃·D_r,K·C_K, hence T = D_r,D⁻¹·T̃·D_r,K.
        let rows = &self.scaling.rows;
        Matrix::from_fn(self.redundancy, self.rank, |j, i| {
            scale(
                self.coefficients[(j, i)],
                rows[self.kept[i]] - rows[self.dropped[j]],
            )
        })
    }

    /// Returns T̃, the dependence between equilibrated rows, as a copy of
    /// [`RankDecision::coefficients`].
    pub fn equilibrated_dependence(&self) -> Matrix {
        self.coefficients.clone()
    }

    /// Returns whether the rank is decided.
    pub fn is_decided(&self) -> bool {
        self.status == RankStatus::Decided
    }

    /// Returns the warning for a decided rank with σ_r below 1e-3. The rank and the verdicts on
    /// reactions are valid for the stored data, but unit loads cause reactions of size 1/σ_r. The
    /// warning is `None` for ranks without a certificate.
    #[must_use]
    pub fn nearly_redundant(&self) -> Option<&NearlyRedundant> {
        self.evidence
            .certificate
            .as_ref()?
            .nearly_redundant
            .as_ref()
            .filter(|_| self.is_decided())
    }
}
