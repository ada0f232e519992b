//! Newton's method for v' and λ at the end of a step: one factorisation at the predicted end.
//!
//! Rows of Φ are divided by ∂q1/∂v'1 = h²·β·(1 − α_f)/(1 − α_m), the other constraints by ∂v1/∂v'1 = h·γ·(1 − α_f)/(1 − α_m), so that
//! both have the rows of G in the matrix.

use super::Stepping;
use crate::constrained::{Constrained, Linearisation};
use crate::control::weighted_square_sum;
use crate::convergence::Verdict;
use crate::drive::finite;
use crate::error::Cause;
use crate::method::{Start, Trial};
use crate::statistics::Statistics;

/// Error that the iterations may leave, as part of the tolerance: so little that the constraints hold to rounding at the usual tolerances,
/// because an error of Φ enters λ multiplied by 1/h².
const PERMITTED: f64 = 1e-6;
/// Increments are never asked to be smaller than this part of the state.
const ROUNDING: f64 = 10.0 * f64::EPSILON;

impl Stepping {
    /// Solves the equations at the end of the trial; `y1` is the state there.
    pub(super) fn solve<O: Constrained>(
        &mut self,
        ode: &mut O,
        trial: &Trial<'_>,
        start: &Start<'_>,
        y1: &mut [f64],
        statistics: &mut Statistics,
    ) -> Result<(), Cause<O::Error>> {
        let (h, c, t1) = (trial.h, self.coefficients, trial.stage_time(1.0));
        let share = (1.0 - c.alpha_f) / (1.0 - c.alpha_m);
        let (c_v, c_q) = (h * c.gamma * share, h * h * c.beta * share);
        // Which rows are kept may change between steps.
        let (n_v, holonomic) = (self.sizes.velocities, ode.sizes().holonomic);
        self.move_to_end(ode, h, start.y0, y1);
        statistics.jacobians += 1;
        statistics.factorisations += 1;
        let point = Linearisation {
            t: t1,
            y: y1,
            a: &self.to.vd,
            lambda: &self.to.lambda,
            c_v,
            c_q,
        };
        ode.factor(&point).map_err(Cause::Problem)?;
        self.convergence = self.convergence.next();
        loop {
            statistics.newton_iterations += 1;
            ode.residual(t1, y1, &self.to.vd, &self.to.lambda, &mut self.x)
                .map_err(Cause::Problem)?;
            let (dynamics, constraints) = self.x.split_at_mut(n_v);
            let (positions, velocities) = constraints.split_at_mut(holonomic);
            dynamics.iter_mut().for_each(|r| *r = -*r);
            positions.iter_mut().for_each(|r| *r /= -c_q);
            velocities.iter_mut().for_each(|r| *r /= -c_v);
            statistics.solves += 1;
            ode.solve(&mut self.x);
            finite(&self.x).map_err(|component| Cause::NonFinite { component })?;
            let (vd, lambda) = self.x.split_at(n_v);
            add(&mut self.to.vd, vd);
            add(&mut self.to.lambda, lambda);
            self.move_to_end(ode, h, start.y0, y1);
            let norm = self.increment_norm(start, y1, c_v, c_q);
            match self.convergence.judge(norm, PERMITTED) {
                Verdict::GoOn => {}
                Verdict::Converged => return Ok(()),
                Verdict::Diverged { .. } => {
                    let (rate, iterations) = (self.convergence.rate, self.convergence.iterations);
                    self.convergence = Default::default();
                    return Err(Cause::NewtonDiverges { rate, iterations });
                }
            }
        }
    }

    /// Positions and velocities at the end, and a there, from v' there.
    fn move_to_end<O: Constrained>(&mut self, ode: &O, h: f64, y0: &[f64], y1: &mut [f64]) {
        let c = self.coefficients;
        let (q, v) = (self.sizes.positions, self.sizes.velocity_range());
        for i in 0..self.sizes.velocities {
            let vd = (1.0 - c.alpha_f) * self.to.vd[i] + c.alpha_f * self.from.vd[i];
            let (v0, a0) = (y0[v.start + i], self.a0[i]);
            let a1 = (vd - c.alpha_m * a0) / (1.0 - c.alpha_m);
            self.to.a[i] = a1;
            self.d[i] = h * (v0 + h * ((0.5 - c.beta) * a0 + c.beta * a1));
            y1[v.start + i] = v0 + h * ((1.0 - c.gamma) * a0 + c.gamma * a1);
        }
        ode.displace(&y0[..q], &self.d, &mut y1[..q]);
    }

    /// Weighted norm of what the last increment has changed in v and, along the directions of v, in q.
    ///
    /// Φ is known to the rounding of the largest coordinate, so q is, too, and v to the rounding divided by the step size: asking for
    /// more would only shorten the step, which makes it worse.
    fn increment_norm(&mut self, start: &Start<'_>, y1: &[f64], c_v: f64, c_q: f64) -> f64 {
        let (n_v, n_q, v) = (
            self.sizes.velocities,
            self.sizes.positions,
            self.sizes.velocity_range(),
        );
        start.tolerance.scale(start.y0, y1, &mut self.scale);
        let positions = start.y0[..n_q].iter().chain(&y1[..n_q]);
        let floor = ROUNDING / PERMITTED * positions.fold(0.0, |size: f64, q| size.max(q.abs()));
        let (in_q, in_v) = self.scale[..v.end].split_at_mut(n_q);
        for scale in in_q.iter_mut() {
            *scale = scale.max(floor);
        }
        for (scale, v1) in in_v.iter_mut().zip(&y1[v]) {
            let rounding = ROUNDING / PERMITTED * v1.abs();
            *scale = scale.max(rounding).max(floor * (c_v / c_q).abs());
        }
        // The sharpest weight of a position stands for all where positions are not displaced component by component.
        let sharpest = in_q.iter().copied().fold(f64::INFINITY, f64::min);
        let x = &self.x[..n_v];
        let of_q: f64 = match n_q == n_v {
            true => weighted_square_sum(x, in_q),
            false => x.iter().map(|x| (x / sharpest) * (x / sharpest)).sum(),
        };
        let sum = c_q * c_q * of_q + c_v * c_v * weighted_square_sum(x, in_v);
        (sum / (2 * n_v).max(1) as f64).sqrt()
    }
}

fn add(a: &mut [f64], b: &[f64]) {
    for (a, b) in a.iter_mut().zip(b) {
        *a += b;
    }
}
