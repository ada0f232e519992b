//! Decisions with given dropped or kept rows, after a check that the choice is admissible.
//!
//! A list D of dropped rows is admissible iff `|D| = p` and the other rows have full rank r.
//! Equivalently, the rows D of a left null space basis Z form a nonsingular block.

use super::{Accuracy, Evidence, RankDecision, RankError, Reading, gap, read, required, shown};
use crate::strong_basis::{self, Basis, complement};
use linalg::{Matrix, RowBasis, Scaling, kernels, singular_values};

/// Reason why a choice of rows is not admissible.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum KeptRowsError {
    /// The matrix itself is invalid.
    #[error(transparent)]
    Rank(#[from] RankError),
    /// The number of rows does not match the rank.
    #[error(
        "{dropped} rows dropped and {kept} kept, but the rank is {rank} of {rows} rows: drop exactly {}",
        rows - rank
    )]
    WrongCount {
        /// Number of rows dropped by the request.
        dropped: usize,
        /// Number of rows kept by the request.
        kept: usize,
        /// Rank of the matrix.
        rank: usize,
        /// Number of rows of the matrix.
        rows: usize,
    },
    /// A row does not exist.
    #[error("row {row} does not exist, rows are 0..{rows}")]
    RowOutOfRange {
        /// The requested row.
        row: usize,
        /// Number of rows of the matrix.
        rows: usize,
    },
    /// A row is listed twice.
    #[error("row {row} is listed twice")]
    Duplicate {
        /// The row.
        row: usize,
    },
    /// The rows that are not dropped depend on each other, so at least one of the dropped rows is
    /// required.
    #[error(
        "the kept rows are dependent: smallest singular value {smallest_singular_value:.3e}, need \
         {required:.3e}; a row in no dependency must not be dropped"
    )]
    Dependent {
        /// Smallest singular value of the equilibrated kept rows.
        smallest_singular_value: f64,
        /// Lower limit for a decided rank, 10³·τ.
        required: f64,
    },
}

/// Works like [`decide`](super::decide), with given dropped rows. In this case `|T̃_ji| ≤ 2` is not
/// guaranteed.
///
/// ```
/// use linalg::Matrix;
/// use pfaff_rank::{KeptRowsError, decide_dropping};
/// let c = Matrix::from_rows(&[[1.0, 0.0], [0.0, 1.0], [0.0, 3.0]]);
/// let decision = decide_dropping(&c, pfaff_rank::Accuracy::Rounding, &[1])?;
/// assert_eq!(decision.kept, [0, 2]);
/// // Row 0 is in no dependency.
/// let refused = decide_dropping(&c, pfaff_rank::Accuracy::Rounding, &[0]).unwrap_err();
/// assert!(matches!(refused, KeptRowsError::Dependent { .. }));
/// # Ok::<(), KeptRowsError>(())
/// ```
///
/// # Errors
/// - [`KeptRowsError::Rank`]: the matrix or the residual is not finite.
/// - [`KeptRowsError::RowOutOfRange`], [`KeptRowsError::Duplicate`]: the list is malformed.
/// - [`KeptRowsError::WrongCount`]: the list does not have m − r rows.
/// - [`KeptRowsError::Dependent`]: the remaining rows do not have full rank.
pub fn decide_dropping<'a>(
    c: &Matrix,
    uncertainty: impl Into<Accuracy<'a>>,
    dropped: &[usize],
) -> Result<RankDecision, KeptRowsError> {
    let dropped = ascending(dropped, c.nrows())?;
    decide_partition(c, uncertainty.into(), complement(c.nrows(), &dropped), None)
}

/// Works like [`decide_dropping`], with a given rank. Data within a stated tolerance may have a
/// lower rank than the matrix. The dropped rows then depend on the kept rows only approximately.
///
/// # Errors
/// Returns the same errors as [`decide_dropping`].
pub fn dropping_of_rank<'a>(
    c: &Matrix,
    uncertainty: impl Into<Accuracy<'a>>,
    dropped: &[usize],
    rank: usize,
) -> Result<RankDecision, KeptRowsError> {
    let dropped = ascending(dropped, c.nrows())?;
    let kept = complement(c.nrows(), &dropped);
    decide_partition(c, uncertainty.into(), kept, Some(rank))
}

/// Returns a decision on C with other dropped rows. Rank, scaling and evidence do not change, and
/// `|T̃_ji| ≤ 2` is not guaranteed.
///
/// ```
/// use linalg::Matrix;
/// use pfaff_rank::{decide, with_dropped};
/// let c = Matrix::from_rows(&[[1.0, 0.0], [0.0, 1.0], [0.0, 3.0]]);
/// let decision = decide(&c, pfaff_rank::Accuracy::Rounding)?;
/// let other = with_dropped(&decision, &c, &[1])?;
/// assert_eq!((other.rank, other.kept), (2, vec![0, 2]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Returns the same errors as [`decide_dropping`], with the rank of the decision.
pub fn with_dropped(
    decision: &RankDecision,
    c: &Matrix,
    dropped: &[usize],
) -> Result<RankDecision, KeptRowsError> {
    let dropped = ascending(dropped, c.nrows())?;
    let kept = complement(c.nrows(), &dropped);
    let reading = Reading {
        rank: decision.rank,
        evidence: decision.evidence.clone(),
        status: decision.status,
    };
    let scaled = decision.scaling.apply(c);
    on_rows((decision.scaling.clone(), &scaled, reading), kept)
}

