//! `summary.json` of a run.

use std::fmt;

use dynamics::{
    ComponentSummary, Event, EventKind, FORMULATION, MotionError, Plan, Prepared, RowChoice,
    Summary,
};
use model::System;
use model::codes::Code;
use model::words::{listed, rounded};
use serde::Serialize;
use solvability::parts::parts;
use solvability::{Freedoms, ONE_PART, ReactionVerdict, Sensitivities};

use super::plan::{short, short_of};
use super::{
    DataDocument, FreedomsDocument, MisfitDocument, Named, SensitivityDocument, SpreadDocument,
    VerdictDocument, from_one,
};

/// A run and its results.
#[derive(Clone, Copy)]
pub struct Run<'a> {
    /// Start, kept rows, and plan of the run.
    pub plan: &'a Plan<'a>,
    /// Verdicts at the start.
    pub reactions: &'a [ReactionVerdict],
    /// How strongly the reactions depend on the data at the start.
    pub sensitivities: &'a Sensitivities,
    /// Tolerances of the data, and what depends on them.
    pub data: DataDocument,
    /// The possible motions at the start.
    pub freedoms: &'a Freedoms,
    /// Numbers of the run.
    pub summary: &'a Summary,
    /// The same on other rows, if rows have missed.
    pub spread: Option<&'a SpreadDocument>,
    /// How it ended.
    pub ending: Ending<'a>,
    /// Number of rows in its tables.
    pub rows: usize,
    /// Names of its files.
    pub files: &'a [&'static str],
}

/// How a run ended.
#[derive(Clone, Copy, Debug)]
pub enum Ending<'a> {
    /// The last time was reached.
    Complete,
    /// The run was interrupted; the results up to there are valid.
    Interrupted,
    /// It stopped with this error; the results up to there are valid.
    Stopped(&'a MotionError),
}

/// Numbers, events and verdicts of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct RunDocument {
    /// Integrator; `auto` if components have different ones.
    pub method: &'static str,
    /// Treatment of redundancy.
    pub formulation: &'static str,
    /// Treatment of drift.
    pub stabilisation: &'static str,
    /// Whether the run ended before its last time.
    pub partial: bool,
    /// Code of the reason why it ended early.
    pub code: Option<Code>,
    /// Reason why it stopped.
    pub error: Option<String>,
    /// Last time reached (s).
    pub t_end: f64,
    /// Number of rows in the tables.
    pub rows: usize,
    /// Names of the files of the run.
    pub files: Vec<&'static str>,
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Evaluations of accelerations.
    pub evaluations: u64,
    /// Projections of steps.
    pub projections: u64,
    /// Quaternions that were scaled to length one at accepted steps.
    pub normalisations: u64,
    /// Wall-clock time of the integration alone (s).
    pub wall_seconds: f64,
    /// Largest |Φ|.
    pub max_position_residual: f64,
    /// Largest |C·v − b|.
    pub max_velocity_residual: f64,
    /// Largest |E − E₀ − work| relative to the largest kinetic energy, or an upper bound on it if
    /// there are components.
    pub energy_balance: f64,
    /// Largest change of a coordinate by the assembly (m or rad).
    pub start_correction: f64,
    /// Largest change of a velocity at the start (m/s or rad/s).
    pub start_velocity_correction: f64,
    /// Degrees of freedom at the start, n_v − r.
    pub mobility: usize,
    /// The possible motions there, with the drives and without them.
    #[serde(flatten)]
    pub freedoms: FreedomsDocument,
    /// Tolerances of the data, and what depends on them at the start.
    pub data: DataDocument,
    /// What rows miss at most that are redundant within the stated tolerance only.
    pub misfits: Vec<MisfitDocument>,
    /// How far the motion on another choice of rows differs; `null` if no row misses.
    pub spread: Option<SpreadDocument>,
    /// Events of the run.
    pub events: Vec<EventDocument>,
    /// Verdict of every joint and drive at the start, by name.
    pub reactions: Named<RunReactionDocument>,
    /// Decisions before the run, in short.
    pub plan: Named<String>,
    /// Components that were run separately.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub components: Vec<ComponentRunDocument>,
}

