//! The rank of a sparse matrix, by the rule of dense rank decisions. The evidence costs a few
//! factorisations.
//!
//! `C̃ = D_r·C·D_c` is equilibrated and factored twice:
//!
//! - `C̃ = Q·R` by columns gives r, and random combinations W of the left null space. ‖C̃ᵀ·W‖ is an
//!   upper estimate of σ_{r+1}.
//! - `C̃ᵀ = Q'·R'` by rows gives the kept rows K as its live columns. `R'₁₁ᵀ·R'₁₁ = C̃_K·C̃_Kᵀ`, so
//!   the smallest singular value of R'₁₁ is that of the kept rows, and `σ_r(C̃) ≥ σ_min(C̃_K)`.
//!
//! The live columns of R do not give the kept rows. If a mechanism has many degrees of freedom,
//! coordinates chosen body by body may be exponentially close to dependent. Rows that are clearly
//! independent would then appear dependent.
//!
//! The ranks follow Heath's rule, which may be wrong. A rank that is too large is visible in
//! σ_min(C̃_K) or as a different rank of the other factorisation. A rank that is too small is
//! visible in ‖C̃ᵀ·W‖. In both cases the result is undecided instead of a wrong rank.
//!
//! Source: L. V. Foster, T. A. Davis, Algorithm 933: Reliable calculation of numerical rank, null
//! space bases, pseudoinverse solutions, and basic solutions using SuiteSparseQR, ACM Trans. Math.
//! Softw. 40 (2013) 7, for confirming a rank by inverse iteration.

use crate::limits::{LEFT, REFLECTORS_WIDTH, WORK_MAX};
use std::ops::Range;

use super::factor::{SparseQr, Tolerances};
use super::front::OutsidePattern;
use super::sketch::{Sketch, sketch};
use super::smallest::smallest_singular_value;
use super::symbolic::KeptFactor;
use super::symbolic::{Symbolic, TooDense};
use crate::decision::{required, tolerance};
use crate::{RankError, RankStatus};
use linalg::SparseMatrix;
use linalg::{Matrix, Scaling, equilibrate_sparse};

mod reading;
#[cfg(test)]
mod tests;

/// Rank of a sparse constraint matrix, with the rows to keep, random combinations of its left null
/// space, and the evidence.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SparseRank {
    /// Rank r of C. If the rank is undecided, an estimate.
    pub rank: usize,
    /// Degree of redundancy p = m − r.
    pub redundancy: usize,
    /// Independent rows K, ascending. The number of these rows is r, unless the rank is undecided.
    pub kept: Vec<usize>,
    /// The other rows, ascending.
    pub dropped: Vec<usize>,
    /// The scaling under which the rank was decided.
    pub scaling: Scaling,
    /// W (m×k): random combinations of an orthonormal basis of the left null space of the
    /// equilibrated rows. `D_r` times a column is a self-stress of C.
    pub sketch: Matrix,
    /// The values that justify the decision.
    pub evidence: SparseEvidence,
    /// Whether the rank is decided, or the reason why it is undecided.
    pub status: RankStatus,
}

/// The values that justify a sparse rank decision. All values refer to the equilibrated matrix.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SparseEvidence {
    /// Lower bound on the smallest singular value of the kept rows, and therefore on σ_r. The bound
    /// is at most about four times too small, and infinite for rank 0.
    pub sigma_r: f64,
    /// ‖Cᵀ·W‖ (Frobenius), which estimates ‖Cᵀ·Z‖ ≥ σ_{r+1}. If all p dependencies exist only
    /// within the stated uncertainty, it is up to √p times larger than σ_{r+1}. The rank is then
    /// undecided.
    pub sigma_next: f64,
    /// Tolerance τ: smaller singular values count as zero.
    pub tolerance: f64,
    /// The stated uncertainty of the equilibrated entries.
    pub uncertainty: f64,
    /// ‖E‖ (Frobenius): the entries that the factorisation by columns set to zero.
    pub backward_error: f64,
    /// Largest norm among the rows of W that are within their noise; 0 if there is no such row.
    pub largest_zero: f64,
    /// Smallest norm among the rows of W that are above their noise; infinite if there is no such
    /// row.
    pub smallest_margin: f64,
    /// Memory of the factors (bytes).
    pub bytes: usize,
}

