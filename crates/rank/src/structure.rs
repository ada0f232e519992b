//! What the pattern of a constraint matrix settles before any rank of the whole: rows that are in
//! no dependency because of where they act, and parts that have nothing to do with each other.
//!
//! Columns come in blocks (bodies), rows in groups (joints). Three facts are used, each exact in
//! one direction: what they settle is settled, what they leave open needs numbers.
//!
//! - **Parts.** Groups that share no block, directly or through others, are independent problems.
//!   The ground is no block.
//! - **Peeling.** `Cᵀ·z = 0` on the columns of one block involves only the rows that touch it. If
//!   these rows, restricted to the block, are independent, then z vanishes on all of them; they and
//!   the block leave.
//! - **Bridges.** In the graph of blocks and ground a group that alone joins a set S of blocks to
//!   the rest has `C_Xᵀ·z_X = 0`: the equilibrium of S. This needs mechanics, see
//!   [`RowGroup::ground`].
//!
//! Ranks here are those of a few rows of the equilibrated matrix, by the rule of `rank`; what is
//! not certain stays open. Not here: names of joints, and verdicts from ranks.

mod cycles;
mod graph;
mod incidence;
mod peel;
#[cfg(test)]
mod tests;

use std::ops::Range;

use crate::{RankError, Uncertainty};
use linalg::Matrix;

use incidence::Incidence;

pub use cycles::cycles;
pub use incidence::{Part, RowGroup};

pub(crate) use incidence::partition;

/// What is known of a row or group before any rank of the whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Settled {
    /// All its rows left with blocks where they are independent: its multipliers are unique.
    Peeled,
    /// It is the only one between two sides: `C_Xᵀ·λ_X` is unique.
    Bridge,
    /// Open; the number of its part in [`Structure::open`].
    Open(usize),
}

/// What the pattern settles.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Structure {
    /// For each group, why it is settled, or its part; peeled if all its rows are.
    pub groups: Vec<Settled>,
    /// The same for each row. A row of no group is one by itself, on the ground.
    pub rows: Vec<Settled>,
    /// Parts of the whole matrix, by their first row.
    pub parts: Vec<Part>,
    /// Parts of what is left open, by their first row: each can be judged alone, on its rows and
    /// the columns of its blocks.
    pub open: Vec<Part>,
}

/// Settles what the pattern settles. `blocks` are ranges of columns; a column of no block is a
/// block of its own.
///
/// A row touches a block where it has an entry that is not zero. Peeling and bridges take turns
/// until neither finds more: each pass is linear in the entries of C, and their number at most that
/// of the blocks. A group on more than two blocks, or on two and the ground (a gear with its
/// carrier), joins all of them and is never called a bridge: what it transmits to one side may
/// vanish while the rest does not.
///
/// ```
/// use linalg::Matrix;
/// use rank::{RowGroup, Settled, structure};
/// // Block 0 = column 0, block 1 = column 1. Rows 0 and 1 hold block 0 twice; row 2 hangs block 1 on it.
/// let c = Matrix::from_rows(&[[1.0, 0.0], [2.0, 0.0], [-1.0, 1.0]]);
/// let groups = [(0..1, true), (1..2, true), (2..3, false)].map(|(rows, ground)| RowGroup { rows, ground });
/// let found = structure(&c, 0.0, &groups, &[0..1, 1..2])?;
/// assert_eq!(found.groups, [Settled::Open(0), Settled::Open(0), Settled::Peeled]);
/// assert_eq!(found.open[0].rows, [0, 1]);
/// # Ok::<(), rank::RankError>(())
/// ```
///
/// Ranges beyond the matrix are cut; a row in several groups, or a column in several blocks, counts
/// for the first.
///
/// # Errors
/// - [`RankError::NonFinite`]: an entry is NaN or infinite.
/// - [`RankError::Uncertainty`], [`RankError::UncertaintyShape`]: the uncertainty is negative, NaN,
///   infinite or of another matrix.
pub fn structure<'a>(
    c: &Matrix,
    uncertainty: impl Into<Uncertainty<'a>>,
    groups: &[RowGroup],
    blocks: &[Range<usize>],
) -> Result<Structure, RankError> {
    if let Some((row, col, value)) = c.first_non_finite() {
        return Err(RankError::NonFinite { row, col, value });
    }
    let (scaling, spread) = uncertainty.into().equilibrate(c)?;
    let mut incidence = Incidence::new(scaling.apply(c), groups, blocks);
    let parts = graph::parts(&incidence);
    let mut rows = vec![Settled::Peeled; c.nrows()];
    loop {
        peel::peel(&mut incidence, spread.largest);
        let bridges = graph::bridges(&incidence);
        if bridges.is_empty() {
            break;
        }
        for group in bridges {
            for row in incidence.remaining(group) {
                rows[row] = Settled::Bridge;
                incidence.active[row] = false;
            }
        }
    }
    let open = graph::parts(&incidence);
    for (k, part) in open.iter().enumerate() {
        for &row in &part.rows {
            rows[row] = Settled::Open(k);
        }
    }
    let of_group = |g: usize| {
        let of = |wanted: fn(&Settled) -> bool| {
            let mut own = incidence.groups[g].rows.iter().map(|&row| rows[row]);
            own.find(wanted)
        };
        of(|s| matches!(s, Settled::Open(_)))
            .or_else(|| of(|s| *s == Settled::Bridge))
            .unwrap_or(Settled::Peeled)
    };
    Ok(Structure {
        groups: (0..groups.len()).map(of_group).collect(),
        rows,
        parts,
        open,
    })
}
