//! Ranks of the rows without those of drives.

use model::Layout;

use crate::certificate::Rows;
use crate::error::AnalysisError;
use crate::matrices::Solvability;

/// Rank and redundancy of the rows without those of drives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WithoutDrives {
    /// Their rank.
    pub rank: usize,
    /// Number of rows minus their rank.
    pub redundancy: usize,
}

impl WithoutDrives {
    /// Computes them from the decision of all rows. Returns `None` if there are no drives.
    pub(crate) fn of(
        layout: &Layout,
        rows: &Rows,
        solvability: &Solvability,
        warnings: &mut Vec<String>,
    ) -> Result<Option<Self>, AnalysisError> {
        let drives = layout.drive_rows();
        if drives.is_empty() {
            return Ok(None);
        }
        let others = (0..layout.rows()).filter(|row| drives.binary_search(row).is_err());
        let others: Vec<usize> = others.collect();
        let rank = match (others.as_slice(), solvability.basis().rank_without(&drives)) {
            ([], _) => 0,
            (_, Some(rank)) => rank,
            _ => {
                let decision = rows.select(&others).decide()?;
                if let rank::RankStatus::Undecided(doubt) = &decision.status {
                    warnings.push(format!("the rank without drives is undecided: {doubt}"));
                }
                decision.rank
            }
        };
        Ok(Some(Self {
            rank,
            redundancy: others.len() - rank,
        }))
    }
}
