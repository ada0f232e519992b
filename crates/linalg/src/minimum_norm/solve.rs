//! Solution for one right-hand side, and the null space that the shortest λ was chosen from.

use super::MinimumNormSaddle;
use crate::kernels::{axpy, dot};
use crate::qr::apply;
use crate::saddle::{SaddleError, State, check_finite, check_length};
use crate::{Matrix, ldl};

impl MinimumNormSaddle {
    /// Solves `M·a + Cᵀ·λ = f`, `C·a = γ` with the last factorisation; allocates nothing.
    ///
    /// | argument | shape | meaning |
    /// | --- | --- | --- |
    /// | `f` | n | applied forces |
    /// | `gamma` | m | right-hand side of all rows |
    /// | `a` | n | overwritten: accelerations; of all a that miss γ least, measured by D_r, the one in equilibrium |
    /// | `lambda` | m | overwritten: of all multipliers those with the least `Σ (λ_i / d_i)²`, with the row factors d of the equilibration |
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
        let (m, n) = (self.factors.nrows(), self.mass.len());
        if self.state != State::Factored {
            return Err(SaddleError::NotFactored);
        }
        check_length("f", f, n)?;
        check_length("gamma", gamma, m)?;
        check_length("a", a, n)?;
        check_length("lambda", lambda, m)?;
        check_finite("f", f, 0)?;
        check_finite("gamma", gamma, 0)?;

        self.particular(gamma);
        self.force_left(f);
        self.add_free_motion();
        self.force_left(f);
        self.multipliers(lambda);
        for ((a, x), d) in a.iter_mut().zip(&self.x).zip(&self.column_factor) {
            *a = d * x;
        }
        Ok(())
    }

    /// x = C̃⁺·D_r·γ.
    fn particular(&mut self, gamma: &[f64]) {
        let r = self.rank;
        for (u, &row) in self.u.iter_mut().zip(&self.reflections.permutation) {
            *u = self.row_factor[row] * gamma[row];
        }
        for k in (0..r).rev() {
            reflect_rest(&self.z_tail, &self.z_tau, k, r, &mut self.u);
        }
        // Tᵀ·y = u.
        let mut x = std::mem::take(&mut self.x);
        x.fill(0.0);
        for k in 0..r {
            let column = self.factors.row(k);
            x[k] = (self.u[k] - dot(&column[..k], &x[..k])) / column[k];
        }
        self.q_mul(&mut x);
        self.x = x;
    }

    /// g = f̃ − M̃·x.
    fn force_left(&mut self, f: &[f64]) {
        for (i, g) in self.g.iter_mut().enumerate() {
            *g = self.column_factor[i] * f[i] - self.mass[i] * self.x[i];
        }
    }

    /// x ← x + Q₂·w with `(Q₂ᵀ·M̃·Q₂)·w = Q₂ᵀ·g`.
    fn add_free_motion(&mut self) {
        let w = &mut self.w[..self.mass.len() - self.rank];
        for (c, w) in w.iter_mut().enumerate() {
            *w = dot(self.free.row(c), &self.g);
        }
        ldl::solve(&self.reduced_mass, w);
        for (c, w) in w.iter().enumerate() {
            axpy(*w, self.free.row(c), &mut self.x);
        }
    }

    /// λ = D_r·P·Zᵀ·[T⁻¹·Q₁ᵀ·g; 0].
    fn multipliers(&mut self, lambda: &mut [f64]) {
        let r = self.rank;
        for k in 0..r {
            let v = &self.factors.row(k)[k..];
            apply(self.reflections.tau[k], v, &mut self.g[k..]);
        }
        self.u[..r].copy_from_slice(&self.g[..r]);
        self.u[r..].fill(0.0);
        for k in (0..r).rev() {
            let column = self.factors.row(k);
            self.u[k] /= column[k];
            let u_k = self.u[k];
            axpy(-u_k, &column[..k], &mut self.u[..k]);
        }
        for k in 0..r {
            reflect_rest(&self.z_tail, &self.z_tau, k, r, &mut self.u);
        }
        for (u, &row) in self.u.iter().zip(&self.reflections.permutation) {
            lambda[row] = self.row_factor[row] * u;
        }
    }

    /// Basis (m×p, p = m − rank) of the self-stresses, `Cᵀ·z = 0`, of the last factorisation: all other solutions are λ + z·y. Allocates.
    #[must_use]
    pub fn left_null_space(&self) -> Matrix {
        let (r, m) = (self.rank, self.factors.nrows());
        let mut basis = Matrix::zeros(m, m - r);
        let mut u = vec![0.0; m];
        for c in 0..m - r {
            u.fill(0.0);
            u[r + c] = 1.0;
            for k in 0..r {
                reflect_rest(&self.z_tail, &self.z_tau, k, r, &mut u);
            }
            for (u, &row) in u.iter().zip(&self.reflections.permutation) {
                basis[(row, c)] = self.row_factor[row] * u;
            }
        }
        basis
    }
}

/// `u ← H_k·u`: entry k and those from r on.
fn reflect_rest(tail: &Matrix, tau: &[f64], k: usize, r: usize, u: &mut [f64]) {
    let (leading, rest) = u.split_at_mut(r);
    let v = &tail.row(k)[r..];
    if v.is_empty() {
        return;
    }
    let s = -tau[k] * (leading[k] + dot(v, rest));
    leading[k] += s;
    axpy(s, v, rest);
}
