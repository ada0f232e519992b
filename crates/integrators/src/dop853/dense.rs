//! The solution inside an accepted step: of order 6 (local error O(h⁷)) without and of order 7 (O(h⁸)) with three extra evaluations.
//!
//! Both are the cubic through (y0, f0), (y1, f1) plus terms that vanish with their derivatives at both ends:
//!
//! ```text
//! u(θ) = y0 + θ²(3 − 2θ)·(y1 − y0) + h·θ(1 − θ)²·f0 − h·θ²(1 − θ)·f1 + h·θ²(1 − θ)²·Σ_r p_r(θ)·Σ_i d_ri k_i
//! p = 1, θ, θ(1 − θ), θ²(1 − θ)
//! ```
//!
//! so that they pass through the projected states with their own derivatives; k_13 is f1.
//!
//! **Order 7.** All four rows, stages 14 to 16 at θ = 1/10, 1/5, 7/9: Hairer, Nørsett, Wanner I, 2nd ed., II.6.
//!
//! **Order 6.** Thirteen stages have room for it: the 37 conditions of order ≤ 6 have rank 12, so that for each power of θ there is a
//! solution and one free direction n. Weights Σ θ^m·x_m that satisfy the conditions and b(1) = b, b'(0) = e_1, b'(1) = e_13 need
//! multiples θ²(α + β·θ)·n of that direction, and α, β are determined. The table was solved for in 40 digits; degree 6, three rows.

use super::Stages;
use super::tableau::{A, C, D, FREE, STAGES};
use crate::combine::combine;
use crate::drive::evaluate;
use crate::error::Cause;
use crate::method::{Dense, Ends};
use crate::ode::Ode;

impl<O: Ode> Dense<O> for Stages {
    fn interpolate(&self, ends: &Ends<'_>, theta: f64, out: &mut [f64]) {
        self.evaluate_polynomial(&FREE, ends, theta, out);
    }

    fn prepare(
        &mut self,
        ode: &mut O,
        ends: &Ends<'_>,
        evaluations: &mut u64,
    ) -> Result<(), Cause<O::Error>> {
        let (h, y0, k1, k13) = (ends.trial.h, ends.y0, ends.f0, ends.f1);
        let [_, _, _, _, k6, k7, k8, k9, k10, k11, k12] = &self.k;
        let [k14, k15, k16] = &mut self.extra;
        let y = &mut self.y[..];
        let mut stage = |s: usize, y: &[f64], k: &mut [f64]| {
            evaluate(ode, ends.trial.stage_time(C[s]), y, k, evaluations)
        };
        let a = A[13];
        combine(
            y,
            y0,
            h,
            [
                (a[0], k1),
                (a[6], k7),
                (a[7], k8),
                (a[8], k9),
                (a[9], k10),
                (a[10], k11),
                (a[11], k12),
                (a[12], k13),
            ],
        );
        stage(13, y, k14)?;
        let a = A[14];
        combine(
            y,
            y0,
            h,
            [
                (a[0], k1),
                (a[5], k6),
                (a[6], k7),
                (a[7], k8),
                (a[10], k11),
                (a[11], k12),
                (a[12], k13),
                (a[13], k14),
            ],
        );
        stage(14, y, k15)?;
        let a = A[15];
        combine(
            y,
            y0,
            h,
            [
                (a[0], k1),
                (a[5], k6),
                (a[6], k7),
                (a[7], k8),
                (a[8], k9),
                (a[12], k13),
                (a[13], k14),
                (a[14], k15),
            ],
        );
        stage(15, y, k16)
    }

    fn interpolate_accurately(&self, ends: &Ends<'_>, theta: f64, out: &mut [f64]) {
        self.evaluate_polynomial(&D, ends, theta, out);
    }
}

impl Stages {
    fn evaluate_polynomial<const R: usize>(
        &self,
        rows: &[[f64; STAGES]; R],
        ends: &Ends<'_>,
        theta: f64,
        out: &mut [f64],
    ) {
        let w = weights(rows, theta);
        let [_, _, _, _, k6, k7, k8, k9, k10, k11, k12] = &self.k;
        let [k14, k15, k16] = &self.extra;
        let k: [&[f64]; 12] = [
            ends.f0, k6, k7, k8, k9, k10, k11, k12, ends.f1, k14, k15, k16,
        ];
        let h = ends.trial.h;
        for i in 0..out.len() {
            let mut sum = w.stages[0] * k[0][i];
            for (w, k) in w.stages[5..].iter().zip(&k[1..]) {
                sum += w * k[i];
            }
            out[i] = ends.y0[i] + (w.delta * (ends.y1[i] - ends.y0[i]) + h * sum);
        }
    }
}

/// Weights of u(θ) − y0 in terms of the difference of the states and of the stages.
#[derive(Debug, Clone, Copy)]
pub(super) struct Weights {
    pub(super) delta: f64,
    /// Zero for stages 2 to 5.
    pub(super) stages: [f64; STAGES],
}

/// The polynomial with the first rows of the products p_r.
pub(super) fn weights<const R: usize>(rows: &[[f64; STAGES]; R], theta: f64) -> Weights {
    let rest = 1.0 - theta;
    let products = [1.0, theta, theta * rest, theta * theta * rest];
    let inner = theta * theta * rest * rest;
    let mut stages = [0.0; STAGES];
    for (row, product) in rows.iter().zip(products) {
        for (w, d) in stages.iter_mut().zip(row) {
            *w += inner * product * d;
        }
    }
    stages[0] += theta * rest * rest;
    stages[12] -= theta * theta * rest;
    Weights {
        delta: theta * theta * (3.0 - 2.0 * theta),
        stages,
    }
}
