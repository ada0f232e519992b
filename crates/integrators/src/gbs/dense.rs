//! The solution inside an accepted step: a polynomial through both ends and derivatives at the middle.
//!
//! With u = 2θ − 1 the change of the state since the start of the step is
//!
//! ```text
//! P(u) = Σ_{κ ≤ μ} c_κ·u^κ + u^(μ+1)·(b_0 + b_1·u + b_2·u² + b_3·u³),   c_κ = (h/2)^κ·y^(κ)/κ! at the middle,
//! ```
//!
//! with b from P(−1) = 0, P(1) = y1 − y0, 2·P'(−1) = h·f0, 2·P'(1) = h·f1 (the projected states with their own derivatives). The
//! derivatives at the middle are extrapolated from central differences of f in each column:
//! `h^κ·y^(κ) ≈ h·(n_j/2)^m·Σ_i (−1)^i·binomial(m, i)·f_{n_j/2 + m − 2i}`, m = κ − 1, in the columns with n_j/2 > m.
//! After column k the accurate output uses μ = 2k − 1 and has the local order 2k + 1, like the step; the output that costs
//! nothing has μ = 1.
//!
//! The steps of this method are long, and in a long step the polynomial may be much less accurate than the end of the step (by
//! four digits on the Arenstorf orbit). So the accurate output compares its derivative with f in two places, and where the step's
//! tolerance is not met, it crosses the step again in 2 to 16 pieces, each with a polynomial of its own. ODEX shortens all steps
//! instead; here a run without output costs nothing more.
//!
//! Source: HNW I, II.9, "Dense output for the GBS method" (E. Hairer, A. Ostermann, Numer. Math. 58 (1990) 419–439).

use super::sequence::{COLUMNS, substeps, weights};
use super::{Column, Extrapolation};
use crate::control::weighted_rms;
use crate::drive::evaluate;
use crate::error::Cause;
use crate::method::{Dense, Ends, Trial};
use crate::ode::Ode;

/// Coefficients of the longest polynomial: μ + 5.
const COEFFICIENTS: usize = 2 * COLUMNS + 4;

/// P for one component, ascending.
pub(super) type Polynomial = [f64; COEFFICIENTS];

/// No change.
pub(super) const ZERO: Polynomial = [0.0; COEFFICIENTS];

/// Places at which the first polynomial is compared with f, and their distance to the nearer end.
const CHECKS: [f64; 2] = [0.1, 0.9];
const DISTANCE: f64 = 0.1;
/// Most pieces into which a step is cut for output.
pub(super) const PIECES: usize = 16;

impl<O: Ode> Dense<O> for Extrapolation {
    fn interpolate(&self, ends: &Ends<'_>, theta: f64, out: &mut [f64]) {
        for i in 0..out.len() {
            let mut p = ZERO;
            p[0] = self.to_middle[i];
            p[1] = 0.5 * ends.trial.h * self.f_middle[i];
            meet_the_ends(&mut p, 1, ends, i);
            out[i] = ends.y0[i] + value(&p, 2.0 * theta - 1.0);
        }
    }

    fn prepare(
        &mut self,
        ode: &mut O,
        ends: &Ends<'_>,
        evaluations: &mut u64,
    ) -> Result<(), Cause<O::Error>> {
        self.pieces = 1;
        self.fit(ends, ends.y0, 0);
        let error = self.estimate(ode, ends, evaluations)?;
        if error.is_nan() || error > 1.0 {
            // The error of a piece falls with the power 2k + 1 of its length.
            let wanted = error.powf(1.0 / (2 * self.control.last) as f64).ceil();
            self.pieces = (wanted as usize).clamp(2, PIECES);
            self.integrate_pieces(ode, ends, evaluations)?;
        }
        Ok(())
    }

