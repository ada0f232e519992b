//! The rank of the matrix of a model. The entries are computed in double-double, and the data have
//! an uncertainty.
//!
//! If the precision is doubled, a singular value that is exactly zero decreases from 1e-16 to
//! 1e-32. A small nonzero value does not change. Such a value is compared with the uncertainty of
//! the data, not with the rounding of `f64`.

use super::certificate::{Certificate, Grounds, NearlyRedundant};
use super::graded::RowLevels;
use super::perturbation;
use super::{
    Accuracy, Doubt, Evidence, RankDecision, RankError, RankStatus, Reading, Spectrum,
    check_finite, gap, projected,
};
use crate::limits::{CLEAR_OF_DATA, HIDDEN, NEARLY_REDUNDANT, NOISE_FACTOR, VANISHES};
use crate::strong_basis::{self, Basis};
use linalg::{Dd, DdMatrix, Scaling};

/// Decides the rank of C (m×n) for a model whose data have the given uncertainty. C must be
/// evaluated in double-double at a refined configuration.
///
/// | argument | meaning |
/// | --- | --- |
/// | `c` | constraint matrix; its entries have errors of double-double only |
/// | `uncertainty` | distance between the entries and the entries of the intended model; see [`Accuracy`]. Near a singular configuration the entries change with the square root of the data |
///
/// Let u be the largest uncertainty of an equilibrated entry, s the Frobenius norm of all
/// uncertainties, and `τ = max(10·u, s)`. A singular value below τ is zero for some matrix within
/// the uncertainty. A singular value above 4·τ is not zero for any such matrix. There are four
/// results: exactly redundant (σ_{r+1} ≤ 1e-26, [`Grounds::Vanishes`]); redundant within the data
/// ([`Grounds::WithinData`]); of full rank, but possibly [nearly
/// redundant](RankDecision::nearly_redundant); or undecided. The result is undecided between τ and
/// 4·τ. The result is also undecided if τ is above 0.01, because entries of about one would be
/// hidden.
///
/// ```
/// use linalg::{Dd, DdMatrix, Matrix};
/// use pfaff_rank::{Grounds, certify_within};
/// let grounds = |misalignment: f64| {
///     let mut c = DdMatrix::from(&Matrix::from_rows(&[[1.0, 1.0, 0.0], [1.0, 1.0, 0.0]]));
///     c[(1, 0)] += Dd::from(misalignment);
///     let decision = certify_within(&c, pfaff_rank::Accuracy::Absolute(2e-16)).unwrap();
///     (decision.rank, decision.evidence.certificate.unwrap().grounds)
/// };
/// assert_eq!(grounds(0.0), (1, Grounds::Vanishes));
/// assert_eq!(grounds(1e-20), (1, Grounds::WithinData)); // f64 would not see it at all
/// assert_eq!(grounds(1e-13), (2, Grounds::FullRank)); // nearly redundant, not redundant
/// ```
///
/// # Errors
/// - [`RankError::NonFinite`]: an entry is NaN or infinite.
/// - [`RankError::Uncertainty`], [`RankError::UncertaintyShape`]: the uncertainty is negative, NaN,
///   infinite or of another shape.
pub fn certify_within<'a>(
    c: &DdMatrix,
    uncertainty: impl Into<Accuracy<'a>>,
) -> Result<RankDecision, RankError> {
    let leading = c.hi();
    check_finite(&leading)?;
    let (m, n) = (c.nrows(), c.ncols());
    let known = uncertainty.into();
    let (scaling, spread) = known.equilibrate(&leading)?;
    let root = (m as f64 * n as f64).sqrt();
    // Entries in double-double are not more accurate than this value, even if the caller states a
    // higher accuracy.
    let rounding = 4.0 * root.max(1.0) * Dd::EPSILON;
    let (uncertainty, spread) = (
        spread.largest.max(rounding),
        spread.norm.max(rounding * root),
    );
    let tolerance = spread.max(NOISE_FACTOR * uncertainty);
    let required = CLEAR_OF_DATA * tolerance;
    let graded = RowLevels::new(&c.scaled(&scaling), tolerance);

    let sigma = graded.singular_values(m.min(n));
    let rank = graded.kept.len();
    let sigma_r = rank.checked_sub(1).map_or(f64::INFINITY, |r| sigma[r]);
    let sigma_next = sigma.get(rank).copied().unwrap_or(0.0);
    let lower = sigma[..rank].partition_point(|&s| s > required);
    let sigma_max = sigma.first().copied().unwrap_or(0.0);
    let status = if rank == 0 && sigma_max > VANISHES {
        RankStatus::Undecided(Doubt::NotPolished {
            sigma_max,
            tolerance,
        })
    } else if lower < rank {
        RankStatus::Undecided(Doubt::NearUncertainty {
            lower,
            upper: rank,
            sigma: sigma_r,
            tolerance,
            required,
        })
    } else if sigma_next > VANISHES && tolerance > HIDDEN {
        RankStatus::Undecided(Doubt::Hidden {
            sigma: sigma_next,
            tolerance,
        })
    } else {
        RankStatus::Decided
    };

    let rule = RankEvidence {
        scaling,
        status,
        tolerance,
        uncertainty,
        spread,
        grounds: match sigma_next {
            _ if rank == m.min(n) => Grounds::FullRank,
            sigma if sigma <= VANISHES => Grounds::Vanishes,
            _ => Grounds::WithinData,
        },
    };
    Ok(rule.decision(&graded, &leading, known))
}

