//! The motions that the rows leave free: a basis N of their null space and the reduced mass
//! `Nᵀ·M·N`, with a Cholesky factorisation without square roots.

use super::error::SaddleError;
use super::lu::TallLu;
use crate::kernels::{axpy, dot, max_abs};

/// Null space basis, masses, and factors of the reduced mass of k = n − r free motions.
#[derive(Debug, Clone)]
pub(super) struct FreeMotions {
    /// Row c: `−L₁⁻ᵀ·L₂ᵀ·e_c`, the dependent part of the null vector c. k×r, row-major.
    basis: Vec<f64>,
    /// diag(M) in the order of P.
    pub(super) mass: Vec<f64>,
    /// Scratch: a row of the basis times its masses, r values.
    weighted: Vec<f64>,
    /// L·D·Lᵀ of NᵀMN: unit lower L with D on the diagonal. k×k, row-major.
    reduced_mass: Vec<f64>,
    /// Smallest fraction of a diagonal entry of NᵀMN that remained after elimination, infinite for
    /// k = 0.
    pub(super) mass_ratio: f64,
}

impl FreeMotions {
    /// Allocates storage for n coordinates and at most this number of rows.
    pub(super) fn new(n: usize, rows: usize) -> Self {
        // Skipped rows become free motions; this is the largest k·r.
        let most = (0..=rows).map(|r| (n - r) * r).max().unwrap_or(0);
        Self {
            basis: vec![0.0; most],
            mass: vec![0.0; n],
            weighted: vec![0.0; rows],
            reduced_mass: vec![0.0; n * n],
            mass_ratio: f64::INFINITY,
        }
    }

    /// The dependent part of the null vector c.
    pub(super) fn dependent(&self, r: usize, c: usize) -> &[f64] {
        &self.basis[c * r..(c + 1) * r]
    }

    /// Basis and factors for these rows and masses.
    pub(super) fn factor<'c>(
        &mut self,
        lu: &TallLu,
        row: impl Fn(usize) -> &'c [f64],
        mass: &[f64],
    ) -> Result<(), SaddleError> {
        for (m, &coordinate) in self.mass.iter_mut().zip(&lu.permutation) {
            *m = mass[coordinate];
        }
        self.fill_basis(lu);
        self.factor_reduced_mass(lu, row)
    }

    /// Solves `L₁ᵀ·Y = −L₂ᵀ` column by column.
    fn fill_basis(&mut self, lu: &TallLu) {
        let (n, r) = (lu.n, lu.r);
        if r == 0 {
            return;
        }
        for (c, y) in self.basis[..(n - r) * r].chunks_exact_mut(r).enumerate() {
            for t in (0..r).rev() {
                let l_t = lu.row(t);
                y[t] = -l_t[r + c] - dot(&l_t[t + 1..r], &y[t + 1..r]);
            }
        }
    }

    /// Cholesky factorisation of `NᵀMN` without roots, L·D·Lᵀ.
    fn factor_reduced_mass<'c>(
        &mut self,
        lu: &TallLu,
        row: impl Fn(usize) -> &'c [f64],
    ) -> Result<(), SaddleError> {
        let (n, r) = (lu.n, lu.r);
        let k = n - r;
        let heaviest = max_abs(&self.mass);
        // Relative rounding due to cancellation in NᵀMN, and to rounding of N, which is exact in
        // the free coordinates and may change a zero into a mass.
        let cancelled = k as f64 * f64::EPSILON;
        let spurious = (n as f64 * f64::EPSILON).powi(2) * max_abs(&self.mass[..r]);
        self.mass_ratio = f64::INFINITY;
        for i in 0..k {
            let y_i = &self.basis[i * r..(i + 1) * r];
            for ((w, y), m) in self.weighted.iter_mut().zip(y_i).zip(&self.mass) {
                *w = y * m;
            }
            let (above, rest) = self.reduced_mass.split_at_mut(i * k);
            let l_i = &mut rest[..k];
            for j in 0..=i {
                let y_j = &self.basis[j * r..(j + 1) * r];
                l_i[j] = self.weighted.iter().zip(y_j).map(|(a, b)| a * b).sum();
            }
            l_i[i] += self.mass[r + i];
            let size = l_i[i];
            // First v_j = l_ij·d_j, then l_ij: L has a unit diagonal, and d is stored in its place.
            for j in 0..i {
                l_i[j] -= dot(&l_i[..j], &above[j * k..j * k + j]);
            }
            let mut reduced = size;
            for j in 0..i {
                let v_j = l_i[j];
                l_i[j] /= above[j * k + j];
                reduced -= v_j * l_i[j];
            }
            let floor =
                |share: f64| (cancelled * size).max(spurious * (share * share + dot(y_i, y_i)));
            let is_lost = reduced <= floor(1.0) && {
                // Rounding of a null vector is relative to the entries of its coordinate in the
                // rows.
                let rows = lu.used().iter().map(|&j| row(j));
                let share = |c: &[f64]| c[lu.permutation[r + i]].abs() / max_abs(c);
                reduced <= floor(rows.map(share).fold(0.0, f64::max))
            };
            if reduced.is_nan() || is_lost {
                return Err(SaddleError::MasslessMotion {
                    reduced,
                    size: size.max(heaviest),
                    motion: self.massless_motion(lu, i),
                });
            }
            self.mass_ratio = self.mass_ratio.min(reduced / size);
            l_i[i] = reduced;
        }
        Ok(())
    }

    /// The motion `N·z` with `z = [−L₁₁⁻ᵀ·l_i; 1; 0]` that belongs to the failed pivot i.
    fn massless_motion(&self, lu: &TallLu, i: usize) -> Vec<f64> {
        let (n, r) = (lu.n, lu.r);
        let k = n - r;
        let mut z = vec![0.0; k];
        z[i] = 1.0;
        for j in 0..i {
            z[j] = -self.reduced_mass[i * k + j];
        }
        for j in (0..i).rev() {
            let z_j = z[j];
            axpy(-z_j, &self.reduced_mass[j * k..j * k + j], &mut z[..j]);
        }
        let mut y = vec![0.0; n];
        for (c, &z_c) in z.iter().enumerate() {
            axpy(z_c, self.dependent(r, c), &mut y[..r]);
            y[r + c] = z_c;
        }
        let largest = max_abs(&y);
        let mut motion = vec![0.0; n];
        for (&coordinate, y_i) in lu.permutation.iter().zip(&y) {
            motion[coordinate] = y_i / largest;
        }
        motion
    }

    /// y ← y + P·N·z with `(NᵀMN)·z = Nᵀ·g`; r is the number of rows.
    pub(super) fn add(&self, r: usize, g: &[f64], y: &mut [f64]) {
        let k = y.len() - r;
        let (y, z) = y.split_at_mut(r);
        for c in 0..k {
            let l_c = &self.reduced_mass[c * k..(c + 1) * k];
            let n_c_g = dot(self.dependent(r, c), &g[..r]) + g[r + c];
            z[c] = n_c_g - dot(&l_c[..c], &z[..c]);
        }
        for c in 0..k {
            z[c] /= self.reduced_mass[c * k + c];
        }
        for c in (0..k).rev() {
            let z_c = z[c];
            axpy(-z_c, &self.reduced_mass[c * k..c * k + c], &mut z[..c]);
            axpy(z_c, self.dependent(r, c), y);
        }
    }
}