/// Reason why a sparse rank cannot be decided.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SparseRankError {
    /// The matrix has an entry that is not finite, or the uncertainty is invalid.
    #[error(transparent)]
    Rank(#[from] RankError),
    /// An entry of the matrix is outside the pattern.
    #[error("entry in row {row}, column {column}, where the pattern has none")]
    Pattern {
        /// Row of the entry.
        row: usize,
        /// Column of the entry.
        column: usize,
    },
    /// Too many bodies, or too many rows of one body, are connected to each other. The separate
    /// elimination of these bodies or rows would take too long.
    #[error(
        "elimination needs about {work:.1e} operations, at most {limit:.1e} are made; bodies or rows are joined too closely"
    )]
    TooDense {
        /// Number of operations, estimated or counted up to the limit.
        work: f64,
        /// The limit.
        limit: f64,
    },
    /// The matrix has another shape than the pattern.
    #[error("matrix of {rows}×{columns} for a pattern of {expected_rows}×{expected_columns}")]
    Shape {
        /// Number of given rows.
        rows: usize,
        /// Number of given columns.
        columns: usize,
        /// Number of rows of the pattern.
        expected_rows: usize,
        /// Number of columns of the pattern.
        expected_columns: usize,
    },
}

/// Decides the rank of a sparse C whose columns form blocks. Each block contains the coordinates of
/// one body. A range beyond the matrix is truncated, and a column outside all blocks is a separate
/// block.
///
/// `uncertainty` is the uncertainty of the entries of the equilibrated matrix beyond rounding.
///
/// ```
/// use linalg::SparseMatrix;
/// use pfaff_rank::{Sketch, decide_sparse};
/// // Rows 0 and 2 are equal up to a factor; both act on the first body.
/// let c = SparseMatrix::from_rows(2, [vec![(0, 1.0)], vec![(0, 1.0), (1, 1.0)], vec![(0, 3.0)]])?;
/// let found = decide_sparse(&c, 0.0, &[0..1, 1..2], Sketch::default())?;
/// assert!(found.is_decided());
/// assert_eq!((found.rank, found.redundancy), (2, 1));
/// assert!(found.margin(0) > 0.1 && found.margin(1) < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// - [`SparseRankError::Rank`]: an entry is NaN or infinite; the uncertainty is negative, NaN or
///   infinite.
/// - [`SparseRankError::TooDense`]: elimination would take too many operations.
pub fn decide_sparse(
    c: &SparseMatrix,
    uncertainty: f64,
    blocks: &[Range<usize>],
    wanted: Sketch,
) -> Result<SparseRank, SparseRankError> {
    SparsePattern::new(c, blocks)?.decide(c, uncertainty, wanted)
}

/// The positions of the entries of matrices with one pattern, and the order of their factorisation.
/// The result can be used for many decisions on matrices with different values.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SparsePattern {
    by_columns: Symbolic,
    by_rows: Symbolic,
}

impl SparsePattern {
    /// Analyses the pattern of the stored entries of `c`, whose columns form blocks.
    ///
    /// # Errors
    /// [`SparseRankError::TooDense`]: elimination would take longer than dense elimination of
    /// several thousand rows.
    pub fn new(c: &SparseMatrix, blocks: &[Range<usize>]) -> Result<Self, SparseRankError> {
        let by_columns = Symbolic::new(c, blocks)?;
        let by_rows = Symbolic::new(&c.transpose(), &by_columns.row_blocks)?;
        Ok(Self {
            by_columns,
            by_rows,
        })
    }

    /// Returns the estimated memory (bytes) of a decision with the random combinations `wanted`.
    pub fn bytes(&self, wanted: Sketch) -> usize {
        let rows = self.by_columns.nrows;
        let q = self.by_columns.bytes(KeptFactor::Q);
        let vectors =
            size_of::<f64>() * rows * 2 * wanted.columns.next_multiple_of(REFLECTORS_WIDTH);
        // The reflections of Cᵀ, one or two vectors of the sketch, and then the triangle of the
        // kept rows.
        q + vectors + self.by_rows.bytes(KeptFactor::R)
    }