/// Numbers of a component that was run separately.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ComponentRunDocument {
    /// Its bodies as text.
    pub name: String,
    /// Integrator.
    pub method: &'static str,
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
    /// Quaternions that were scaled to length one at accepted steps.
    pub normalisations: u64,
    /// Largest |Φ|.
    pub max_position_residual: f64,
    /// Largest |C·v − b|.
    pub max_velocity_residual: f64,
    /// Largest |E − E₀ − work| relative to its largest kinetic energy.
    pub energy_balance: f64,
    /// Decisions about it, in short.
    pub plan: Named<String>,
}

/// An event.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct EventDocument {
    /// Time (s).
    pub time: f64,
    /// Kind of event.
    pub kind: &'static str,
    /// Degree of redundancy before.
    pub redundancy_before: usize,
    /// Degree of redundancy after.
    pub redundancy_after: usize,
    /// Rows deleted after the event.
    pub deleted_rows: Vec<usize>,
    /// Description.
    pub text: String,
}

/// The verdict of a reaction of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct RunReactionDocument {
    /// The verdict.
    #[serde(flatten)]
    pub verdict: VerdictDocument,
    /// How strongly it depends on the data at the start.
    #[serde(flatten)]
    pub data: SensitivityDocument,
    /// The choice on which its numbers depend if they are not unique.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub choice: Option<ChoiceDocument>,
}

/// The choice by which a non-unique reaction has a number.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "method", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum ChoiceDocument {
    /// The multipliers of some rows were set to zero.
    KeptRows {
        /// These rows.
        deleted_rows: Vec<usize>,
        /// Time from which other rows are deleted (s; see the events); absent if never.
        #[serde(skip_serializing_if = "Option::is_none")]
        valid_until: Option<f64>,
    },
}

impl ChoiceDocument {
    /// The choice on which the reaction of a joint or drive depends: that of its component, if
    /// there are several.
    fn of(run: &Run<'_>, parts: Option<&[Vec<usize>]>, group: usize) -> Self {
        let prepared = run.plan.prepared();
        let components = &run.summary.components;
        let own = components.iter().find(|c| c.places.groups.contains(&group));
        let summary = own.map_or(run.summary, |component| &component.summary);
        // Rows requested by the user are used for the reactions throughout, whatever rows the
        // motion keeps.
        let automatic = prepared.choice == RowChoice::Automatic;
        let exchange = |e: &&Event| automatic && e.kind == EventKind::RowsExchanged;
        let belongs = |row: &&usize| own.is_none_or(|c| c.places.rows.contains(row));
        let dropped = match parts {
            Some(parts) => parts[group].iter().filter(belongs),
            None => prepared.decision.dropped.iter().filter(belongs),
        };
        Self::KeptRows {
            deleted_rows: dropped.map(|row| row + 1).collect(),
            valid_until: summary.events.iter().find(exchange).map(|e| e.time),
        }
    }
}

/// For each joint and drive of a large mechanism, the deleted rows on common cycles with it, from
/// 0; no other rows affect its reaction.
fn dropped_by_group(prepared: &Prepared) -> Option<Vec<Vec<usize>>> {
    let (mechanism, layout) = (&prepared.mechanism, prepared.mechanism.layout());
    if layout.rows() <= ONE_PART {
        return None;
    }
    let mut s = mechanism.scratch();
    mechanism.pose(0.0, &prepared.q, &mut s);
    mechanism.c(&mut s);
    let is_dropped = |row: &usize| prepared.decision.dropped.binary_search(row).is_ok();
    let mut of_group = vec![Vec::new(); layout.groups.len()];
    for part in parts(mechanism, &s) {
        let rows = part.iter().flat_map(|&k| layout.groups[k].rows.clone());
        let dropped: Vec<usize> = rows.filter(is_dropped).collect();
        part.iter().for_each(|&k| of_group[k].clone_from(&dropped));
    }
    Some(of_group)
}

