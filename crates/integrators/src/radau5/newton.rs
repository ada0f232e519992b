//! Simplified Newton iterations for the stages.
//!
//! `z = h·(A⊗I)·f(y0 + z)` is multiplied by A⁻¹/h and transformed by w = T⁻¹·z:
//!
//! ```text
//! (u₁/h·I − J)·Δw₁ = (T⁻¹·f)₁ − u₁/h·w₁
//! ((α + iβ)/h·I − J)·(Δw₂ + iΔw₃) = (T⁻¹·f)₂ + i(T⁻¹·f)₃ − (α + iβ)/h·(w₂ + iw₃)
//! ```
//!
//! The module `convergence` contains the stopping criterion.

use super::Radau5Stages;
use super::scale::set_scale;
use super::tableau::{C, COMPLEX, REAL, T, T_INVERSE, lagrange};
use crate::control::weighted_square_sum;
use crate::convergence::Verdict;
use crate::error::Cause;
use crate::implicit::Implicit;
use crate::method::{Start, Trial};
use crate::ode::{evaluate, finite};
use crate::statistics::Statistics;

/// Iterations stop if their increments are below this many units of rounding of the state.
const ROUNDING: f64 = 10.0 * f64::EPSILON;
impl Radau5Stages {
    /// Computes starting values from the extrapolated collocation polynomial of the last step. The
    /// starting values are zero if there is no last step.
    pub(super) fn predict(&mut self, h: f64) {
        let Some(h_before) = self.before.h else {
            for v in self.z.iter_mut().chain(&mut self.newton.w) {
                v.fill(0.0);
            }
            return;
        };
        // The differences are u(1 + c·h/h_before) − u(1).
        let weights = C.map(|c| {
            let mut l = lagrange(1.0 + c * h / h_before);
            l[2] -= 1.0;
            l
        });
        combine(&weights, &self.before.z, &mut self.z);
        combine(&T_INVERSE, &self.z, &mut self.newton.w);
    }

    /// Iterates until `z` has the accuracy that the tolerance requires, or until the iteration
    /// fails. An error of f at a stage is an error of the trial.
    pub(super) fn solve_stages<O: Implicit>(
        &mut self,
        ode: &mut O,
        trial: &Trial<'_>,
        start: &Start<'_>,
        statistics: &mut Statistics,
    ) -> Result<Verdict, Cause<O::Error>> {
        self.newton.convergence = self.newton.convergence.next();
        loop {
            statistics.newton_iterations += 1;
            self.increment(ode, trial, start.y0, statistics)?;
            for (w, dw) in self.newton.w.iter_mut().zip(&self.newton.k) {
                for (w, dw) in w.iter_mut().zip(dw) {
                    *w += dw;
                }
            }
            combine(&T, &self.newton.w, &mut self.z);
            let (norm, permitted) = self.increment_norm(start);
            let verdict = self.newton.convergence.judge(norm, permitted);
            if verdict != Verdict::GoOn {
                return Ok(verdict);
            }
        }
    }

    /// Writes Δw at the current values z and w to `k`.
    fn increment<O: Implicit>(
        &mut self,
        ode: &mut O,
        trial: &Trial<'_>,
        y0: &[f64],
        statistics: &mut Statistics,
    ) -> Result<(), Cause<O::Error>> {
        for ((z, k), c) in self.z.iter().zip(&mut self.newton.k).zip(C) {
            for ((y, y0), z) in self.y.iter_mut().zip(y0).zip(z) {
                *y = y0 + z;
            }
            evaluate(
                ode,
                trial.stage_time(c),
                &self.y,
                k,
                &mut statistics.evaluations,
            )?;
        }
        let (real, [re, im]) = (REAL / trial.h, COMPLEX.map(|x| x / trial.h));
        let ([k1, k2, k3], [w1, w2, w3]) = (self.newton.k.each_mut(), self.newton.w.each_ref());
        for i in 0..y0.len() {
            let f = [k1[i], k2[i], k3[i]];
            let [f1, f2, f3] = T_INVERSE.map(|row| dot(&row, &f));
            k1[i] = f1 - real * w1[i];
            k2[i] = f2 - (re * w2[i] - im * w3[i]);
            k3[i] = f3 - (re * w3[i] + im * w2[i]);
        }
        statistics.solves += 1;
        ode.solve(k1);
        ode.solve_complex(k2, k3);
        finite(k1)
            .and(finite(k2))
            .and(finite(k3))
            .map_err(|component| Cause::NonFinite { component })
    }

    /// Returns the weighted norm of the last increments, and the largest norm that is permitted at
    /// the end. The weights contain the current end of the step.
    fn increment_norm(&mut self, start: &Start<'_>) -> (f64, f64) {
        for ((y, y0), z) in self.y.iter_mut().zip(start.y0).zip(&self.z[2]) {
            *y = y0 + z;
        }
        let permitted = set_scale(start.tolerance, start.y0, &self.y, &mut self.scale);
        for ((scale, y0), y1) in self.scale.iter_mut().zip(start.y0).zip(&self.y) {
            *scale = scale.max(ROUNDING / permitted * y0.abs().max(y1.abs()));
        }
        let sum: f64 = self
            .newton
            .k
            .iter()
            .map(|dw| weighted_square_sum(dw, &self.scale))
            .sum();
        let norm = (sum / (3 * start.y0.len()).max(1) as f64).sqrt();
        (norm, permitted)
    }
}

/// Computes `out_i = Σ_j weights_ij·v_j`, component by component.
fn combine(weights: &[[f64; 3]; 3], v: &[Vec<f64>; 3], out: &mut [Vec<f64>; 3]) {
    for component in 0..v[0].len() {
        let x = [v[0][component], v[1][component], v[2][component]];
        for (out, row) in out.iter_mut().zip(weights) {
            out[component] = dot(row, &x);
        }
    }
}

pub(super) fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
