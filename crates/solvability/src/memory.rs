//! Estimates the memory of ranks and verdicts before it is allocated.

use crate::error::AnalysisError;
use crate::limits::{
    CERTIFIED_MATRICES, DENSE_MATRICES, OF_ENTRY, OF_GROUP, OF_ROW, OF_VELOCITY, ONE_PART,
    ROWS_MAX, SPARSE_FROM,
};
use crate::pose::evaluated;
use model::{Mechanism, Scratch, System};
use rank::SparsePattern;

use crate::parts::parts;
use crate::sparse::{blocks, rows_of, sketch_of};

/// Estimated memory (bytes) of a mechanism, its ranks, independent rows and verdicts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VerdictMemory {
    /// Memory of the mechanism.
    pub mechanism: usize,
    /// Additional memory during the decision. The largest parts need it, one on each thread.
    pub work: usize,
    /// Memory of the results after the decision: verdicts and their explanations.
    pub results: usize,
}

impl VerdictMemory {
    /// Returns the maximum memory until the results exist. `besides` is the additional memory that
    /// is needed at the same time as the results.
    #[must_use]
    pub fn most(self, besides: usize) -> usize {
        self.mechanism + self.work.max(self.results + besides)
    }
}

/// Estimates the memory of a mechanism, its ranks, independent rows and verdicts on this number of
/// threads. The estimate is proportional to the numbers of velocities, of joints, drives and
/// couplings, and of rows and their entries. The estimate also includes the matrices of the largest
/// parts.
///
/// # Errors
/// [`AnalysisError::Large`]: the rows are too densely connected for a sparse decision.
pub fn memory_of_verdicts(
    mechanism: &Mechanism,
    threads: usize,
) -> Result<VerdictMemory, AnalysisError> {
    let layout = mechanism.layout();
    let (q, _) = mechanism.described_state();
    let s = evaluated(mechanism, 0.0, &q);
    let rows = layout.rows();
    let entries = rows_of(mechanism, &s, 0..rows, |_| 1.0).nnz();
    Ok(VerdictMemory {
        mechanism: OF_VELOCITY * layout.n_v,
        work: of_decision(mechanism, &s, threads)?,
        results: OF_GROUP * layout.groups.len() + OF_ROW * rows + OF_ENTRY * entries,
    })
}

fn of_decision(mechanism: &Mechanism, s: &Scratch, threads: usize) -> Result<usize, AnalysisError> {
    let layout = mechanism.layout();
    let rows = layout.rows();
    if rows <= ONE_PART {
        return Ok(dense(DENSE_MATRICES, rows, layout.n_v));
    }
    let certificate = if rows <= ROWS_MAX {
        dense(CERTIFIED_MATRICES, rows, layout.n_v)
    } else {
        0
    };
    let mut sizes = Vec::new();
    for part in parts(mechanism, s) {
        let rows: usize = part.iter().map(|&k| layout.groups[k].rows.len()).sum();
        if rows > SPARSE_FROM {
            let part = mechanism.part_of_groups(&part).mechanism;
            sizes.push(of_part(&part, s.t)?);
        } else {
            sizes.push(dense(DENSE_MATRICES, rows, layout.space.n_v() * rows));
        }
    }
    sizes.sort_unstable();
    let at_once: usize = sizes.iter().rev().take(threads).sum();
    Ok(certificate.max(at_once))
}

fn of_part(part: &Mechanism, time: f64) -> Result<usize, AnalysisError> {
    let layout = part.layout();
    let rows = layout.rows();
    if rows <= ROWS_MAX {
        return Ok(dense(DENSE_MATRICES, rows, layout.n_v));
    }
    let c = rows_of(part, &part.scratch(), 0..rows, |_| 1.0);
    let pattern = SparsePattern::new(&c, &blocks(part)).map_err(|source| AnalysisError::Large {
        time,
        rows,
        source,
    })?;
    Ok(pattern.bytes(sketch_of(part)))
}

fn dense(matrices: usize, rows: usize, columns: usize) -> usize {
    matrices * size_of::<f64>() * rows * columns
}
