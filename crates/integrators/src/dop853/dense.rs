//! The solution within an accepted step. The dense output has order 6 (local error O(h⁷)) without
//! extra evaluations, and order 8 (O(h⁹), like the step) with six extra evaluations.
//!
//! Both outputs are the cubic through (y0, f0), (y1, f1) plus terms that vanish at both ends
//! together with their derivatives:
//!
//! ```text
//! u(θ) = y0 + θ²(3 − 2θ)·(y1 − y0) + h·θ(1 − θ)²·f0 − h·θ²(1 − θ)·f1 + h·θ²(1 − θ)²·Σ_r p_r(θ)·Σ_i d_ri k_i
//! p = 1, θ, θ(1 − θ), θ²(1 − θ), θ²(1 − θ)²
//! ```
//!
//! Therefore both outputs interpolate the projected states and the derivatives at these states. The
//! stage k_13 is f1.
//!
//! **Order 6.** Thirteen stages are sufficient. The 37 conditions of order ≤ 6 have rank 12, so the
//! conditions for each power of θ have a solution x_m and one free direction n. A multiple θ²(α +
//! β·θ)·n of this direction is added to the weights Σ θ^m·x_m. The end conditions b(1) = b, b'(0) =
//! e_1, b'(1) = e_13 determine α and β. The output has degree 6, and its table has three rows,
//! computed with 40 digits.
//!
//! **Order 8.** A combination of stages is called clean if Σ w_i k_i = Σ w_i y'(t0 + c_i h) +
//! O(h⁸). A polynomial of degree 8 through y0 needs eight independent clean combinations. Thirteen
//! stages have only three clean combinations: k_1, k_13 and the step Σ b_i k_i. Bootstrapping (see
//! `rk5::dense`) from Hairer, Nørsett and Wanner's output of order 7 would take eight evaluations:
//! the three extra stages of this output, which are not clean, and five clean stages. Six
//! evaluations are enough:
//!
//! - Stages 14, 15, 16 have order 6. The arguments of these stages are y(t0 + c_i h) + h⁷·δ_i +
//!   O(h⁸). Apart from combinations of earlier stages, all these δ lie in a space of four
//!   dimensions. The conditions leave one free direction for stage 14, two for stage 15 and three
//!   for stage 16. Along these directions, δ can be changed. The free directions of stages 15 and
//!   16 are used to make δ_15 and δ_16 multiples of δ_14, so that three stages give two clean
//!   combinations. For stage 15 this is possible only if `∫ θ²(1 − θ)²(θ − c_14)²(θ − c_15) dθ = 0`
//!   (from 0 to 1).
//! - The sixteen stages determine weights of order 7 for each θ. Stages 17, 18, 19 use these
//!   weights and are clean.
//! - The eight clean combinations determine the weights of order 8 for each θ. The output has
//!   degree 8, and its table has five rows.
//!
//! Five evaluations would need a clean stage 14, and thirteen stages are not sufficient for such a
//! stage. The free parameters are c_14, c_16 to c_19 and one weight of stage 14. The free
//! parameters were optimised with two goals. First, the error coefficients of order 9 within the
//! step do not exceed the error coefficients of the method at the end of the step. Second, the
//! weights are small: Σ|b_i(θ)| exceeds its value at the end, 12.91, by less than 0.1 %, and
//! Σ|a_ij| < 8 in the extra stages (the method itself has values up to 95). The module
//! `order_conditions` asserts these properties. The tables were computed with 40 digits from the
//! rounded table of the method.

use super::Dop853Stages;
use super::tableau::{A, C, D, FREE, STAGES, STEP_STAGES};
use crate::error::Cause;
use crate::method::{Dense, Ends};
use crate::ode::{Ode, evaluate};

impl<O: Ode> Dense<O> for Dop853Stages {
    fn interpolate(&self, ends: &Ends<'_>, theta: f64, out: &mut [f64]) {
        self.evaluate_polynomial(&weights(&FREE, theta), ends, out);
    }

    fn prepare(
        &mut self,
        ode: &mut O,
        ends: &Ends<'_>,
        evaluations: &mut u64,
    ) -> Result<(), Cause<O::Error>> {
        let h = ends.trial.h;
        for s in STEP_STAGES..STAGES {
            let (known, next) = self.extra.split_at_mut(s - STEP_STAGES);
            slopes(&A[s], ends, &self.k, known, &mut self.y);
            for (y, y0) in self.y.iter_mut().zip(ends.y0) {
                *y = y0 + h * *y;
            }
            let t = ends.trial.stage_time(C[s]);
            evaluate(ode, t, &self.y, &mut next[0], evaluations)?;
        }
        Ok(())
    }

    fn interpolate_accurately(&self, ends: &Ends<'_>, theta: f64, out: &mut [f64]) {
        self.evaluate_polynomial(&weights(&D, theta), ends, out);
    }
}

impl Dop853Stages {
    fn evaluate_polynomial<const S: usize>(
        &self,
        w: &Weights<S>,
        ends: &Ends<'_>,
        out: &mut [f64],
    ) {
        let h = ends.trial.h;
        let extra = &self.extra[..S - STEP_STAGES];
        slopes(&w.stages, ends, &self.k, extra, out);
        for ((out, y0), y1) in out.iter_mut().zip(ends.y0).zip(ends.y1) {
            *out = y0 + (w.delta * (y1 - y0) + h * *out);
        }
    }
}

/// Writes Σ w_j k_j, stage by stage. Stages 2 to 5 have no weight. Stages after `extra` are not
/// read.
fn slopes(w: &[f64], ends: &Ends<'_>, k: &[Vec<f64>; 11], extra: &[Vec<f64>], out: &mut [f64]) {
    for (out, k) in out.iter_mut().zip(ends.f0) {
        *out = w[0] * k;
    }
    let stages = k[4..].iter().map(Vec::as_slice).chain([ends.f1]);
    let stages = stages.chain(extra.iter().map(Vec::as_slice));
    for (w, k) in w[5..].iter().zip(stages) {
        for (out, k) in out.iter_mut().zip(k) {
            *out += w * k;
        }
    }
}

/// Weights of u(θ) − y0 in terms of the difference of the states and of the stages.
#[derive(Debug, Clone, Copy)]
pub(super) struct Weights<const S: usize> {
    pub(super) delta: f64,
    /// Weights of the stages, zero for stages 2 to 5.
    pub(super) stages: [f64; S],
}

/// Computes the weights at θ from the table. Row r is multiplied by θ²(1 − θ)²·p_r(θ).
pub(super) fn weights<const R: usize, const S: usize>(
    rows: &[[f64; S]; R],
    theta: f64,
) -> Weights<S> {
    let rest = 1.0 - theta;
    let inner = theta * theta * rest * rest;
    let products = [1.0, theta, theta * rest, theta * theta * rest, inner];
    let mut stages = [0.0; S];
    for (row, product) in rows.iter().zip(products) {
        for (w, d) in stages.iter_mut().zip(row) {
            *w += inner * product * d;
        }
    }
    stages[0] += theta * rest * rest;
    stages[STEP_STAGES - 1] -= theta * theta * rest;
    Weights {
        delta: theta * theta * (3.0 - 2.0 * theta),
        stages,
    }
}
