//! Runs of the product, with the written states and the reactions at these states.

use std::ops::ControlFlow;

use dynamics::{MotionError, MotionOptions, simulate};
use model::{Reaction, Registry, System};
use solvability::Stretches;

use pfaff::{AssembledScene, RunOptions, Study, StudyError};

/// Relative and absolute tolerance of all runs.
pub const RTOL: f64 = 1e-11;
const ATOL: f64 = 1e-13;

/// Number of steps after which a run ends. The rows up to this step are used.
const STEPS: u64 = 4000;

/// A written row.
#[derive(Clone, Debug)]
pub struct Row {
    /// Time (s).
    pub t: f64,
    /// The time at which functions of time are evaluated. At a break time it is just before the
    /// break.
    pub t_before: f64,
    /// Coordinates.
    pub q: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
    /// Reactions; the list is empty if this state has no reactions.
    pub reactions: Vec<Reaction>,
}

/// A run.
pub struct Run {
    /// The study of the run.
    pub study: Study,
    /// Rows of the run. There are twice as many rows as the scene requests.
    pub rows: Vec<Row>,
    /// Times at which verdicts may change.
    pub cuts: Vec<f64>,
    /// Verdicts on the reactions in the intervals of the run.
    pub stretches: Option<Stretches>,
    /// The time that the run reached (s).
    pub reached: f64,
    /// Reason why the run stopped before its end.
    pub stopped: Option<MotionError>,
}

/// Prepares a scene; `drop` contains the redundant rows, counted from 0.
///
/// # Errors
/// Returns an error if the product rejects the scene.
pub fn prepared(text: &str, drop: Option<&[usize]>) -> Result<Study, StudyError> {
    let overrides = RunOptions {
        rtol: Some(RTOL),
        atol: Some(ATOL),
        max_steps: Some(STEPS),
        drop: drop.map(<[usize]>::to_vec),
        ..RunOptions::default()
    };
    AssembledScene::read("scene.toml", text, &Registry::standard())?.prepare(&overrides)
}

/// Runs a study.
#[must_use]
pub fn run(study: Study) -> Run {
    let options = study
        .options
        .clone()
        .unwrap_or_else(|| MotionOptions::to(0.0));
    let options = MotionOptions {
        output_step: 0.5 * options.output_step,
        ..options
    };
    let breaks = study.prepared.mechanism.layout().break_times.clone();
    let mut rows = Vec::new();
    let outcome = simulate(&study.prepared, &options, |sample| {
        let t = sample.t;
        let is_break = t > 0.0 && breaks.contains(&t);
        rows.push(Row {
            t,
            t_before: if is_break { t.next_down() } else { t },
            q: sample.q.to_vec(),
            v: sample.v.to_vec(),
            reactions: sample
                .reactions()
                .map_or_else(|_| Vec::new(), |found| found.as_chosen().to_vec()),
        });
        Ok(ControlFlow::Continue(()))
    });
    let (summary, stopped) = match outcome {
        Ok(summary) => (summary, None),
        Err(failure) => (failure.summary, Some(failure.error)),
    };
    let mut cuts = breaks;
    cuts.extend(summary.events.iter().map(|e| e.time));
    Run {
        study,
        rows,
        cuts,
        stretches: summary.verdicts,
        reached: summary.t,
        stopped,
    }
}
