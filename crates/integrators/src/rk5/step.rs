//! One trial step and its estimated error.

use super::{Rk5Stages, Tableau};
use crate::combine::combine;
use crate::control::StepControl;
use crate::error::Cause;
use crate::method::{Start, Stepper, Trial, widest_gap};
use crate::ode::{Ode, evaluate};
use crate::statistics::Statistics;

impl<O: Ode, T: Tableau> Stepper<O> for Rk5Stages<T> {
    fn order(&self) -> i32 {
        5
    }

    fn widest_gap(&self) -> f64 {
        widest_gap(&T::C)
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
        let (h, y0, k1) = (trial.h, start.y0, start.f0);
        let [k2, k3, k4, k5, k6, k7] = &mut self.k;
        let (a, y) = (T::A, &mut self.y[..]);
        let mut stage = |s: usize, y: &[f64], k: &mut [f64]| {
            let t = trial.stage_time(T::C[s]);
            evaluate(ode, t, y, k, &mut statistics.evaluations)
        };
        combine(y, y0, h, [(a[0][0], k1)]);
        stage(0, y, k2)?;
        combine(y, y0, h, [(a[1][0], k1), (a[1][1], k2)]);
        stage(1, y, k3)?;
        combine(y, y0, h, [(a[2][0], k1), (a[2][1], k2), (a[2][2], k3)]);
        stage(2, y, k4)?;
        let [a1, a2, a3, a4, ..] = a[3];
        combine(y, y0, h, [(a1, k1), (a2, k2), (a3, k3), (a4, k4)]);
        stage(3, y, k5)?;
        let [a1, a2, a3, a4, a5, _] = a[4];
        combine(y, y0, h, [(a1, k1), (a2, k2), (a3, k3), (a4, k4), (a5, k5)]);
        stage(4, y, k6)?;
        let [a1, a2, a3, a4, a5, a6] = a[5];
        combine(
            y1,
            y0,
            h,
            [(a1, k1), (a2, k2), (a3, k3), (a4, k4), (a5, k5), (a6, k6)],
        );
        stage(5, y1, k7)
    }

    fn error_norm(
        &mut self,
        _ode: &mut O,
        trial: &Trial<'_>,
        start: &Start<'_>,
        scale: &[f64],
        _statistics: &mut Statistics,
    ) -> Result<f64, Cause<O::Error>> {
        let (h, k1, n) = (trial.h, start.f0, scale.len());
        if n == 0 {
            return Ok(0.0);
        }
        let [k2, k3, k4, k5, k6, k7] = self.k.each_ref().map(|k| &k[..n]);
        let e = T::E;
        let mut sum = 0.0;
        for i in 0..n {
            let slopes = e[0] * k1[i] + e[1] * k2[i] + e[2] * k3[i] + e[3] * k4[i];
            let error = h * (slopes + e[4] * k5[i] + e[5] * k6[i] + e[6] * k7[i]);
            // A component without error is skipped, because the weight of a component that stays 0
            // may be 0.
            if error != 0.0 {
                sum += (error / scale[i]) * (error / scale[i]);
            }
        }
        Ok((sum / n as f64).sqrt())
    }

    fn end_derivative(
        &mut self,
        _ode: &mut O,
        _trial: &Trial<'_>,
        _y1: &[f64],
        f1: &mut [f64],
        _statistics: &mut Statistics,
    ) -> Result<(), Cause<O::Error>> {
        f1.copy_from_slice(&self.k[5]);
        Ok(())
    }
}
