//! Constrained equations of motion with all rows, redundant ones included, by proximal iterations (an augmented Lagrangian):
//!
//! ```text
//! (M + C̃ᵀ·C̃/μ)·a_k = f + C̃ᵀ·(γ̃/μ − λ̃_{k−1}),   λ̃_k = λ̃_{k−1} + (C̃·a_k − γ̃)/μ,   λ̃_0 = 0
//! ```
//!
//! The rows `C̃ = W·C` are weighted so that `C̃·M⁻¹·C̃ᵀ` has a unit diagonal at the reference; μ compares with its eigenvalues σ². No rank enters a
//! solve. Iterations that go on forever would give the a of the other solvers and, of all λ, the one with the least `Σ (λ_i / w_i)²`.
//!
//! How far k iterations go: a direction σ of C̃·M^(−½) is answered by `(1 − (μ/(μ + σ²))^k)/σ`. A true direction is therefore off by the share
//! `(μ/(μ + σ²))^k`. A direction that is zero on the constraints and about δ off them (at a stage of an integrator) gives accelerations of `k·δ²/μ`:
//! **a smaller μ is worse, not better, off the constraints**. [`ProximalTuning::rule`] keeps both small; μ = 1e-8 with 3 iterations, exact on the constraints, costs
//! an integrator four digits.
//!
//! The same iterates are computed as corrections of a, so that rounding of the large C̃ᵀ·C̃/μ does not reach the accelerations. Source:
//! J. Carpentier, R. Budhiraja, N. Mansard, Proximal and sparse resolution of constrained dynamic equations, Robotics: Science and Systems
//! XVII (2021).

mod tuning;

#[cfg(test)]
mod tests;

use crate::kernels::{axpy, dot, max_abs};
use crate::saddle::{SaddleError, State, check_equations, check_finite, check_length};
use crate::{Matrix, ldl};

pub use tuning::ProximalTuning;
use tuning::{row_weights, smallest_direction};

/// Solver of the saddle equations of n coordinates and m rows of any rank; all storage is allocated when it is made.
///
/// ```
/// use linalg::{Matrix, ProximalSaddle};
/// // Unit mass on the line x = y, stated twice, pushed along x: a = (½, ½), and each row takes its half.
/// let c = Matrix::from_rows(&[[1.0, -1.0], [1.0, -1.0]]);
/// let mut saddle = ProximalSaddle::new(&c, &[1.0, 1.0], 1, 1e-12)?;
/// saddle.factor(&c, &[1.0, 1.0])?;
/// let (mut a, mut lambda) = ([0.0; 2], [0.0; 2]);
/// saddle.solve(&[1.0, 0.0], &[0.0, 0.0], &mut a, &mut lambda)?;
/// for x in a.iter().zip(&lambda).flat_map(|(a, l)| [a - 0.5, l - 0.25]) {
///     assert!(x.abs() < 1e-12);
/// }
/// # Ok::<(), linalg::SaddleError>(())
/// ```
#[derive(Debug, Clone)]
pub struct ProximalSaddle {
    tuning: ProximalTuning,
    /// Diagonal of W.
    weights: Vec<f64>,
    /// C̃.
    rows: Matrix,
    mass: Vec<f64>,
    /// L·D·Lᵀ of M + C̃ᵀ·C̃/μ, n×n.
    regularised: Vec<f64>,
    unsettled: f64,
    state: State,
    /// Scratch of `solve`: a and its correction (n), λ̃ (m).
    x: Vec<f64>,
    g: Vec<f64>,
    multipliers: Vec<f64>,
}