    /// Works like [`decide_sparse`], for a matrix with this pattern.
    ///
    /// # Errors
    /// - [`SparseRankError::Rank`]: an entry is NaN or infinite; the uncertainty is negative, NaN
    ///   or infinite.
    /// - [`SparseRankError::Pattern`], [`SparseRankError::Shape`]: the matrix does not have this
    ///   pattern.
    pub fn decide(
        &self,
        c: &SparseMatrix,
        uncertainty: f64,
        wanted: Sketch,
    ) -> Result<SparseRank, SparseRankError> {
        self.check(c, uncertainty)?;
        let (m, n) = (c.nrows(), c.ncols());
        let tolerance = tolerance(m, n, uncertainty);
        let scaling = equilibrate_sparse(c);
        let scaled = scaling.apply_sparse(c);

        let exact = Tolerances {
            dead: tolerance,
            rest: tolerance,
        };
        let by_columns = self.by_columns.factor(&scaled, exact, KeptFactor::Q)?;
        let rank = by_columns.rank;
        let (sketch, sigma_next) = sketch(&by_columns, &scaled, wanted);
        let by_rows = self.kept_rows(&scaled.transpose(), rank, tolerance)?;
        let sigma_r = smallest_singular_value(&by_rows.r, m, wanted.seed);
        let sigma_r = (sigma_r - by_rows.dropped_from_rest).max(0.0);
        let mut is_kept = vec![false; m];
        by_rows.r.live().for_each(|i| is_kept[i] = true);
        let (kept, dropped): (Vec<usize>, Vec<usize>) = (0..m).partition(|&i| is_kept[i]);

        let mut found = SparseRank {
            rank,
            redundancy: m - rank,
            kept,
            dropped,
            scaling,
            sketch,
            evidence: SparseEvidence {
                sigma_r,
                sigma_next,
                tolerance,
                uncertainty,
                backward_error: by_columns.dropped,
                largest_zero: 0.0,
                smallest_margin: f64::INFINITY,
                bytes: by_columns.bytes() + by_rows.bytes(),
            },
            status: RankStatus::Decided,
        };
        (found.evidence.largest_zero, found.evidence.smallest_margin) = found.margins();
        found.status = found.read(scaled.norm());
        Ok(found)
    }

    /// Returns the factorisation of Cᵀ whose live columns are the kept rows. Among sufficiently
    /// independent rows, the rows with the largest remaining norm are kept.
    fn kept_rows(
        &self,
        transposed: &SparseMatrix,
        rank: usize,
        tolerance: f64,
    ) -> Result<SparseQr, OutsidePattern> {
        let factor = |dead: f64| {
            let tolerances = Tolerances {
                dead,
                rest: tolerance,
            };
            self.by_rows.factor(transposed, tolerances, KeptFactor::R)
        };
        // If the remaining norm is below the limit, the kept rows cannot have the required singular
        // value.
        let required = required(tolerance);
        let found = factor(required.max(LEFT))?;
        if found.rank == rank {
            Ok(found)
        } else {
            factor(required)
        }
    }

    fn check(&self, c: &SparseMatrix, uncertainty: f64) -> Result<(), SparseRankError> {
        let (expected_rows, expected_columns) = (self.by_columns.nrows, self.by_columns.ncols);
        if (c.nrows(), c.ncols()) != (expected_rows, expected_columns) {
            return Err(SparseRankError::Shape {
                rows: c.nrows(),
                columns: c.ncols(),
                expected_rows,
                expected_columns,
            });
        }
        if let Some((row, col, value)) = c.first_non_finite() {
            return Err(RankError::NonFinite { row, col, value }.into());
        }
        if uncertainty.is_finite() && uncertainty >= 0.0 {
            Ok(())
        } else {
            Err(RankError::Uncertainty { value: uncertainty }.into())
        }
    }
}

impl From<TooDense> for SparseRankError {
    fn from(TooDense { work }: TooDense) -> Self {
        Self::TooDense {
            work,
            limit: WORK_MAX,
        }
    }
}

impl From<OutsidePattern> for SparseRankError {
    fn from(OutsidePattern { row, column }: OutsidePattern) -> Self {
        Self::Pattern { row, column }
    }
}
