//! Solution with the factors, and correction of its rounding.

use super::{Factors, SchurSaddle, Work};
use crate::kernels::all_finite;
use crate::limits::{SCHUR_CORRECTIONS, SCHUR_ENOUGH, SCHUR_POOR, SCHUR_PROGRESS, SCHUR_ROUNDING};
use crate::{SaddleError, SparseMatrix};

impl SchurSaddle {
    /// Solves `M·a + Cᵀ·λ = f`, `C·a = γ` with the rows of the last factorisation. Rows that are
    /// not satisfied to rounding are corrected with the same factors until they are, or until
    /// nothing is gained; skipped rows are ignored.
    ///
    /// | argument | shape | meaning |
    /// | --- | --- | --- |
    /// | `c` | r × n | as in the factorisation |
    /// | `f`, `gamma` | n, r | right-hand sides |
    /// | `a`, `lambda` | n, r | overwritten |
    ///
    /// # Errors
    /// - [`SaddleError::NotFactored`], [`SaddleError::Length`], [`SaddleError::NonFinite`].
    /// - [`SaddleError::Unrefined`]: the residual of a row stays above 1e-9 of its terms in spite
    ///   of corrections.
    pub fn solve(
        &mut self,
        c: &SparseMatrix,
        f: &[f64],
        gamma: &[f64],
        a: &mut [f64],
        lambda: &mut [f64],
    ) -> Result<(), SaddleError> {
        self.check(
            c,
            [("f", f.len()), ("a", a.len())],
            [("gamma", gamma.len()), ("lambda", lambda.len())],
        )?;
        for ((free, f), inverse) in self
            .work
            .free
            .iter_mut()
            .zip(f)
            .zip(&self.factors.inverse_mass)
        {
            *free = f * inverse;
        }
        a.copy_from_slice(&self.work.free);
        for (all, free) in self.work.all.iter_mut().zip(&self.work.free) {
            *all = free.abs();
        }
        lambda.fill(0.0);
        self.take_residual(c, gamma, a);
        if !all_finite(&self.work.x) {
            return Err(first_non_finite([("f", f), ("gamma", gamma)]));
        }
        self.substitute();
        self.add_solution(c, a, lambda);
        let mut before = f64::INFINITY;
        for round in 1..=SCHUR_CORRECTIONS {
            let Misfit { of_motion, of_all } = self.take_misfit(c, gamma, a);
            // Where large multipliers balance each other, a correction leaves their rounding.
            if of_motion <= SCHUR_ENOUGH || round > 1 && of_all <= SCHUR_ROUNDING {
                return Ok(());
            }
            if !of_motion.is_finite() {
                return Err(first_non_finite([("f", f), ("gamma", gamma)]));
            }
            // The first round computes the solution, for which there is no earlier residual.
            if round > 1 && of_motion > SCHUR_PROGRESS * before || round == SCHUR_CORRECTIONS {
                if of_motion.min(before) <= SCHUR_POOR || of_all <= SCHUR_POOR {
                    return Ok(());
                }
                return Err(SaddleError::Unrefined {
                    rounds: round,
                    change: of_motion,
                });
            }
            before = of_motion;
            self.substitute();
            self.add_solution(c, a, lambda);
        }
        Ok(())
    }

    /// The λ that minimises `‖Cᵀ·λ − (f − M·a)‖` in the metric of the inverse masses, for a known
    /// motion a; not corrected.
    ///
    /// # Errors
    /// As [`SchurSaddle::solve`].
    pub fn multipliers(
        &mut self,
        c: &SparseMatrix,
        f: &[f64],
        a: &[f64],
        lambda: &mut [f64],
    ) -> Result<(), SaddleError> {
        self.check(
            c,
            [("f", f.len()), ("a", a.len())],
            [("lambda", lambda.len()), ("lambda", lambda.len())],
        )?;
        for (k, free) in self.work.free.iter_mut().enumerate() {
            *free = f[k] * self.factors.inverse_mass[k] - a[k];
        }
        for (place, x) in self.work.x.iter_mut().enumerate() {
            let terms = self.structure.rows.entries_at(place, c.values());
            *x = terms.map(|(j, c)| c * self.work.free[j]).sum();
        }
        self.substitute();
        for (x, &row) in self.work.x.iter().zip(&self.structure.rows.row) {
            lambda[row] = *x;
        }
        if all_finite(lambda) {
            Ok(())
        } else {
            Err(first_non_finite([("f", f), ("a", a)]))
        }
    }

