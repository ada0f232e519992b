//! `summary.json` of a run.

use std::fmt;

use dynamics::{ComponentSummary, Event, FORMULATION, MotionError, Plan, ReactionImpulse, Summary};
use model::codes::Code;
use model::words::{listed, rough, rounded};
use model::{Layout, System};
use serde::Serialize;
use solvability::{Freedoms, ReactionVerdict, Sensitivities};

use super::plan::{short, short_of};
use super::{
    ByName, DataDocument, FreedomsDocument, Gap, ImpulseDocument, MagnitudeOfRunDocument,
    MisfitDocument, RangeOfRunDocument, RunBoundsDocument, RunGroupDocument, RunReactionDocument,
    RunVerdicts, SpecialDocument, SpreadDocument, from_one,
};

/// Largest error of the energy balance without a warning, as a fraction of the largest kinetic
/// energy. With the default tolerances, the error is below a thousandth of this limit. Errors above
/// the limit are visible in a plot.
pub const TRUSTED_BALANCE: f64 = 1e-3;

/// A run and its results.
#[derive(Clone, Copy)]
pub struct Run<'a> {
    /// Plan of the run with its start and its independent rows.
    pub plan: &'a Plan<'a>,
    /// Verdicts at the start of the run.
    pub reactions: &'a [ReactionVerdict],
    /// Sensitivities of the reactions to the data at the start.
    pub sensitivities: &'a Sensitivities,
    /// Tolerances of the data, and the results that depend on the tolerances.
    pub data: DataDocument,
    /// The possible motions at the start.
    pub freedoms: &'a Freedoms,
    /// Verdicts and peaks of the run; `None` if no reactions were requested.
    pub verdicts: Option<RunVerdicts<'a>>,
    /// Numerical summary of the run.
    pub summary: &'a Summary,
    /// The difference between this motion and the motion on other rows, if rows are violated.
    pub spread: Option<&'a SpreadDocument>,
    /// How the run ended.
    pub ending: Ending<'a>,
    /// Number of rows in the tables of the run.
    pub rows: usize,
    /// Names of the files of the run.
    pub files: &'a [String],
    /// The rows without numbers for each choice of the plan.
    pub gaps: &'a [Option<Gap>],
}

/// How a run ended.
#[derive(Clone, Copy, Debug)]
pub enum Ending<'a> {
    /// The run reached its end time.
    Complete,
    /// The run was interrupted. The results up to this time are valid.
    Interrupted,
    /// The run stopped with this error. The results up to this time are valid.
    Stopped(&'a MotionError),
}

/// Numbers, events and verdicts of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct RunDocument {
    /// The load case whose values the scene has, if it has those of one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub case: Option<String>,
    /// Integrator; `auto` if components have different ones.
    pub method: &'static str,
    /// Treatment of redundancy.
    pub formulation: &'static str,
    /// Method against constraint drift.
    pub stabilisation: &'static str,
    /// Whether the run ended before its end time.
    pub partial: bool,
    /// Code of the reason why the run ended early.
    pub code: Option<Code>,
    /// Reason why the run ended early.
    pub error: Option<String>,
    /// Last time reached (s).
    pub t_end: f64,
    /// Number of rows in the tables.
    pub rows: usize,
    /// Names of the files of the run.
    pub files: Vec<String>,
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
    /// Largest |E − E₀ − work| relative to the largest kinetic energy, or an upper bound on this
    /// value if there are several components.
    pub energy_balance: f64,
    /// Largest change of a coordinate by the assembly (m or rad).
    pub start_correction: f64,
    /// Largest change of a velocity at the start (m/s or rad/s).
    pub start_velocity_correction: f64,
    /// Rank of C at the start.
    pub rank: usize,
    /// Degree of redundancy at the start, number of rows − rank.
    pub redundancy: usize,
    /// Degrees of freedom at the start, n_v − r.
    pub mobility: usize,
    /// The possible motions at the start, with the drives and without them.
    #[serde(flatten)]
    pub freedoms: FreedomsDocument,
    /// Tolerances of the data, and the results at the start that depend on the tolerances.
    pub data: DataDocument,
    /// Largest violations of rows that are redundant only within the stated tolerance.
    pub misfits: Vec<MisfitDocument>,
    /// Difference to the motion on another choice of rows; `null` if no row is violated.
    pub spread: Option<SpreadDocument>,
    /// Events of the run.
    pub events: Vec<EventDocument>,
    /// Verdicts of every joint and drive, by name.
    pub reactions: ByName<RunReactionDocument>,
    /// Verdicts of the groups of the scene, by name.
    #[serde(skip_serializing_if = "ByName::is_empty")]
    pub groups: ByName<RunGroupDocument>,
    /// Extreme values of the loads of force elements, by name.
    #[serde(skip_serializing_if = "ByName::is_empty")]
    pub loads: ByName<LoadOfRunDocument>,
    /// The tables of all loads on bodies, by the names of the bodies.
    #[serde(skip_serializing_if = "ByName::is_empty")]
    pub bodies: ByName<BodyOfRunDocument>,
    /// The assumptions of the bounds, if bounds were requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bounds: Option<RunBoundsDocument>,
    /// Contacts that pull although the scene does not describe them as one-sided, in the order of
    /// time.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub pulls: Vec<PullDocument>,
    /// Instants at which a verdict differs from the verdict of its stretch of the run.
    pub special: Vec<SpecialDocument>,
    /// The choices that determine the numbers of `choice.csv` and of further files; empty if every
    /// number is determined.
    pub choice: Vec<ChoiceDocument>,
    /// Decisions before the run, in short form.
    pub plan: ByName<String>,
    /// Components that were run separately.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub components: Vec<ComponentRunDocument>,
}

