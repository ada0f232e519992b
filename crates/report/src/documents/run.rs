//! `summary.json` of a run.

use dynamics::{Event, EventKind, MotionError, MotionOptions, Prepared, RowChoice, Summary};
use serde::Serialize;
use solvability::Analysis;

use super::{Named, VerdictDocument, from_one};

/// What a run was and what came out.
#[derive(Clone, Copy)]
pub struct Run<'a> {
    /// Start and kept rows.
    pub prepared: &'a Prepared,
    /// What was asked.
    pub options: &'a MotionOptions,
    /// Verdicts at the start.
    pub analysis: &'a Analysis,
    /// What came out.
    pub summary: &'a Summary,
    /// How it ended.
    pub ending: Ending<'a>,
}

/// How a run ended.
#[derive(Clone, Copy, Debug)]
pub enum Ending<'a> {
    /// At its last time.
    Complete,
    /// It was interrupted; what was reached is good.
    Interrupted,
    /// It stopped; what was reached is good.
    Stopped(&'a MotionError),
}

/// Numbers, events and verdicts of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunDocument {
    /// Integrator.
    pub method: &'static str,
    /// Treatment of redundancy.
    pub formulation: &'static str,
    /// Whether the run ended before its last time.
    pub partial: bool,
    /// Why it stopped.
    pub error: Option<String>,
    /// Last time reached (s).
    pub t_end: f64,
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Evaluations of accelerations.
    pub evaluations: u64,
    /// Projections of steps.
    pub projections: u64,
    /// Time of the integration alone (s).
    pub wall_seconds: f64,
    /// Largest |Φ|.
    pub max_position_residual: f64,
    /// Largest |C·v − b|.
    pub max_velocity_residual: f64,
    /// Largest |E − E₀ − work| relative to the largest kinetic energy.
    pub energy_balance: f64,
    /// Largest change of a coordinate by the assembly (m or rad).
    pub start_correction: f64,
    /// Largest change of a velocity at the start (m/s or rad/s).
    pub start_velocity_correction: f64,
    /// What happened on the way.
    pub events: Vec<EventDocument>,
    /// Verdict of every joint and drive at the start, by name.
    pub reactions: Named<RunReactionDocument>,
}

/// An event.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EventDocument {
    /// When (s).
    pub time: f64,
    /// What.
    pub kind: &'static str,
    /// Degree of redundancy before.
    pub redundancy_before: usize,
    /// Degree of redundancy after.
    pub redundancy_after: usize,
    /// Rows deleted from now on.
    pub deleted_rows: Vec<usize>,
    /// In words.
    pub text: String,
}

/// The verdict of a reaction of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunReactionDocument {
    /// The verdict.
    #[serde(flatten)]
    pub verdict: VerdictDocument,
    /// What its numbers depend on where they are not unique.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub choice: Option<ChoiceDocument>,
}

/// What was decided so that a non-unique reaction has a number.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChoiceDocument {
    /// Treatment of redundancy.
    pub method: &'static str,
    /// Rows whose multipliers are zero by decree.
    pub deleted_rows: Vec<usize>,
    /// Time from which other rows are deleted (s; see the events); absent if never.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub valid_until: Option<f64>,
}

impl RunDocument {
    /// The document of a run.
    #[must_use]
    pub fn new(run: &Run<'_>) -> Self {
        let (prepared, summary) = (run.prepared, run.summary);
        let (partial, error) = match run.ending {
            Ending::Complete => (false, None),
            Ending::Interrupted => (true, None),
            Ending::Stopped(error) => (true, Some(error.to_string())),
        };
        // Rows that the user asked for stay those of the reactions, whatever is kept for the motion.
        let automatic = prepared.choice == RowChoice::Automatic;
        let exchange = |e: &&Event| automatic && e.kind == EventKind::RowsExchanged;
        let choice = ChoiceDocument {
            method: run.options.formulation.name(),
            deleted_rows: from_one(&prepared.decision.dropped),
            valid_until: summary.events.iter().find(exchange).map(|e| e.time),
        };
        let reactions = run.analysis.reactions.iter().map(|r| {
            let document = RunReactionDocument {
                verdict: (&r.wrench).into(),
                choice: (!r.wrench.verdict.is_unique()).then(|| choice.clone()),
            };
            (r.name.clone(), document)
        });
        Self {
            method: run.options.method.name(),
            formulation: run.options.formulation.name(),
            partial,
            error,
            t_end: summary.t,
            steps: summary.steps,
            rejected: summary.rejected,
            evaluations: summary.evaluations,
            projections: summary.projections,
            wall_seconds: summary.wall_seconds,
            max_position_residual: summary.max_position_residual,
            max_velocity_residual: summary.max_velocity_residual,
            energy_balance: summary.energy_balance,
            start_correction: largest(&prepared.assembly.correction),
            start_velocity_correction: largest(&prepared.velocity_correction),
            events: summary.events.iter().map(Into::into).collect(),
            reactions: Named(reactions.collect()),
        }
    }
}

impl From<&Event> for EventDocument {
    fn from(event: &Event) -> Self {
        Self {
            time: event.time,
            kind: event.kind.name(),
            redundancy_before: event.redundancy_before,
            redundancy_after: event.redundancy_after,
            deleted_rows: from_one(&event.dropped),
            text: event.text.clone(),
        }
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |a, x| f64::max(a, x.abs()))
}
