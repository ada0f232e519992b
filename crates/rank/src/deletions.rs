//! Determines which rows may be deleted without changing the motion, and which deletions make a
//! given multiplier unique.
//!
//! A set D of p rows is admissible iff the other rows still have rank r. Equivalently, the block
//! `Z_D` of a left null space basis must be nonsingular. Deleting D sets the multipliers of D to
//! zero, and all other multipliers become unique. If fewer rows are deleted, some multipliers
//! become unique: a combination `ℓᵀ·λ` becomes unique iff `ℓᵀ·Z` is in the row space of `Z_D`. All
//! tests use the clear gap of rank decisions, on the coefficients of the decision. If a value lies
//! in the gap, the result is an error that contains the value.
//!
//! The caller decides which rows are candidates for deletion.

mod count;
mod substitutes;
#[cfg(test)]
mod tests;

use crate::dual::{Dual, Unclear};
use crate::null_space::Support;
use crate::{Doubt, RankDecision, RankStatus, components};

pub use count::count_deletions;
pub use substitutes::{Limits, Substitutes, making_unique};

/// Reason why deletions cannot be determined.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DeletionError {
    /// The rank itself is undecided.
    #[error("the rank is undecided, so no deletion can be analysed: {0}")]
    Rank(Doubt),
    /// Whether some rows may be deleted together depends on a value that is neither certainly zero
    /// nor certainly nonzero.
    #[error(
        "whether rows can be deleted together depends on a coefficient of {}, and coefficients are accurate only to {}: use more accurate data or a smaller tolerance",
        rough(*value),
        rough(*noise)
    )]
    Unclear {
        /// The value.
        value: f64,
        /// Accuracy of the coefficients of the dependencies.
        noise: f64,
    },
    /// The number of deletions is too large.
    #[error(
        "a component with redundancy {redundancy} has too many admissible deletions to be counted"
    )]
    TooMany {
        /// Redundancy p of the component.
        redundancy: usize,
    },
    /// A row does not exist.
    #[error("row {row} does not exist, rows are 0..{rows}")]
    RowOutOfRange {
        /// The row.
        row: usize,
        /// Number of rows of the matrix.
        rows: usize,
    },
    /// The target is not a list of combinations of all multipliers of the matrix.
    #[error("combinations have {found} coefficients, there are {rows} multipliers")]
    TargetShape {
        /// Number of columns of the target.
        found: usize,
        /// Number of rows of the constraint matrix.
        rows: usize,
    },
    /// The target has an entry that is NaN or infinite.
    #[error("combination {combination}: coefficient of row {row} is {value}, need a finite number")]
    NonFinite {
        /// Row of the target.
        combination: usize,
        /// Column of the target.
        row: usize,
        /// The entry.
        value: f64,
    },
}

/// Formats a number with two significant digits, such as `0.1` or `2.3e-9`.
fn rough(x: f64) -> String {
    let rounded = format!("{x:.1e}").parse().unwrap_or(x);
    if (1e-4..1e4).contains(&rounded.abs()) {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

impl From<Unclear> for DeletionError {
    fn from(Unclear { value, noise }: Unclear) -> Self {
        Self::Unclear { value, noise }
    }
}

/// Returns the first `limit` admissible sets of p rows. The deletion of one of these sets does not
/// change the motion and makes all other multipliers unique.
///
/// The rows of a set ascend. The sets of one component (coupled rows) are in lexicographic order,
/// and several components are combined like the digits of a number. [`count_deletions`] returns the
/// number of all sets. A matrix of full rank has one such set, the empty set.
///
/// ```
/// use linalg::Matrix;
/// use pfaff_rank::{count_deletions, decide, deletions};
/// // Row 2 is the sum of rows 0 and 1, row 4 is twice row 3.
/// let c = Matrix::from_rows(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 2.0]]);
/// let decision = decide(&c, pfaff_rank::Accuracy::Rounding)?;
/// assert_eq!(count_deletions(&decision), Ok(6)); // one of three, one of two
/// assert_eq!(deletions(&decision, 3).unwrap(), [[0, 3], [0, 4], [1, 3]]);
/// # Ok::<(), pfaff_rank::RankError>(())
/// ```
///
/// # Errors
/// - [`DeletionError::Rank`]: the rank is undecided.
/// - [`DeletionError::Unclear`]: it is undecided whether some set is admissible.
pub fn deletions(decision: &RankDecision, limit: usize) -> Result<Vec<Vec<usize>>, DeletionError> {
    let mut sets = vec![Vec::new()];
    for dual in duals(decision)? {
        let mut bases = Vec::new();
        let all: Vec<usize> = (0..dual.rows.len()).collect();
        list_bases(&dual, &all, 0, &mut Vec::new(), limit, &mut bases)?;
        let both = |set: &Vec<usize>, basis: &Vec<usize>| [set.as_slice(), basis].concat();
        sets = sets
            .iter()
            .flat_map(|set| bases.iter().map(move |basis| both(set, basis)))
            .take(limit)
            .collect();
    }
    sets.truncate(limit);
    sets.iter_mut().for_each(|set| set.sort_unstable());
    Ok(sets)
}

/// Returns the dual of each component.
fn duals(decision: &RankDecision) -> Result<Vec<Dual>, DeletionError> {
    require_rank(decision)?;
    let support = Support::new(decision);
    let parts = components(decision).coupled;
    Ok(parts
        .iter()
        .map(|rows| Dual::new(decision, &support, rows))
        .collect())
}

fn require_rank(decision: &RankDecision) -> Result<(), DeletionError> {
    match decision.status {
        RankStatus::Decided => Ok(()),
        RankStatus::Undecided(doubt) => Err(DeletionError::Rank(doubt)),
    }
}

/// Adds to `bases` the bases that contain `chosen` and otherwise rows from index `next` onwards.
/// Every branch of the search ends in a basis, so the work for each basis is bounded.
fn list_bases(
    dual: &Dual,
    all: &[usize],
    next: usize,
    chosen: &mut Vec<usize>,
    limit: usize,
    bases: &mut Vec<Vec<usize>>,
) -> Result<(), Unclear> {
    if bases.len() >= limit {
        return Ok(());
    }
    if chosen.len() == dual.dimension() {
        bases.push(chosen.iter().map(|&k| dual.rows[k]).collect());
        return Ok(());
    }
    for k in next..all.len() {
        let rest = [chosen.as_slice(), &all[k..]].concat();
        if dual.rank(&rest)? < dual.dimension() {
            break;
        }
        chosen.push(k);
        if dual.rank(chosen)? == chosen.len() {
            list_bases(dual, all, k + 1, chosen, limit, bases)?;
        }
        chosen.pop();
    }
    Ok(())
}
