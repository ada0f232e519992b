//! The rank of one large set of joints on common cycles, decided sparsely.

use linalg::{
    Evidence, Matrix, RankDecision, RankStatus, Sketch, SparseMatrix, SparseRank, SparseRankError,
    decide_sparse,
};
use model::start::scene_size;
use model::{Known, Mechanism, Scratch, System};

use crate::mechanism::AnalysisError;

/// Sets of more rows are decided sparsely.
pub(crate) const SPARSE_FROM: usize = 150;

/// Rank and kept rows of the rows of C in a range, at the pose of the scratch, where Φ and C have been evaluated at coordinates q.
///
/// # Errors
/// If C is not finite, or too dense for a sparse decision.
pub(crate) fn decide_range(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
    rows: std::ops::Range<usize>,
) -> Result<SparseRank, AnalysisError> {
    let (layout, size) = (mechanism.layout(), scene_size(mechanism, q));
    let dimensions = mechanism.dimension_scaling(size);
    let unit = |j: usize| f64::from(dimensions.cols[j]).exp2();
    let row = |i: usize| layout.row(s, i).map(|(j, c)| (j, c * unit(j)));
    // Columns of a pattern are below n_v.
    let c = SparseMatrix::from_rows(layout.n_v, rows.clone().map(row))
        .unwrap_or_else(|e| unreachable!("columns of a pattern: {e}"));
    let scaling = linalg::equilibrate_sparse(&c);
    let known = mechanism.uncertainty_of_entries(s, q, size, Known::AsStored);
    let pattern = &layout.pattern;
    let mut largest = 0.0_f64;
    for i in rows.clone() {
        for k in pattern.start[i]..pattern.start[i + 1] {
            let j = pattern.column[k];
            let exponent = scaling.rows[i - rows.start] + scaling.cols[j];
            largest = largest.max(known[k] * unit(j) * f64::from(exponent).exp2());
        }
    }
    let blocks: Vec<_> = (0..mechanism.bodies().len())
        .map(|b| layout.columns(b))
        .collect();
    decide_sparse(&c, largest, &blocks, Sketch::default()).map_err(|source| match source {
        SparseRankError::Rank(source) => AnalysisError::Rank { time: s.t, source },
        source => AnalysisError::Large {
            time: s.t,
            rows: rows.len(),
            source,
        },
    })
}

/// A decided sparse rank without redundancy as one with evidence: there is no dependence to tell.
pub(crate) fn full_rank(found: SparseRank) -> Option<RankDecision> {
    if found.redundancy > 0 || found.status != RankStatus::Decided {
        return None;
    }
    let e = found.evidence;
    Some(RankDecision {
        rank: found.rank,
        redundancy: 0,
        coefficients: Matrix::zeros(0, found.rank),
        kept: found.kept,
        dropped: Vec::new(),
        scaling: found.scaling,
        evidence: Evidence {
            singular_values: Vec::new(),
            sigma_r: e.sigma_r,
            sigma_next: e.sigma_next,
            gap: f64::INFINITY,
            tolerance: e.tolerance,
            constraint_residual: e.uncertainty,
            dependence_residual: 0.0,
            certificate: None,
        },
        status: found.status,
    })
}
