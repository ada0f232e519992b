//! Solution for one right-hand side. One factorisation serves any number of right-hand sides.

use super::KeptRowSaddle;
use super::error::{SaddleError, check_finite, check_length};

impl KeptRowSaddle {
    /// Solves `M·a + Cᵀ·λ = f`, `C·a = γ` with the last factorisation. The function does not
    /// allocate memory.
    ///
    /// The function calls [`KeptRowSaddle::motion`] and then [`KeptRowSaddle::multipliers`].
    ///
    /// | argument | shape | meaning |
    /// | --- | --- | --- |
    /// | `f` | n | applied forces; 0 for a projection |
    /// | `gamma` | r | right-hand side of the rows; −Φ for a mass-metric projection step |
    /// | `a` | n | overwritten: accelerations (or the correction of the projection) |
    /// | `lambda` | r | overwritten: multipliers of the rows, zero for skipped rows |
    ///
    /// # Errors
    /// - [`SaddleError::NotFactored`]: no successful `factor` precedes this call.
    /// - [`SaddleError::Length`], [`SaddleError::NonFinite`]: bad input; outputs are not changed.
    pub fn solve(
        &mut self,
        f: &[f64],
        gamma: &[f64],
        a: &mut [f64],
        lambda: &mut [f64],
    ) -> Result<(), SaddleError> {
        check_length("lambda", lambda, self.lu.n_rows())?;
        self.motion(f, gamma, a)?;
        self.multipliers(f, a, lambda)
    }

    /// Works like [`Self::solve`], but does not compute λ. The function takes two thirds of the
    /// work.
    ///
    /// # Errors
    /// Returns the same errors as [`KeptRowSaddle::solve`].
    pub fn motion(&mut self, f: &[f64], gamma: &[f64], a: &mut [f64]) -> Result<(), SaddleError> {
        let n = self.lu.n;
        if !self.is_factored {
            return Err(SaddleError::NotFactored);
        }
        check_length("f", f, n)?;
        check_length("gamma", gamma, self.lu.n_rows())?;
        check_length("a", a, n)?;
        check_finite("f", f, 0)?;
        check_finite("gamma", gamma, 0)?;

        // A particular solution, with zeros in the free coordinates.
        self.lu.free.iter().for_each(|&i| a[i] = 0.0);
        self.lu.determine(gamma, a);
        self.force_left(f, a);
        self.free.add(&self.g, a);
        Ok(())
    }

    /// Computes λ from `Cᵀ·λ = f − M·a` with the last factorisation. The given a must solve the
    /// equations. The function does not allocate memory.
    ///
    /// | argument | shape | meaning |
    /// | --- | --- | --- |
    /// | `f` | n | the forces |
    /// | `a` | n | their accelerations; 0 for a force without acceleration, such as a row of the
    /// whole mechanism that depends on the rows of C |
    /// | `lambda` | r | overwritten: multipliers of the rows, zero for skipped rows |
    ///
    /// # Errors
    /// Returns the same errors as [`KeptRowSaddle::solve`].
    pub fn multipliers(
        &mut self,
        f: &[f64],
        a: &[f64],
        lambda: &mut [f64],
    ) -> Result<(), SaddleError> {
        if !self.is_factored {
            return Err(SaddleError::NotFactored);
        }
        check_length("f", f, self.lu.n)?;
        check_length("a", a, self.lu.n)?;
        check_length("lambda", lambda, self.lu.n_rows())?;
        check_finite("f", f, 0)?;
        check_finite("a", a, 0)?;

        self.force_left(f, a);
        lambda.fill(0.0);
        self.lu.solve_for_multipliers(&mut self.g, lambda);
        Ok(())
    }

    /// Computes g = f − M·a.
    fn force_left(&mut self, f: &[f64], a: &[f64]) {
        let (mass, added) = (&self.free.mass, &self.free.added);
        for (((g, f), m), a) in self.g.iter_mut().zip(f).zip(mass).zip(a) {
            *g = f - m * a;
        }
        for (k, (inertia, columns, values)) in added.rows().enumerate() {
            let force = inertia * added.times(k, a);
            for (&j, g) in columns.iter().zip(values) {
                self.g[j] -= g * force;
            }
        }
    }
}
