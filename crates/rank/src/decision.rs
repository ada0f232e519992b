//! The one place where a rank is decided, and where a tolerance for it lives.
//!
//! A rank is decided once per regime of a motion, at a point polished onto the constraints, never
//! inside a right-hand side: off the manifold by δ a singular value that is exactly zero on it is
//! about δ. The decision carries its evidence (all singular values of the equilibrated matrix) and
//! may be `Undecided`; then both readings are in it. Not here: what redundancy means for reactions
//! (`null_space` gives the dependencies) and any weighting by masses, which creates false small
//! singular values.
//!
//! The rule, with singular values σ of `D_r·C·D_c` (maxima of rows and columns near one):
//! `τ = 10·max(eps·√(m·n), uncertainty)`, rank r is decided iff `σ_{r+1} ≤ τ` and
//! `σ_r ≥ max(10³·τ, 10⁻⁷)`; where τ is above 0.01, only if σ_{r+1} is rounding. Two other rules
//! give a certificate: `exact` reads the entries as they stand, `within` reads them in
//! double-double and knows what the data are worth.

mod bound;
mod certificate;
mod clear;
mod coefficient;
mod exact;
mod explicit;
mod graded;
mod modular;
mod perturbation;
#[cfg(test)]
mod tests;
mod uncertainty;
mod within;

use crate::limits::{CLEARANCE, HIDDEN, NEARLY_SINGULAR, NOISE_FACTOR, NOT_ROUNDING};
use crate::strong_basis::{self, Basis};
use linalg::{Matrix, PivotedQr, Scaling, kernels, powers::scale, singular_values};

pub use certificate::{Certificate, Grounds, NearlyRedundant};
pub use coefficient::{CoefficientReading, Readings};
pub use exact::certify_exact;
pub use modular::ExactNullSpace;
pub use uncertainty::Uncertainty;
pub use within::{RankReading, certify_rank, certify_within};

pub(crate) use clear::{Size, independent, size};
pub(crate) use coefficient::coefficient_noise;
pub use explicit::{KeptRowsError, decide_dropping, decide_keeping};

/// Rank of a constraint matrix C (m×n), with the rows to keep and the evidence for it.
#[derive(Debug, Clone, PartialEq)]
pub struct RankDecision {
    /// r = rank C. If undecided: the reading with the larger gap.
    pub rank: usize,
    /// Degree of redundancy p = m − r.
    pub redundancy: usize,
    /// r independent rows K, ascending.
    pub kept: Vec<usize>,
    /// The other p rows D, ascending.
    pub dropped: Vec<usize>,
    /// T̃ = C̃_D·C̃_K⁺ (p×r) between the equilibrated rows: row `dropped[j]` = Σ T̃_ji · row
    /// `kept[i]`. Its entries are at most 2 unless the caller chose the rows.
    pub coefficients: Matrix,
    /// The scaling under which the rank was decided.
    pub scaling: Scaling,
    /// The numbers behind the decision.
    pub evidence: Evidence,
    /// Decided, or why not.
    pub status: RankStatus,
}

/// The numbers behind a rank decision; all of them belong to the equilibrated matrix.
#[derive(Debug, Clone, PartialEq)]
pub struct Evidence {
    /// All `min(m, n)` singular values, largest first; none of a sparse decision.
    pub singular_values: Vec<f64>,
    /// σ_r, infinite for rank 0.
    pub sigma_r: f64,
    /// σ_{r+1}, zero if r = min(m, n).
    pub sigma_next: f64,
    /// σ_r / σ_{r+1}, infinite if σ_{r+1} = 0.
    pub gap: f64,
    /// τ: below it a singular value counts as zero.
    pub tolerance: f64,
    /// The largest uncertainty of an equilibrated entry that the caller stated; 0 for exact
    /// entries.
    pub constraint_residual: f64,
    /// Largest `‖row of C_D − T·C_K‖₂`: how far the dependencies are from exact.
    pub dependence_residual: f64,
    /// The proof, where one was asked for.
    pub certificate: Option<Certificate>,
}

/// Whether the singular values leave room for another rank.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum RankStatus {
    /// `σ_{r+1} ≤ τ` and `σ_r ≥ max(10³·τ, 10⁻⁷)`, or, with a certificate, what its [`Grounds`]
    /// say.
    Decided,
    /// Two ranks can be read from the singular values; do not build on either.
    Undecided(Doubt),
}

