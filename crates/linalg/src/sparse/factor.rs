//! The factorisation: C = Q·R, body by body, with the rank found on the way.
//!
//! Each front is triangularised by Householder reflections. A pivot column of which less than the tolerance is left is *dead* and stepped
//! over (Heath's rule); there is no exchange of columns but among those of one body. What is left of the front below its pivots is
//! triangularised too, so that it has no more rows than columns when it goes up; rows that have nothing left are the left null space.
//! All that is set to zero on the way is E: `C + E = Q·R` up to rounding, hence `σ_{r+1}(C) ≤ ‖E‖`.
//!
//! Not here: whether to believe that rank. The live columns may be nearly dependent without one of them showing it.
//!
//! Source: M. T. Heath, Some extensions of an algorithm for sparse linear least squares problems, SIAM J. Sci. Stat. Comput. 3 (1982)
//! 223–237; T. A. Davis, Algorithm 915: SuiteSparseQR, ACM Trans. Math. Softw. 38 (2011) 8.

use super::SparseMatrix;
use super::front::Workspace;
use super::reflectors::Reflectors;
use super::symbolic::Symbolic;
use super::trapezoid::Trapezoid;

#[cfg(test)]
mod tests;

/// Which factor is kept; the other one is not stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Wanted {
    Q,
    R,
}

/// C = Q·R with r rows in R; one of the factors is empty.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SparseQr {
    pub(super) q: Reflectors,
    pub(super) r: Trapezoid,
    pub(super) rank: usize,
    /// Which rows of QᵀC are rows of R; the others are zero.
    pub(super) is_live: Vec<bool>,
    /// ‖E‖, the Frobenius norm of what was set to zero.
    pub(super) dropped: f64,
}

impl SparseQr {
    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        self.q.bytes() + self.r.bytes()
    }
}

/// An entry where the pattern has none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct OutsidePattern {
    pub(super) row: usize,
    pub(super) column: usize,
}

impl Symbolic {
    /// Factors a matrix whose entries all lie in the pattern; what is left of a column below `tolerance` is zero.
    pub(super) fn factor(
        &self,
        c: &SparseMatrix,
        tolerance: f64,
        wanted: Wanted,
    ) -> Result<SparseQr, OutsidePattern> {
        let mut work = Workspace::new(self, tolerance, wanted);
        for front in &self.fronts {
            work.assemble(front, c)?;
            work.eliminate(front);
        }
        Ok(work.finish())
    }
}
