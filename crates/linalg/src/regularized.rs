//! Computes a damped least-squares correction towards `res + J·dq = 0`, for rows that may be
//! redundant or contradict each other.
//!
//! The correction is intended only for the assembly of an initial configuration far from the
//! constraint manifold, where the rank is not known. On the manifold, use independent rows and
//! `KeptRowSaddle`, which preserves the order of the integrator.

use crate::{Matrix, PivotedQr, powers};

/// Reason why a correction step could not be computed.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StepError {
    /// An argument has the wrong length.
    #[error("{argument} has {found} entries, need {expected}")]
    Length {
        /// Name of the argument.
        argument: &'static str,
        /// Length of the argument.
        found: usize,
        /// The length it must have.
        expected: usize,
    },
    /// An entry is NaN or infinite.
    #[error("{argument} contains the value {value} at {index}, need finite numbers")]
    NonFinite {
        /// Name of the argument.
        argument: &'static str,
        /// Index of the entry, row-major for J.
        index: usize,
        /// Value of the entry.
        value: f64,
    },
    /// A weight or μ is negative.
    #[error("{argument} contains {value:.3e} at {index}, need numbers that are not negative")]
    Negative {
        /// Name of the argument.
        argument: &'static str,
        /// Index of the entry.
        index: usize,
        /// Value of the weight or of μ.
        value: f64,
    },
    /// Without damping, dependent rows have no unique correction.
    #[error(
        "row {row} depends on the others (pivot {pivot:.3e} of {largest:.3e}) and μ = {mu:.1e} does \
         not separate them: use a larger μ"
    )]
    Dependent {
        /// Row of J.
        row: usize,
        /// Pivot of the row.
        pivot: f64,
        /// The largest pivot.
        largest: f64,
        /// The damping.
        mu: f64,
    },
}

/// Returns the W-weighted correction `dq = W·Jᵀ·(J·W·Jᵀ + μ·S⁻²)⁻¹·(−res)`. The function allocates
/// memory.
///
/// S is the power-of-two row scaling that brings the largest entry of each row of `J·√W` into [1,
/// 2). Therefore μ is compared with entries near one, for any units of the rows. The correction dq
/// minimises `μ·dqᵀ·W⁻¹·dq + ‖S·(J·dq + res)‖²`. Corrections are small, and contradictions are
/// distributed among the rows.
///
/// | argument | shape | meaning |
/// | --- | --- | --- |
/// | `j` | m×n | Jacobian of the residual, any rank, m may exceed n |
/// | `residual` | m | res |
/// | `weights` | n | diagonal of W ≥ 0; a coordinate with a large weight moves easily, one with weight 0 is fixed |
/// | `mu` | – | damping ≥ 0; 1e-12 … 1e-2. With 0 the rows must be independent |
///
/// The function uses a QR factorisation of `[S·J·√W, √μ·I]ᵀ`, so `J·W·Jᵀ` is never formed.
///
/// ```
/// use pfaff_linalg::{Matrix, least_squares_step};
/// // Two contradicting rows x = 1 and x = 3: the middle, up to the damping. y does not move.
/// let j = Matrix::from_rows(&[[1.0, 0.0], [1.0, 0.0]]);
/// let dq = least_squares_step(&j, &[-1.0, -3.0], &[1.0, 1.0], 1e-9)?;
/// assert!((dq[0] - 2.0).abs() < 1e-8 && dq[1] == 0.0);
/// # Ok::<(), pfaff_linalg::StepError>(())
/// ```
///
/// # Errors
/// - [`StepError::Length`], [`StepError::NonFinite`], [`StepError::Negative`]: bad input.
/// - [`StepError::Dependent`]: μ is too small for rows that depend on each other.
pub fn least_squares_step(
    j: &Matrix,
    residual: &[f64],
    weights: &[f64],
    mu: f64,
) -> Result<Vec<f64>, StepError> {
    check("residual", residual, j.nrows())?;
    DampedRows::new(j, weights, mu)?.step(residual)
}

/// Factors for [`least_squares_step`], which can be used for any number of residuals.
#[derive(Debug, Clone)]
pub struct DampedRows {
    /// Factors of `[S·J·√W, √μ·I]ᵀ`; without damping, only J is factored.
    qr: PivotedQr,
    /// Square root √W.
    root: Vec<f64>,
    /// Exponents of S.
    scaling: Vec<i32>,
}

impl DampedRows {
    /// Factors J with the weights and the damping of [`least_squares_step`].
    ///
    /// # Errors
    /// Returns the same errors as [`least_squares_step`].
    pub fn new(j: &Matrix, weights: &[f64], mu: f64) -> Result<Self, StepError> {
        let (m, n) = (j.nrows(), j.ncols());
        check("weights", weights, n)?;
        check("J", j.as_slice(), m * n)?;
        check("mu", &[mu], 1)?;
        check_sign("weights", weights)?;
        check_sign("mu", &[mu])?;

        let root: Vec<f64> = weights.iter().map(|w| w.sqrt()).collect();
        let mut rows = Matrix::zeros(m, n + if mu == 0.0 { 0 } else { m });
        let mut scaling = vec![0; m];
        for i in 0..m {
            let row = rows.row_mut(i);
            for l in 0..n {
                row[l] = j[(i, l)] * root[l];
            }
            let e = powers::unit_exponent(row);
            for x in &mut row[..n] {
                *x = powers::scale(*x, e);
            }
            scaling[i] = e;
        }
        let qr = if mu == 0.0 {
            PivotedQr::of_rows(rows)
        } else {
            PivotedQr::of_damped_rows(rows, mu.sqrt())
        };
        let largest = qr.r_diagonal().next().unwrap_or(0.0).abs();
        let pivots = qr.r_diagonal().chain(std::iter::repeat(0.0));
        for (pivot, &row) in pivots.zip(qr.permutation()) {
            let pivot = pivot.abs();
            if pivot.is_nan() || pivot <= m as f64 * f64::EPSILON * largest {
                return Err(StepError::Dependent {
                    row,
                    pivot,
                    largest,
                    mu,
                });
            }
        }
        Ok(Self { qr, root, scaling })
    }