/// Why a rank is undecided, with the numbers.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Doubt {
    /// Singular values between "certainly zero" and "certainly not".
    #[error(
        "singular value {sigma:.3e} lies between the tolerance {tolerance:.3e} and {required:.3e}: \
         rank {lower} or {upper}; polish the point or decide in higher precision"
    )]
    NoClearGap {
        /// Singular values that are certainly not zero.
        lower: usize,
        /// Singular values above the tolerance.
        upper: usize,
        /// The smallest one above the tolerance.
        sigma: f64,
        /// τ.
        tolerance: f64,
        /// max(10³·τ, 10⁻⁷).
        required: f64,
    },
    /// A singular value that stays at every precision, about as large as what the data are known
    /// to.
    #[error(
        "singular value {sigma:.3e} is the same at every precision and lies between {tolerance:.3e} and {required:.3e}, what \
         the uncertainty of the data explains: rank {lower} or {upper}; know the data better, or change them by more than that"
    )]
    NearUncertainty {
        /// Singular values that are larger than the data explain.
        lower: usize,
        /// Singular values above the tolerance.
        upper: usize,
        /// The smallest one above the tolerance.
        sigma: f64,
        /// τ.
        tolerance: f64,
        /// 4·τ.
        required: f64,
    },
    /// Data that are wrong by about as much as they are rounded would have a lower rank.
    #[error(
        "singular value {sigma:.3e}: if the data were wrong by {share:.2} times their rounding, the rank would be {lower} instead of {upper}; \
         give the data with more digits, or place the mechanism nearer to the origin"
    )]
    WithinRounding {
        /// The rank that other data within the rounding have.
        lower: usize,
        /// The rank of the data as read.
        upper: usize,
        /// The singular value that vanishes then.
        sigma: f64,
        /// Largest change of a datum, as a share of its rounding.
        share: f64,
    },
    /// The rank hangs on where in the tolerance the data are.
    #[error(
        "with data known to {tolerance:.1e} {unit} the rank is {lower} or {upper}: one row is redundant from about {from:.1e} {unit} on; \
         state a tolerance below {:.1e} {unit} or above {:.1e} {unit}",
        from / 3.0,
        3.0 * from
    )]
    WithinTolerance {
        /// The rank that data within the tolerance have.
        lower: usize,
        /// The rank of the data as read.
        upper: usize,
        /// Where the reading changes.
        from: f64,
        /// What is stated.
        tolerance: f64,
        /// The unit of both: `m`, or `rad` where a tolerance is stated for angles alone.
        unit: &'static str,
    },
    /// At this pose the data within their tolerance have a lower rank; of too few other poses it is
    /// known whether they have it there.
    #[error(
        "with data known to {tolerance:.1e} {unit} the rank at this pose is {lower}; whether it is {lower} or {upper} at others is open, \
         because on the rows that are left too few of them are reached, or none that is known well enough; move the start, or know the data better"
    )]
    OtherPoses {
        /// The rank that data within the tolerance have here.
        lower: usize,
        /// The rank that they may have elsewhere.
        upper: usize,
        /// What is stated.
        tolerance: f64,
        /// Its unit: `m`, or `rad` where a tolerance is stated for angles alone.
        unit: &'static str,
    },
    /// Rows that are not zero are hidden by what the data are known to.
    #[error(
        "singular value {sigma:.3e} is not rounding, and lies below {tolerance:.3e}, what the uncertainty of the data explains, \
         in a matrix of size one: nothing is known of these rows; place the mechanism nearer to the origin, or know the data better"
    )]
    Hidden {
        /// The largest of those below the tolerance.
        sigma: f64,
        /// τ.
        tolerance: f64,
    },
    /// The tolerance swallows every singular value of a matrix that is not zero.
    #[error(
        "tolerance {tolerance:.3e} exceeds the largest singular value {sigma_max:.3e} of a non-zero \
         matrix: the constraint residual is too large to decide anything, polish the point first"
    )]
    NotPolished {
        /// σ₁.
        sigma_max: f64,
        /// τ.
        tolerance: f64,
    },
}

/// Input that no rank can be decided for.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
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
    /// The stated uncertainty is none.
    #[error("uncertainty is {value}, need a finite number that is not negative")]
    Uncertainty {
        /// What was given.
        value: f64,
    },
    /// The stated uncertainty is that of another matrix.
    #[error("uncertainty of {rows}×{cols} entries for a matrix of {expected_rows}×{expected_cols}")]
    UncertaintyShape {
        /// Rows given.
        rows: usize,
        /// Columns given.
        cols: usize,
        /// Rows of the matrix.
        expected_rows: usize,
        /// Columns of the matrix.
        expected_cols: usize,
    },
}