/// A rank that was decided in f64, with its evidence; see [`certify_rank`].
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct RankReading {
    /// Rank r.
    pub rank: usize,
    /// Whether the rank is decided, or the reason why it is undecided.
    pub status: RankStatus,
    /// The scaling of the decision.
    pub scaling: Scaling,
    /// The equilibrated matrix of the decision.
    pub matrix: Spectrum,
    /// Uncertainty of all entries together. A singular value below it counts as zero.
    pub noise: f64,
    /// Lower limit of the non-zero singular values. If a nonzero singular value is smaller, the
    /// matrix does not have this rank.
    pub separation: f64,
    /// Reason why the remaining rows count as redundant although their singular values do not
    /// vanish at doubled precision.
    pub grounds: Grounds,
}

/// Chooses kept rows and computes dependencies and double-double evidence for a given rank. The
/// rank was decided from data with the given uncertainty (m×n, in the units of C). Returns `None`
/// if double-double gives another rank, because the given rank then belongs to another matrix.
///
/// # Errors
/// Returns the same errors as [`certify_within`].
pub fn certify_rank(
    c: &DdMatrix,
    uncertainty: &linalg::Matrix,
    reading: &RankReading,
) -> Result<Option<RankDecision>, RankError> {
    let leading = c.hi();
    check_finite(&leading)?;
    let known = Accuracy::Entries(uncertainty);
    let spread = known.equilibrated(&leading, &reading.scaling)?;
    let graded = RowLevels::of_rank(&c.scaled(&reading.scaling), reading.rank, &reading.matrix);
    let (m, n) = (c.nrows(), c.ncols());
    let sigma = graded.singular_values(m.min(n));
    let least = reading.rank.checked_sub(1).map(|r| sigma[r]);
    if graded.kept.len() != reading.rank || least.is_some_and(|least| least <= reading.separation) {
        return Ok(None);
    }
    let sigma_next = sigma.get(reading.rank).copied().unwrap_or(0.0);
    let found = RankEvidence {
        scaling: reading.scaling.clone(),
        status: reading.status,
        tolerance: reading.noise,
        uncertainty: spread.largest,
        spread: spread.norm,
        grounds: match sigma_next {
            _ if reading.rank == m.min(n) => Grounds::FullRank,
            sigma if sigma <= VANISHES => Grounds::Vanishes,
            _ => reading.grounds,
        },
    };
    Ok(Some(found.decision(&graded, &leading, known)))
}

/// A rank and its evidence.
struct RankEvidence {
    scaling: Scaling,
    status: RankStatus,
    tolerance: f64,
    uncertainty: f64,
    spread: f64,
    grounds: Grounds,
}

impl RankEvidence {
    /// Returns the decision with its certificate, for rows chosen level by level.
    fn decision(
        self,
        graded: &RowLevels,
        leading: &linalg::Matrix,
        known: Accuracy<'_>,
    ) -> RankDecision {
        let sigma = graded.singular_values(leading.nrows().min(leading.ncols()));
        let rank = graded.kept.len();
        let sigma_r = rank.checked_sub(1).map_or(f64::INFINITY, |r| sigma[r]);
        let sigma_next = sigma.get(rank).copied().unwrap_or(0.0);
        let bounds = graded.bounds();
        let rank_at_least = bounds
            .iter()
            .rev()
            .find(|b| b.1 > self.spread)
            .map_or(0, |b| b.0);
        let sigma_bound = bounds.last().map_or(0.0, |b| b.1);
        let (mut t, mut kept, mut dropped) = (
            graded.dependence(),
            graded.kept.clone(),
            graded.left.clone(),
        );
        strong_basis::exchange_all(&mut t, &mut kept, &mut dropped);
        let basis = Basis::sorted(&kept, &dropped, &t, graded.residual());
        let reading = Reading {
            rank,
            status: self.status,
            evidence: Evidence {
                sigma_r,
                sigma_next,
                gap: gap(sigma_r, sigma_next),
                tolerance: self.tolerance,
                constraint_residual: self.uncertainty,
                dependence_residual: 0.0,
                singular_values: sigma,
                certificate: None,
            },
        };
        let mut decision = reading.with_basis(self.scaling, basis);
        let nearly_redundant = (sigma_r < NEARLY_REDUNDANT).then(|| NearlyRedundant {
            sigma: sigma_r,
            direction: projected(&decision, graded.smallest_direction().unwrap_or_default()),
        });
        let inverse = graded.inverse_of(&decision.kept);
        let row_noise = perturbation::row_noise(&decision, leading, known, inverse);
        decision.evidence.certificate = Some(Certificate {
            rank_at_least,
            sigma_bound,
            sigma_next,
            grounds: self.grounds,
            uncertainty: self.uncertainty,
            spread: self.spread,
            row_noise,
            nearly_redundant,
            lower_rank_here: None,
            lower_rank_from: None,
            lower_rank_by_angles: false,
            row_data: None,
            row_turn: None,
            open_rows: Vec::new(),
            has_tolerance: false,
        });
        decision
    }
}

#[cfg(test)]
mod tests;