    fn check(
        &self,
        c: &SparseMatrix,
        of_n: [(&'static str, usize); 2],
        of_r: [(&'static str, usize); 2],
    ) -> Result<(), SaddleError> {
        if !self.is_factored {
            return Err(SaddleError::NotFactored);
        }
        self.check_shape(c)?;
        let (n, r) = (self.factors.inverse_mass.len(), self.factors.inverse.len());
        let lengths = of_n.map(|a| (a, n)).into_iter().chain(of_r.map(|a| (a, r)));
        match lengths
            .into_iter()
            .find(|((_, found), expected)| found != expected)
        {
            Some(((argument, found), expected)) => Err(SaddleError::Length {
                argument,
                found,
                expected,
            }),
            None => Ok(()),
        }
    }

    /// Writes `C·a − γ` of the rows in use to x, in the order of elimination.
    fn take_residual(&mut self, c: &SparseMatrix, gamma: &[f64], a: &[f64]) {
        let s = &self.structure.rows;
        let places = self.work.x.iter_mut().zip(&self.factors.inverse);
        for (place, ((x, &inverse), &row)) in places.zip(&s.row).enumerate() {
            *x = match inverse {
                0.0 => 0.0,
                _ => s
                    .entries_at(place, c.values())
                    .fold(-gamma[row], |sum, (j, c)| sum + c * a[j]),
            };
        }
    }

    /// Also returns the largest residuals relative to their terms.
    fn take_misfit(&mut self, c: &SparseMatrix, gamma: &[f64], a: &[f64]) -> Misfit {
        let Work {
            x,
            terms,
            all,
            free,
            ..
        } = &mut self.work;
        for ((terms, free), a) in terms.iter_mut().zip(free).zip(a) {
            *terms = free.abs().max(a.abs());
        }
        let mut largest = Misfit {
            of_motion: 0.0,
            of_all: 0.0,
        };
        let s = &self.structure.rows;
        let places = x.iter_mut().zip(&self.factors.inverse);
        for (place, ((x, &inverse), &row)) in places.zip(&s.row).enumerate() {
            if inverse == 0.0 {
                *x = 0.0;
                continue;
            }
            let (mut sum, mut size, mut of_all) = (-gamma[row], gamma[row].abs(), gamma[row].abs());
            for (j, c) in s.entries_at(place, c.values()) {
                sum += c * a[j];
                size += c.abs() * terms[j];
                of_all += c.abs() * all[j];
            }
            *x = sum;
            if sum == 0.0 {
                continue;
            }
            for (largest, size) in [
                (&mut largest.of_motion, size),
                (&mut largest.of_all, of_all),
            ] {
                let share = sum.abs() / size;
                if share > *largest || share.is_nan() {
                    *largest = share;
                }
            }
        }
        largest
    }

    /// Adds the multipliers in x and their effect on the motion; accumulates the sizes of the
    /// terms.
    fn add_solution(&mut self, c: &SparseMatrix, a: &mut [f64], lambda: &mut [f64]) {
        let s = &self.structure.rows;
        for (place, (&x, &row)) in self.work.x.iter().zip(&s.row).enumerate() {
            if x == 0.0 {
                continue;
            }
            lambda[row] += x;
            for (j, c) in s.entries_at(place, c.values()) {
                let term = c * x * self.factors.inverse_mass[j];
                a[j] -= term;
                self.work.all[j] += term.abs();
            }
        }
    }

    /// `x ← S⁻¹·x` in the order of elimination.
    fn substitute(&mut self) {
        let s = &self.structure;
        let Factors { l, inverse, .. } = &self.factors;
        let Work { x, local, .. } = &mut self.work;
        for front in &s.fronts {
            let (p, later) = (front.pivots.clone(), &s.later[front.rest.clone()]);
            let local = &mut local[..front.order()];
            let (own, rest) = local.split_at_mut(p.len());
            own.copy_from_slice(&x[p.clone()]);
            rest.fill(0.0);
            let mut at = front.l;
            for k in 0..own.len() {
                let value = own[k];
                let (inside, outside) =
                    l[at..at + own.len() - 1 - k + rest.len()].split_at(own.len() - 1 - k);
                at += inside.len() + outside.len();
                if value == 0.0 {
                    continue;
                }
                own[k + 1..]
                    .iter_mut()
                    .zip(inside)
                    .for_each(|(x, l)| *x -= l * value);
                rest.iter_mut()
                    .zip(outside)
                    .for_each(|(x, l)| *x += l * value);
            }
            x[p].copy_from_slice(own);
            for (&j, r) in later.iter().zip(&*rest) {
                x[j as usize] -= r;
            }
        }
        x.iter_mut().zip(inverse).for_each(|(x, d)| *x *= d);
        for front in s.fronts.iter().rev() {
            let (p, later) = (front.pivots.clone(), &s.later[front.rest.clone()]);
            if p.is_empty() {
                continue;
            }
            let local = &mut local[..front.order()];
            let (own, rest) = local.split_at_mut(p.len());
            own.copy_from_slice(&x[p.clone()]);
            for (r, &j) in rest.iter_mut().zip(later) {
                *r = x[j as usize];
            }
            let mut end = front.l
                + (0..p.len())
                    .map(|k| p.len() + rest.len() - 1 - k)
                    .sum::<usize>();
            for k in (0..own.len()).rev() {
                let n = own.len() - 1 - k + rest.len();
                let column = &l[end - n..end];
                end -= n;
                let (inside, outside) = column.split_at(own.len() - 1 - k);
                let inner: f64 = own[k + 1..].iter().zip(inside).map(|(x, l)| x * l).sum();
                own[k] -= inner + crate::kernels::dot(outside, rest);
            }
            x[p].copy_from_slice(own);
        }
    }
}

/// Largest residuals of rows relative to their terms.
struct Misfit {
    /// The larger of the accelerations and those of free bodies.
    of_motion: f64,
    /// All terms that were added: if multipliers balance each other, accelerations are only their
    /// rounding.
    of_all: f64,
}

fn first_non_finite(arguments: [(&'static str, &[f64]); 2]) -> SaddleError {
    let of = |(argument, values): (&'static str, &[f64])| {
        let index = values.iter().position(|x| !x.is_finite())?;
        Some((argument, index, values[index]))
    };
    let (argument, index, value) =
        arguments
            .into_iter()
            .find_map(of)
            .unwrap_or(("solution", 0, f64::INFINITY));
    SaddleError::NonFinite {
        argument,
        index,
        value,
    }
}
