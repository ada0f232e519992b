//! Solves with all rows by proximal iterations (an augmented Lagrangian), with parameters that are
//! computed once:
//!
//! ```text
//! (M + C̃ᵀ·C̃/μ)·δ = f − M·a − C̃ᵀ·(λ̃ + (C̃·a − γ̃)/μ),   a ← a + δ,   λ̃ ← λ̃ + (C̃·a − γ̃)/μ,   C̃ = W·C
//! ```
//!
//! W scales the rows so that the diagonal of C̃·M⁻¹·C̃ᵀ is one. The size of μ is relative to the
//! eigenvalues σ² of this matrix. The relative error in a direction with singular value σ is
//! `(μ/(μ + σ²))^k` after k iterations. If the constraints are violated, a zero singular value may
//! become δ. Its direction then has accelerations of `k·δ²/μ`, so a smaller μ increases this error.
//! A solve does not need the rank. Source: J. Carpentier, R. Budhiraja, N. Mansard, Proximal and
//! sparse resolution of constrained dynamic equations, Robotics: Science and Systems XVII (2021).

use linalg::{Lu, Matrix, singular_values};

use super::{Fault, Saddle, Solver, dot};

/// Ratio of μ to σ_r²: each iteration reduces the error by a factor of eleven.
const DECADE: f64 = 0.1;

/// Smallest mass for the computation of the parameters, relative to the largest mass. Smaller
/// masses are replaced by this value, to avoid a division by zero for massless bodies.
const LEAST_MASS: f64 = 1e-12;

/// The parameter μ and the number of iterations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tuning {
    /// The parameter μ, relative to the eigenvalues of C̃·M⁻¹·C̃ᵀ.
    pub mu: f64,
    /// Number of iterations k.
    pub iterations: usize,
}

impl Tuning {
    /// Computes a value of μ one decade below σ_r², and the number of iterations after which the
    /// fraction `tolerance` remains in the slowest direction.
    ///
    /// ```
    /// let tuning = lab::comparators::Tuning::rule(4e-3, 1e-8);
    /// assert!((tuning.mu - 4e-4).abs() < 1e-18);
    /// assert_eq!(tuning.iterations, 8); // 11⁻⁸ = 4.7e-9
    /// ```
    #[must_use]
    pub fn rule(sigma_squared: f64, tolerance: f64) -> Self {
        let share = DECADE / (1.0 + DECADE);
        let tolerance = tolerance.clamp(f64::EPSILON, share);
        Self {
            mu: DECADE * sigma_squared.min(1.0),
            iterations: (tolerance.ln() / share.ln()).ceil() as usize,
        }
    }
}

/// A solver for all rows, of any rank.
pub struct Proximal {
    tuning: Tuning,
    /// Diagonal of the matrix W.
    weights: Vec<f64>,
}

impl Proximal {
    /// Computes weights and parameters for a relative `tolerance`, for a matrix C of this rank and
    /// these masses.
    ///
    /// # Errors
    /// [`Fault::RankLost`].
    pub fn new(c: &Matrix, mass: &[f64], rank: usize, tolerance: f64) -> Result<Self, Fault> {
        let least = LEAST_MASS * mass.iter().fold(0.0, |a: f64, m| a.max(*m));
        let mobility = |i: usize| {
            let terms = c.row(i).iter().zip(mass);
            terms.map(|(c, m)| c * c / m.max(least)).sum::<f64>()
        };
        let weight = |i: usize| match mobility(i) {
            0.0 => 1.0,
            mobility => mobility.sqrt().recip(),
        };
        let weights: Vec<f64> = (0..c.nrows()).map(weight).collect();
        let whitened = Matrix::from_fn(c.nrows(), c.ncols(), |i, j| {
            weights[i] * c[(i, j)] / mass[j].max(least).sqrt()
        });
        let sigma = match rank.checked_sub(1) {
            None => 1.0,
            Some(last) => singular_values(&whitened).get(last).copied().unwrap_or(0.0),
        };
        if sigma <= f64::EPSILON {
            return Err(Fault::RankLost { rank });
        }
        Ok(Self::with_tuning(
            Tuning::rule(sigma * sigma, tolerance),
            weights,
        ))
    }

    /// Creates the solver with the parameters and weights of the caller.
    #[must_use]
    pub fn with_tuning(tuning: Tuning, weights: Vec<f64>) -> Self {
        Self { tuning, weights }
    }

    /// Returns μ and the number of iterations.
    #[must_use]
    pub fn tuning(&self) -> Tuning {
        self.tuning
    }
}

impl Solver for Proximal {
    fn solve(&mut self, at: &Saddle<'_>, a: &mut [f64], lambda: &mut [f64]) -> Result<(), Fault> {
        let (m, n, mu) = (at.c.nrows(), at.c.ncols(), self.tuning.mu);
        let rows = Matrix::from_fn(m, n, |i, j| self.weights[i] * at.c[(i, j)]);
        let mut matrix = Matrix::zeros(n, n);
        for (i, mass) in at.mass.iter().enumerate() {
            matrix[(i, i)] = *mass;
        }
        for k in 0..m {
            let row = rows.row(k);
            for i in (0..n).filter(|&i| row[i] != 0.0) {
                for (entry, c) in matrix.row_mut(i).iter_mut().zip(row) {
                    *entry += row[i] * c / mu;
                }
            }
        }
        let mut lu = Lu::new(n);
        lu.factor(|i, j| matrix[(i, j)])
            .map_err(|_| Fault::Massless)?;
        a.fill(0.0);
        lambda.fill(0.0);
        let missed =
            |k: usize, a: &[f64]| (dot(rows.row(k), a) - self.weights[k] * at.gamma[k]) / mu;
        for _ in 0..self.tuning.iterations {
            let mut left: Vec<f64> = (0..n).map(|i| at.force[i] - at.mass[i] * a[i]).collect();
            for k in 0..m {
                let pull = lambda[k] + missed(k, a);
                for (left, c) in left.iter_mut().zip(rows.row(k)) {
                    *left -= pull * c;
                }
            }
            lu.solve(&mut left);
            for (a, d) in a.iter_mut().zip(&left) {
                *a += d;
            }
            for (k, l) in lambda.iter_mut().enumerate() {
                *l += missed(k, a);
            }
        }
        for (l, w) in lambda.iter_mut().zip(&self.weights) {
            *l *= w;
        }
        Ok(())
    }
}
