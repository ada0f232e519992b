//! A rank, with the independent and the redundant rows.

use rank::{RankDecision, RankStatus, SparseRank};

/// Rank, independent rows (`kept`) and redundant rows (`dropped`).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct RowDecision {
    /// Rank r.
    pub rank: usize,
    /// Degree of redundancy p.
    pub redundancy: usize,
    /// Independent rows, ascending; their number is r.
    pub kept: Vec<usize>,
    /// The other rows, ascending.
    pub dropped: Vec<usize>,
    /// Whether the rank is decided, or the reason why it is undecided.
    pub status: RankStatus,
    /// Largest coefficient of a dependency that counts as zero.
    pub support_tolerance: f64,
}

impl RowDecision {
    /// Returns whether the rank is decided.
    #[must_use]
    pub fn is_decided(&self) -> bool {
        self.status == RankStatus::Decided
    }

    /// Returns the decision on zero rows.
    pub(crate) fn empty() -> Self {
        Self {
            rank: 0,
            redundancy: 0,
            kept: Vec::new(),
            dropped: Vec::new(),
            status: RankStatus::Decided,
            support_tolerance: 0.0,
        }
    }

    /// Adds the decision of a part. The function `row` maps a row of the part to a row of the whole
    /// mechanism.
    pub(crate) fn add(&mut self, part: Self, row: impl Fn(usize) -> usize) {
        self.rank += part.rank;
        self.redundancy += part.redundancy;
        self.kept.extend(part.kept.into_iter().map(&row));
        self.dropped.extend(part.dropped.into_iter().map(&row));
        if self.is_decided() {
            self.status = part.status;
        }
        self.support_tolerance = self.support_tolerance.max(part.support_tolerance);
    }

    /// Returns the decision restricted to some rows (ascending). No other row may depend on these
    /// rows; they are rows of bodies that are not connected to other bodies.
    #[must_use]
    pub fn of_rows(&self, rows: &[usize]) -> Self {
        let own = |all: &[usize]| -> Vec<usize> {
            let own = all.iter().filter_map(|row| rows.binary_search(row).ok());
            own.collect()
        };
        let (kept, dropped) = (own(&self.kept), own(&self.dropped));
        Self {
            rank: kept.len(),
            redundancy: dropped.len(),
            kept,
            dropped,
            status: self.status,
            support_tolerance: self.support_tolerance,
        }
    }

    /// Sorts the rows collected from several parts.
    pub(crate) fn sort(&mut self) {
        self.kept.sort_unstable();
        self.dropped.sort_unstable();
    }
}

impl From<&Self> for RowDecision {
    fn from(decision: &Self) -> Self {
        decision.clone()
    }
}

impl From<&RankDecision> for RowDecision {
    fn from(decision: &RankDecision) -> Self {
        Self {
            rank: decision.rank,
            redundancy: decision.redundancy,
            kept: decision.kept.clone(),
            dropped: decision.dropped.clone(),
            status: decision.status,
            support_tolerance: rank::support_tolerance(decision),
        }
    }
}

impl From<&SparseRank> for RowDecision {
    fn from(found: &SparseRank) -> Self {
        Self {
            rank: found.rank,
            redundancy: found.redundancy,
            kept: found.kept.clone(),
            dropped: found.dropped.clone(),
            status: found.status,
            support_tolerance: found.noise(),
        }
    }
}
