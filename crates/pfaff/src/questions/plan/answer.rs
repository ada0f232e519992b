//! The plan of a run.

use std::fmt;

use crate::documents::decision_key;
use dynamics::plan::{ComponentPlan, Line, Plan, Saving};
use serde::Serialize;

/// The computed and omitted results of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct PlanAnswer {
    /// Name of the scene.
    pub scene: String,
    /// End time of the run (s).
    pub t_end: f64,
    /// Treatment of redundancy.
    pub formulation: &'static str,
    /// Method against constraint drift.
    pub stabilisation: &'static str,
    /// Estimated upper bound on the memory of a run, including reading (bytes).
    pub memory: usize,
    /// Components that are independent of each other; there is one component if all bodies affect
    /// each other.
    pub components: Vec<PlannedComponent>,
    /// The decisions.
    pub decisions: Vec<PlannedDecision>,
    /// Evaluation method for the runs of a sweep, if a sweep was requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sweep: Option<String>,
}

/// Bodies that affect each other.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct PlannedComponent {
    /// Bodies of the component as text, as used in decisions.
    pub name: String,
    /// Names of the bodies.
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
    /// Integrator of the component.
    pub method: &'static str,
}

/// One decision.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct PlannedDecision {
    /// The component to which it applies, if there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub component: Option<String>,
    /// The question that is decided.
    pub decision: String,
    /// The decision.
    pub taken: String,
    /// Reason for the decision.
    pub reason: String,
    /// The computations that it saves, if they can be counted.
    pub saves: Option<PlannedSaving>,
}

/// The computations that a decision saves.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct PlannedSaving {
    /// Number of omitted items.
    pub left_out: u64,
    /// Number of all items.
    pub of: u64,
    /// Kind of the items, and how often they occur.
    pub what: &'static str,
}

impl PlanAnswer {
    /// Builds the answer of a plan, with the memory (bytes) that the run needs.
    pub(super) fn new(plan: &Plan<'_>, memory: usize, sweep: Option<String>) -> Self {
        let options = plan.options();
        Self {
            scene: plan.prepared().mechanism.name().to_owned(),
            t_end: options.t_end,
            formulation: dynamics::FORMULATION,
            stabilisation: options.stabilisation.name(),
            memory,
            components: plan.components.iter().map(Into::into).collect(),
            decisions: plan.lines().into_iter().map(Into::into).collect(),
            sweep,
        }
    }
}

impl From<&ComponentPlan<'_>> for PlannedComponent {
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

impl From<Line<'_>> for PlannedDecision {
    fn from(line: Line<'_>) -> Self {
        Self {
            component: line.component.map(str::to_owned),
            decision: decision_key(line.decision),
            taken: line.taken.to_owned(),
            reason: line.reason.to_owned(),
            saves: line.saves.map(Into::into),
        }
    }
}

impl From<Saving> for PlannedSaving {
    fn from(saving: Saving) -> Self {
        Self {
            left_out: saving.left_out,
            of: saving.of,
            what: saving.what.name(),
        }
    }
}

impl fmt::Display for PlannedSaving {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} of {} {}", self.left_out, self.of, self.what)
    }
}
