//! The plan of a run in short form for its summary.

use dynamics::plan::{ComponentPlan, Line, Plan};

use super::ByName;

/// Returns the decisions about the whole mechanism. If there is only one component, the decisions
/// about this component are included.
pub(super) fn short(plan: &Plan<'_>) -> ByName<String> {
    let lines = plan.lines().into_iter();
    named(lines.filter(|line| line.component.is_none()))
}

/// Returns the decisions about one of several components.
pub(super) fn short_of(component: &ComponentPlan<'_>) -> ByName<String> {
    named(component.decisions.lines().into_iter())
}

fn named<'p>(lines: impl Iterator<Item = Line<'p>>) -> ByName<String> {
    ByName(
        lines
            .map(|line| (decision_key(line.decision), line.taken.to_owned()))
            .collect(),
    )
}

/// Converts the name of a decision to a key of documents.
#[must_use]
pub fn decision_key(decision: &str) -> String {
    decision.replace(' ', "_")
}
