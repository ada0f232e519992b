//! The plan of a run: complete for `plan --json`, and short for `summary.json`.

use dynamics::plan::{ComponentPlan, Line, Plan, Saving};
use serde::Serialize;

use super::Named;

/// The document of `plan --json`.
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
    /// Estimated upper bound on the memory of a run, including reading (bytes).
    pub memory: usize,
    /// Components that are independent of each other; one if all bodies affect each other.
    pub components: Vec<PlannedComponentDocument>,
    /// The decisions.
    pub decisions: Vec<DecisionDocument>,
    /// What evaluates the runs of a sweep, if one was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sweep: Option<String>,
}

/// Bodies that affect each other.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct PlannedComponentDocument {
    /// Its bodies as text, as used in decisions.
    pub name: String,
    /// Names of its bodies.
    pub bodies: Vec<String>,
    /// Number of velocities.
    pub velocities: usize,
    /// Number of holonomic rows.
    pub holonomic_rows: usize,
    /// Number of nonholonomic rows.
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
    /// The component to which it applies, if there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub component: Option<String>,
    /// The question that is decided.
    pub decision: String,
    /// The decision.
    pub taken: String,
    /// Its reason.
    pub reason: String,
    /// The computations that it saves, if they can be counted.
    pub saves: Option<SavingDocument>,
}

/// The computations that a decision saves.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SavingDocument {
    /// Number of omitted items.
    pub left_out: u64,
    /// Number of all items.
    pub of: u64,
    /// Kind of the items, and how often they occur.
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
            sweep: None,
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
