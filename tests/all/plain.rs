//! Verdicts of plain matrices as the suites ask for them: the entries are meant exactly as they stand.

use std::ops::Range;

use linalg::{Matrix, RankDecision};
use solvability::{Judgement, Solvability};

/// [`Solvability`] of a matrix whose rows all exist.
pub(crate) struct Plain(Solvability);

impl Plain {
    pub(crate) fn of(c: &Matrix) -> Self {
        let decision = linalg::certify_exact(c).expect("C is finite");
        Self(Solvability::from_decision(c, decision))
    }

    pub(crate) fn of_rows(rows: &[Vec<f64>]) -> Self {
        let n = rows.first().map_or(0, Vec::len);
        Self::of(&Matrix::from_fn(rows.len(), n, |i, k| rows[i][k]))
    }

    pub(crate) fn decision(&self) -> &RankDecision {
        self.0.decision()
    }

    pub(crate) fn row(&self, i: usize) -> Judgement {
        self.0.row(i)
    }

    pub(crate) fn group(&self, rows: Range<usize>) -> Judgement {
        self.0.group(rows)
    }

    pub(crate) fn multipliers(&self, rows: Range<usize>) -> Judgement {
        self.0.multipliers(rows)
    }

    pub(crate) fn combination(&self, l: &[f64]) -> Judgement {
        self.0.combination(l)
    }
}
