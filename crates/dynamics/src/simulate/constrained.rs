//! The equations of a run for methods that treat the kept constraints as equations of their own.

use integrators::{Constrained, Linearisation, Sizes, Target};
use model::System;

use super::equations::Equations;
use crate::error::Trip;
use crate::motion::constrained::Aim;

/// Positions and velocities of a state.
fn parts(y: &[f64], n_q: usize, n_v: usize) -> (&[f64], &[f64]) {
    (&y[..n_q], &y[n_q..n_q + n_v])
}

impl Constrained for Equations<'_> {
    fn sizes(&self) -> Sizes {
        let [holonomic, nonholonomic] = self.motion.kept_rows();
        Sizes {
            positions: self.n_q,
            velocities: self.n_v,
            holonomic,
            nonholonomic,
        }
    }

    fn position_rate(&mut self, _t: f64, y: &[f64], qd: &mut [f64]) -> Result<(), Trip> {
        let (q, v) = parts(y, self.n_q, self.n_v);
        self.motion.mechanism().rate(q, v, qd);
        Ok(())
    }

    fn rhs_towards(
        &mut self,
        t: f64,
        y: &[f64],
        target: &Target<'_>,
        dy: &mut [f64],
    ) -> Result<(), Trip> {
        let (q, v) = parts(y, self.n_q, self.n_v);
        let (qd, rest) = dy.split_at_mut(self.n_q);
        let (a, work) = rest.split_at_mut(self.n_v);
        self.motion.mechanism().rate(q, v, qd);
        let aim = Aim {
            t: target.t,
            q: target.q,
            w: target.w,
            tau: target.tau,
        };
        let (motion, saddle_point) = self.constrained();
        saddle_point.acceleration_towards(motion, (t, q, v), &aim, a)?;
        if let Some(work) = work.first_mut() {
            *work = self.motion.mechanism().energy_rate(v, a);
        }
        Ok(())
    }

    fn displace(&self, q: &[f64], d: &[f64], out: &mut [f64]) {
        out.copy_from_slice(q);
        self.motion.mechanism().displace(out, d);
    }

    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        a: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Trip> {
        let (q, v) = parts(y, self.n_q, self.n_v);
        let (motion, saddle_point) = self.constrained();
        saddle_point.residual(motion, (t, q, v), (a, lambda), out);
        Ok(())
    }

    fn factor(&mut self, point: &Linearisation<'_>) -> Result<(), Trip> {
        let (q, v) = parts(point.y, self.n_q, self.n_v);
        let (motion, saddle_point) = self.constrained();
        saddle_point.linearise(
            motion,
            (point.t, q, v),
            (point.a, point.lambda),
            (point.c_v, point.c_q),
        )
    }

    fn solve(&mut self, x: &mut [f64]) {
        self.constrained().1.solve(x);
    }
}
