//! One trial step and its estimated error.

use super::Stages;
use super::tableau::{A, C, E};
use crate::control::Control;
use crate::drive::evaluate;
use crate::error::Cause;
use crate::method::{Start, Stepper, Trial};
use crate::ode::Ode;
use crate::statistics::Statistics;

impl<O: Ode> Stepper<O> for Stages {
    fn order(&self) -> i32 {
        5
    }

    /// Between the nodes 3/10 and 4/5.
    fn widest_gap(&self) -> f64 {
        0.55
    }

    fn control(&mut self) -> &mut Control {
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
        let y0 = start.y0;
        let (h, n) = (trial.h, y0.len());
        let [k2, k3, k4, k5, k6, k7] = self.k.each_mut().map(|k| &mut k[..n]);
        let (k1, y) = (&start.f0[..n], &mut self.y[..n]);
        let mut stage = |s: usize, y: &[f64], k: &mut [f64]| {
            evaluate(
                ode,
                trial.stage_time(C[s]),
                y,
                k,
                &mut statistics.evaluations,
            )
        };
        for i in 0..n {
            y[i] = y0[i] + h * (A[0][0] * k1[i]);
        }
        stage(0, y, k2)?;
        for i in 0..n {
            y[i] = y0[i] + h * (A[1][0] * k1[i] + A[1][1] * k2[i]);
        }
        stage(1, y, k3)?;
        for i in 0..n {
            y[i] = y0[i] + h * (A[2][0] * k1[i] + A[2][1] * k2[i] + A[2][2] * k3[i]);
        }
        stage(2, y, k4)?;
        for i in 0..n {
            let sum = A[3][0] * k1[i] + A[3][1] * k2[i] + A[3][2] * k3[i] + A[3][3] * k4[i];
            y[i] = y0[i] + h * sum;
        }
        stage(3, y, k5)?;
        for i in 0..n {
            let sum = A[4][0] * k1[i] + A[4][1] * k2[i] + A[4][2] * k3[i] + A[4][3] * k4[i];
            y[i] = y0[i] + h * (sum + A[4][4] * k5[i]);
        }
        stage(4, y, k6)?;
        let y1 = &mut y1[..n];
        for i in 0..n {
            let sum = A[5][0] * k1[i] + A[5][2] * k3[i] + A[5][3] * k4[i] + A[5][4] * k5[i];
            y1[i] = y0[i] + h * (sum + A[5][5] * k6[i]);
        }
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
        let (h, f0, n) = (trial.h, start.f0, start.f0.len());
        if n == 0 {
            return Ok(0.0);
        }
        let [_, k3, k4, k5, k6, k7] = self.k.each_ref().map(|k| &k[..n]);
        let mut sum = 0.0;
        for i in 0..n {
            let slopes = E[0] * f0[i] + E[2] * k3[i] + E[3] * k4[i] + E[4] * k5[i];
            let error = h * (slopes + E[5] * k6[i] + E[6] * k7[i]);
            // No error needs no weight: a component that stays 0 may have weight 0.
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
