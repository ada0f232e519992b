//! Decisions with given dropped or kept rows, after a check that the choice is admissible.
//!
//! A list D of dropped rows is admissible iff `|D| = p` and the other rows have full rank r.
//! Equivalently, the rows D of a left null space basis Z form a nonsingular block.

use super::{Accuracy, RankDecision, RankError, Reading, read, required};
use crate::strong_basis::{Basis, complement};
use linalg::{Matrix, RowBasis, Scaling, singular_values};

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
