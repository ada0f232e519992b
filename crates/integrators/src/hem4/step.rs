//! One trial step, its estimated error, the solution inside it.

use super::Stages;
use super::tableau::{A, C, E};
use crate::constrained::{Constrained, Target};
use crate::control::{StepControl, weighted_rms};
use crate::drive::{evaluate, finite};
use crate::error::Cause;
use crate::hermite::{PLACE, cubic, cubic_derivative, quartic_weight};
use crate::method::{Dense, Ends, Start, Stepper, Trial, widest_gap};
use crate::statistics::Statistics;

impl<O: Constrained> Stepper<O> for Stages {
    fn order(&self) -> i32 {
        4
    }

    fn widest_gap(&self) -> f64 {
        widest_gap(&C)
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
        let (h, n, sizes) = (trial.h, start.y0.len(), self.sizes);
        y1.copy_from_slice(start.y0);
        for s in 0..5 {
            let row = &A[s];
            let (done, rest) = self.k.split_at_mut(s);
            let k = &mut rest[0];
            self.y.copy_from_slice(y1);
            let t = trial.stage_time(C[s]);
            // q' of this stage is known before its accelerations and takes part in the positions at which they aim.
            ode.position_rate(t, &self.y, &mut k[..sizes.positions])
                .map_err(Cause::Problem)?;
            for i in 0..sizes.rest() {
                let sum: f64 = done.iter().zip(row).map(|(k, a)| a * k[i]).sum();
                let own = if i < sizes.positions {
                    row[s] * k[i]
                } else {
                    0.0
                };
                self.target[i] = start.y0[i] + h * (sum + own);
            }
            let target = Target {
                t: trial.stage_time(C[s + 1]),
                q: &self.target[..sizes.positions],
                w: &self.target[sizes.velocity_range()],
                tau: h * row[s],
            };
            statistics.evaluations += 1;
            ode.rhs_towards(t, &self.y, &target, k)
                .map_err(Cause::Problem)?;
            finite(k).map_err(|component| Cause::NonFinite { component })?;
            for i in 0..n {
                let sum: f64 = done.iter().zip(row).map(|(k, a)| a * k[i]).sum();
                y1[i] = start.y0[i] + h * (sum + row[s] * k[i]);
            }
        }
        let t1 = trial.stage_time(1.0);
        evaluate(ode, t1, y1, &mut self.f1, &mut statistics.evaluations)
    }

    fn error_norm(
        &mut self,
        _ode: &mut O,
        trial: &Trial<'_>,
        start: &Start<'_>,
        scale: &[f64],
        _statistics: &mut Statistics,
    ) -> Result<f64, Cause<O::Error>> {
        let [_, _, k3, k4, k5] = self.k.each_ref();
        for (i, error) in self.y.iter_mut().enumerate() {
            let stages = E[1] * k3[i] + E[2] * k4[i] + E[3] * k5[i];
            *error = trial.h * (E[0] * start.f0[i] + stages + E[4] * self.f1[i]);
        }
        Ok(weighted_rms(&self.y, scale))
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
}

impl<O: Constrained> Dense<O> for Stages {
    fn interpolate(&self, ends: &Ends<'_>, theta: f64, out: &mut [f64]) {
        for (i, out) in out.iter_mut().enumerate() {
            *out = cubic(ends, theta, i);
        }
    }

    fn prepare(
        &mut self,
        ode: &mut O,
        ends: &Ends<'_>,
        evaluations: &mut u64,
    ) -> Result<(), Cause<O::Error>> {
        for (i, y) in self.y.iter_mut().enumerate() {
            *y = cubic(ends, PLACE, i);
        }
        let t = ends.trial.stage_time(PLACE);
        evaluate(ode, t, &self.y, &mut self.defect, evaluations)?;
        for (i, defect) in self.defect.iter_mut().enumerate() {
            *defect -= cubic_derivative(ends, PLACE, i);
        }
        Ok(())
    }

    fn interpolate_accurately(&self, ends: &Ends<'_>, theta: f64, out: &mut [f64]) {
        let weight = ends.trial.h * quartic_weight(theta);
        for (i, out) in out.iter_mut().enumerate() {
            *out = cubic(ends, theta, i) + weight * self.defect[i];
        }
    }
}
