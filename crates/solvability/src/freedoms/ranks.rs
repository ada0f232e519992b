//! Ranks of subsets of the rows: Φq, Ψ, and all rows without drives.

use model::Layout;
use rank::RankStatus;

use crate::error::AnalysisError;

/// Rank and redundancy of the rows without drives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct WithoutDrives {
    /// Rank of these rows.
    pub rank: usize,
    /// Number of rows minus their rank.
    pub redundancy: usize,
}

/// Ranks of subsets of the rows, independent of the method of decision.
pub(crate) struct PartialRanks {
    pub(crate) holonomic: usize,
    pub(crate) nonholonomic: usize,
    /// Rank and redundancy without drives. `None` if there are no drives.
    pub(crate) without_drives: Option<WithoutDrives>,
    /// Descriptions of undecided ranks.
    pub(crate) warnings: Vec<String>,
}

impl PartialRanks {
    /// Determines the ranks from the rank of all rows. `decide` is called for a subset that is
    /// neither empty nor complete.
    pub(crate) fn of(
        layout: &Layout,
        rank: usize,
        decide: impl Fn(&[usize]) -> Result<(usize, RankStatus), AnalysisError>,
    ) -> Result<Self, AnalysisError> {
        let mut warnings = Vec::new();
        let mut rank_of = |what: &str, rows: &[usize]| {
            if rows.is_empty() {
                return Ok(0);
            }
            if rows.len() == layout.rows() {
                return Ok(rank);
            }
            let (rank, status) = decide(rows)?;
            if let RankStatus::Undecided(doubt) = status {
                warnings.push(format!("the rank {what} is undecided: {doubt}"));
            }
            Ok::<_, AnalysisError>(rank)
        };
        let (of_phi, of_psi): (Vec<usize>, Vec<usize>) =
            (0..layout.rows()).partition(|&row| row < layout.m);
        let holonomic = rank_of("of Φq alone", &of_phi)?;
        let nonholonomic = rank_of("of Ψ alone", &of_psi)?;
        let drives = layout.drive_rows();
        let others = (0..layout.rows()).filter(|row| drives.binary_search(row).is_err());
        let others: Vec<usize> = others.collect();
        let without_drives = if drives.is_empty() {
            None
        } else {
            let rank = rank_of("without drives", &others)?;
            let redundancy = others.len() - rank;
            Some(WithoutDrives { rank, redundancy })
        };
        Ok(Self {
            holonomic,
            nonholonomic,
            without_drives,
            warnings,
        })
    }
}
