//! The rank of a matrix that comes from a model: entries in double-double, data known to an uncertainty.
//!
//! A singular value that is exactly zero falls from 1e-16 to 1e-32 when the precision is doubled; one that is merely small stays. If it
//! stays, it is compared with what the data are known to, never with the rounding of `f64`.

use super::certificate::{Certificate, Grounds, NEARLY_REDUNDANT, NearlyRedundant};
use super::graded::Graded;
use super::perturbation;
use super::{
    Doubt, Evidence, HIDDEN, NOISE_FACTOR, RankDecision, RankError, RankStatus, Reading,
    Uncertainty, check_finite, gap, projected,
};
use crate::strong_basis::{self, Basis};
use crate::{Dd, DdMatrix};

/// σ_{r+1} vanishes if it falls by ten digits below the 1e-16 of `f64`; what remains is the polishing of the point in double-double.
const VANISHES: f64 = 1e-26;

/// Above this multiple of the tolerance a singular value is larger than the data can explain.
const CLEAR_OF_DATA: f64 = 4.0;

/// Decides the rank of C (m×n), evaluated in double-double at a polished point, of a model whose data are known to `uncertainty`.
///
/// | argument | meaning |
/// | --- | --- |
/// | `c` | constraint matrix; its entries carry errors of double-double only |
/// | `uncertainty` | how far the entries may be from those of the model meant; see [`Uncertainty`]. Near a singular configuration they move with the root of the data |
///
/// With u, the largest uncertainty of an equilibrated entry, s, the Frobenius norm of all, and `τ = max(10·u, s)`: a singular value below τ is zero for some matrix within the uncertainty, one above 4·τ is not zero for any. Then:
/// redundant exactly (σ_{r+1} ≤ 1e-26, [`Grounds::Vanishes`]); redundant within the data ([`Grounds::WithinData`]); of full rank although
/// [nearly redundant](RankDecision::nearly_redundant); or undecided between τ and 4·τ, and where τ is above 0.01: entries of size one would be hidden.
///
/// ```
/// use linalg::{Dd, DdMatrix, Grounds, Matrix, certify_within};
/// let grounds = |misalignment: f64| {
///     let mut c = DdMatrix::from(&Matrix::from_rows(&[[1.0, 1.0, 0.0], [1.0, 1.0, 0.0]]));
///     c[(1, 0)] += Dd::from(misalignment);
///     let decision = certify_within(&c, 2e-16).unwrap();
///     (decision.rank, decision.evidence.certificate.unwrap().grounds)
/// };
/// assert_eq!(grounds(0.0), (1, Grounds::Vanishes));
/// assert_eq!(grounds(1e-20), (1, Grounds::WithinData)); // f64 would not see it at all
/// assert_eq!(grounds(1e-13), (2, Grounds::FullRank)); // nearly redundant, not redundant
/// ```
///
/// # Errors
/// - [`RankError::NonFinite`]: an entry is NaN or infinite.
/// - [`RankError::Uncertainty`], [`RankError::UncertaintyShape`]: the uncertainty is negative, NaN, infinite or of another matrix.
pub fn certify_within<'a>(
    c: &DdMatrix,
    uncertainty: impl Into<Uncertainty<'a>>,
) -> Result<RankDecision, RankError> {
    let leading = c.hi();
    check_finite(&leading)?;
    let (m, n) = (c.nrows(), c.ncols());
    let known = uncertainty.into();
    let (scaling, spread) = known.equilibrate(&leading)?;
    let root = (m as f64 * n as f64).sqrt();
    // Entries in double-double are no better than this, whatever the caller knows.
    let rounding = 4.0 * root.max(1.0) * Dd::EPSILON;
    let (uncertainty, spread) = (
        spread.largest.max(rounding),
        spread.norm.max(rounding * root),
    );
    let tolerance = spread.max(NOISE_FACTOR * uncertainty);
    let required = CLEAR_OF_DATA * tolerance;
    let graded = Graded::new(&c.scaled(&scaling), tolerance);

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

    let bounds = graded.bounds();
    let rank_at_least = bounds
        .iter()
        .rev()
        .find(|b| b.1 > spread)
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
        status,
        evidence: Evidence {
            sigma_r,
            sigma_next,
            gap: gap(sigma_r, sigma_next),
            tolerance,
            constraint_residual: uncertainty,
            dependence_residual: 0.0,
            singular_values: sigma,
            certificate: None,
        },
    };
    let mut decision = reading.with_basis(scaling, basis);
    let nearly_redundant = (sigma_r < NEARLY_REDUNDANT).then(|| NearlyRedundant {
        sigma: sigma_r,
        direction: projected(&decision, graded.smallest_direction().unwrap_or_default()),
    });
    let row_noise = perturbation::row_noise(&decision, &leading, known);
    decision.evidence.certificate = Some(Certificate {
        rank_at_least,
        sigma_bound,
        sigma_next,
        grounds: if rank == m.min(n) {
            Grounds::FullRank
        } else if sigma_next <= VANISHES {
            Grounds::Vanishes
        } else {
            Grounds::WithinData
        },
        uncertainty,
        spread,
        row_noise,
        nearly_redundant,
    });
    Ok(decision)
}

#[cfg(test)]
mod tests;
