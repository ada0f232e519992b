//! Runs that measure errors, and runs that measure times.

use std::ops::ControlFlow;
use std::time::Instant;

use dynamics::{MotionError, MotionOptions, Summary};

use super::observation::Observation;
use super::plan::{ComparisonPlan, Curve};
use crate::study::Study;

/// Smallest number of rows of a run with a time limit. The run can be abandoned between two rows.
const ROWS: f64 = 1000.0;

/// The times of a run at which rows are evaluated.
#[derive(Clone, Debug)]
pub(super) struct Times {
    /// Time between rows (s). All requested times are multiples of this time.
    step: f64,
    /// The requested times (s).
    pub(super) wanted: Vec<f64>,
}

impl Times {
    /// Creates times that are multiples of `step`.
    pub(super) fn multiples(wanted: Vec<f64>, step: f64) -> Self {
        Self { step, wanted }
    }

    /// Creates `count` evenly spaced times and the end time.
    pub(super) fn evenly(count: u32, t_end: f64) -> Self {
        let step = t_end / f64::from(count);
        let wanted = (1..=count).map(|k| step * f64::from(k)).collect();
        Self::multiples(wanted, step)
    }

    fn has(&self, t: f64) -> bool {
        let near = 1e-3 * self.step / ROWS;
        self.wanted.iter().any(|w| (w - t).abs() < near)
    }

    /// Returns the time between the rows of a run with a time limit (s).
    fn step(&self, t_end: f64, budget: f64) -> f64 {
        if budget.is_finite() {
            self.step / (ROWS * self.step / t_end).ceil().max(1.0)
        } else {
            self.step
        }
    }
}

/// How a run ended.
#[derive(Debug)]
pub(super) enum RunEnding {
    Reached,
    /// The run took too long. The value is the last time that was reached (s).
    GivenUp(f64),
    /// The comparison was interrupted.
    Interrupted,
    Failed(MotionError),
}

/// A run with its recorded rows.
#[derive(Debug)]
pub(super) struct Look {
    pub(super) observations: Vec<Observation>,
    pub(super) summary: Summary,
    pub(super) ending: RunEnding,
}

/// Returns the options of a run for a curve at a tolerance.
pub(super) fn options(base: &MotionOptions, curve: Curve, tolerance: f64) -> MotionOptions {
    MotionOptions {
        rtol: tolerance,
        atol: tolerance,
        method: curve.method,
        stabilisation: curve.stabilisation,
        ..base.clone()
    }
}

/// Runs and records the rows at the requested times.
pub(super) fn look(
    study: &Study,
    options: &MotionOptions,
    times: &Times,
    budget: f64,
    interrupted: &(impl Fn() -> bool + Sync),
) -> Look {
    let options = MotionOptions {
        output_step: times.step(options.t_end, budget),
        ..options.clone()
    };
    let clock = Instant::now();
    let (mut observations, mut early) = (Vec::new(), None);
    let outcome = study.run_until(&options, interrupted, |sample| {
        if times.has(sample.t) {
            observations.push(Observation::of(sample, study.prepared.mechanism.space())?);
        }
        let is_late = clock.elapsed().as_secs_f64() > budget;
        early = is_late.then_some(RunEnding::GivenUp(sample.t));
        Ok(match early {
            Some(_) => ControlFlow::Break(()),
            None => ControlFlow::Continue(()),
        })
    });
    let (summary, ending) = match outcome {
        Ok(summary) if interrupted() => (summary, RunEnding::Interrupted),
        Ok(summary) => (summary, early.unwrap_or(RunEnding::Reached)),
        Err(failure) => (failure.summary, RunEnding::Failed(failure.error)),
    };
    Look {
        observations,
        summary,
        ending,
    }
}

/// Measures the time of runs without output. Returns the summary of the fastest run, and the number
/// of runs. Returns `None` if a run did not reach its end, or if the measurement was interrupted.
pub(super) fn clock(
    study: &Study,
    options: &MotionOptions,
    plan: &ComparisonPlan,
    interrupted: &(impl Fn() -> bool + Sync),
) -> Option<(Summary, u32)> {
    let options = MotionOptions {
        output_step: options.t_end,
        ..options.clone()
    };
    let (mut best, mut runs, mut total) = (None::<Summary>, 0, 0.0);
    while runs < plan.repetitions || total < plan.seconds {
        let summary = study
            .run_until(&options, interrupted, |_| Ok(ControlFlow::Continue(())))
            .ok()?;
        if interrupted() {
            return None;
        }
        (runs, total) = (runs + 1, total + summary.wall_seconds);
        if best
            .as_ref()
            .is_none_or(|b| summary.wall_seconds < b.wall_seconds)
        {
            best = Some(summary);
        }
    }
    best.map(|summary| (summary, runs))
}
