//! The rank decision and its tolerance. Only this module decides ranks.
//!
//! A rank is decided once for each regime of a motion, at a configuration that is refined onto the
//! constraints. The rank is never decided inside a right-hand side. At a distance δ from the
//! manifold, a singular value that is exactly zero on the manifold is about δ. The decision
//! contains its evidence (all singular values of the equilibrated matrix). A decision may be
//! `Undecided`, and then contains both possible ranks. This module does not determine the effect of
//! redundancy on reactions; `null_space` computes the dependencies. Masses are not used as weights,
//! because they create false small singular values.
//!
//! The rule, with singular values σ of `D_r·C·D_c` (maxima of rows and columns near one):
//! `τ = 10·max(eps·√(m·n), uncertainty)`, rank r is decided iff `σ_{r+1} ≤ τ` and
//! `σ_r ≥ max(10³·τ, 10⁻⁷)`. If τ is above 0.01, σ_{r+1} must also be rounding. Two other rules
//! give a certificate: `exact` assumes exact entries, and `within` uses double-double and the
//! uncertainty of the data.

mod accuracy;
mod bound;
mod certificate;
mod clear;
mod coefficient;
mod decide;
mod exact;
mod explicit;
mod graded;
mod modular;
mod outcome;
mod perturbation;
mod spectrum;
#[cfg(test)]
mod tests;
mod within;

use crate::limits::{CLEARANCE, HIDDEN, NEARLY_SINGULAR, NOISE_FACTOR, NOT_ROUNDING};
use crate::strong_basis::{self, Basis};
use linalg::{Matrix, PivotedQr, RowBasis, Scaling, kernels, singular_values};

pub use accuracy::Accuracy;
pub use certificate::{Certificate, Grounds, NearlyRedundant};
pub use coefficient::{CoefficientReading, Readings};
pub use decide::decide;
pub use exact::certify_exact;
pub use modular::ExactNullSpace;
pub use outcome::{Doubt, Evidence, RankDecision, RankError, RankStatus};
pub use spectrum::Spectrum;
pub use within::{RankReading, certify_rank, certify_within};

pub(crate) use clear::{Size, independent, size};
pub(crate) use coefficient::coefficient_noise;
pub use explicit::{
    KeptRowsError, carried, decide_dropping, decide_keeping, dropping_of_rank, with_dropped,
};

/// Works like [`decide`], with a given rank. Data within a stated tolerance may have a lower rank
/// than the matrix. The dropped rows then depend on the kept rows only approximately.
///
/// # Errors
/// Returns the same errors as [`decide`].
pub fn decide_of_rank<'a>(
    c: &Matrix,
    uncertainty: impl Into<Accuracy<'a>>,
    rank: usize,
) -> Result<RankDecision, RankError> {
    let (scaling, scaled, reading) = read(c, uncertainty.into())?;
    Ok(reading.of_rank(rank).with_strong_basis(scaling, &scaled))
}

/// Returns rows that appear independent by the pivots of one factorisation, ascending. A Newton
/// iteration may be tried with these rows; its convergence shows whether they are independent. This
/// test is not a rank decision.
///
/// ```
/// use linalg::Matrix;
/// use pfaff_rank::promising_rows;
/// let c = Matrix::from_rows(&[[1.0, 0.0], [2.0, 0.0], [0.0, 3.0]]);
/// assert_eq!(promising_rows(&c, pfaff_rank::Accuracy::Rounding)?.len(), 2);
/// # Ok::<(), pfaff_rank::RankError>(())
/// ```
///
/// # Errors
/// Returns the same errors as [`decide`].
pub fn promising_rows<'a>(
    c: &Matrix,
    uncertainty: impl Into<Accuracy<'a>>,
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

/// A rank decided from singular values, before rows are chosen.
struct Reading {
    rank: usize,
    evidence: Evidence,
    status: RankStatus,
}

