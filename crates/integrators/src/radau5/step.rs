//! One trial step, its estimated error and the size of the next step.

use super::newton::dot;
use super::scale::set_scale;
use super::tableau::{C, COMPLEX, E, REAL};
use super::{Matrices, Radau5Stages};
use crate::control::{StepControl, weighted_rms};
use crate::convergence::{Convergence, GOOD_RATE, MAX_ITERATIONS, Verdict};
use crate::error::Cause;
use crate::implicit::Implicit;
use crate::method::{Start, Stepper, Trial, widest_gap};
use crate::ode::{evaluate, finite};
use crate::statistics::Statistics;

/// If the step size differs by less than this fraction, the factors are reused. Newton's method
/// then still converges at a good rate.
const SAME_SIZE: f64 = 1e-3;
/// If a step size could increase by less than this factor, the size and the factors are reused.
const WORTH_GROWING: f64 = 1.2;
/// Lower bound of the error with which the predictive controller compares.
const SMALLEST_REFERENCE: f64 = 1e-2;

impl Radau5Stages {
    /// Computes J and its factors for this trial if new factors are needed.
    fn prepare_matrices<O: Implicit>(
        &mut self,
        ode: &mut O,
        trial: &Trial<'_>,
        y0: &[f64],
        statistics: &mut Statistics,
    ) -> Result<(), Cause<O::Error>> {
        let matrices = &mut self.matrices;
        if matrices.linearised_at.is_none()
            || (matrices.is_worn && matrices.linearised_at != Some(trial.t))
        {
            *matrices = Matrices::default();
            statistics.jacobians += 1;
            ode.linearise(trial.stage_time(0.0), y0)
                .map_err(Cause::Problem)?;
            matrices.linearised_at = Some(trial.t);
        }
        let fits = |h: f64| (trial.h / h - 1.0).abs() <= SAME_SIZE;
        if !matrices.factored_for.is_some_and(fits) {
            matrices.factored_for = None;
            statistics.factorisations += 1;
            ode.factor(REAL / trial.h, COMPLEX.map(|x| x / trial.h))
                .map_err(Cause::Problem)?;
            matrices.factored_for = Some(trial.h);
        }
        Ok(())
    }

    /// Computes `error ← (u₁/h·I − J)⁻¹·(f + Σ E_i·z_i/h)`. On entry, `error` contains f.
    fn filter_estimate<O: Implicit>(
        &mut self,
        ode: &mut O,
        h: f64,
        statistics: &mut Statistics,
    ) -> Result<(), Cause<O::Error>> {
        let [z1, z2, z3] = self.z.each_ref();
        for (i, error) in self.defect.iter_mut().enumerate() {
            *error += dot(&E, &[z1[i], z2[i], z3[i]]) / h;
        }
        statistics.solves += 1;
        ode.solve(&mut self.defect);
        finite(&self.defect).map_err(|component| Cause::NonFinite { component })
    }
}

impl<O: Implicit> Stepper<O> for Radau5Stages {
    fn order(&self) -> i32 {
        5
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
        self.newton.factor_after_failure = None;
        loop {
            self.prepare_matrices(ode, trial, start.y0, statistics)?;
            self.predict(trial.h);
            let Verdict::Diverged { factor } = self.solve_stages(ode, trial, start, statistics)?
            else {
                break;
            };
            let Convergence {
                rate, iterations, ..
            } = std::mem::take(&mut self.newton.convergence);
            self.matrices.is_worn = true;
            if self.matrices.linearised_at == Some(trial.t) {
                self.newton.factor_after_failure = Some(factor);
                return Err(Cause::NewtonDiverges { rate, iterations });
            }
        }
        for ((y1, y0), z) in y1.iter_mut().zip(start.y0).zip(&self.z[2]) {
            *y1 = y0 + z;
        }
        Ok(())
    }