impl ProximalSaddle {
    /// Storage for matrices like `reference`, where the rank has been decided, with weights and tuning that reach a relative `tolerance` there.
    ///
    /// # Errors
    /// - [`SaddleError::TooManyRows`]: a rank that no matrix of this shape has.
    /// - [`SaddleError::Length`], [`SaddleError::NonFinite`], [`SaddleError::NegativeMass`]: bad input.
    /// - [`SaddleError::MasslessMotion`]: M is not positive definite on ker C, and no μ makes up for that.
    /// - [`SaddleError::RankLost`]: C has a smaller rank.
    pub fn new(
        reference: &Matrix,
        mass: &[f64],
        rank: usize,
        tolerance: f64,
    ) -> Result<Self, SaddleError> {
        let one = ProximalTuning {
            mu: 1.0,
            iterations: 1,
        };
        let mut saddle = Self::with_tuning(reference, mass, one)?;
        saddle.tune(reference, mass, rank, tolerance)?;
        Ok(saddle)
    }

    /// Tunes again for C of a decided rank; the weights of the rows stay, and with them the λ that iterations tend to. Allocates; after it
    /// there is nothing factored.
    ///
    /// # Errors
    /// As [`ProximalSaddle::new`]; the tuning is then the old one.
    pub fn tune(
        &mut self,
        c: &Matrix,
        mass: &[f64],
        rank: usize,
        tolerance: f64,
    ) -> Result<(), SaddleError> {
        let old = std::mem::replace(&mut self.tuning.mu, 1.0);
        let factored = self.factor(c, mass);
        self.tuning.mu = old;
        self.state = State::Empty;
        factored?;
        let sigma_squared = smallest_direction(&self.rows, &self.regularised, rank)?;
        self.tuning = ProximalTuning::rule(sigma_squared, tolerance);
        Ok(())
    }

    /// The same with a tuning of the caller's.
    ///
    /// # Errors
    /// [`SaddleError::Length`], [`SaddleError::NonFinite`], [`SaddleError::NegativeMass`]: bad input.
    pub fn with_tuning(
        reference: &Matrix,
        mass: &[f64],
        tuning: ProximalTuning,
    ) -> Result<Self, SaddleError> {
        let (m, n) = (reference.nrows(), reference.ncols());
        check_equations(reference, mass, (m, n))?;
        Ok(Self {
            tuning,
            weights: row_weights(reference, mass),
            rows: Matrix::zeros(m, n),
            mass: vec![0.0; n],
            regularised: vec![0.0; n * n],
            unsettled: 0.0,
            state: State::Empty,
            x: vec![0.0; n],
            g: vec![0.0; n],
            multipliers: vec![0.0; m],
        })
    }

    /// μ and the number of iterations.
    pub fn tuning(&self) -> ProximalTuning {
        self.tuning
    }

    /// What the last iteration of the last solve still changed, as a share of the whole in the norm of M + C̃ᵀ·C̃/μ. On the constraints it is about
    /// the tolerance asked for; more means that σ_r has become smaller than where the tuning was chosen.
    pub fn unsettled(&self) -> f64 {
        self.unsettled
    }

    /// Factors M + C̃ᵀ·C̃/μ for C (m×n) and the diagonal of M; allocates nothing unless it fails. After an error the solver holds no
    /// factorisation.
    ///
    /// # Errors
    /// - [`SaddleError::Length`], [`SaddleError::NonFinite`], [`SaddleError::NegativeMass`]: bad input.
    /// - [`SaddleError::MasslessMotion`]: M + C̃ᵀ·C̃/μ is not positive definite; carries the motion that has neither mass nor constraint.
    pub fn factor(&mut self, c: &Matrix, mass: &[f64]) -> Result<(), SaddleError> {
        self.state = State::Empty;
        let n = self.mass.len();
        check_equations(c, mass, (self.rows.nrows(), n))?;
        self.mass.copy_from_slice(mass);
        self.regularised.fill(0.0);
        for (i, m) in mass.iter().enumerate() {
            self.regularised[i * n + i] = *m;
        }
        let inverse_mu = self.tuning.mu.recip();
        for (k, w) in self.weights.iter().enumerate() {
            let row = self.rows.row_mut(k);
            for (x, c) in row.iter_mut().zip(c.row(k)) {
                *x = w * c;
            }
            for i in (0..n).filter(|&i| row[i] != 0.0) {
                axpy(
                    inverse_mu * row[i],
                    &row[..=i],
                    &mut self.regularised[i * n..],
                );
            }
        }
        let floor = |_, size: f64| n as f64 * f64::EPSILON * size;
        ldl::factor(&mut self.regularised, n, floor).map_err(|lost| {
            let mut motion = ldl::direction(&self.regularised, n, lost);
            let largest = max_abs(&motion);
            for x in &mut motion {
                *x /= largest;
            }
            SaddleError::MasslessMotion {
                reduced: lost.left,
                size: lost.size,
                motion,
            }
        })?;
        self.state = State::Factored;
        Ok(())
    }

