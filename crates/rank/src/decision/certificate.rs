//! The certificate of a rank: a proof that the rank is at least r, and the reason why it is not
//! larger.

/// The proof of a rank, in addition to the values in [`Evidence`](crate::Evidence).
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Certificate {
    /// Proved lower bound on the rank of every matrix within the uncertainty.
    pub rank_at_least: usize,
    /// Proved lower bound of σ_r of the equilibrated matrix; 0 if only arithmetic modulo primes
    /// proves the rank.
    pub sigma_bound: f64,
    /// σ_{r+1} in double-double precision: the residual of the dependencies (0 if no row is
    /// dependent).
    pub sigma_next: f64,
    /// The reason why the rank is not larger.
    pub grounds: Grounds,
    /// Absolute uncertainty of the entries of the equilibrated matrix; 0 for exact entries.
    pub uncertainty: f64,
    /// Bound on the distance between the equilibrated matrix and the intended matrix (Frobenius
    /// norm); 0 for exact entries.
    pub spread: f64,
    /// Bounds on the error (norm) of each row of the dependencies `[−T̃, I]` with respect to the
    /// intended matrix, m values; empty for exact entries.
    pub row_noise: Vec<f64>,
    /// The combination of the kept rows that nearly vanishes, if there is one.
    pub nearly_redundant: Option<NearlyRedundant>,
    /// The smallest displacement (m; angles times the size of the mechanism) that lowers the rank
    /// at this configuration. The displacement is measured at the point that moves most. Present
    /// only if the displacement is small.
    pub lower_rank_here: Option<f64>,
    /// The displacement for one change of the data that lowers the rank at this and all
    /// neighbouring configurations. If the data change by more, a row is redundant. `None` if no
    /// such change exists or the displacement is not small.
    pub lower_rank_from: Option<f64>,
    /// Whether these two changes change only angles, because a tolerance is stated only for angles.
    pub lower_rank_by_angles: bool,
    /// The change of each row of the left null space within the uncertainty of the data, m values;
    /// `None` if the caller did not request it.
    pub row_data: Option<Vec<f64>>,
    /// Whether the uncertainty is a tolerance that the scene states.
    pub has_tolerance: bool,
    /// For each row, the angle (rad) by which its force rotates and the length (m) by which its
    /// force shifts within the stated tolerance, m values; `None` without a tolerance.
    pub row_turn: Option<Vec<[f64; 2]>>,
    /// Rows for which the stated tolerance leaves undecided which dependencies contain them;
    /// ascending.
    pub open_rows: Vec<usize>,
}

/// Reason why a rank is not larger.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum Grounds {
    /// The rank equals the number of rows or of columns.
    FullRank,
    /// The rank is proved for exact entries: all larger minors vanish modulo primes whose product
    /// exceeds Hadamard's bound.
    Exact,
    /// σ_{r+1} decreases with the precision of the arithmetic, to 1e-26 or less.
    Vanishes,
    /// σ_{r+1} does not decrease, but is below the uncertainty of the data.
    WithinData,
    /// The rows are redundant within the tolerance that the scene states.
    WithinTolerance,
}

/// Rows that are nearly dependent.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct NearlyRedundant {
    /// σ_r of the equilibrated matrix; below 1e-28 it is an upper estimate.
    pub sigma: f64,
    /// Left singular vector of σ_r (unit norm, length m). The combination of the equilibrated rows
    /// with these weights is a row of norm σ_r.
    pub direction: Vec<f64>,
}
