//! A rank that has been decided, at another point of the same regime: the kept rows factored anew, nothing re-decided.
//!
//! Along a motion the rank and the kept rows stay; only the coefficients of the dropped rows change. This costs a tenth of a decision. It
//! refuses where a decision is due.

use super::{
    CLEARANCE, Evidence, NEARLY_SINGULAR, RankDecision, RankError, RankStatus, Uncertainty,
    check_finite, gap, tolerance,
};
use crate::strong_basis;
use crate::{Matrix, PivotedQr, kernels};

/// Kept rows that have lost this much of their σ_r since the decision call for another one.
const DEGRADED: f64 = 1e-2;

/// Why a decision does not carry over to another matrix.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Degraded {
    /// The matrix or the residual is at fault.
    #[error(transparent)]
    Input(#[from] RankError),
    /// The matrix has another shape.
    #[error(
        "matrix of {rows}×{cols}, but the rank was decided for {expected_rows}×{expected_cols}"
    )]
    Shape {
        /// Rows found.
        rows: usize,
        /// Columns found.
        cols: usize,
        /// Rows of the decision.
        expected_rows: usize,
        /// Columns of the decision.
        expected_cols: usize,
    },
    /// The rank was undecided to begin with.
    #[error("the rank has not been decided")]
    Undecided,
    /// The kept rows are nearly dependent here.
    #[error(
        "smallest singular value of the kept rows is {sigma:.3e}, need {required:.3e}: decide the rank here"
    )]
    KeptRows {
        /// Estimate of the smallest singular value.
        sigma: f64,
        /// What is needed.
        required: f64,
    },
    /// The dropped rows do not depend on the kept ones here.
    #[error(
        "a dropped row is {residual:.3e} outside the span of the kept ones, tolerance {tolerance:.3e}: the rank is larger here"
    )]
    DroppedRows {
        /// Largest distance.
        residual: f64,
        /// τ.
        tolerance: f64,
    },
}

impl RankDecision {
    /// This decision at another point of the same regime, where the matrix is `c`: the same rank and rows, other dependencies.
    ///
    /// ```
    /// use linalg::{Degraded, Matrix, decide};
    /// let at = |t: f64| Matrix::from_rows(&[[1.0, t], [2.0, 2.0 * t], [0.0, 1.0]]);
    /// let decision = decide(&at(0.0), 0.0)?;
    /// assert_eq!(decision.at(&at(1.0), 0.0).unwrap().kept, decision.kept);
    /// let other = Matrix::from_rows(&[[1.0, 0.0], [2.0, 1.0], [0.0, 1.0]]);
    /// assert!(decision.at(&other, 0.0).is_ok()); // three rows in the plane still depend on each other
    /// let flat = Matrix::from_rows(&[[0.0, 1.0], [0.0, 2.0], [0.0, 1.0]]);
    /// assert!(matches!(decision.at(&flat, 0.0), Err(Degraded::KeptRows { .. })));
    /// # Ok::<(), linalg::RankError>(())
    /// ```
    ///
    /// # Errors
    /// - [`Degraded::Input`], [`Degraded::Shape`]: the matrix is not finite or has another shape, or the residual is none.
    /// - [`Degraded::Undecided`]: the rank was undecided.
    /// - [`Degraded::KeptRows`]: σ_r fell below a hundredth of what it was at the decision, or below 1e-7.
    /// - [`Degraded::DroppedRows`]: the dependencies do not hold.
    pub fn at<'a>(
        &self,
        c: &Matrix,
        uncertainty: impl Into<Uncertainty<'a>>,
    ) -> Result<Self, Degraded> {
        check_finite(c)?;
        let (expected_rows, expected_cols) = (self.scaling.rows.len(), self.scaling.cols.len());
        if (c.nrows(), c.ncols()) != (expected_rows, expected_cols) {
            return Err(Degraded::Shape {
                rows: c.nrows(),
                cols: c.ncols(),
                expected_rows,
                expected_cols,
            });
        }
        if !self.is_decided() {
            return Err(Degraded::Undecided);
        }
        let scaled = self.scaling.apply(c);
        let constraint_residual = uncertainty.into().equilibrated(c, &self.scaling)?.largest;
        let tolerance = tolerance(c.nrows(), c.ncols(), constraint_residual);
        let qr = PivotedQr::of_rows(scaled.select_rows(&self.kept));
        let sigma = smallest_singular_value(&qr, self.rank);
        let required = (DEGRADED * self.evidence.sigma_r)
            .min(1.0)
            .max(CLEARANCE * tolerance)
            .max(NEARLY_SINGULAR);
        if self.rank > 0 && (sigma.is_nan() || sigma < required) {
            return Err(Degraded::KeptRows { sigma, required });
        }
        let mut coefficients = Matrix::zeros(self.redundancy, self.rank);
        let mut residual = 0.0_f64;
        let mut y = vec![0.0; c.ncols()];
        for (j, &row) in self.dropped.iter().enumerate() {
            y.copy_from_slice(scaled.row(row));
            residual = residual.max(strong_basis::coefficients(
                &qr,
                &mut y,
                coefficients.row_mut(j),
            ));
        }
        if residual > tolerance {
            return Err(Degraded::DroppedRows {
                residual,
                tolerance,
            });
        }
        Ok(Self {
            rank: self.rank,
            redundancy: self.redundancy,
            kept: self.kept.clone(),
            dropped: self.dropped.clone(),
            coefficients,
            scaling: self.scaling.clone(),
            evidence: Evidence {
                singular_values: Vec::new(),
                sigma_r: sigma,
                sigma_next: residual,
                gap: gap(sigma, residual),
                tolerance,
                constraint_residual,
                dependence_residual: residual,
                certificate: None,
            },
            status: RankStatus::Decided,
        })
    }
}

/// Two inverse iterations on RᵀR: a little above σ_r of the factored rows; infinite for no rows.
fn smallest_singular_value(qr: &PivotedQr, rank: usize) -> f64 {
    if rank == 0 {
        return f64::INFINITY;
    }
    if rank > qr.steps() || qr.r_diagonal().any(|r| r == 0.0) {
        return 0.0;
    }
    let mut x: Vec<f64> = (0..rank)
        .map(|i| if i % 2 == 0 { 1.0 } else { -0.75 })
        .collect();
    let mut growth = 0.0;
    for _ in 0..2 {
        let size = kernels::norm(&x);
        x.iter_mut().for_each(|x| *x /= size);
        qr.solve_r_transpose(&mut x);
        qr.solve_r(&mut x);
        growth = kernels::norm(&x);
    }
    growth.sqrt().recip()
}
