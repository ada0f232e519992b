//! Sensitivities of sums, of components in other frames and of moments, in the document of a
//! configuration.

use model::{ConstraintId, System};
use report::AnalysisDocument;
use report::documents::GroupDocument;
use solvability::{
    ComponentVerdict, Group, GroupSensitivities, GroupVerdict, ReactionNumber, Sensitivities,
};

use super::{ConfigurationAnalysis, requests};
use crate::error::StudyError;

/// Axes of the ground.
const UNITS: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

impl ConfigurationAnalysis<'_> {
    /// Adds the verdicts of all reactions in other frames to a document of this configuration, with
    /// their sensitivities.
    ///
    /// # Errors
    /// [`StudyError::Request`], [`StudyError::Choice`]
    pub fn add_frames(&self, document: &mut AnalysisDocument) -> Result<(), StudyError> {
        let layout = self.mechanism.layout();
        let (mut all, mut numbers) = (Vec::new(), Vec::new());
        for id in layout.constraint_ids() {
            let frames = self.frames(id)?;
            for found in &frames {
                let number = |k: usize| ReactionNumber::in_frame(id, found.frame, k);
                numbers.extend(unique(&found.components).map(number));
            }
            all.push(frames);
        }
        document.add_frames(&all);
        document.add_frame_sensitivities(self.sensitivities_of(&numbers)?, layout);
        Ok(())
    }

    /// Adds the verdicts on the moments of these reactions about a point (m, ground axes) to a
    /// document of this configuration, with their sensitivities.
    ///
    /// # Errors
    /// [`StudyError::Request`], [`StudyError::Choice`]
    pub fn add_moments(
        &self,
        document: &mut AnalysisDocument,
        ids: impl IntoIterator<Item = ConstraintId>,
        about: [f64; 3],
    ) -> Result<(), StudyError> {
        let layout = self.mechanism.layout();
        let space = layout.space;
        let mut numbers = Vec::new();
        for id in ids {
            let found = self.moment(id, about)?;
            let axis = |k: usize| UNITS[space.axis_of(space.torques().start + k)];
            let moment = |k: usize| ReactionNumber::moment(id, axis(k), about);
            numbers.extend(unique(&found.components).map(moment));
            document.add_moment(id, space, &found);
        }
        document.add_moment_sensitivities(self.sensitivities_of(&numbers)?, layout);
        Ok(())
    }

    /// The verdict on a sum of reactions as [`ConfigurationAnalysis::group`], with its numbers and
    /// sensitivities where they are unique.
    ///
    /// # Errors
    /// As [`ConfigurationAnalysis::group`], and [`StudyError::Choice`].
    pub fn group_document(&self, combination: &str) -> Result<GroupDocument, StudyError> {
        let group = requests::combination(self.scene, self.mechanism, combination)?;
        let verdict = self.questions.group(&group)?;
        let mut document = GroupDocument::new(combination, &verdict);
        if let Ok(solution) = self.solution() {
            document = document.with_values(&self.questions.determined(&group, &solution)?);
        }
        let found = match &group {
            Group::Members(_) => {
                self.sensitivities_of_groups(&[(&group, &verdict)], &self.sensitivities()?)?
            }
            _ => self.sensitivities_of_groups(&[(&group, &verdict)], &Sensitivities::default())?,
        };
        document.add_sensitivities(&found[0], self.mechanism.layout());
        Ok(document)
    }

    /// How strongly the numbers of the groups of the scene depend on the data, by their names; what
    /// is not unique, or not known, has no sensitivity. `reactions` are those of
    /// [`ConfigurationAnalysis::sensitivities`].
    ///
    /// # Errors
    /// [`StudyError::Choice`], and as [`ConfigurationAnalysis::reaction`].
    pub fn group_sensitivities(
        &self,
        reactions: &Sensitivities,
    ) -> Result<Vec<(String, GroupSensitivities)>, StudyError> {
        let groups = requests::groups(self.scene, self.mechanism, &[])?;
        // A group of a part that is too large has no verdict here.
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

    /// How strongly the unique numbers of these groups depend on the data.
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

/// The places of unique components.
fn unique(components: &[ComponentVerdict]) -> impl Iterator<Item = usize> + '_ {
    let all = components.iter().enumerate();
    all.filter(|(_, c)| c.judgement.verdict.is_unique())
        .map(|(k, _)| k)
}
