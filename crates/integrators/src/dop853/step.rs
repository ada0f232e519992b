//! One trial step and its estimated error.

use super::Dop853Stages;
use super::tableau::{A, C, E3, E5, STEP_STAGES};
use crate::combine::combine;
use crate::control::StepControl;
use crate::error::Cause;
use crate::method::{Start, Stepper, Trial, widest_gap};
use crate::ode::{Ode, evaluate};
use crate::statistics::Statistics;

impl<O: Ode> Stepper<O> for Dop853Stages {
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
        let mut step = Dop853Step {
            ode,
            trial,
            start,
            statistics,
        };
        let (k, y) = (&mut self.k, &mut self.y);
        step.stage(1, [0], k, y)?;
        step.stage(2, [0, 1], k, y)?;
        step.stage(3, [0, 2], k, y)?;
        step.stage(4, [0, 2, 3], k, y)?;
        step.stage(5, [0, 3, 4], k, y)?;
        step.stage(6, [0, 3, 4, 5], k, y)?;
        step.stage(7, [0, 3, 4, 5, 6], k, y)?;
        step.stage(8, [0, 3, 4, 5, 6, 7], k, y)?;
        step.stage(9, [0, 3, 4, 5, 6, 7, 8], k, y)?;
        step.stage(10, [0, 3, 4, 5, 6, 7, 8, 9], k, y)?;
        step.stage(11, [0, 3, 4, 5, 6, 7, 8, 9, 10], k, y)?;
        step.argument(12, [0, 5, 6, 7, 8, 9, 10, 11], k, y1);
        Ok(())
    }

    /// Returns `h·err5·(err5 / √(err5² + 0.01·err3²))` in the norm. The result is the estimate of
    /// order 5 times a factor of about h². Therefore the result is proportional to h⁸; see Hairer,
    /// Nørsett, Wanner I, II.10, (10.17).
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
            // A component without error is skipped, because the weight of a component that stays 0
            // may be 0.
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

/// A trial step.
struct Dop853Step<'a, O> {
    ode: &'a mut O,
    trial: &'a Trial<'a>,
    start: &'a Start<'a>,
    statistics: &'a mut Statistics,
}

impl<O: Ode> Dop853Step<'_, O> {
    /// Writes `y0 + h·Σ a_sj·k_j` to y. `used` lists the indices j of the nonzero coefficients.
    /// The first entry of `k` is k_1.
    #[inline]
    fn argument<const N: usize>(&self, s: usize, used: [usize; N], k: &[Vec<f64>], y: &mut [f64]) {
        let of = |j: usize| if j == 0 { self.start.f0 } else { &k[j - 1][..] };
        let terms = used.map(|j| (A[s][j], of(j)));
        combine(y, self.start.y0, self.trial.h, terms);
    }

    /// Computes stage s from the previous stages.
    #[inline]
    fn stage<const N: usize>(
        &mut self,
        s: usize,
        used: [usize; N],
        k: &mut [Vec<f64>],
        y: &mut [f64],
    ) -> Result<(), Cause<O::Error>> {
        self.argument(s, used, k, y);
        let (t, evaluations) = (
            self.trial.stage_time(C[s]),
            &mut self.statistics.evaluations,
        );
        evaluate(self.ode, t, y, &mut k[s - 1], evaluations)
    }
}
