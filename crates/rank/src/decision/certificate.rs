//! What a certificate of a rank says: a proof that the rank is at least r, and the grounds on which
//! it is not more.

/// The proof behind a rank, beside the numbers in [`Evidence`](crate::Evidence).
#[derive(Debug, Clone, PartialEq)]
pub struct Certificate {
    /// Proved: the rank is at least this, for every matrix within the uncertainty.
    pub rank_at_least: usize,
    /// Proved lower bound of σ_r of the equilibrated matrix; 0 if only arithmetic modulo primes
    /// proves the rank.
    pub sigma_bound: f64,
    /// σ_{r+1} in double-double precision: the residual of the dependencies (0 if there are none).
    pub sigma_next: f64,
    /// Why the rank is not larger.
    pub grounds: Grounds,
    /// What the entries of the equilibrated matrix are known to, absolute; 0 if they are meant
    /// exactly as they stand.
    pub uncertainty: f64,
    /// How far the equilibrated matrix may be from the one that is meant (Frobenius norm); 0 for
    /// exact entries.
    pub spread: f64,
    /// How far row i of the dependencies `[−T̃, I]` may be from that of the matrix meant (norm), m
    /// values; none for exact entries.
    pub row_noise: Vec<f64>,
    /// The direction in which the kept rows nearly cancel, if they do.
    pub nearly_redundant: Option<NearlyRedundant>,
    /// By how much (m; angles times the size of the mechanism) the point that changes most would
    /// have to be elsewhere for the rank to be lower at this configuration; told where that is
    /// little.
    pub lower_rank_here: Option<f64>,
    /// The same by one change of the data that lowers the rank at all configurations near this one:
    /// from there on a row is redundant. `None` where no change does, or none is near.
    pub lower_rank_from: Option<f64>,
    /// Whether only angles were wrong by these two, because a tolerance is stated for angles alone.
    pub lower_rank_by_angles: bool,
    /// By how much each row of the left null space changes with data within what they are known to,
    /// m values; `None` if nobody asked.
    pub row_data: Option<Vec<f64>>,
    /// Whether that is a tolerance which the scene states.
    pub has_tolerance: bool,
    /// By what angle (rad) the force of each row turns with data within that tolerance, and by what
    /// length (m) it shifts, m values; `None` without one.
    pub row_turn: Option<Vec<[f64; 2]>>,
    /// Rows of dependencies of which that tolerance leaves open which rows belong to them,
    /// ascending.
    pub open_rows: Vec<usize>,
}

/// Why a rank is not larger than it was read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Grounds {
    /// There are no more rows or no more columns.
    FullRank,
    /// Proved for the entries as they stand: all larger minors vanish modulo primes whose product
    /// exceeds Hadamard's bound.
    Exact,
    /// σ_{r+1} falls with the precision of the arithmetic, to 1e-26 and below.
    Vanishes,
    /// σ_{r+1} stays, but is less than what the data are known to.
    WithinData,
    /// Redundant within the tolerance that the scene states.
    WithinTolerance,
}

/// Rows that are independent, but only just.
#[derive(Debug, Clone, PartialEq)]
pub struct NearlyRedundant {
    /// σ_r of the equilibrated matrix; below 1e-28 it is an upper estimate.
    pub sigma: f64,
    /// Left singular vector of σ_r: weights (unit norm, length m) with which the equilibrated rows
    /// sum to a row of norm σ_r.
    pub direction: Vec<f64>,
}