    /// Solves `M·a + Cᵀ·λ = f`, `C·a = γ` with the last factorisation as far as the iterations go; allocates nothing.
    ///
    /// | argument | shape | meaning |
    /// | --- | --- | --- |
    /// | `f` | n | applied forces |
    /// | `gamma` | m | right-hand side of all rows |
    /// | `a` | n | overwritten: accelerations |
    /// | `lambda` | m | overwritten: multipliers of all rows, `λ = W·λ̃` |
    ///
    /// # Errors
    /// - [`SaddleError::NotFactored`]: there is no successful `factor` before.
    /// - [`SaddleError::Length`], [`SaddleError::NonFinite`]: bad input; outputs are untouched.
    pub fn solve(
        &mut self,
        f: &[f64],
        gamma: &[f64],
        a: &mut [f64],
        lambda: &mut [f64],
    ) -> Result<(), SaddleError> {
        let (m, n) = (self.rows.nrows(), self.mass.len());
        if self.state != State::Factored {
            return Err(SaddleError::NotFactored);
        }
        check_length("f", f, n)?;
        check_length("gamma", gamma, m)?;
        check_length("a", a, n)?;
        check_length("lambda", lambda, m)?;
        check_finite("f", f, 0)?;
        check_finite("gamma", gamma, 0)?;

        self.x.fill(0.0);
        self.multipliers.fill(0.0);
        let mut first = 0.0;
        for iteration in 0..self.tuning.iterations {
            let size = self.correct(f, gamma);
            if iteration == 0 {
                first = size;
            }
            self.unsettled = if first > 0.0 {
                (size / first).sqrt()
            } else {
                0.0
            };
            self.update_multipliers(gamma);
        }
        a.copy_from_slice(&self.x);
        for ((l, w), of_row) in lambda.iter_mut().zip(&self.weights).zip(&self.multipliers) {
            *l = w * of_row;
        }
        Ok(())
    }

    /// `x ← x + (M + C̃ᵀ·C̃/μ)⁻¹·g` with the forces g that x and λ̃ leave; returns the square of the correction in the norm of the matrix.
    fn correct(&mut self, f: &[f64], gamma: &[f64]) -> f64 {
        for ((g, f), (m, x)) in self.g.iter_mut().zip(f).zip(self.mass.iter().zip(&self.x)) {
            *g = f - m * x;
        }
        for (k, w) in self.weights.iter().enumerate() {
            let row = self.rows.row(k);
            let missed = (dot(row, &self.x) - w * gamma[k]) / self.tuning.mu;
            axpy(-(self.multipliers[k] + missed), row, &mut self.g);
        }
        // With L·D·Lᵀ·dx = g the square is ‖D^(−½)·L⁻¹·g‖².
        ldl::forward(&self.regularised, &mut self.g);
        let n = self.g.len();
        let mut size = 0.0;
        for (i, g) in self.g.iter_mut().enumerate() {
            let d = self.regularised[i * n + i];
            size += *g * (*g / d);
            *g /= d;
        }
        ldl::backward(&self.regularised, &mut self.g);
        axpy(1.0, &self.g, &mut self.x);
        size
    }

    /// λ̃ ← λ̃ + (C̃·x − γ̃)/μ.
    fn update_multipliers(&mut self, gamma: &[f64]) {
        for (k, l) in self.multipliers.iter_mut().enumerate() {
            let missed = dot(self.rows.row(k), &self.x) - self.weights[k] * gamma[k];
            *l += missed / self.tuning.mu;
        }
    }
}