/// Decides the rank of C, chooses the rows to keep and expresses the others by them.
///
/// | argument | shape | meaning |
/// | --- | --- | --- |
/// | `c` | m×n | constraint matrix; `0×n` and `m×0` have rank 0 |
/// | `uncertainty` | – or m×n | what the entries are known to beyond rounding; see [`Uncertainty`] |
///
/// ```
/// use linalg::Matrix;
/// use rank::{RankStatus, decide};
/// // The third constraint is the sum of the other two.
/// let c = Matrix::from_rows(&[[1.0, 0.0, 2.0], [0.0, 1.0, 0.0], [1.0, 1.0, 2.0]]);
/// let decision = decide(&c, 0.0)?;
/// assert_eq!((decision.rank, decision.redundancy), (2, 1));
/// assert_eq!(decision.status, RankStatus::Decided);
/// assert!(decision.evidence.gap > 1e15);
/// # Ok::<(), rank::RankError>(())
/// ```
///
/// # Errors
/// - [`RankError::NonFinite`]: an entry is NaN or infinite.
/// - [`RankError::Uncertainty`], [`RankError::UncertaintyShape`]: the uncertainty is negative, NaN,
///   infinite or of another matrix.
///
/// Source: rank rule and scaling as in the module docs; rows by pivoted QR of `(D_r·C·D_c)ᵀ` and
/// strong exchanges (Gu and Eisenstat 1996).
pub fn decide<'a>(
    c: &Matrix,
    uncertainty: impl Into<Uncertainty<'a>>,
) -> Result<RankDecision, RankError> {
    let (scaling, scaled, reading) = read(c, uncertainty.into())?;
    let kept = match reading.rank == c.nrows() {
        true => (0..reading.rank).collect(),
        false => PivotedQr::of_rows(scaled.clone()).permutation()[..reading.rank].to_vec(),
    };
    let basis = strong_basis::bounded(&scaled, kept);
    Ok(reading.with_basis(scaling, basis))
}

/// Rows that look independent by the pivots of one factorisation, ascending: what a Newton
/// iteration may solve with, which shows whether they are. Not a rank.
///
/// ```
/// use linalg::Matrix;
/// use rank::promising_rows;
/// let c = Matrix::from_rows(&[[1.0, 0.0], [2.0, 0.0], [0.0, 3.0]]);
/// assert_eq!(promising_rows(&c, 0.0)?.len(), 2);
/// # Ok::<(), rank::RankError>(())
/// ```
///
/// # Errors
/// As [`decide`].
pub fn promising_rows<'a>(
    c: &Matrix,
    uncertainty: impl Into<Uncertainty<'a>>,
) -> Result<Vec<usize>, RankError> {
    check_finite(c)?;
    let (scaling, spread) = uncertainty.into().equilibrate(c)?;
    let required = required(tolerance(c.nrows(), c.ncols(), spread.largest));
    let qr = PivotedQr::of_rows(scaling.apply(c));
    let independent = qr.r_diagonal().take_while(|pivot| pivot.abs() > required);
    let mut rows = qr.permutation()[..independent.count()].to_vec();
    rows.sort_unstable();
    Ok(rows)
}

/// A rank read from singular values, without rows yet.
struct Reading {
    rank: usize,
    evidence: Evidence,
    status: RankStatus,
}

/// Checks the input, equilibrates, and reads the rank.
fn read(c: &Matrix, uncertainty: Uncertainty<'_>) -> Result<(Scaling, Matrix, Reading), RankError> {
    check_finite(c)?;
    let (scaling, spread) = uncertainty.equilibrate(c)?;
    let uncertainty = spread.largest;
    let scaled = scaling.apply(c);
    let tolerance = tolerance(c.nrows(), c.ncols(), uncertainty);
    let reading = Reading::new(singular_values(&scaled), tolerance, uncertainty);
    Ok((scaling, scaled, reading))
}

/// τ of an m×n matrix whose equilibrated entries are known to `uncertainty`.
pub(crate) fn tolerance(m: usize, n: usize, uncertainty: f64) -> f64 {
    let rounding = f64::EPSILON * (m as f64 * n as f64).sqrt();
    NOISE_FACTOR * rounding.max(uncertainty)
}

/// What the smallest singular value that counts as non-zero has to reach: max(10³·τ, 10⁻⁷).
pub(crate) fn required(tolerance: f64) -> f64 {
    (CLEARANCE * tolerance).max(NEARLY_SINGULAR)
}

