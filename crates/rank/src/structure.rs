//! Facts that follow from the pattern of a constraint matrix, without a rank decision on the whole
//! matrix. Some rows belong to no dependency because of the bodies on which they act, and some
//! parts are independent of each other.
//!
//! Columns form blocks (bodies), and rows form groups (joints). Three facts are used. A row that is
//! decided by one of these facts needs no further analysis. All other rows need numerical values.
//!
//! - **Parts.** Groups that share no block, directly or through other groups, are independent
//!   problems. The ground is not a block.
//! - **Peeling.** `Cᵀ·z = 0` on the columns of one block involves only the rows that touch it. If
//!   these rows, restricted to the block, are independent, then z vanishes on all of these rows,
//!   and the rows are removed together with the block.
//! - **Bridges.** If a group X is the only connection of a set S of blocks to the rest of the graph
//!   of blocks and ground, then `C_Xᵀ·z_X = 0`, because S is in equilibrium. This conclusion uses
//!   mechanics, see [`RowGroup::ground`].
//!
//! The ranks in this module are ranks of a few rows of the equilibrated matrix, by the rule of
//! `rank`. Uncertain results stay open. This module does not use names of joints or verdicts from
//! ranks.

mod cycles;
mod graph;
mod incidence;
mod peel;
#[cfg(test)]
mod tests;

use std::ops::Range;

use crate::{Accuracy, RankError};
use linalg::Matrix;

use incidence::Incidence;

pub use cycles::cycles;
pub use incidence::{Part, RowGroup};

pub(crate) use incidence::{partition, within};

/// Result for a row or group without a rank decision on the whole matrix.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum StructureVerdict {
    /// All rows of the group were removed with blocks on which they are independent, so its
    /// multipliers are unique.
    Peeled,
    /// The group is the only connection between two sides, so `C_Xᵀ·λ_X` is unique.
    Bridge,
    /// The group is not settled. The value is the index of its part in [`Structure::open`].
    Open(usize),
}

/// Results that follow from the pattern.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Structure {
    /// For each group, the reason why the group is settled, or its part. A group is peeled if all
    /// its rows are peeled.
    pub groups: Vec<StructureVerdict>,
    /// The same result for each row. A row outside all groups forms a group by itself, which is
    /// connected to the ground.
    pub rows: Vec<StructureVerdict>,
    /// Parts of the whole matrix, ordered by their first rows.
    pub parts: Vec<Part>,
    /// Parts of the open rows, ordered by their first rows. Each part can be analysed separately,
    /// on its rows and the columns of its blocks.
    pub open: Vec<Part>,
}

/// Determines the facts that follow from the pattern. `blocks` are ranges of columns; a column
/// outside all blocks is a separate block.
///
/// A row touches a block if it has a non-zero entry in it. Peeling and the search for bridges
/// alternate until neither finds more. Each pass is linear in the entries of C, and there are at
/// most as many passes as blocks. A group on more than two blocks, or on two blocks and the ground
/// (a gear with its carrier), connects all these blocks and is never a bridge. The load that such a
/// group transmits to one side may vanish while the other loads do not.
///
/// ```
/// use linalg::Matrix;
/// use pfaff_rank::StructureVerdict::{Open, Peeled};
/// use pfaff_rank::{RowGroup, structure};
/// // Block k = column k. Rows 0 and 1 both fix block 0; row 2 connects block 1 to it.
/// let c = Matrix::from_rows(&[[1.0, 0.0], [2.0, 0.0], [-1.0, 1.0]]);
/// let groups = [(0..1, true), (1..2, true), (2..3, false)].map(|(rows, ground)| {
///     let rows = rows.collect();
///     RowGroup { rows, ground }
/// });
/// let found = structure(&c, pfaff_rank::Accuracy::Rounding, &groups, &[0..1, 1..2])?;
/// assert_eq!(found.groups, [Open(0), Open(0), Peeled]);
/// assert_eq!(found.open[0].rows, [0, 1]);
/// # Ok::<(), pfaff_rank::RankError>(())
/// ```
///
/// Rows and columns beyond the matrix are omitted. A row in several groups, or a column in several
/// blocks, counts for the first group or block.
///
/// # Errors
/// - [`RankError::NonFinite`]: an entry is NaN or infinite.
/// - [`RankError::Uncertainty`], [`RankError::UncertaintyShape`]: the uncertainty is negative, NaN,
///   infinite or of another shape.
pub fn structure<'a>(
    c: &Matrix,
    uncertainty: impl Into<Accuracy<'a>>,
    groups: &[RowGroup],
    blocks: &[Range<usize>],
) -> Result<Structure, RankError> {
    if let Some((row, col, value)) = c.first_non_finite() {
        return Err(RankError::NonFinite { row, col, value });
    }
    let (scaling, spread) = uncertainty.into().equilibrate(c)?;
    let mut incidence = Incidence::new(scaling.apply(c), groups, blocks);
    let parts = graph::parts(&incidence);
    let mut rows = vec![StructureVerdict::Peeled; c.nrows()];
    loop {
        peel::peel(&mut incidence, spread.largest);
        let bridges = graph::bridges(&incidence);
        if bridges.is_empty() {
            break;
        }
        for group in bridges {
            for row in incidence.remaining(group) {
                rows[row] = StructureVerdict::Bridge;
                incidence.active[row] = false;
            }
        }
    }
    let open = graph::parts(&incidence);
    for (k, part) in open.iter().enumerate() {
        for &row in &part.rows {
            rows[row] = StructureVerdict::Open(k);
        }
    }
    let of_group = |g: usize| {
        let of = |wanted: fn(&StructureVerdict) -> bool| {
            let mut own = incidence.groups[g].rows.iter().map(|&row| rows[row]);
            own.find(wanted)
        };
        of(|s| matches!(s, StructureVerdict::Open(_)))
            .or_else(|| of(|s| *s == StructureVerdict::Bridge))
            .unwrap_or(StructureVerdict::Peeled)
    };
    Ok(Structure {
        groups: (0..groups.len()).map(of_group).collect(),
        rows,
        parts,
        open,
    })
}
