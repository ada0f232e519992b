//! Verdicts on groups that the user defines. A group is a set of several reactions, one number
//! computed from their components, a sum of wrenches, or all loads on a set of bodies. The user
//! decides the purpose of a group, so each kind of group has its own verdict.

mod configuration;
mod error;
mod form;
mod group;
mod numbers;
mod reactions;

use crate::judged::ComponentVerdict;
use model::{ConstraintId, Mechanism, SpaceKind};
use rank::RankDecision;

pub use configuration::Configuration;
pub use error::RequestError;
pub(crate) use error::{check, check_finite, unknown_component};
pub use form::LinearForm;
pub(crate) use group::NO_REACTION;
pub use group::{Group, Term};
pub use numbers::GroupNumbers;
pub use reactions::ReactionForms;

use crate::verdict::{Judgement, worst};

/// The verdict on a group: whether its components are unique.
#[derive(Clone, Debug)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct GroupVerdict {
    /// Verdict on the whole group. If the group has parts, it is not unique if one part is not
    /// unique. Otherwise it is undecided if one part is undecided.
    pub judgement: Judgement,
    /// The space of the mechanism.
    pub space: SpaceKind,
    /// Force and torque of a sum of wrenches or a resultant; empty for other groups.
    pub components: Vec<ComponentVerdict>,
    /// The point (m, ground axes) about which the torque of these components is taken.
    pub about: Option<[f64; 3]>,
}

/// Determines the verdicts on groups at time t and coordinates q, at which the rank has been
/// decided.
///
/// # Errors
/// - [`RequestError::UnknownReaction`], [`RequestError::UnknownComponent`],
///   [`RequestError::UnknownBody`]: a group contains an element that does not exist.
/// - [`RequestError::Empty`]: a group is empty.
/// - [`RequestError::NotFinite`], [`RequestError::Length`]: a coefficient is not a finite number,
///   or t, q and the decision do not fit the mechanism.
pub fn judge_groups(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    decision: &RankDecision,
    groups: &[Group],
) -> Result<Vec<GroupVerdict>, RequestError> {
    let configuration = Configuration::new(mechanism, t, q, decision)?;
    groups.iter().map(|g| configuration.group(g)).collect()
}

impl Configuration<'_> {
    /// Returns the verdict on a group.
    ///
    /// # Errors
    /// Returns the same errors as [`judge_groups`].
    pub fn group(&self, group: &Group) -> Result<GroupVerdict, RequestError> {
        self.group_about(group, self.reactions.about(group)?)
    }

    /// Works like [`Self::group`], but the torques T of wrenches are about this point.
    pub(crate) fn group_about(
        &self,
        group: &Group,
        about: Option<[f64; 3]>,
    ) -> Result<GroupVerdict, RequestError> {
        match group {
            Group::Members(members) => {
                let each = self.reactions.rows_of(members)?.into_iter();
                let judged = each.map(|rows| self.solvability.group(rows));
                worst(judged.collect::<Result<Vec<_>, _>>()?.into_iter())
                    .map(|judgement| whole(self.layout().space, judgement))
                    .ok_or(NO_REACTION)
            }
            Group::OneJoint(members) => self.one_joint(members),
            Group::Combination(terms) => Ok(whole(
                self.layout().space,
                self.judge(&self.reactions.combination(terms)?)?,
            )),
            Group::WrenchSum(_) | Group::Resultant(_) => {
                let forms = self.reactions.numbers_about(group, about)?;
                let judged = forms.iter().map(|(_, form)| self.judge(form));
                let judged = judged.collect::<Result<Vec<_>, _>>()?;
                let named = forms.iter().map(|(name, _)| *name).zip(&judged);
                Ok(GroupVerdict {
                    space: self.layout().space,
                    components: named
                        .map(|(name, judgement)| ComponentVerdict {
                            name,
                            judgement: judgement.clone(),
                        })
                        .collect(),
                    judgement: worst(judged.into_iter()).ok_or(NO_REACTION)?,
                    about,
                })
            }
        }
    }

    /// Returns the verdict on the sum of the reactions of several joints on each body: `Σ
    /// C_Xᵀ·λ_X`. Each joint is counted once.
    fn one_joint(&self, members: &[ConstraintId]) -> Result<GroupVerdict, RequestError> {
        let mut rows: Vec<usize> = self
            .reactions
            .rows_of(members)?
            .into_iter()
            .flatten()
            .collect();
        rows.sort_unstable();
        rows.dedup();
        let mut judgements = Vec::new();
        for body in 0..self.reactions.mechanism.bodies().len() {
            for form in self
                .reactions
                .resultant(&[body], self.reactions.origin(body)?)?
            {
                judgements.push(self.judge(&form.only(&rows))?);
            }
        }
        worst(judgements.into_iter())
            .map(|judgement| whole(self.layout().space, judgement))
            .ok_or(RequestError::Empty { of: "body" })
    }
}

fn whole(space: SpaceKind, judgement: Judgement) -> GroupVerdict {
    GroupVerdict {
        space,
        judgement,
        components: Vec::new(),
        about: None,
    }
}