/// σ_r / σ_{r+1}, infinite if σ_{r+1} = 0.
fn gap(sigma_r: f64, sigma_next: f64) -> f64 {
    match sigma_next {
        0.0 => f64::INFINITY,
        _ => sigma_r / sigma_next,
    }
}

fn check_finite(c: &Matrix) -> Result<(), RankError> {
    match c.first_non_finite() {
        Some((row, col, value)) => Err(RankError::NonFinite { row, col, value }),
        None => Ok(()),
    }
}

/// A combination of rows without its part in the left null space, of unit norm.
fn projected(decision: &RankDecision, mut direction: Vec<f64>) -> Vec<f64> {
    let z = crate::orthonormal(decision);
    let part = z.transpose_times(&direction);
    for (d, z) in direction.iter_mut().zip(z.times(&part)) {
        *d -= z;
    }
    let size = kernels::norm(&direction);
    direction.iter_mut().for_each(|d| *d /= size);
    direction
}

/// The status of a rank with a clear gap: decided, unless the tolerance hides singular values that
/// are no rounding.
pub(crate) fn shown(sigma_next: f64, tolerance: f64) -> RankStatus {
    match tolerance > HIDDEN && sigma_next > NOT_ROUNDING {
        true => RankStatus::Undecided(Doubt::Hidden {
            sigma: sigma_next,
            tolerance,
        }),
        false => RankStatus::Decided,
    }
}

impl Reading {
    fn new(singular_values: Vec<f64>, tolerance: f64, constraint_residual: f64) -> Self {
        let above = |limit: f64| singular_values.partition_point(|&sigma| sigma > limit);
        let required = required(tolerance);
        let upper = above(tolerance);
        let lower = singular_values.partition_point(|&sigma| sigma >= required);
        let lower = lower.min(upper);
        let sigma_max = singular_values.first().copied().unwrap_or(0.0);
        let hidden = singular_values.get(upper).copied().unwrap_or(0.0);
        let status = if upper == 0 && sigma_max > 0.0 {
            RankStatus::Undecided(Doubt::NotPolished {
                sigma_max,
                tolerance,
            })
        } else if lower < upper {
            RankStatus::Undecided(Doubt::NoClearGap {
                lower,
                upper,
                sigma: singular_values[upper - 1],
                tolerance,
                required,
            })
        } else {
            shown(hidden, tolerance)
        };

        let sigma_r = |r: usize| {
            if r == 0 {
                f64::INFINITY
            } else {
                singular_values[r - 1]
            }
        };
        let sigma_next = |r: usize| singular_values.get(r).copied().unwrap_or(0.0);
        // Below the tolerance there is only noise: no gap may profit from it.
        let clear_gap = |r: usize| sigma_r(r).min(sigma_max) / sigma_next(r).max(tolerance);
        let rank = (lower..=upper)
            .max_by(|&a, &b| clear_gap(a).total_cmp(&clear_gap(b)))
            .unwrap_or(upper);
        let (sigma_r, sigma_next) = (sigma_r(rank), sigma_next(rank));
        Self {
            rank,
            evidence: Evidence {
                sigma_r,
                sigma_next,
                gap: gap(sigma_r, sigma_next),
                tolerance,
                constraint_residual,
                dependence_residual: 0.0,
                singular_values,
                certificate: None,
            },
            status,
        }
    }

    fn with_basis(self, scaling: Scaling, basis: Basis) -> RankDecision {
        let Basis {
            kept,
            dropped,
            t,
            residual,
        } = basis;
        RankDecision {
            rank: self.rank,
            redundancy: dropped.len(),
            kept,
            dropped,
            coefficients: t,
            scaling,
            evidence: Evidence {
                dependence_residual: residual,
                ..self.evidence
            },
            status: self.status,
        }
    }
}

impl RankDecision {
    /// T = C_D·C_K⁺ (p×r) in the row scaling of C: row `dropped[j]` = Σ T_ji · row `kept[i]`.
    /// Leaves the range of `f64` where rows differ by more than that;
    /// [`RankDecision::coefficients`] does not.
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

    /// T̃, the dependence between equilibrated rows; copies [`RankDecision::coefficients`].
    pub fn equilibrated_dependence(&self) -> Matrix {
        self.coefficients.clone()
    }

    /// Whether the rank is decided.
    pub fn is_decided(&self) -> bool {
        self.status == RankStatus::Decided
    }
}