/// Checks the input, equilibrates the matrix, and decides the rank.
fn read(c: &Matrix, uncertainty: Accuracy<'_>) -> Result<(Scaling, Matrix, Reading), RankError> {
    check_finite(c)?;
    let (scaling, spread) = uncertainty.equilibrate(c)?;
    let uncertainty = spread.largest;
    let scaled = scaling.apply(c);
    let tolerance = tolerance(c.nrows(), c.ncols(), uncertainty);
    let reading = Reading::new(singular_values(&scaled), tolerance, uncertainty);
    Ok((scaling, scaled, reading))
}

/// Returns τ of an m×n matrix. `uncertainty` is the uncertainty of its equilibrated entries.
pub(crate) fn tolerance(m: usize, n: usize, uncertainty: f64) -> f64 {
    let rounding = f64::EPSILON * (m as f64 * n as f64).sqrt();
    NOISE_FACTOR * rounding.max(uncertainty)
}

impl RankDecision {
    /// Returns the smallest singular value, in this equilibration, that kept rows must have to
    /// count as independent.
    #[must_use]
    pub fn required_of_kept(&self) -> f64 {
        required(self.evidence.tolerance)
    }
}

/// Returns the lower limit for singular values that count as non-zero: max(10³·τ, 10⁻⁷).
pub(crate) fn required(tolerance: f64) -> f64 {
    (CLEARANCE * tolerance).max(NEARLY_SINGULAR)
}

/// Returns σ_r and σ_{r+1}. A value is infinite for r = 0, and zero beyond the last singular value.
fn around(singular_values: &[f64], r: usize) -> [f64; 2] {
    let before = r.checked_sub(1).map(|k| singular_values[k]);
    let next = singular_values.get(r).copied();
    [before.unwrap_or(f64::INFINITY), next.unwrap_or(0.0)]
}

/// Returns σ_r / σ_{r+1}, or infinity if σ_{r+1} = 0.
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

/// Returns a combination of rows without its component in the left null space, of unit norm.
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

/// Returns the status of a rank with a clear gap. The rank is decided unless the tolerance hides
/// singular values that are not rounding.
pub(crate) fn shown(sigma_next: f64, tolerance: f64) -> RankStatus {
    if tolerance > HIDDEN && sigma_next > NOT_ROUNDING {
        RankStatus::Undecided(Doubt::Hidden {
            sigma: sigma_next,
            tolerance,
        })
    } else {
        RankStatus::Decided
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

        // Below the tolerance, all values are noise, which must not enlarge the gap.
        let clear_gap = |r: usize| {
            let [sigma_r, sigma_next] = around(&singular_values, r);
            sigma_r.min(sigma_max) / sigma_next.max(tolerance)
        };
        let rank = (lower..=upper)
            .max_by(|&a, &b| clear_gap(a).total_cmp(&clear_gap(b)))
            .unwrap_or(upper);
        let [sigma_r, sigma_next] = around(&singular_values, rank);
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

    /// Returns the result for the same singular values and a given rank.
    fn of_rank(self, rank: usize) -> Self {
        let rank = rank.min(self.evidence.singular_values.len());
        let [sigma_r, sigma_next] = around(&self.evidence.singular_values, rank);
        Self {
            rank,
            evidence: Evidence {
                sigma_r,
                sigma_next,
                gap: gap(sigma_r, sigma_next),
                ..self.evidence
            },
            status: RankStatus::Decided,
        }
    }

    /// Returns the decision on the rows with the largest pivots. Rows are exchanged until no
    /// coefficient is large.
    fn with_strong_basis(self, scaling: Scaling, scaled: &Matrix) -> RankDecision {
        let basis = if self.rank == scaled.nrows() {
            Basis::whole(self.rank)
        } else {
            let rows = RowBasis::most_independent(scaled.clone(), self.rank);
            strong_basis::bounded(scaled, rows).0
        };
        self.with_basis(scaling, basis)
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