/// Carries a decision to a neighbouring matrix, such as C at another configuration of a motion. The
/// scaling and the tolerance τ do not change. The kept rows change only if a coefficient exceeds 2.
/// Instead of singular values, the function computes two bounds from the factors of the kept rows:
/// `σ_r ≥ 1/‖C_K⁺‖` and `σ_{r+1} ≤ ‖C_D − T·C_K‖` (Frobenius norms). The evidence contains the
/// bounds. Returns `None` if the bounds do not satisfy the rule for a decided rank, if the decision
/// was undecided, or if the matrix has another shape.
///
/// ```
/// use linalg::Matrix;
/// use pfaff_rank::{Accuracy, carried, decide};
/// let parallel = |x: f64| Matrix::from_rows(&[[1.0, x], [2.0, 2.0 * x], [x, 1.0]]);
/// let decision = decide(&parallel(0.5), Accuracy::Rounding)?;
/// let near = carried(&decision, &parallel(0.25)).expect("the same rank");
/// assert_eq!((near.rank, &near.kept), (2, &decision.kept));
/// // At x = 1 all rows are parallel.
/// assert_eq!(carried(&decision, &parallel(1.0)), None);
/// # Ok::<(), pfaff_rank::RankError>(())
/// ```
#[must_use]
pub fn carried(decision: &RankDecision, c: &Matrix) -> Option<RankDecision> {
    let shape = [decision.scaling.rows.len(), decision.scaling.cols.len()];
    let is_same = shape == [c.nrows(), c.ncols()];
    if !is_same || !decision.is_decided() || c.first_non_finite().is_some() {
        return None;
    }
    let scaled = decision.scaling.apply(c);
    let rows = RowBasis::of_rows(&scaled, decision.kept.clone());
    let (basis, rows) = strong_basis::bounded(&scaled, rows);
    let tolerance = decision.evidence.tolerance;
    let sigma_r = rows.factored().inverse_norm().recip();
    let outside = (0..basis.dropped.len()).map(|j| kernels::norm(rows.outside(j)));
    let sigma_next = outside.fold(0.0, f64::hypot);
    if sigma_next > tolerance || sigma_r < required(tolerance) || sigma_r.is_nan() {
        return None;
    }
    let reading = Reading {
        rank: decision.rank,
        evidence: Evidence {
            sigma_r,
            sigma_next,
            gap: gap(sigma_r, sigma_next),
            tolerance,
            constraint_residual: decision.evidence.constraint_residual,
            dependence_residual: 0.0,
            singular_values: Vec::new(),
            certificate: None,
        },
        status: shown(sigma_next, tolerance),
    };
    let carried = reading.with_basis(decision.scaling.clone(), basis);
    carried.is_decided().then_some(carried)
}

/// Works like [`decide`](super::decide), with given kept rows. In this case `|T̃_ji| ≤ 2` is not
/// guaranteed.
///
/// # Errors
/// Returns the same errors as [`decide_dropping`].
pub fn decide_keeping<'a>(
    c: &Matrix,
    uncertainty: impl Into<Accuracy<'a>>,
    kept: &[usize],
) -> Result<RankDecision, KeptRowsError> {
    let kept = ascending(kept, c.nrows())?;
    decide_partition(c, uncertainty.into(), kept, None)
}

fn decide_partition(
    c: &Matrix,
    uncertainty: Accuracy<'_>,
    kept: Vec<usize>,
    rank: Option<usize>,
) -> Result<RankDecision, KeptRowsError> {
    let (scaling, scaled, reading) = read(c, uncertainty)?;
    let reading = match rank {
        Some(rank) => reading.of_rank(rank),
        None => reading,
    };
    on_rows((scaling, &scaled, reading), kept)
}

/// Returns the decision on these kept rows of an equilibrated matrix.
fn on_rows(
    (scaling, scaled, reading): (Scaling, &Matrix, Reading),
    kept: Vec<usize>,
) -> Result<RankDecision, KeptRowsError> {
    let rows = scaled.nrows();
    if kept.len() != reading.rank {
        return Err(KeptRowsError::WrongCount {
            dropped: rows - kept.len(),
            kept: kept.len(),
            rank: reading.rank,
            rows,
        });
    }
    let required = required(reading.evidence.tolerance);
    if let Some(&smallest) = singular_values(&scaled.select_rows(&kept)).last()
        && smallest < required
    {
        return Err(KeptRowsError::Dependent {
            smallest_singular_value: smallest,
            required,
        });
    }
    let basis = if kept.len() == rows {
        Basis::whole(rows)
    } else {
        Basis::of(&RowBasis::of_rows(scaled, kept))
    };
    Ok(reading.with_basis(scaling, basis))
}

/// Returns the list in ascending order. The function first checks that no row is repeated or out of
/// range.
fn ascending(rows: &[usize], m: usize) -> Result<Vec<usize>, KeptRowsError> {
    let mut sorted = rows.to_vec();
    sorted.sort_unstable();
    if let Some(&row) = sorted.last()
        && row >= m
    {
        return Err(KeptRowsError::RowOutOfRange { row, rows: m });
    }
    match sorted.windows(2).find(|w| w[0] == w[1]) {
        Some(w) => Err(KeptRowsError::Duplicate { row: w[0] }),
        None => Ok(sorted),
    }
}