    fn interpolate_accurately(&self, ends: &Ends<'_>, theta: f64, out: &mut [f64]) {
        let scaled = theta * self.pieces as f64;
        let piece = (scaled as usize).min(self.pieces - 1);
        let u = 2.0 * (scaled - piece as f64) - 1.0;
        for i in 0..out.len() {
            out[i] = ends.y0[i] + value(&self.polynomials[piece * out.len() + i], u);
        }
    }
}

fn value(polynomial: &Polynomial, u: f64) -> f64 {
    polynomial.iter().rev().fold(0.0, |sum, c| sum * u + c)
}

fn slope(polynomial: &Polynomial, u: f64) -> f64 {
    let terms = polynomial.iter().enumerate().skip(1).rev();
    terms.fold(0.0, |sum, (kappa, c)| sum * u + kappa as f64 * c)
}

/// The weights with which columns 1 to k enter the coefficients at the middle.
struct Stencil {
    /// μ.
    highest: usize,
    /// For κ = 0, …, μ and each column, for κ > 0 without the factor h.
    weights: [[f64; COLUMNS]; 2 * COLUMNS],
}

impl Stencil {
    fn new(last: usize) -> Self {
        let highest = 2 * last - 1;
        let mut table = [[0.0; COLUMNS]; 2 * COLUMNS];
        table[0] = weights(1, last);
        // 1/(κ!·2^κ).
        let mut taylor = 1.0;
        for (kappa, row) in table.iter_mut().enumerate().take(highest + 1).skip(1) {
            taylor /= 2.0 * kappa as f64;
            let m = kappa - 1;
            *row = weights(m.div_ceil(2) + 1, last);
            for (w, j) in row.iter_mut().zip(1..) {
                *w *= taylor * (0.5 * substeps(j) as f64).powi(m as i32);
            }
        }
        Self {
            highest,
            weights: table,
        }
    }

    /// The terms up to u^μ for component `i` over a step of size h.
    fn middle(&self, columns: &[Column], h: f64, i: usize) -> Polynomial {
        let mut p = ZERO;
        for (column, w) in columns.iter().zip(self.weights[0]) {
            if w != 0.0 {
                p[0] += w * column.to_middle[i];
            }
        }
        for kappa in 1..=self.highest {
            for (column, w) in columns.iter().zip(self.weights[kappa]) {
                if w != 0.0 {
                    p[kappa] += w * h * difference(&column.f, kappa - 1, i);
                }
            }
        }
        p
    }
}

/// `Σ_i (−1)^i·binomial(m, i)·f_{middle + m − 2i}` for component `i_y`; `f[0]` is f after one substep.
fn difference(f: &[Vec<f64>], m: usize, i_y: usize) -> f64 {
    let middle = f.len().div_ceil(2) - 1;
    let (mut binomial, mut sum) = (1.0, 0.0);
    for i in 0..=m {
        sum += binomial * f[middle + m - 2 * i][i_y];
        binomial *= -((m - i) as f64) / (i + 1) as f64;
    }
    sum
}

impl Extrapolation {
    /// Writes the polynomials of a piece of the step, the last one computed, to place `piece`; they are changes since `origin`.
    fn fit(&mut self, ends: &Ends<'_>, origin: &[f64], piece: usize) {
        let n = origin.len();
        let stencil = Stencil::new(self.control.last);
        for i in 0..n {
            let mut p = stencil.middle(&self.columns, ends.trial.h, i);
            meet_the_ends(&mut p, stencil.highest, ends, i);
            p[0] += ends.y0[i] - origin[i];
            self.polynomials[piece * n + i] = p;
        }
    }