impl fmt::Display for ChoiceDocument {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::KeptRows { deleted_rows, .. } => {
                let rows: Vec<String> = deleted_rows.iter().map(usize::to_string).collect();
                let word = if rows.len() == 1 { "row" } else { "rows" };
                write!(f, "kept-rows, {word} {} deleted", listed(&rows))
            }
        }
    }
}

impl RunDocument {
    /// What a run that ended early has kept, in words.
    #[must_use]
    pub fn kept(&self) -> String {
        let tables = self.files.iter().filter(|name| name.ends_with(".csv"));
        let tables: Vec<&str> = tables.copied().collect();
        let rows = match (self.rows, tables.as_slice()) {
            (_, []) => "summary.json".to_owned(),
            (1, tables) => format!("1 row in {}", tables.join(" and ")),
            (n, tables) => format!("{n} rows in {}", tables.join(" and ")),
        };
        format!(
            "kept: {rows}, up to t = {} s; summary.json says that they are partial",
            rounded(self.t_end)
        )
    }

    /// The document of a run.
    #[must_use]
    pub fn new(run: &Run<'_>) -> Self {
        let (prepared, summary) = (run.plan.prepared(), run.summary);
        let options = run.plan.options();
        let (code, error) = match run.ending {
            Ending::Complete => (None, None),
            Ending::Interrupted => (Some(const { Code::new(8) }), None),
            Ending::Stopped(error) => (Some(error.code()), Some(error.to_string())),
        };
        let parts = dropped_by_group(prepared);
        let reactions = run.reactions.iter().map(|r| {
            let is_unique = r.wrench.verdict.is_unique();
            let document = RunReactionDocument {
                verdict: (&r.wrench).into(),
                data: SensitivityDocument::of(run.sensitivities, r.id, prepared.mechanism.layout()),
                choice: (!is_unique).then(|| ChoiceDocument::of(run, parts.as_deref(), r.id.0)),
            };
            (r.name.clone(), document)
        });
        Self {
            method: run.summary.method.name(),
            formulation: FORMULATION,
            stabilisation: options.stabilisation.name(),
            partial: code.is_some(),
            code,
            error,
            t_end: summary.t,
            rows: run.rows,
            files: run.files.to_vec(),
            steps: summary.steps,
            rejected: summary.rejected,
            evaluations: summary.evaluations,
            projections: summary.projections,
            normalisations: summary.normalisations,
            wall_seconds: summary.wall_seconds,
            max_position_residual: summary.max_position_residual,
            max_velocity_residual: summary.max_velocity_residual,
            energy_balance: summary.energy_balance,
            start_correction: largest(&prepared.assembly.correction),
            start_velocity_correction: largest(&prepared.velocity_correction),
            mobility: run.freedoms.mobility,
            freedoms: FreedomsDocument::new(run.freedoms, &prepared.mechanism),
            data: run.data,
            misfits: summary.misfits.iter().map(Into::into).collect(),
            spread: run.spread.cloned(),
            events: summary.events.iter().map(Into::into).collect(),
            reactions: Named(reactions.collect()),
            plan: short(run.plan),
            components: summary
                .components
                .iter()
                .zip(&run.plan.components)
                .map(|(component, plan)| ComponentRunDocument::new(component, short_of(plan)))
                .collect(),
        }
    }
}

impl ComponentRunDocument {
    fn new(component: &ComponentSummary, plan: Named<String>) -> Self {
        let summary = &component.summary;
        Self {
            name: component.name.clone(),
            method: summary.method.name(),
            t_end: summary.t,
            steps: summary.steps,
            rejected: summary.rejected,
            evaluations: summary.evaluations,
            projections: summary.projections,
            normalisations: summary.normalisations,
            max_position_residual: summary.max_position_residual,
            max_velocity_residual: summary.max_velocity_residual,
            energy_balance: summary.energy_balance,
            plan,
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
