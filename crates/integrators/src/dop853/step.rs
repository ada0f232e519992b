//! One trial step and its estimated error.

use super::Stages;
use super::tableau::{A, C, E3, E5, STEP_STAGES};
use crate::combine::combine;
use crate::control::StepControl;
use crate::error::Cause;
use crate::method::{Start, Stepper, Trial, widest_gap};
use crate::ode::{Ode, evaluate};
use crate::statistics::Statistics;

impl<O: Ode> Stepper<O> for Stages {
    fn order(&self) -> i32 {
        8
    }

    fn widest_gap(&self) -> f64 {
        widest_gap(&C[..STEP_STAGES])
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
        let [k2, k3, k4, k5, k6, k7, k8, k9, k10, k11, k12] = &mut self.k;
        let y = &mut self.y[..];
        let mut stage = |s: usize, y: &[f64], k: &mut [f64]| {
            let t = trial.stage_time(C[s]);
            evaluate(ode, t, y, k, &mut statistics.evaluations)
        };
        let a = A[1];
        combine(y, y0, h, [(a[0], k1)]);
        stage(1, y, k2)?;
        let a = A[2];
        combine(y, y0, h, [(a[0], k1), (a[1], k2)]);
        stage(2, y, k3)?;
        let a = A[3];
        combine(y, y0, h, [(a[0], k1), (a[2], k3)]);
        stage(3, y, k4)?;
        let a = A[4];
        combine(y, y0, h, [(a[0], k1), (a[2], k3), (a[3], k4)]);
        stage(4, y, k5)?;
        let a = A[5];
        combine(y, y0, h, [(a[0], k1), (a[3], k4), (a[4], k5)]);
        stage(5, y, k6)?;
        let a = A[6];
        combine(y, y0, h, [(a[0], k1), (a[3], k4), (a[4], k5), (a[5], k6)]);
        stage(6, y, k7)?;
        let a = A[7];
        combine(
            y,
            y0,
            h,
            [(a[0], k1), (a[3], k4), (a[4], k5), (a[5], k6), (a[6], k7)],
        );
        stage(7, y, k8)?;
        let a = A[8];
        combine(
            y,
            y0,
            h,
            [
                (a[0], k1),
                (a[3], k4),
                (a[4], k5),
                (a[5], k6),
                (a[6], k7),
                (a[7], k8),
            ],
        );
        stage(8, y, k9)?;
        let a = A[9];
        combine(
            y,
            y0,
            h,
            [
                (a[0], k1),
                (a[3], k4),
                (a[4], k5),
                (a[5], k6),
                (a[6], k7),
                (a[7], k8),
                (a[8], k9),
            ],
        );
        stage(9, y, k10)?;
        let a = A[10];
        combine(
            y,
            y0,
            h,
            [
                (a[0], k1),
                (a[3], k4),
                (a[4], k5),
                (a[5], k6),
                (a[6], k7),
                (a[7], k8),
                (a[8], k9),
                (a[9], k10),
            ],
        );
        stage(10, y, k11)?;
        let a = A[11];
        combine(
            y,
            y0,
            h,
            [
                (a[0], k1),
                (a[3], k4),
                (a[4], k5),
                (a[5], k6),
                (a[6], k7),
                (a[7], k8),
                (a[8], k9),
                (a[9], k10),
                (a[10], k11),
            ],
        );
        stage(11, y, k12)?;
        let a = A[12];
        combine(
            y1,
            y0,
            h,
            [
                (a[0], k1),
                (a[5], k6),
                (a[6], k7),
                (a[7], k8),
                (a[8], k9),
                (a[9], k10),
                (a[10], k11),
                (a[11], k12),
            ],
        );
        Ok(())
    }

    /// `h·err5·(err5 / √(err5² + 0.01·err3²))` in the norm: the estimate of order 5 times a factor
    /// of about h², so that the whole behaves like h⁸; HNW I, II.10, (10.17).
    fn error_norm(
        &mut self,
        _ode: &mut O,
        trial: &Trial<'_>,
        start: &Start<'_>,
        scale: &[f64],
        _statistics: &mut Statistics,
    ) -> Result<f64, Cause<O::Error>> {
        let (k1, n) = (start.f0, scale.len());
        let [_, _, _, _, k6, k7, k8, k9, k10, k11, k12] = self.k.each_ref().map(|k| &k[..n]);
        let (mut sum_5, mut sum_3) = (0.0, 0.0);
        for i in 0..n {
            let k = [k1[i], k6[i], k7[i], k8[i], k9[i], k10[i], k11[i], k12[i]];
            let (mut error_5, mut error_3) = (0.0, 0.0);
            for (k, j) in k.iter().zip([0, 5, 6, 7, 8, 9, 10, 11]) {
                error_5 += E5[j] * k;
                error_3 += E3[j] * k;
            }
            // A component without error needs no weight: one that stays 0 may have weight 0.
            if error_5 != 0.0 {
                sum_5 += (error_5 / scale[i]) * (error_5 / scale[i]);
            }
            if error_3 != 0.0 {
                sum_3 += (error_3 / scale[i]) * (error_3 / scale[i]);
            }
        }
        if sum_5 == 0.0 {
            return Ok(0.0);
        }
        let denominator = ((sum_5 + 0.01 * sum_3) * n as f64).sqrt();
        Ok(trial.h.abs() * sum_5 / denominator)
    }

    fn end_derivative(
        &mut self,
        ode: &mut O,
        trial: &Trial<'_>,
        y1: &[f64],
        f1: &mut [f64],
        statistics: &mut Statistics,
    ) -> Result<(), Cause<O::Error>> {
        evaluate(
            ode,
            trial.stage_time(1.0),
            y1,
            f1,
            &mut statistics.evaluations,
        )
    }
}