    /// The error of the only polynomial in the norm of the step: the difference of its derivative to f, times the distance to the
    /// end, where both agree.
    fn estimate<O: Ode>(
        &mut self,
        ode: &mut O,
        ends: &Ends<'_>,
        evaluations: &mut u64,
    ) -> Result<f64, Cause<O::Error>> {
        let (h, n) = (ends.trial.h, ends.y0.len());
        let mut largest = 0.0_f64;
        for theta in CHECKS {
            let u = 2.0 * theta - 1.0;
            for i in 0..n {
                self.previous[i] = ends.y0[i] + value(&self.polynomials[i], u);
            }
            let t = ends.trial.stage_time(theta);
            evaluate(ode, t, &self.previous, &mut self.present, evaluations)?;
            for i in 0..n {
                let gap = 2.0 * slope(&self.polynomials[i], u) - h * self.present[i];
                self.present[i] = DISTANCE * gap;
            }
            largest = largest.max(weighted_rms(&self.present, &self.scale));
        }
        Ok(largest)
    }

    /// Crosses the step again in pieces of equal length, with the same number of columns, and fits a polynomial in each.
    fn integrate_pieces<O: Ode>(
        &mut self,
        ode: &mut O,
        ends: &Ends<'_>,
        evaluations: &mut u64,
    ) -> Result<(), Cause<O::Error>> {
        let [mut y0, mut f0, mut y1, mut f1] = std::mem::take(&mut self.piece_ends);
        y0.copy_from_slice(ends.y0);
        f0.copy_from_slice(ends.f0);
        let result = (0..self.pieces).try_for_each(|piece| {
            let part = |piece: usize| piece as f64 / self.pieces as f64;
            let is_last = piece + 1 == self.pieces;
            let t = ends.trial.t + part(piece) * ends.trial.h;
            let t1 = if is_last {
                ends.trial.t1
            } else {
                ends.trial.t + part(piece + 1) * ends.trial.h
            };
            let trial = Trial {
                t,
                h: t1 - t,
                t1,
                ..ends.trial
            };
            for j in 1..=self.control.last {
                self.column(ode, &trial, &y0, &f0, j, evaluations)?;
            }
            if is_last {
                y1.copy_from_slice(ends.y1);
                f1.copy_from_slice(ends.f1);
            } else {
                self.extrapolate(&y0, self.control.last, &mut y1);
                evaluate(ode, trial.stage_time(1.0), &y1, &mut f1, evaluations)?;
            }
            let piece_ends = Ends {
                trial,
                y0: &y0,
                f0: &f0,
                y1: &y1,
                f1: &f1,
            };
            self.fit(&piece_ends, ends.y0, piece);
            std::mem::swap(&mut y0, &mut y1);
            std::mem::swap(&mut f0, &mut f1);
            Ok(())
        });
        self.piece_ends = [y0, f0, y1, f1];
        result
    }
}

/// Completes a polynomial of degree μ for the change over the step by four terms, so that it meets both ends with their derivatives.
fn meet_the_ends(p: &mut Polynomial, highest: usize, ends: &Ends<'_>, i: usize) {
    let h = ends.trial.h;
    // What is missing at u = −1 and u = 1, in the value and in the derivative with respect to u.
    let mut value = [0.0, ends.y1[i] - ends.y0[i]];
    let mut slope = [0.5 * h * ends.f0[i], 0.5 * h * ends.f1[i]];
    let mut sign = 1.0; // (−1)^κ
    for kappa in 0..=highest {
        let c = p[kappa];
        value[0] -= sign * c;
        value[1] -= c;
        slope[0] += sign * kappa as f64 * c;
        slope[1] -= kappa as f64 * c;
        sign = -sign;
    }
    // The parts with the parity of u^(μ+1) and of u^(μ+2): b_0·u^n + b_2·u^(n+2) has the value b_0 + b_2 and the slope
    // n·b_0 + (n + 2)·b_2 at u = 1.
    for (n, sign) in [(highest + 1, sign), (highest + 2, -sign)] {
        let (a, b) = (
            0.5 * (value[1] + sign * value[0]),
            0.5 * (slope[1] - sign * slope[0]),
        );
        let second = 0.5 * (b - n as f64 * a);
        p[n] = a - second;
        p[n + 2] = second;
    }
}
