//! Estimates the memory of ranks and verdicts before it is allocated.

use crate::error::AnalysisError;
use crate::limits::{DENSE_MATRICES, OF_VERDICT, ONE_PART, ROWS_MAX, SPARSE_FROM};
use crate::pose::evaluated;
use model::{Mechanism, System};
use rank::SparsePattern;

use crate::parts::parts;
use crate::sparse::{blocks, rows_of, sketch_of};

/// Estimated upper bound (bytes) on the memory of ranks, kept rows and verdicts of a mechanism, not
/// counting the mechanism itself: the part with most rows, on each of `threads` threads, and all
/// verdicts.
///
/// # Errors
/// [`AnalysisError::Large`]: rows are joined too closely for a sparse decision.
pub fn memory_of_verdicts(mechanism: &Mechanism, threads: usize) -> Result<usize, AnalysisError> {
    let layout = mechanism.layout();
    let results = OF_VERDICT * layout.groups.len();
    if layout.rows() <= ONE_PART {
        return Ok(results + dense(layout.rows(), layout.n_v));
    }
    let (q, _) = mechanism.described_state();
    let s = evaluated(mechanism, 0.0, &q);
    let mut most = 0;
    for part in parts(mechanism, &s) {
        let rows: usize = part.iter().map(|&k| layout.groups[k].rows.len()).sum();
        // A part with fewer rows than another one takes less memory.
        if rows > SPARSE_FROM {
            let part = mechanism.part_of_groups(&part).mechanism;
            most = most.max(of_part(&part, s.t)?);
        } else {
            most = most.max(dense(rows, layout.space.n_v() * rows));
        }
    }
    Ok(results + threads * most)
}

fn of_part(part: &Mechanism, time: f64) -> Result<usize, AnalysisError> {
    let layout = part.layout();
    let rows = layout.rows();
    if rows <= ROWS_MAX {
        return Ok(dense(rows, layout.n_v));
    }
    let c = rows_of(part, &part.scratch(), 0..rows, |_| 1.0);
    let pattern = SparsePattern::new(&c, &blocks(part)).map_err(|source| AnalysisError::Large {
        time,
        rows,
        source,
    })?;
    Ok(pattern.bytes(sketch_of(part)))
}

fn dense(rows: usize, columns: usize) -> usize {
    DENSE_MATRICES * size_of::<f64>() * rows * columns
}
