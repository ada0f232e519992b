//! Solution for one right-hand side; any number of them per factorisation.

use super::{KeptRowSaddle, SaddleError, State, check_finite, check_length};
use crate::kernels::{axpy, dot};

impl KeptRowSaddle {
    /// Solves `M·a + Cᵀ·λ = f`, `C·a = γ` with the last factorisation; allocates nothing.
    ///
    /// This is [`KeptRowSaddle::motion`] and [`KeptRowSaddle::multipliers`].
    ///
    /// | argument | shape | meaning |
    /// | --- | --- | --- |
    /// | `f` | n | applied forces; 0 for a projection |
    /// | `gamma` | r | right-hand side of the kept rows; −Φ for a mass-metric projection step |
    /// | `a` | n | overwritten: accelerations (or the correction of the projection) |
    /// | `lambda` | r | overwritten: multipliers of the kept rows, zero for rows left out |
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
        check_length("lambda", lambda, self.rows)?;
        self.motion(f, gamma, a)?;
        self.multipliers(f, a, lambda)
    }

    /// The same without λ: two thirds of the work.
    ///
    /// # Errors
    /// As [`KeptRowSaddle::solve`].
    pub fn motion(&mut self, f: &[f64], gamma: &[f64], a: &mut [f64]) -> Result<(), SaddleError> {
        let n = self.n;
        if self.state != State::Factored {
            return Err(SaddleError::NotFactored);
        }
        check_length("f", f, n)?;
        check_length("gamma", gamma, self.rows)?;
        check_length("a", a, n)?;
        check_finite("f", f, 0)?;
        check_finite("gamma", gamma, 0)?;

        self.particular(gamma);
        self.force_left(f);
        self.add_free_motion();
        for (&coordinate, &y_i) in self.permutation.iter().zip(&self.y) {
            a[coordinate] = y_i;
        }
        Ok(())
    }

    /// λ from `Cᵀ·λ = f − M·a` with the last factorisation, for an a that solves the equations;
    /// allocates nothing.
    ///
    /// | argument | shape | meaning |
    /// | --- | --- | --- |
    /// | `f` | n | the forces |
    /// | `a` | n | their accelerations; 0 for a force that moves nothing, a row of C that the kept ones imply |
    /// | `lambda` | r | overwritten: multipliers of the kept rows, zero for rows left out |
    ///
    /// # Errors
    /// As [`KeptRowSaddle::solve`].
    pub fn multipliers(
        &mut self,
        f: &[f64],
        a: &[f64],
        lambda: &mut [f64],
    ) -> Result<(), SaddleError> {
        if self.state != State::Factored {
            return Err(SaddleError::NotFactored);
        }
        check_length("f", f, self.n)?;
        check_length("a", a, self.n)?;
        check_length("lambda", lambda, self.rows)?;
        check_finite("f", f, 0)?;
        check_finite("a", a, 0)?;

        for (y, &coordinate) in self.y.iter_mut().zip(&self.permutation) {
            *y = a[coordinate];
        }
        self.force_left(f);
        self.solve_for_multipliers();
        lambda.fill(0.0);
        for (&row, &l) in self.used[..self.r].iter().zip(&self.g) {
            lambda[row] = l;
        }
        Ok(())
    }

    fn lu_row(&self, j: usize) -> &[f64] {
        &self.lu[j * self.n..(j + 1) * self.n]
    }

    /// y = P·a_p with `C·a_p = γ` and zeros in the free coordinates.
    fn particular(&mut self, gamma: &[f64]) {
        self.y[self.r..].fill(0.0);
        self.determine(gamma);
    }

    /// y₁ such that `C·a = γ` with the y₂ that is there: `Uᵀ·s = γ`, `L₁ᵀ·y₁ = s − L₂ᵀ·y₂`.
    pub(super) fn determine(&mut self, gamma: &[f64]) {
        let (n, y) = (self.n, &mut self.y);
        let rows = self.lu[..self.r * n].chunks_exact(n.max(1)).enumerate();
        for (j, row) in rows.clone() {
            y[j] = (gamma[self.used[j]] - dot(&row[..j], &y[..j])) * self.inverse[j];
        }
        for (j, row) in rows.rev() {
            y[j] -= dot(&row[j + 1..], &y[j + 1..]);
        }
    }

    /// g = P·(f − M·a).
    fn force_left(&mut self, f: &[f64]) {
        for i in 0..self.n {
            self.g[i] = f[self.permutation[i]] - self.mass[i] * self.y[i];
        }
    }

    /// y ← y + P·N·z with `(NᵀMN)·z = Nᵀ·g`.
    fn add_free_motion(&mut self) {
        let (r, k) = (self.r, self.n - self.r);
        let (y, z) = self.y.split_at_mut(r);
        for c in 0..k {
            let l_c = &self.reduced_mass[c * k..(c + 1) * k];
            let null_c = &self.null_basis[c * r..(c + 1) * r];
            let n_c_g = dot(null_c, &self.g[..r]) + self.g[r + c];
            z[c] = n_c_g - dot(&l_c[..c], &z[..c]);
        }
        for c in 0..k {
            z[c] /= self.reduced_mass[c * k + c];
        }
        for c in (0..k).rev() {
            let z_c = z[c];
            axpy(-z_c, &self.reduced_mass[c * k..c * k + c], &mut z[..c]);
            axpy(z_c, &self.null_basis[c * r..(c + 1) * r], y);
        }
    }

    /// g[..r] ← λ with `L₁·U·λ = g₁`; the other rows of `L·U·λ = g` then hold as well.
    fn solve_for_multipliers(&mut self) {
        let r = self.r;
        let mut g = std::mem::take(&mut self.g);
        for j in 0..r {
            let g_j = g[j];
            axpy(-g_j, &self.lu_row(j)[j + 1..r], &mut g[j + 1..r]);
        }
        for j in (0..r).rev() {
            let row = self.lu_row(j);
            g[j] *= self.inverse[j];
            let g_j = g[j];
            axpy(-g_j, &row[..j], &mut g[..j]);
        }
        self.g = g;
    }
}