    fn error_norm(
        &mut self,
        ode: &mut O,
        trial: &Trial<'_>,
        start: &Start<'_>,
        _scale: &[f64],
        statistics: &mut Statistics,
    ) -> Result<f64, Cause<O::Error>> {
        let h = trial.h;
        for ((y, y0), z) in self.y.iter_mut().zip(start.y0).zip(&self.z[2]) {
            *y = y0 + z;
        }
        set_scale(start.tolerance, start.y0, &self.y, &mut self.scale);
        self.defect.copy_from_slice(start.f0);
        self.filter_estimate(ode, h, statistics)?;
        let mut norm = weighted_rms(&self.defect, &self.scale);
        if norm >= 1.0 && self.filter_twice {
            for ((y, y0), error) in self.y.iter_mut().zip(start.y0).zip(&self.defect) {
                *y = y0 + error;
            }
            let t = trial.stage_time(0.0);
            evaluate(
                ode,
                t,
                &self.y,
                &mut self.defect,
                &mut statistics.evaluations,
            )?;
            self.filter_estimate(ode, h, statistics)?;
            norm = weighted_rms(&self.defect, &self.scale);
        }
        Ok(norm)
    }

    fn end_derivative(
        &mut self,
        ode: &mut O,
        trial: &Trial<'_>,
        y1: &[f64],
        f1: &mut [f64],
        statistics: &mut Statistics,
    ) -> Result<(), Cause<O::Error>> {
        let t = trial.stage_time(1.0);
        evaluate(ode, t, y1, f1, &mut statistics.evaluations)
    }

    fn restart(&mut self) {
        self.control.reset();
        self.matrices = Matrices::default();
        self.newton.convergence = Convergence::default();
        self.before.h = None;
        self.before.reference = None;
        self.filter_twice = true;
    }

    /// Returns the smaller of two proposals. One proposal is that of the classical controller. The
    /// other proposal is that of Gustafsson's predictive controller, which extrapolates the trend
    /// of the error. Many iterations have the same effect as a larger error. If the size would
    /// change only slightly, the size and the factors are reused.
    fn after_acceptance(&mut self, h: f64, error_norm: f64) -> f64 {
        let effort = self.effort();
        let mut next = self.control.accept(h, error_norm * effort.powi(4));
        if let Some((h_reference, error_reference)) = self.before.reference {
            let trend = (error_reference / (error_norm * error_norm)).powf(0.25);
            let factor = super::CONTROL.safety * h / h_reference * trend;
            let factor = factor.clamp(super::CONTROL.min_factor, super::CONTROL.max_factor);
            if (h * factor).abs() < next.abs() {
                next = h * factor;
            }
        }
        self.before.reference = Some((h, error_norm.max(SMALLEST_REFERENCE)));
        self.before.h = Some(h);
        self.filter_twice = false;
        std::mem::swap(&mut self.z, &mut self.before.z);
        self.matrices.is_worn = self.newton.convergence.rate > GOOD_RATE;
        if !self.matrices.is_worn && (1.0..=WORTH_GROWING).contains(&(next / h)) {
            h
        } else {
            next
        }
    }

    fn after_rejection(&mut self, h: f64, error_norm: f64) -> f64 {
        self.filter_twice = true;
        let effort = self.effort();
        self.control.reject(h, error_norm * effort.powi(4))
    }

    fn after_failure(&mut self, h: f64, factor: f64) -> f64 {
        self.filter_twice = true;
        let factor = self.newton.factor_after_failure.take().unwrap_or(factor);
        self.control.shorten(h, factor)
    }
}

impl Radau5Stages {
    /// Returns (n + 2·n_max)/(1 + 2·n_max) for n iterations. The result is the cost of the last
    /// step relative to its smallest possible cost.
    fn effort(&self) -> f64 {
        let (n, n_max) = (
            f64::from(self.newton.convergence.iterations),
            f64::from(MAX_ITERATIONS),
        );
        (n + 2.0 * n_max) / (1.0 + 2.0 * n_max)
    }
}
