//! The loop of steps for methods with their own step control. Steps end at all requested times, and
//! at break times.

use integrators::Ode;
use model::System;

use super::Fault;
use super::equations::Equations;

/// The first step, as a fraction of the available time.
const FIRST: f64 = 1e-3;

/// A step is too short if it is less than this number times the rounding error of the time.
const SHORTEST: f64 = 16.0;

/// Factor of the step size after a step that failed.
const AFTER_FAILURE: f64 = 0.5;

/// An integration method with its own step size control.
pub(super) trait Stepper {
    /// Deletes the stored previous steps, because the solution may jump at this time.
    fn restart(&mut self);

    /// Performs the step of size h from (t, y0), with y0' = f0, to y1. Returns the scaled error,
    /// which is at most 1 if the step is accurate enough.
    ///
    /// # Errors
    /// Returns an error if the step cannot be computed.
    fn step(
        &mut self,
        equations: &mut Equations<'_>,
        step: &Trial<'_>,
        y1: &mut [f64],
    ) -> Result<f64, Fault>;

    /// Returns the size of the next step after an accepted or rejected step with this size and
    /// error.
    fn next_size(&mut self, h: f64, error: f64, is_accepted: bool) -> f64;
}

/// One trial of a step.
pub(super) struct Trial<'a> {
    /// Start and size (s), and the last time at which the equations of the step are valid.
    pub(super) t: f64,
    pub(super) h: f64,
    pub(super) last: f64,
    /// Whether the step is shorter than the method requested.
    pub(super) is_cut: bool,
    pub(super) y0: &'a [f64],
    pub(super) f0: &'a [f64],
    /// The relative and absolute tolerance.
    pub(super) tolerance: f64,
}

impl Trial<'_> {
    /// Returns the time at the fraction c of the step.
    pub(super) fn time(&self, c: f64) -> f64 {
        (self.t + c * self.h).min(self.last)
    }

    /// Returns the norm `√(1/n · Σ (d/scale)²)` with scale = tolerance·(1 + max(|y0|, |y1|)).
    pub(super) fn norm(&self, d: &[f64], y1: &[f64]) -> f64 {
        let terms = d.iter().zip(self.y0.iter().zip(y1));
        let sum: f64 = terms
            .map(|(d, (y0, y1))| {
                let share = d / (self.tolerance * (1.0 + y0.abs().max(y1.abs())));
                share * share
            })
            .sum();
        (sum / d.len().max(1) as f64).sqrt()
    }
}

/// Number of accepted steps and number of rejected steps.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Steps {
    pub(super) accepted: u64,
    pub(super) rejected: u64,
}

/// Limits at which a run is stopped.
pub(super) struct Limits {
    pub(super) tolerance: f64,
    /// Largest number of steps.
    pub(super) steps: u64,
}

impl Limits {
    pub(super) fn check(&self, time: f64, steps: Steps) -> Result<(), Fault> {
        let made = steps.accepted + steps.rejected;
        if made >= self.steps {
            Err(Fault::TooManySteps { time, steps: made })
        } else {
            Ok(())
        }
    }
}

/// Integrates from t = 0 and passes the states at `times` to `show`; the times are ascending and >
/// 0.
///
/// # Errors
/// Returns an error if steps become too short or too many, or if `show` returns an error.
pub(super) fn drive(
    stepper: &mut dyn Stepper,
    equations: &mut Equations<'_>,
    mut y: Vec<f64>,
    times: &[f64],
    limits: &Limits,
    mut show: impl FnMut(&mut Equations<'_>, f64, &[f64]) -> Result<(), Fault>,
) -> Result<Steps, Fault> {
    let end = times.last().copied().unwrap_or(0.0);
    let breaks = &equations.mechanism().layout().break_times;
    let inside = breaks.iter().copied().filter(|t| *t > 0.0 && *t < end);
    let mut stops: Vec<f64> = times.iter().copied().chain(inside).collect();
    stops.sort_by(f64::total_cmp);
    stops.dedup();
    let (mut t, mut wanted, mut steps) = (0.0, FIRST * end, Steps::default());
    let (mut f, mut y1) = (vec![0.0; y.len()], y.clone());
    let mut is_fresh = true;
    for stop in stops {
        let is_break = breaks.contains(&stop);
        let last = if is_break { stop.next_down() } else { stop };
        while t < stop {
            if is_fresh {
                stepper.restart();
                let now = if breaks.contains(&t) { t.next_up() } else { t };
                equations.rhs(now, &y, &mut f)?;
                is_fresh = false;
            }
            limits.check(t, steps)?;
            let is_last = t + 1.01 * wanted >= stop;
            let h = if is_last { stop - t } else { wanted };
            let trial = Trial {
                t,
                h,
                last,
                is_cut: is_last,
                y0: &y,
                f0: &f,
                tolerance: limits.tolerance,
            };
            let end = trial.time(1.0);
            let made = stepper.step(equations, &trial, &mut y1).and_then(|error| {
                if error <= 1.0 {
                    equations.end(end, &mut y1)?;
                }
                Ok(error)
            });
            match made {
                Ok(error) if error <= 1.0 => {
                    let next = stepper.next_size(h, error, true);
                    // A step that was shortened gives no estimate of the next step size.
                    wanted = if is_last { next.max(wanted) } else { next };
                    steps.accepted += 1;
                    t = if is_last { stop } else { t + h };
                    y.copy_from_slice(&y1);
                    equations.rhs(end, &y, &mut f)?;
                }
                Ok(error) => {
                    wanted = stepper.next_size(h, error, false);
                    steps.rejected += 1;
                }
                Err(_) => {
                    wanted = AFTER_FAILURE * h;
                    steps.rejected += 1;
                }
            }
            if wanted.is_nan() || wanted < SHORTEST * f64::EPSILON * end {
                return Err(made.err().unwrap_or(Fault::StepTooShort { time: t }));
            }
        }
        if times.contains(&stop) {
            show(equations, last, &y)?;
        }
        if is_break {
            equations.at_break(stop.next_up(), &mut y)?;
            is_fresh = true;
        }
    }
    Ok(steps)
}
