//! Factorisation: pivoted QR of the rows up to the locked rank, the second orthogonal factor, the reduced mass.

use super::MinimumNormSaddle;
use crate::kernels::{axpy, dot, max_abs};
use crate::qr::{apply, factor_above, reflect};
use crate::saddle::{SaddleError, State, check_equations};
use crate::{Matrix, ldl};

impl MinimumNormSaddle {
    /// Factors for C and the masses; allocates nothing unless it fails. Cost about `2·m·n·r − (m + n)·r²` multiplications for the first QR.
    ///
    /// | argument | shape | meaning |
    /// | --- | --- | --- |
    /// | `c` | m×n | all rows |
    /// | `mass` | n | diagonal of M, entries ≥ 0 |
    ///
    /// After an error the solver holds no factorisation.
    ///
    /// # Errors
    /// - [`SaddleError::Length`], [`SaddleError::NonFinite`], [`SaddleError::NegativeMass`]: bad input.
    /// - [`SaddleError::MasslessMotion`]: M is not positive definite on ker C; carries the motion.
    pub fn factor(&mut self, c: &Matrix, mass: &[f64]) -> Result<(), SaddleError> {
        self.state = State::Empty;
        check_equations(c, mass, (self.factors.nrows(), self.mass.len()))?;
        self.decompose(c);
        for ((scaled, m), d) in self.mass.iter_mut().zip(mass).zip(&self.column_factor) {
            *scaled = d * m * d;
        }
        self.fill_free();
        self.factor_reduced_mass()?;
        self.state = State::Factored;
        Ok(())
    }

    /// Both orthogonal factors and T.
    pub(super) fn decompose(&mut self, c: &Matrix) {
        for (i, d_i) in self.row_factor.iter().enumerate() {
            let scaled = self.factors.row_mut(i).iter_mut();
            for ((x, c_ij), d_j) in scaled.zip(c.row(i)).zip(&self.column_factor) {
                *x = d_i * c_ij * d_j;
            }
        }
        self.rank = factor_above(self.floor, &mut self.factors, &mut self.reflections);
        self.annihilate_rest();
    }

    /// `[R₁ R₂]·H_{r−1}·…·H_0 = [T 0]`: the reflection k turns row k of R into its diagonal entry, from the last row up.
    fn annihilate_rest(&mut self) {
        let (r, m) = (self.rank, self.factors.nrows());
        if r == m || r == 0 {
            return;
        }
        // `v` is [R_kk, R_k,r…] and then β with the tail of the vector.
        let v = &mut self.u[..=m - r];
        for k in 0..r {
            for j in r..m {
                self.z_tail[(k, j)] = self.factors[(j, k)];
            }
        }
        for k in (0..r).rev() {
            v[0] = self.factors[(k, k)];
            v[1..].copy_from_slice(&self.z_tail.row(k)[r..]);
            self.z_tau[k] = reflect(v);
            self.factors[(k, k)] = v[0];
            self.z_tail.row_mut(k)[r..].copy_from_slice(&v[1..]);
            for i in 0..k {
                let rest = &mut self.z_tail.row_mut(i)[r..];
                let s = -self.z_tau[k] * (self.factors[(k, i)] + dot(&v[1..], rest));
                self.factors[(k, i)] += s;
                axpy(s, &v[1..], rest);
            }
        }
    }

    /// `x ← Q·x`.
    pub(super) fn q_mul(&self, x: &mut [f64]) {
        for k in (0..self.rank).rev() {
            apply(
                self.reflections.tau[k],
                &self.factors.row(k)[k..],
                &mut x[k..],
            );
        }
    }

    /// Q₂.
    fn fill_free(&mut self) {
        let mut free = std::mem::take(&mut self.free);
        for c in 0..self.mass.len() - self.rank {
            let vector = free.row_mut(c);
            vector.fill(0.0);
            vector[self.rank + c] = 1.0;
            self.q_mul(vector);
        }
        self.free = free;
    }

    fn factor_reduced_mass(&mut self) -> Result<(), SaddleError> {
        let n = self.mass.len();
        let k = n - self.rank;
        for i in 0..k {
            for j in 0..=i {
                let (x, y) = (self.free.row(i), self.free.row(j));
                let terms = x.iter().zip(y).zip(&self.mass);
                self.reduced_mass[i * k + j] = terms.map(|((x, y), m)| x * m * y).sum();
            }
        }
        // What cancels in the reduced mass, and what rounding of the basis turns from zero into mass.
        let heaviest = max_abs(&self.mass);
        let spurious = (n as f64 * f64::EPSILON).powi(2) * heaviest;
        let cancelled = k as f64 * f64::EPSILON;
        let floor = |_, size: f64| (cancelled * size).max(spurious);
        ldl::factor(&mut self.reduced_mass, k, floor).map_err(|lost| SaddleError::MasslessMotion {
            reduced: lost.left,
            size: lost.size.max(heaviest),
            motion: self.motion(&ldl::direction(&self.reduced_mass, k, lost)),
        })
    }

    /// The motion of these shares of the free vectors, largest entry 1.
    fn motion(&self, shares: &[f64]) -> Vec<f64> {
        let mut motion = vec![0.0; self.mass.len()];
        for (c, share) in shares.iter().enumerate() {
            axpy(*share, self.free.row(c), &mut motion);
        }
        for (x, d) in motion.iter_mut().zip(&self.column_factor) {
            *x *= d;
        }
        let largest = max_abs(&motion);
        for x in &mut motion {
            *x /= largest;
        }
        motion
    }
}
