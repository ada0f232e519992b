//! The rank of a matrix whose entries are exact.
//!
//! The rows are proposed in floating point, and the rank is decided by arithmetic modulo primes.
//! The decision needs no tolerance, and the result is always decided.

use super::certificate::{Certificate, Grounds, NearlyRedundant};
use super::graded::RowLevels;
use super::modular::{ExactBasis, Integers, exact_basis};
use super::{Evidence, RankDecision, RankError, RankStatus, check_finite, gap, projected};
use crate::limits::{COEFFICIENT_BOUND, EXCHANGE_ROUNDS, NEARLY_REDUNDANT};
use crate::strong_basis;
use linalg::{Dd, DdMatrix, Matrix, equilibrate, kernels};

/// Decides the rank of C (m×n) exactly. The entries are dyadic rationals and count as exact.
///
/// A minor that is not zero modulo a prime proves that the rank is at least r. If all larger minors
/// are zero modulo primes whose product exceeds Hadamard's bound, the rank is not larger. The
/// dependencies T are rounded from their exact values, so their zeros are exact. The time grows
/// with the number of digits of the minors. A redundant 22×21 matrix takes less than a millisecond,
/// and a 200×200 matrix takes seconds. Use [`certify_within`](crate::certify_within) for entries
/// that come from measured or rounded data.
///
/// ```
/// use linalg::Matrix;
/// use pfaff_rank::{Grounds, certify_exact};
/// // Row 2 differs from the sum of the others by the last bit of one entry …
/// let mut c = Matrix::from_rows(&[[1.0, 0.0, 2.0], [0.0, 1.0, 0.0], [1.0, 1.0, 2.0 + 4.0 * f64::EPSILON]]);
/// let decision = certify_exact(&c)?;
/// assert_eq!(decision.rank, 3);
/// assert!(decision.nearly_redundant().is_some_and(|near| near.sigma < 1e-15));
/// // … and now by nothing.
/// c[(2, 2)] = 2.0;
/// let decision = certify_exact(&c)?;
/// assert_eq!(decision.rank, 2);
/// assert_eq!(decision.evidence.certificate.map(|c| c.grounds), Some(Grounds::Exact));
/// # Ok::<(), pfaff_rank::RankError>(())
/// ```
///
/// # Errors
/// [`RankError::NonFinite`]: an entry is NaN or infinite.
pub fn certify_exact(c: &Matrix) -> Result<RankDecision, RankError> {
    check_finite(c)?;
    let (m, n) = (c.nrows(), c.ncols());
    let scaling = equilibrate(c);
    let scaled = scaling.apply(c);
    // Below this limit, the singular values are noise of double-double. Below it, only the
    // arithmetic modulo primes decides, and a proposal is not needed.
    let floor = 16.0 * (m.max(1) as f64) * (n.max(1) as f64) * Dd::EPSILON;
    let graded = RowLevels::new(&DdMatrix::from(&scaled), floor);

    let integers = Integers::new(c, &scaling);
    let mut order = graded.kept.clone();
    order.extend(&graded.left);
    let mut basis = exact_basis(&integers, &scaling, &order);
    for _ in 0..EXCHANGE_ROUNDS {
        if basis.t.max_abs() <= COEFFICIENT_BOUND {
            break;
        }
        let ExactBasis {
            mut t,
            mut kept,
            mut dropped,
        } = basis;
        strong_basis::exchange_all(&mut t, &mut kept, &mut dropped);
        kept.extend(dropped);
        basis = exact_basis(&integers, &scaling, &kept);
    }
    let ExactBasis { kept, dropped, t } = basis;
    let rank = kept.len();
    let residual = largest_residual(&scaled, &kept, &dropped, &t);

    let mut sigma = graded.singular_values(m.min(n));
    for sigma in &mut sigma[..rank] {
        // The value is not zero, even if double-double shows zero.
        *sigma = sigma.max(f64::MIN_POSITIVE);
    }
    let sigma_r = rank.checked_sub(1).map_or(f64::INFINITY, |r| sigma[r]);
    let sigma_next = sigma.get(rank).copied().unwrap_or(0.0);
    let sigma_bound = graded
        .bounds()
        .into_iter()
        .find(|&(count, _)| count >= rank)
        .map_or(0.0, |(_, bound)| bound);
    let mut decision = RankDecision {
        rank,
        redundancy: dropped.len(),
        kept,
        dropped,
        coefficients: t,
        scaling,
        evidence: Evidence {
            sigma_r,
            sigma_next,
            gap: gap(sigma_r, sigma_next),
            tolerance: 0.0,
            constraint_residual: 0.0,
            dependence_residual: residual,
            singular_values: sigma,
            certificate: None,
        },
        status: RankStatus::Decided,
    };
    let nearly_redundant = (sigma_r < NEARLY_REDUNDANT).then(|| {
        // Rows whose independence is detected only modulo primes.
        let hidden = graded.left.iter().position(|i| decision.kept.contains(i));
        let direction = match hidden {
            Some(j) => graded.left_direction(j),
            None => graded.smallest_direction().unwrap_or_default(),
        };
        NearlyRedundant {
            sigma: sigma_r,
            direction: projected(&decision, direction),
        }
    });
    decision.evidence.certificate = Some(Certificate {
        rank_at_least: rank,
        sigma_bound,
        sigma_next,
        grounds: if rank == m.min(n) {
            Grounds::FullRank
        } else {
            Grounds::Exact
        },
        uncertainty: 0.0,
        spread: 0.0,
        row_noise: Vec::new(),
        nearly_redundant,
        lower_rank_here: None,
        lower_rank_from: None,
        lower_rank_by_angles: false,
        row_data: None,
        row_turn: None,
        open_rows: Vec::new(),
        has_tolerance: false,
    });
    Ok(decision)
}

/// Returns the largest `‖row of C_D − T·C_K‖₂`. In an exact decision this norm contains only the
/// rounding of T.
fn largest_residual(c: &Matrix, kept: &[usize], dropped: &[usize], t: &Matrix) -> f64 {
    let mut largest = 0.0_f64;
    for (j, &row) in dropped.iter().enumerate() {
        let mut outside = c.row(row).to_vec();
        for (&t_ji, &i) in t.row(j).iter().zip(kept) {
            kernels::axpy(-t_ji, c.row(i), &mut outside);
        }
        largest = largest.max(kernels::norm(&outside));
    }
    largest
}

#[cfg(test)]
mod tests;
