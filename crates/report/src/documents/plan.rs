//! The plan of a run: whole for `plan --json`, and in short for `summary.json`.

use dynamics::plan::{ComponentPlan, Line, Plan, Saving};
use serde::Serialize;

use super::Named;

/// `plan --json`
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct PlanDocument {
    /// Name of the scene.
    pub scene: String,
    /// Last time of the run (s).
    pub t_end: f64,
    /// Treatment of redundancy.
    pub formulation: &'static str,
    /// Treatment of drift.
    pub stabilisation: &'static str,
    /// What a run takes of memory at most, about, reading included (bytes).
    pub memory: usize,
    /// Components that do not feel each other; one, if all bodies do.
    pub components: Vec<PlannedComponentDocument>,
    /// What was decided.
    pub decisions: Vec<DecisionDocument>,
}

/// Bodies that feel each other.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct PlannedComponentDocument {
    /// Its bodies in words, as decisions name it.
    pub name: String,
    /// Names of its bodies.
    pub bodies: Vec<String>,
    /// Velocities.
    pub velocities: usize,
    /// Holonomic rows.
    pub holonomic_rows: usize,
    /// Nonholonomic rows.
    pub nonholonomic_rows: usize,
    /// Rank of C.
    pub rank: usize,
    /// Degree of redundancy.
    pub redundancy: usize,
    /// Degrees of freedom.
    pub mobility: usize,
    /// Its integrator.
    pub method: &'static str,
}

/// One decision.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct DecisionDocument {
    /// The component that it is of, where there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub component: Option<String>,
    /// What was to be decided.
    pub decision: String,
    /// What was decided.
    pub taken: String,
    /// Why.
    pub reason: String,
    /// What it saves, where that can be counted.
    pub saves: Option<SavingDocument>,
}

/// What a decision saves.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SavingDocument {
    /// How many are left out.
    pub left_out: u64,
    /// Of how many.
    pub of: u64,
    /// Of what, and how often.
    pub what: &'static str,
}

impl PlanDocument {
    /// The document of a plan.
    #[must_use]
    pub fn new(plan: &Plan<'_>, memory: usize) -> Self {
        let options = plan.options();
        Self {
            scene: plan.prepared().mechanism.name().to_owned(),
            t_end: options.t_end,
            formulation: dynamics::FORMULATION,
            stabilisation: options.stabilisation.name(),
            memory,
            components: plan.components.iter().map(Into::into).collect(),
            decisions: plan.lines().into_iter().map(Into::into).collect(),
        }
    }
}

impl From<&ComponentPlan<'_>> for PlannedComponentDocument {
    fn from(component: &ComponentPlan<'_>) -> Self {
        let sizes = &component.sizes;
        let bodies = component.prepared().mechanism.bodies();
        Self {
            name: component.name.clone(),
            bodies: bodies.iter().map(|b| b.name.clone()).collect(),
            velocities: sizes.velocities,
            holonomic_rows: sizes.holonomic,
            nonholonomic_rows: sizes.nonholonomic,
            rank: sizes.rank,
            redundancy: sizes.redundancy(),
            mobility: sizes.mobility(),
            method: component.decisions.method.value.name(),
        }
    }
}

impl From<Line<'_>> for DecisionDocument {
    fn from(line: Line<'_>) -> Self {
        Self {
            component: line.component.map(str::to_owned),
            decision: key(line.decision),
            taken: line.taken.to_owned(),
            reason: line.reason.to_owned(),
            saves: line.saves.map(Into::into),
        }
    }
}

impl From<Saving> for SavingDocument {
    fn from(saving: Saving) -> Self {
        Self {
            left_out: saving.left_out,
            of: saving.of,
            what: saving.what.name(),
        }
    }
}

/// The decisions about the whole, and about its only component if there is one.
pub(super) fn short(plan: &Plan<'_>) -> Named<String> {
    let lines = plan.lines().into_iter();
    named(lines.filter(|line| line.component.is_none()))
}

/// The decisions about one of several components.
pub(super) fn short_of(component: &ComponentPlan<'_>) -> Named<String> {
    named(component.decisions.lines().into_iter())
}

fn named<'p>(lines: impl Iterator<Item = Line<'p>>) -> Named<String> {
    Named(
        lines
            .map(|line| (key(line.decision), line.taken.to_owned()))
            .collect(),
    )
}

/// The name of a decision as a key.
fn key(decision: &str) -> String {
    decision.replace(' ', "_")
}
