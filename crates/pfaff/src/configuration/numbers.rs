//! Sensitivities of sums.

use solvability::{Group, GroupSensitivities, GroupVerdict, Sensitivities};

use super::{ConfigurationAnalysis, requests};
use crate::error::StudyError;

impl ConfigurationAnalysis<'_> {
    /// Computes the sensitivities of the numbers of the groups of the scene to the data, by group
    /// name. Numbers that are not unique or not known have no sensitivity. `reactions` contains the
    /// results of [`ConfigurationAnalysis::sensitivities`].
    ///
    /// # Errors
    /// [`StudyError::Choice`], and the errors of [`ConfigurationAnalysis::reaction`].
    pub fn group_sensitivities(
        &self,
        reactions: &Sensitivities,
    ) -> Result<Vec<(String, GroupSensitivities)>, StudyError> {
        let groups = requests::groups(self.scene, self.mechanism, &[])?;
        // A group has no verdict here if it involves a part that is too large.
        let judged: Vec<Option<GroupVerdict>> = groups
            .iter()
            .map(|(_, group)| self.questions.group(group).ok())
            .collect();
        let pairs = groups.iter().zip(&judged);
        let known = pairs.filter_map(|((_, group), verdict)| Some((group, verdict.as_ref()?)));
        let known: Vec<_> = known.collect();
        let mut found = self.sensitivities_of_groups(&known, reactions)?.into_iter();
        let named = groups.into_iter().zip(&judged);
        Ok(named
            .map(|((name, _), verdict)| {
                let own = verdict.as_ref().and_then(|_| found.next());
                (name, own.unwrap_or_default())
            })
            .collect())
    }

    /// Computes the sensitivities of the unique numbers of these groups to the data.
    pub(super) fn sensitivities_of_groups(
        &self,
        groups: &[(&Group, &GroupVerdict)],
        reactions: &Sensitivities,
    ) -> Result<Vec<GroupSensitivities>, StudyError> {
        if self.has_no_velocities() {
            return Ok(vec![GroupSensitivities::default(); groups.len()]);
        }
        let state = (&self.state.q[..], &self.state.v[..]);
        let analysis = &self.analysis;
        Ok(analysis.group_sensitivities(self.mechanism, state, groups, reactions)?)
    }
}