    /// Returns the correction for a residual.
    ///
    /// # Errors
    /// [`StepError::Length`], [`StepError::NonFinite`]: bad input.
    pub fn step(&self, residual: &[f64]) -> Result<Vec<f64>, StepError> {
        let m = self.scaling.len();
        check("residual", residual, m)?;
        // The minimum-norm solution of [S·J·√W, √μ·I]·x = −S·res is x = Q·R⁻ᵀ·Pᵀ·(−S·res).
        let mut x = vec![0.0; self.qr.dimension()];
        for (x_k, &row) in x.iter_mut().zip(self.qr.permutation()) {
            *x_k = -powers::scale(residual[row], self.scaling[row]);
        }
        self.qr.solve_r_transpose(&mut x[..m]);
        self.qr.q_mul(&mut x);
        Ok(self.root.iter().zip(&x).map(|(root, x)| root * x).collect())
    }
}

fn check(argument: &'static str, x: &[f64], expected: usize) -> Result<(), StepError> {
    if x.len() != expected {
        return Err(StepError::Length {
            argument,
            found: x.len(),
            expected,
        });
    }
    match x.iter().position(|a| !a.is_finite()) {
        Some(index) => Err(StepError::NonFinite {
            argument,
            index,
            value: x[index],
        }),
        None => Ok(()),
    }
}

fn check_sign(argument: &'static str, x: &[f64]) -> Result<(), StepError> {
    match x.iter().position(|&a| a < 0.0) {
        Some(index) => Err(StepError::Negative {
            argument,
            index,
            value: x[index],
        }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Compares with the normal equations in nalgebra, which are well conditioned for μ = 1e-2.
        #[test]
        fn agrees_with_the_normal_equations(
            m in 1..9_usize, n in 1..9_usize,
            data in prop::collection::vec(-1.0..1.0_f64, 64),
            res in prop::collection::vec(-1.0..1.0_f64, 8),
            weights in prop::collection::vec(prop_oneof![Just(0.0), 0.1..10.0_f64], 8),
        ) {
            const MU: f64 = 1e-2;
            let j = Matrix::from_fn(m, n, |i, l| data[8 * i + l]);
            let dq = least_squares_step(&j, &res[..m], &weights[..n], MU).unwrap();
            let jac = DMatrix::from_row_slice(m, n, j.as_slice());
            let w = DMatrix::from_diagonal(&DVector::from_column_slice(&weights[..n]));
            let s_inverse_squared = DMatrix::from_diagonal(&DVector::from_fn(m, |i, _| {
                let top = (0..n).map(|l| (j[(i, l)] * weights[l].sqrt()).abs()).fold(0.0, f64::max);
                if top == 0.0 { 1.0 } else { 4.0_f64.powi(top.log2().floor() as i32) }
            }));
            let normal = &jac * &w * jac.transpose() + MU * s_inverse_squared;
            let y = normal.lu().solve(&-DVector::from_column_slice(&res[..m])).unwrap();
            let expected = w * jac.transpose() * y;
            for l in 0..n {
                prop_assert!((dq[l] - expected[l]).abs() < 1e-9 * (1.0 + expected.amax()));
            }
        }
    }

    #[test]
    fn independent_rows_are_met_exactly_without_damping() {
        let j = Matrix::from_rows(&[[1e6, 0.0, 1e6], [0.0, 1e-6, 0.0]]);
        let dq = least_squares_step(&j, &[-2e6, 3e-6], &[1.0, 1.0, 0.0], 0.0).unwrap();
        for (x, y) in dq.iter().zip([2.0, -3.0, 0.0]) {
            assert!((x - y).abs() < 1e-15 * 8.0, "{dq:?}");
        }
    }

    #[test]
    fn errors_name_the_numbers() {
        let j = Matrix::from_rows(&[[1.0], [2.0]]);
        let message =
            |r: &[f64], w: &[f64], mu| least_squares_step(&j, r, w, mu).unwrap_err().to_string();
        assert_eq!(
            message(&[1.0], &[1.0], 0.0),
            "residual has 1 entries, need 2"
        );
        assert!(message(&[1.0, f64::NAN], &[1.0], 0.0).contains("NaN at 1"));
        assert!(message(&[1.0, 1.0], &[-1.0], 0.0).contains("weights contains -1.000e0 at 0"));
        assert!(message(&[1.0, 1.0], &[1.0], 0.0).contains("use a larger μ"));
    }
}