/// Numbers of a component that was run separately.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ComponentRunDocument {
    /// Bodies of the component as text.
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
    /// Largest |E − E₀ − work| relative to the largest kinetic energy of the component.
    pub energy_balance: f64,
    /// Decisions about the component, in short form.
    pub plan: ByName<String>,
}

/// An event of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct EventDocument {
    /// Time (s).
    pub time: f64,
    /// Kind of event.
    pub kind: &'static str,
    /// Degree of redundancy before the event.
    pub redundancy_before: usize,
    /// Degree of redundancy after the event.
    pub redundancy_after: usize,
    /// Rows deleted after the event.
    pub deleted_rows: Vec<usize>,
    /// Description.
    pub text: String,
    /// Impulses of joints and drives at a jump of velocities, by name and component, with the
    /// verdicts at this instant.
    #[serde(skip_serializing_if = "ByName::is_empty")]
    pub impulses: ByName<ImpulseDocument>,
}

/// Extreme values of a load over the rows of a run. The model determines the loads of force
/// elements at every state.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LoadOfRunDocument {
    /// The largest magnitudes of force and moment.
    pub peak: MagnitudeOfRunDocument,
    /// The smallest and the largest value of each component on the first body (N, N·m), of the
    /// `length` (m) or `angle` (rad), and of its `rate`.
    pub components: ByName<RangeOfRunDocument>,
}

/// A contact that pulls.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PullDocument {
    /// Name of the joint.
    pub joint: String,
    /// The first time at which the joint pulls (s).
    pub from: f64,
    /// The largest force with which it pulls (N).
    pub force: f64,
    /// The time of this force (s).
    pub time: f64,
}

/// The table of all loads on a body.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct BodyOfRunDocument {
    /// Name of the file.
    pub file: String,
    /// Whether the loads are those of the first choice, because the model does not determine them
    /// during the whole run.
    pub choice: bool,
    /// Number of rows that the table omits, because a reaction is not determined.
    pub rows_left_out: usize,
}

/// The choice that determines the numbers of a table, on an interval of time.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ChoiceDocument {
    /// Name of the table; absent if there is only one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Time of the first row of the table (s).
    pub from: f64,
    /// Time up to which the choice is valid (s).
    pub to: f64,
    /// Name of the choice: `kept-rows` if the run selects the rows with zero multipliers; otherwise
    /// the name of the requested choice.
    pub name: String,
    /// Rows whose multipliers are zero by choice.
    pub deleted_rows: Vec<usize>,
    /// Rows of the table at which the choice selects no solution; their cells are empty.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gap: Option<Gap>,
}

/// Returns the file name of the table of a choice, counted from 0.
#[must_use]
pub fn choice_file(k: usize) -> String {
    match k {
        0 => "choice.csv".to_owned(),
        k => format!("choice_{}.csv", k + 1),
    }
}

impl ChoiceDocument {
    /// Returns the choices of a run, file by file in the order of time.
    fn of(run: &Run<'_>) -> Vec<Self> {
        let (choices, summary) = (&run.plan.choices, run.summary);
        if choices.is_empty() {
            return Self::of_kept_rows(summary);
        }
        let several = choices.len() > 1;
        let each = choices.iter().enumerate();
        each.map(|(k, named)| Self {
            file: several.then(|| choice_file(k)),
            from: 0.0,
            to: summary.t,
            name: named.label.to_string(),
            deleted_rows: from_one(named.choice.eliminated()),
            gap: run.gaps.get(k).cloned().flatten(),
        })
        .collect()
    }

