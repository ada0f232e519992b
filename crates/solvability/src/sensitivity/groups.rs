//! Sensitivities of groups. The sensitivity of a sum belongs to the sum as a whole, not to its
//! terms.

use model::Mechanism;

use super::{ReactionNumber, Sensitivities};
use crate::analysis::Analysis;
use crate::choices::ChoiceError;
use crate::groups::{Group, GroupVerdict};
use crate::value::Sensitivity;

/// Sensitivities of the unique components of a group.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct GroupSensitivities {
    /// Sensitivities of the components, with the names of [`Group::number_names`]. The terms of a
    /// sum change together, so their changes may cancel in the sum.
    pub numbers: Vec<(&'static str, Sensitivity)>,
    /// The largest sensitivity of a component. If the group consists of several separate reactions
    /// that are all unique, the value is the largest sensitivity of these reactions. `None` if no
    /// component is unique, or if the sensitivity is not known.
    pub whole: Option<Sensitivity>,
}

impl GroupSensitivities {
    /// Returns the sensitivity of the unique component with this name.
    #[must_use]
    pub fn number(&self, name: &str) -> Option<&Sensitivity> {
        let mut numbers = self.numbers.iter();
        numbers.find(|(known, _)| *known == name).map(|(_, s)| s)
    }

    /// Returns whether a component of the group is sensitive to data (fragile).
    #[must_use]
    pub fn is_fragile(&self) -> bool {
        self.whole.as_ref().is_some_and(Sensitivity::is_fragile)
    }
}

impl Analysis {
    /// Computes how strongly the unique numbers of groups depend on the data, given their verdicts
    /// and the sensitivities of all reactions.
    ///
    /// # Errors
    /// Returns the same errors as [`Self::sensitivities`].
    pub fn group_sensitivities(
        &self,
        mechanism: &Mechanism,
        (q, v): (&[f64], &[f64]),
        groups: &[(&Group, &GroupVerdict)],
        reactions: &Sensitivities,
    ) -> Result<Vec<GroupSensitivities>, ChoiceError> {
        let (mut asked, mut numbers) = (Vec::new(), Vec::new());
        for (k, (group, verdict)) in groups.iter().enumerate() {
            for (name, number) in unique_numbers(mechanism, group, verdict)? {
                asked.push((k, name));
                numbers.push(number);
            }
        }
        let mut all = vec![GroupSensitivities::default(); groups.len()];
        let found = self.sensitivities_of(mechanism, q, v, &numbers)?;
        for ((k, name), found) in asked.into_iter().zip(found) {
            all[k].numbers.extend(found.map(|s| (name, s)));
        }
        for (own, (group, verdict)) in all.iter_mut().zip(groups) {
            let of_members: Vec<&Sensitivity> = match group {
                Group::Members(members) if verdict.judgement.verdict.is_unique() => {
                    let members = members.iter();
                    members.filter_map(|id| reactions.reaction(*id)).collect()
                }
                _ => Vec::new(),
            };
            let numbers = own.numbers.iter().map(|(_, s)| s);
            let largest = numbers
                .chain(of_members)
                .reduce(|a, b| if b.change > a.change { b } else { a });
            own.whole = largest.cloned();
        }
        Ok(all)
    }
}

/// Returns the unique numbers of a group, with their names.
fn unique_numbers(
    mechanism: &Mechanism,
    group: &Group,
    verdict: &GroupVerdict,
) -> Result<Vec<(&'static str, ReactionNumber)>, ChoiceError> {
    let numbers = ReactionNumber::of_group(mechanism, group, verdict.about)?;
    let is_unique = |k: usize| match verdict.components.get(k) {
        Some(component) => component.judgement.verdict.is_unique(),
        None => verdict.judgement.verdict.is_unique(),
    };
    let numbers = numbers.into_iter().enumerate();
    let unique = numbers.filter(|(k, _)| is_unique(*k));
    Ok(unique.map(|(_, number)| number).collect())
}
