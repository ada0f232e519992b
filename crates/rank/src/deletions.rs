//! Which rows may be deleted so that the motion stays, and which deletions make a wanted multiplier
//! unique.
//!
//! A set D of p rows is admissible iff the other rows still have rank r; equivalently iff the block
//! `Z_D` of a left null space basis is nonsingular. The multipliers of D are then zero by decree
//! and all others are unique. Deleting fewer rows makes some of them unique: a combination `ℓᵀ·λ`
//! becomes unique iff `ℓᵀ·Z` lies in the row space of `Z_D`. All of it is decided with the clear
//! gap of rank decisions, on the coefficients of the decision; where a number lies in the gap, that
//! is the answer.
//!
//! Not here: which rows it is sensible to delete. The caller says which are candidates.

mod count;
mod substitutes;
#[cfg(test)]
mod tests;

use crate::dual::{Dual, Unclear};
use crate::null_space::Support;
use crate::{Doubt, RankDecision, RankStatus, components};

pub use count::count_deletions;
pub use substitutes::{Limits, Substitutes, making_unique};

/// Why deletions cannot be told.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DeletionError {
    /// The rank itself is undecided.
    #[error("the rank is undecided, so no deletion can be judged: {0}")]
    Rank(Doubt),
    /// Whether some rows may be deleted together hangs on a number that is neither zero nor
    /// certainly not.
    #[error(
        "whether rows can be deleted together hangs on {value:.3e}, between the rounding {noise:.3e} of the dependencies and what is \
         certainly not zero; polish the point or decide in higher precision"
    )]
    Unclear {
        /// The number.
        value: f64,
        /// Below this it would be zero.
        noise: f64,
    },
    /// Too many to be counted.
    #[error(
        "a component with redundancy {redundancy} has too many admissible deletions to be counted"
    )]
    TooMany {
        /// p of the component.
        redundancy: usize,
    },
    /// A row that does not exist.
    #[error("row {row} does not exist, rows are 0..{rows}")]
    RowOutOfRange {
        /// The row.
        row: usize,
        /// Rows of the matrix.
        rows: usize,
    },
    /// The target is no list of combinations of all multipliers.
    #[error("combinations have {found} coefficients, there are {rows} multipliers")]
    TargetShape {
        /// Columns of the target.
        found: usize,
        /// Rows of the constraint matrix.
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

impl From<Unclear> for DeletionError {
    fn from(Unclear { value, noise }: Unclear) -> Self {
        Self::Unclear { value, noise }
    }
}

/// The first `limit` admissible sets of p rows: deleting one of them leaves the motion as it is and
/// all multipliers unique.
///
/// Sets ascend; those of one component (rows that mix) come in lexicographic order, several
/// components combine like the digits of a number. How many there are is [`count_deletions`]. Full
/// rank has one such set, the empty one.
///
/// ```
/// use linalg::Matrix;
/// use rank::{count_deletions, decide, deletions};
/// // Row 2 is the sum of rows 0 and 1, row 4 is twice row 3.
/// let c = Matrix::from_rows(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 2.0]]);
/// let decision = decide(&c, 0.0)?;
/// assert_eq!(count_deletions(&decision), Ok(6)); // one of three, one of two
/// assert_eq!(deletions(&decision, 3).unwrap(), [[0, 3], [0, 4], [1, 3]]);
/// # Ok::<(), rank::RankError>(())
/// ```
///
/// # Errors
/// - [`DeletionError::Rank`]: the rank is undecided.
/// - [`DeletionError::Unclear`]: a set lies in the gap between admissible and not.
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

/// The dual of each component.
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

/// Adds to `bases` the bases that contain `chosen` and otherwise rows from place `next` on. Every
/// branch that is entered ends in a basis, so the work for each of them is bounded.
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
