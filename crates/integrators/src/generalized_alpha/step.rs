//! One trial step, its estimated error, the solution inside it.

use super::Stepping;
use crate::constrained::Constrained;
use crate::control::{StepControl, weighted_rms};
use crate::convergence::Convergence;
use crate::drive::evaluate;
use crate::error::Cause;
use crate::hermite::cubic;
use crate::method::{Dense, Ends, Start, Stepper, Trial};
use crate::statistics::Statistics;

impl<O: Constrained> Stepper<O> for Stepping {
    fn order(&self) -> i32 {
        2
    }

    fn control(&mut self) -> &mut dyn StepControl {
        &mut self.control
    }

    fn trial(
        &mut self,
        ode: &mut O,
        trial: &Trial<'_>,
        start: &Start<'_>,
        y1: &mut [f64],
        statistics: &mut Statistics,
    ) -> Result<(), Cause<O::Error>> {
        self.begin(trial.h, start);
        y1.copy_from_slice(start.y0);
        self.solve(ode, trial, start, y1, statistics)?;
        let t1 = trial.stage_time(1.0);
        evaluate(ode, t1, y1, &mut self.f1, &mut statistics.evaluations)?;
        for i in self.sizes.rest()..y1.len() {
            y1[i] = start.y0[i] + 0.5 * trial.h * (start.f0[i] + self.f1[i]);
        }
        Ok(())
    }

    /// `C·h³·y'''`, with y''' from the derivatives at both ends and at the start of the step before; without such a step, in the middle.
    fn error_norm(
        &mut self,
        ode: &mut O,
        trial: &Trial<'_>,
        start: &Start<'_>,
        scale: &[f64],
        statistics: &mut Statistics,
    ) -> Result<f64, Cause<O::Error>> {
        let h = trial.h;
        if let Some(h_before) = self.h_before {
            for (i, f) in self.f.iter_mut().enumerate() {
                let slope = (self.f1[i] - start.f0[i]) / h;
                let slope_before = (start.f0[i] - self.f_before[i]) / h_before;
                *f = 2.0 * (slope - slope_before) / (h + h_before);
            }
        } else {
            for (i, y) in self.y.iter_mut().enumerate() {
                *y = start.y0[i] + h * (0.375 * start.f0[i] + 0.125 * self.f1[i]);
            }
            let t = trial.stage_time(0.5);
            evaluate(ode, t, &self.y, &mut self.f, &mut statistics.evaluations)?;
            for (i, f) in self.f.iter_mut().enumerate() {
                *f = 4.0 * (start.f0[i] - 2.0 * *f + self.f1[i]) / (h * h);
            }
        }
        let [q, v, rest] = self.coefficients.error_constants();
        for (i, error) in self.f.iter_mut().enumerate() {
            let constant = match i {
                i if i < self.sizes.positions => q,
                i if i < self.sizes.rest() => v,
                _ => rest,
            };
            *error *= constant * h * h * h;
        }
        Ok(weighted_rms(&self.f, scale))
    }

    fn end_derivative(
        &mut self,
        _ode: &mut O,
        _trial: &Trial<'_>,
        _y1: &[f64],
        f1: &mut [f64],
        _statistics: &mut Statistics,
    ) -> Result<(), Cause<O::Error>> {
        f1.copy_from_slice(&self.f1);
        Ok(())
    }

    fn restart(&mut self) {
        self.control.reset();
        self.convergence = Convergence::default();
        self.from.lambda.fill(0.0);
        self.h_before = None;
    }

    fn after_acceptance(&mut self, h: f64, error_norm: f64) -> f64 {
        for (i, jerk) in self.jerk.iter_mut().enumerate() {
            *jerk = (self.to.vd[i] - self.from.vd[i]) / h;
        }
        std::mem::swap(&mut self.from, &mut self.to);
        std::mem::swap(&mut self.f_before, &mut self.f_start);
        self.h_before = Some(h);
        self.control.accept(h, error_norm)
    }
}

impl Stepping {
    /// Accelerations at the start of the trial and predicted ones at its end.
    fn begin(&mut self, h: f64, start: &Start<'_>) {
        let lag = self.coefficients.alpha_m - self.coefficients.alpha_f;
        if let Some(h_before) = self.h_before {
            for i in 0..self.sizes.velocities {
                self.a0[i] = self.from.a[i] + lag * (h - h_before) * self.jerk[i];
                self.to.vd[i] = self.from.vd[i] + h * self.jerk[i];
            }
        } else {
            self.from
                .vd
                .copy_from_slice(&start.f0[self.sizes.velocity_range()]);
            self.a0.copy_from_slice(&self.from.vd);
            self.to.vd.copy_from_slice(&self.from.vd);
        }
        self.to.lambda.copy_from_slice(&self.from.lambda);
        self.f_start.copy_from_slice(start.f0);
    }
}

impl<O: Constrained> Dense<O> for Stepping {
    fn interpolate(&self, ends: &Ends<'_>, theta: f64, out: &mut [f64]) {
        for (i, out) in out.iter_mut().enumerate() {
            *out = cubic(ends, theta, i);
        }
    }

    fn prepare(
        &mut self,
        _ode: &mut O,
        _ends: &Ends<'_>,
        _evaluations: &mut u64,
    ) -> Result<(), Cause<O::Error>> {
        Ok(())
    }

    fn interpolate_accurately(&self, ends: &Ends<'_>, theta: f64, out: &mut [f64]) {
        Dense::<O>::interpolate(self, ends, theta, out);
    }
}
