//! Solvability of a plain constraint matrix. The module determines which combinations of
//! multipliers are the same in all solutions `λ = λ₀ + Z·y` of `M·a + Cᵀ·λ = Q`.
//!
//! Rows may be grouped in any way, and groups may overlap. A row listed twice in a group counts
//! once. A group without rows has no reaction and is unique with margin 0. The module `mechanism`
//! defines the meaning of rows and groups; the crate `rank` decides the rank.
//!
//! Source: Wojtyra, Frączek (2013), doi 10.1007/s11044-013-9352-0. With `C·P = Q·R` and the last p
//! columns of Q as Z, the reaction of a joint with rows X is unique iff `B_X = C_Xᵀ·Z_X = 0` (27).
//! Here Z is an orthonormal basis of the left null space of the equilibrated C. This basis spans
//! the same space, up to the scaling of rows.

use linalg::{Matrix, PivotedQr};
use rank::{Accuracy, ExactNullSpace, RankDecision, RankError};

use crate::verdict::Judgement;

mod basis;
mod error;
mod mapped;
#[cfg(test)]
mod tests;

pub(crate) use basis::{Basis, RowAccuracy};
pub(crate) use mapped::MultiplierMap;

pub use error::QueryError;

/// Solvability of the multipliers of a constraint matrix.
///
/// ```
/// use linalg::Matrix;
/// use pfaff_solvability::{Solvability, Verdict};
/// // Rows 0 and 1 are parallel; row 2 is independent of them.
/// let c = Matrix::from_rows(&[[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 1.0]]);
/// let s = Solvability::of(&c, rank::Accuracy::Rounding)?;
/// assert_eq!((s.decision().rank, s.decision().redundancy), (2, 1));
/// assert_eq!(s.row(0)?.verdict, Verdict::NotUnique);
/// assert_eq!(s.row(2)?.verdict, Verdict::Unique);
/// // λ₀ + 2·λ₁ is the total force along x: unique.
/// assert_eq!(s.combination(&[1.0, 2.0, 0.0])?.verdict, Verdict::Unique);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Solvability {
    decision: RankDecision,
    /// All rows, and their null space.
    basis: Basis,
}

