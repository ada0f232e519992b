//! Sensitivities of sums, of components in other frames and of moments, in the document of a
//! configuration.

use model::{ConstraintId, System};
use report::AnalysisDocument;
use report::documents::GroupDocument;
use solvability::{ComponentVerdict, Group, GroupVerdict, ReactionNumber, Sensitivities};

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
        let numbers = self.numbers_of_group(&group, &verdict)?;
        let found = self.sensitivities_of(&numbers)?;
        document.add_sensitivities(found, self.mechanism.layout());
        Ok(document)
    }

    /// Adds the sensitivities of the groups of a document.
    pub(super) fn add_group_sensitivities(
        &self,
        document: &mut AnalysisDocument,
        groups: &[(Group, &GroupVerdict)],
        reactions: &Sensitivities,
    ) -> Result<(), StudyError> {
        let layout = self.mechanism.layout();
        for (document, (group, verdict)) in document.groups.iter_mut().zip(groups) {
            let found = match group {
                Group::Members(members) if verdict.judgement.verdict.is_unique() => {
                    let members = members
                        .iter()
                        .map(|id: &ConstraintId| reactions.reaction(*id));
                    members.map(|found| found.cloned()).collect()
                }
                _ => {
                    let numbers = self.numbers_of_group(group, verdict)?;
                    self.sensitivities_of(&numbers)?
                }
            };
            document.add_sensitivities(found, layout);
        }
        Ok(())
    }

    /// The unique numbers of a group.
    fn numbers_of_group(
        &self,
        group: &Group,
        verdict: &GroupVerdict,
    ) -> Result<Vec<ReactionNumber>, StudyError> {
        let numbers = ReactionNumber::of_group(self.mechanism, group, verdict.about)?;
        let is_unique = |(k, _): &(usize, _)| match verdict.components.get(*k) {
            Some(component) => component.judgement.verdict.is_unique(),
            None => verdict.judgement.verdict.is_unique(),
        };
        let numbers = numbers.into_iter().map(|(_, number)| number);
        let unique = numbers.enumerate().filter(is_unique);
        Ok(unique.map(|(_, number)| number).collect())
    }
}

/// The places of unique components.
fn unique(components: &[ComponentVerdict]) -> impl Iterator<Item = usize> + '_ {
    let all = components.iter().enumerate();
    all.filter(|(_, c)| c.judgement.verdict.is_unique())
        .map(|(k, _)| k)
}