    /// Returns the choices of independent rows during a run, in the order of time.
    fn of_kept_rows(summary: &Summary) -> Vec<Self> {
        let all = &summary.dropped;
        let ends = all.iter().skip(1).map(|next| next.from).chain([summary.t]);
        let each = all.iter().zip(ends);
        each.map(|(dropped, to)| Self {
            file: None,
            from: dropped.from,
            to,
            name: FORMULATION.to_owned(),
            deleted_rows: from_one(&dropped.rows),
            gap: None,
        })
        .collect()
    }
}

impl fmt::Display for ChoiceDocument {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.name != FORMULATION {
            return f.write_str(&self.name);
        }
        let rows: Vec<String> = self.deleted_rows.iter().map(usize::to_string).collect();
        let word = if rows.len() == 1 { "row" } else { "rows" };
        write!(f, "{word} {} deleted", listed(&rows))
    }
}

impl RunDocument {
    /// Describes the saved results of a run that ended early.
    #[must_use]
    pub fn kept(&self) -> String {
        let tables = self.files.iter().filter(|name| name.ends_with(".csv"));
        let tables: Vec<&str> = tables.map(String::as_str).collect();
        let rows = match (self.rows, tables.as_slice()) {
            (_, []) => "summary.json".to_owned(),
            (1, tables) => format!("1 row in {}", tables.join(" and ")),
            (n, tables) => format!("{n} rows in {}", tables.join(" and ")),
        };
        format!(
            "kept: {rows}, up to t = {} s; summary.json marks the tables as partial",
            rounded(self.t_end)
        )
    }

    /// Warns about an error of the energy balance that is too large.
    #[must_use]
    pub fn energy_warning(&self) -> Option<String> {
        let is_large = self.energy_balance.is_nan() || self.energy_balance > TRUSTED_BALANCE;
        is_large.then(|| {
            format!(
                "the error of the energy balance is {} of the largest kinetic energy: do not trust this run; use tighter \
                 tolerances",
                rough(self.energy_balance)
            )
        })
    }

    /// The document of a run.
    #[must_use]
    pub fn new(run: &Run<'_>) -> Self {
        let (prepared, summary) = (run.plan.prepared(), run.summary);
        let options = run.plan.options();
        let (code, error) = match run.ending {
            Ending::Complete => (None, None),
            Ending::Interrupted => (
                Some(const { Code::new(8) }),
                Some("it was interrupted".to_owned()),
            ),
            Ending::Stopped(error) => (Some(error.code()), Some(error.to_string())),
        };
        let (mechanism, verdicts) = (&prepared.mechanism, run.verdicts.as_ref());
        let reactions = run.reactions.iter().map(|r| {
            let document = RunReactionDocument::new(r, verdicts, run.sensitivities, mechanism);
            (r.name.clone(), document)
        });
        let reactions = ByName(reactions.collect());
        let groups = verdicts.map_or_else(|| ByName(Vec::new()), |v| v.groups(mechanism.layout()));
        let has_choice = verdicts.is_some_and(RunVerdicts::has_choice);
        Self {
            case: None,
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
            rank: prepared.decision.rank,
            redundancy: prepared.decision.redundancy,
            mobility: run.freedoms.mobility,
            freedoms: FreedomsDocument::new(run.freedoms, &prepared.mechanism),
            data: run.data,
            misfits: summary.misfits.iter().map(Into::into).collect(),
            spread: run.spread.cloned(),
            events: (summary.events.iter())
                .map(|event| EventDocument::new(event, mechanism.layout()))
                .collect(),
            reactions,
            groups,
            loads: ByName(Vec::new()),
            bodies: ByName(Vec::new()),
            bounds: None,
            pulls: Vec::new(),
            special: verdicts.map_or_else(Vec::new, |v| {
                SpecialDocument::all(v.stretches, v.groups, mechanism.layout())
            }),
            choice: if has_choice {
                ChoiceDocument::of(run)
            } else {
                Vec::new()
            },
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
    fn new(component: &ComponentSummary, plan: ByName<String>) -> Self {
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

impl EventDocument {
    /// The document of an event.
    #[must_use]
    pub fn new(event: &Event, layout: &Layout) -> Self {
        let name = |impulse: &ReactionImpulse| layout.groups[impulse.id.0].name.clone();
        let impulses = event.impulses.iter();
        let impulses = impulses.map(|impulse| (name(impulse), impulse.into()));
        Self {
            time: event.time,
            kind: event.kind.name(),
            redundancy_before: event.redundancy_before,
            redundancy_after: event.redundancy_after,
            deleted_rows: from_one(&event.dropped),
            text: event.text.clone(),
            impulses: ByName(impulses.collect()),
        }
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |a, x| f64::max(a, x.abs()))
}