impl Solvability {
    /// Decides the rank of `c` (m × n) and stores the data for verdicts. `uncertainty` is the
    /// uncertainty of its entries in addition to rounding.
    ///
    /// # Errors
    /// Returns an error if an entry or the uncertainty is not finite.
    pub fn of<'a>(c: &Matrix, uncertainty: impl Into<Accuracy<'a>>) -> Result<Self, RankError> {
        Ok(Self::from_decision(c, rank::decide(c, uncertainty)?))
    }

    /// Works like [`Self::of`], for a matrix with exact entries: every verdict is exact and
    /// decided.
    ///
    /// Tests for zero use arithmetic modulo primes. Margins are computed in `f64`. If a reported
    /// margin is below 1e-15, the true margin may be smaller.
    ///
    /// # Errors
    /// Returns an error if an entry is not finite.
    pub fn of_exact(c: &Matrix) -> Result<Self, RankError> {
        Ok(Self::from_decision(c, rank::certify_exact(c)?))
    }

    /// Uses a rank that has already been decided. The rank must belong to this matrix, or to the
    /// double-double matrix that was rounded to this matrix.
    ///
    /// # Panics
    /// Panics if the decision belongs to a matrix of another shape.
    #[must_use]
    pub fn from_decision(c: &Matrix, decision: RankDecision) -> Self {
        // The matrix of an exact decision is always finite.
        let exact = decision.is_exact();
        let exact = exact.then(|| ExactNullSpace::new(c).ok()).flatten();
        let certificate = decision.evidence.certificate.as_ref();
        let rows = 0..c.nrows();
        let basis = Basis {
            c: decision.scaling.apply(c),
            z: rank::orthonormal(&decision),
            known: RowAccuracy {
                status: decision.status,
                row_factor: rows
                    .clone()
                    .map(|i| decision.scaling.row_factor(i))
                    .collect(),
                row_noise: rows.clone().map(|i| decision.row_noise(i)).collect(),
                row_rounding: if decision.has_tolerance() {
                    rows.map(|i| decision.row_rounding(i)).collect()
                } else {
                    Vec::new()
                },
                tolerance: decision.coefficient_tolerance(),
                spread: certificate.map_or(0.0, |c| c.spread),
                uncertainty: certificate.map_or(0.0, |c| c.uncertainty),
                row_turn: certificate.and_then(|c| c.row_turn.clone()),
                readings: decision.readings(),
            },
            exact,
        };
        Self { decision, basis }
    }

    /// Returns the rank and its evidence.
    #[must_use]
    pub fn decision(&self) -> &RankDecision {
        &self.decision
    }

    /// Returns an orthonormal basis of the left null space of the equilibrated matrix, m × p.
    #[must_use]
    pub fn null_space(&self) -> &Matrix {
        &self.basis.z
    }

    /// Returns the row factors of the equilibration, D_r.
    pub(crate) fn row_factors(&self) -> &[f64] {
        &self.basis.known.row_factor
    }

    /// Returns the values of a linear form of the multipliers along the columns of the null space.
    pub(crate) fn along_null_space(&self, form: &[f64]) -> Vec<f64> {
        let (z, factors) = (&self.basis.z, &self.basis.known.row_factor);
        let value = |k: usize| {
            let terms = form.iter().zip(factors).enumerate();
            terms.map(|(i, (w, factor))| w * factor * z[(i, k)]).sum()
        };
        (0..z.ncols()).map(value).collect()
    }

    /// Returns the rows and the null space on which verdicts are based.
    pub(crate) fn basis(&self) -> &Basis {
        &self.basis
    }

    /// Returns `D_r·C·D_c`, the matrix to which verdicts refer.
    pub(crate) fn equilibrated(&self) -> &Matrix {
        &self.basis.c
    }

    /// Returns the verdict on the multiplier of one row. The multiplier is unique iff `Z_i = 0`.
    ///
    /// # Errors
    /// Returns an error if the row does not exist.
    pub fn row(&self, i: usize) -> Result<Judgement, QueryError> {
        self.basis.row(i)
    }

    /// Returns the verdict on all multipliers of a group of rows. The multipliers are unique iff
    /// `Z_X = 0`. If the rows depend on each other, this condition is stronger than the condition
    /// of [`Solvability::group`].
    ///
    /// # Errors
    /// Returns an error if a row does not exist.
    pub fn multipliers(
        &self,
        rows: impl IntoIterator<Item = usize>,
    ) -> Result<Judgement, QueryError> {
        self.basis.multipliers(rows)
    }

    /// Returns `B_X = C_Xᵀ·Z_X` (n × p) of a group of equilibrated rows.
    ///
    /// # Errors
    /// Returns an error if a row does not exist.
    pub fn b_x(&self, rows: impl IntoIterator<Item = usize>) -> Result<Matrix, QueryError> {
        self.basis.b_x(rows)
    }

    /// Returns the verdict on the reaction of a group of rows. The reaction is unique iff `B_X =
    /// 0`, and the margin is ‖B_X‖ (Frobenius).
    ///
    /// # Errors
    /// Returns an error if a row does not exist.
    pub fn group(&self, rows: impl IntoIterator<Item = usize>) -> Result<Judgement, QueryError> {
        self.basis.group(rows)
    }

    /// Returns the verdict on a linear combination `ℓᵀ·λ` of all multipliers. The combination is
    /// unique iff `ℓᵀ·Z = 0`. The margin is relative to ‖ℓ‖. Both values are computed for
    /// equilibrated rows.
    ///
    /// # Errors
    /// Returns an error if the number of coefficients is not m, or if a coefficient is not finite.
    pub fn combination(&self, l: &[f64]) -> Result<Judgement, QueryError> {
        self.basis.combination(l)
    }

    /// Returns the verdict on component `k` of a reaction `W·λ_X`. The component is unique iff row
    /// k of `W·Z_X` is zero. The margin is relative to the largest row of W. A row of W that is
    /// only rounding relative to the other rows counts as zero, unless the entries are exact.
    /// Column l of W belongs to row l of the list.
    ///
    /// # Errors
    /// Returns an error if a row or the component does not exist, if W does not have a column for
    /// each row, or if W is not finite.
    pub fn component(
        &self,
        map: &Matrix,
        k: usize,
        rows: impl IntoIterator<Item = usize>,
    ) -> Result<Judgement, QueryError> {
        self.basis.mapped(map, rows)?.component(k)
    }

    /// Returns the directions in which a reaction is unique. The directions are a basis of the left
    /// null space of `W·Z_X` for the map W (k × |X|) from multipliers to components. The directions
    /// are unit vectors with k entries, the largest of which is positive.
    ///
    /// # Errors
    /// Returns the same errors as [`Solvability::component`]. The function also returns an error if
    /// the number of directions is undecided.
    pub fn unique_directions(
        &self,
        map: &Matrix,
        rows: impl IntoIterator<Item = usize>,
    ) -> Result<Vec<Vec<f64>>, QueryError> {
        self.basis.mapped(map, rows)?.unique_directions()
    }
}

/// Returns an orthonormal basis of the span of dependencies, restricted to some of the rows. The
/// rows are equilibrated with these factors. Each column comes from the longest remaining
/// dependency.
pub(crate) fn orthonormal(
    dependencies: &[&[f64]],
    rows: &[usize],
    row_factor: &[f64],
    columns: usize,
) -> Matrix {
    let scaled = Matrix::from_fn(rows.len(), dependencies.len(), |i, j| {
        dependencies[j][rows[i]] / row_factor[i]
    });
    PivotedQr::of_columns(&scaled).q_columns(0..columns)
}
