//! Whether contacts stay closed and hold, and the conditions that a choice violates.

use model::{ConstraintId, System};
use solvability::{ConditionKind, ContactCondition, Distribution, Impossible};

use crate::configuration::ConfigurationAnalysis;
use crate::contact_fault::ContactFault;
use crate::error::StudyError;

impl ConfigurationAnalysis<'_> {
    /// Returns why contacts do not all stay closed and hold under the loads of this configuration;
    /// `None` if they do, or if no contact has a condition.
    ///
    /// # Errors
    /// Returns an error if the equations have no solution here.
    pub fn contact_fault(&self) -> Result<Option<ContactFault>, StudyError> {
        let layout = self.mechanism.layout();
        if !layout.has_contact_limits() {
            return Ok(None);
        }
        let impossible = self
            .permitted(self.solution()?)
            .and_then(|found| found.map_or(Ok(Vec::new()), |found| found.impossible()));
        let proofs = match impossible {
            Ok(proofs) => proofs,
            Err(e) => return Ok(Some(ContactFault::Undecided(e))),
        };
        let names = |ids: Vec<ConstraintId>| {
            let names = ids.iter().map(|id| layout.groups[id.0].name.clone());
            names.collect::<Vec<_>>()
        };
        let (opening, slipping): (Vec<_>, Vec<_>) =
            proofs.iter().partition(|proof| proof.is_opening());
        let joints = |proofs: Vec<&Impossible>| {
            let weights = proofs.iter().flat_map(|proof| &proof.weights);
            let mut ids: Vec<ConstraintId> = weights.map(|(c, _)| c.joint).collect();
            ids.sort_unstable();
            ids.dedup();
            ids
        };
        if !opening.is_empty() {
            let state = (self.analysis.time, &self.state.q[..], &self.state.v[..]);
            let ids = solvability::opened(self.mechanism, state, &joints(opening));
            return Ok(Some(ContactFault::Opens(names(ids))));
        }
        let slips = !slipping.is_empty();
        Ok(slips.then(|| ContactFault::Slips(names(joints(slipping)))))
    }
}

/// Returns the conditions of contacts that a distribution violates, in words.
///
/// # Errors
/// Returns the reason why the conditions are not decided.
pub(crate) fn violated(
    of: &ConfigurationAnalysis<'_>,
    distribution: &Distribution,
) -> Result<Vec<String>, String> {
    let groups = &of.mechanism.layout().groups;
    let words = |c: &ContactCondition| {
        let verb = match c.kind {
            ConditionKind::Presses => "pulls",
            ConditionKind::Grips => "slips",
        };
        format!("`{}` {verb}", groups[c.joint.0].name)
    };
    let found = of.violated(distribution).map_err(|e| e.to_string())?;
    Ok(found.iter().map(words).collect())
}
