//! Verdicts on plain matrices for the tests: the entries are exact, and the arguments are existing
//! rows.

use linalg::Matrix;
use rank::RankDecision;
use solvability::{Judgement, Solvability};

/// The analysis [`Solvability::of_exact`] of a finite matrix.
pub(crate) struct Plain(Solvability);

impl Plain {
    pub(crate) fn of(c: &Matrix) -> Self {
        Self(Solvability::of_exact(c).expect("C is finite"))
    }

    pub(crate) fn of_rows(rows: &[Vec<f64>]) -> Self {
        let n = rows.first().map_or(0, Vec::len);
        Self::of(&Matrix::from_fn(rows.len(), n, |i, k| rows[i][k]))
    }

    pub(crate) fn decision(&self) -> &RankDecision {
        self.0.decision()
    }

    pub(crate) fn row(&self, i: usize) -> Judgement {
        self.0.row(i).expect("the row exists")
    }

    pub(crate) fn group(&self, rows: &[usize]) -> Judgement {
        self.0.group(rows.iter().copied()).expect("the rows exist")
    }

    pub(crate) fn multipliers(&self, rows: &[usize]) -> Judgement {
        self.0
            .multipliers(rows.iter().copied())
            .expect("the rows exist")
    }

    pub(crate) fn combination(&self, l: &[f64]) -> Judgement {
        self.0.combination(l).expect("one coefficient for each row")
    }

    /// Component `k` of the reaction `W·λ_X`.
    pub(crate) fn component(&self, map: &Matrix, k: usize, rows: &[usize]) -> Judgement {
        self.0
            .component(map, k, rows.iter().copied())
            .expect("the component exists")
    }

    /// Number of directions in which the multipliers of some rows are unique.
    pub(crate) fn unique_directions(&self, rows: &[usize]) -> usize {
        let map = Matrix::identity(rows.len());
        let directions = self.0.unique_directions(&map, rows.iter().copied());
        directions.expect("exact").len()
    }
}
