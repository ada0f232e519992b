//! Sensitivities of the reactions of an analysed configuration. Every unique component and every
//! unique direction has a sensitivity.

use model::{ConstraintId, Layout, Mechanism, System};

use super::ReactionNumber;
use super::by_sets::changes;
use crate::analysis::Analysis;
use crate::choices::{ChoiceError, ReactionValues};
use crate::groups::check;
use crate::judged::ReactionVerdict;
use crate::value::{Datum, Sensitivity, change_in_words};
use crate::words;

/// Sensitivities of the unique numbers of one reaction.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ReactionSensitivities {
    /// Sensitivities of components by their names, as in [`crate::ComponentVerdict`]. The list
    /// includes the named component of the definition, such as `N` of a knife edge or `drive`.
    pub components: Vec<(&'static str, Sensitivity)>,
    /// Sensitivities of [`ReactionVerdict::live_directions`]. A value is `None` if the sensitivity
    /// of the direction is not known.
    pub directions: Vec<Option<Sensitivity>>,
    /// Whether the reaction is unique as a whole.
    pub is_whole: bool,
}

impl ReactionSensitivities {
    /// Returns the sensitivity of a unique component, by its name.
    #[must_use]
    pub fn component(&self, name: &str) -> Option<&Sensitivity> {
        let mut components = self.components.iter();
        components.find(|(known, _)| *known == name).map(|(_, s)| s)
    }

    /// Returns the largest sensitivity of the components.
    #[must_use]
    pub fn largest(&self) -> Option<&Sensitivity> {
        let components = self.components.iter().map(|(_, s)| s);
        components.reduce(|a, b| if b.change > a.change { b } else { a })
    }

    /// Returns whether all components that change are sensitive to data.
    fn is_all_fragile(&self) -> bool {
        let mut components = self.components.iter();
        components.all(|(_, s)| s.is_fragile() || s.by.is_none())
    }
}

/// Sensitivities of the reactions of a mechanism of any size.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Sensitivities {
    /// Sensitivities of joints and drives in the order of their rows. The list is empty for a
    /// reaction without a unique component, and for a reaction whose sensitivities cannot be
    /// computed.
    pub each: Vec<ReactionSensitivities>,
    /// Sentences on unique reactions whose sensitivity cannot be computed, with the reason.
    pub left_out: Vec<String>,
}

impl Sensitivities {
    /// Creates unknown sensitivities for this number of joints and drives. The sentence states the
    /// reason.
    #[must_use]
    pub fn unknown(reactions: usize, reason: Option<String>) -> Self {
        Self {
            each: vec![ReactionSensitivities::default(); reactions],
            left_out: reason.into_iter().collect(),
        }
    }

    /// Returns the sensitivity of a component of a reaction, which is a component of the space or
    /// the named component of the definition. Returns `None` if the component is not unique or is
    /// identically zero, or if its sensitivity is not known.
    #[must_use]
    pub fn component(&self, id: ConstraintId, name: &str) -> Option<&Sensitivity> {
        self.each.get(id.0)?.component(name)
    }

    /// Returns the largest sensitivity of the unique components of a reaction, or `None` if there
    /// is no sensitivity.
    #[must_use]
    pub fn reaction(&self, id: ConstraintId) -> Option<&Sensitivity> {
        self.each.get(id.0)?.largest()
    }

    /// Adds the sensitivities of the determined components of reactions.
    pub fn add_to(&self, reactions: &mut [ReactionValues]) {
        for reaction in reactions {
            for (name, value) in &mut reaction.components {
                value.add_sensitivity(self.component(reaction.id, name).cloned());
            }
        }
    }

    /// Returns the reactions with a component that is sensitive to data (fragile).
    pub fn fragile(&self) -> impl Iterator<Item = (ConstraintId, &Sensitivity)> {
        let each = self.each.iter().enumerate();
        let known = each.filter_map(|(k, all)| Some((ConstraintId(k), all.largest()?)));
        known.filter(|(_, s)| s.is_fragile())
    }

    /// Returns sentences on the components that are sensitive to data. One sentence covers all
    /// reactions and components whose largest change comes from the same point. The name of a
    /// reaction without a component denotes all of its components.
    #[must_use]
    pub fn sentences(&self, layout: &Layout) -> Vec<String> {
        let fragile = self.fragile().map(|(id, _)| id);
        sentences(
            fragile.flat_map(|id| self.fragile_names(id, layout)),
            layout,
        )
    }

    /// Returns the sentences for one joint or drive.
    #[must_use]
    pub fn sentences_of(&self, id: ConstraintId, layout: &Layout) -> Vec<String> {
        sentences(self.fragile_names(id, layout), layout)
    }

    /// Returns the sensitive quantities, with names for sentences. A quantity is the reaction with
    /// all its components, or only some components.
    fn fragile_names(&self, id: ConstraintId, layout: &Layout) -> Vec<(String, Sensitivity)> {
        let Some(all) = self.each.get(id.0) else {
            return Vec::new();
        };
        let Some(largest) = all.largest().filter(|s| s.is_fragile()) else {
            return Vec::new();
        };
        let name = &layout.groups[id.0].name;
        let components = all.components.iter().filter(|(_, s)| s.is_fragile());
        let of_components =
            components.map(|(component, s)| (format!("`{name}.{component}`"), s.clone()));
        let of_components: Vec<_> = of_components.collect();
        if all.is_whole && all.is_all_fragile() {
            vec![(format!("`{name}`"), largest.clone())]
        } else {
            of_components
        }
    }
}

/// Returns one sentence for all names whose largest change comes from the same datum.
fn sentences(
    fragile: impl IntoIterator<Item = (String, Sensitivity)>,
    layout: &Layout,
) -> Vec<String> {
    let mut groups: Vec<(Option<Datum>, f64, Vec<String>)> = Vec::new();
    for (name, Sensitivity { change, by }) in fragile {
        match groups.iter_mut().find(|(known, ..)| *known == by) {
            Some((_, largest, names)) => {
                *largest = largest.max(change);
                names.push(name);
            }
            None => groups.push((by, change, vec![name])),
        }
    }
    let sentence = |(by, change, names): (Option<Datum>, f64, Vec<String>)| {
        let condition = by.map(|by| by.condition(layout)).unwrap_or_default();
        let are = if names.len() == 1 { "is" } else { "are" };
        let change = change_in_words(change, names.len());
        format!(
            "{} {are} unique but {change} if {condition}",
            words::list(&names)
        )
    };
    groups.into_iter().map(sentence).collect()
}

/// Key of the computed number of a reaction.
enum NumberKey {
    Component(&'static str),
    /// The live direction with this index in the list.
    Direction(usize),
}

impl Analysis {
    /// Computes how strongly each unique component and direction depends on the data. The
    /// configuration is that of the analysis, and the velocities v must satisfy the constraints.
    /// Each set of bodies connected by joints and drives is examined separately, with its own size
    /// and loads, on the `rayon` thread pool of the caller. If a set has too many rows for dense
    /// matrices, each of its parts on common cycles is examined with its own data and size, under
    /// the loads from the rest of the set. Parts are omitted if they are too large or if their rank
    /// is undecided.
    ///
    /// # Errors
    /// [`ChoiceError::Request`]: q or v do not fit the mechanism.
    pub fn sensitivities(
        &self,
        mechanism: &Mechanism,
        q: &[f64],
        v: &[f64],
    ) -> Result<Sensitivities, ChoiceError> {
        let (mut asked, mut numbers) = (Vec::new(), Vec::new());
        for reaction in &self.reactions {
            for (what, number) in numbers_of(mechanism, reaction)? {
                asked.push((reaction.id, what));
                numbers.push(number);
            }
        }
        let mut all = Sensitivities::unknown(self.reactions.len(), None);
        let (found, left_out) = self.changes_of(mechanism, q, v, &numbers)?;
        all.left_out = left_out;
        for ((id, what), found) in asked.into_iter().zip(found) {
            let own = &mut all.each[id.0];
            match what {
                NumberKey::Component(name) => own.components.extend(found.map(|s| (name, s))),
                NumberKey::Direction(k) => {
                    own.directions.resize(k + 1, None);
                    own.directions[k] = found;
                }
            }
        }
        for reaction in &self.reactions {
            let own = &mut all.each[reaction.id.0];
            own.take_aligned(reaction);
            own.is_whole = reaction.wrench.verdict.is_unique();
        }
        Ok(all)
    }

    /// Returns the sensitivity of each of these numbers, which must be unique. The result is `None`
    /// if the sensitivity is not known.
    ///
    /// # Errors
    /// Returns the same errors as [`Self::sensitivities`].
    pub fn sensitivities_of(
        &self,
        mechanism: &Mechanism,
        q: &[f64],
        v: &[f64],
        numbers: &[ReactionNumber],
    ) -> Result<Vec<Option<Sensitivity>>, ChoiceError> {
        Ok(self.changes_of(mechanism, q, v, numbers)?.0)
    }

    fn changes_of(
        &self,
        mechanism: &Mechanism,
        q: &[f64],
        v: &[f64],
        numbers: &[ReactionNumber],
    ) -> Result<(Vec<Option<Sensitivity>>, Vec<String>), ChoiceError> {
        let layout = mechanism.layout();
        if !self.decision.is_decided() || numbers.is_empty() {
            return Ok((vec![None; numbers.len()], Vec::new()));
        }
        check("q", q, layout.n_q)?;
        check("v", v, layout.n_v)?;
        let found = changes(mechanism, (self.time, q, v), &self.decision.kept, numbers);
        let each = found.each.into_iter();
        let each = each.map(|change| change?.relative());
        Ok((each.collect(), found.left_out))
    }
}

impl ReactionSensitivities {
    /// Adds the directions along one component. These directions have the sensitivity of this
    /// component.
    fn take_aligned(&mut self, reaction: &ReactionVerdict) {
        let directions = reaction.live_directions.as_deref().unwrap_or_default();
        if self.components.is_empty() && self.directions.is_empty() {
            return;
        }
        self.directions.resize(directions.len(), None);
        for (k, direction) in directions.iter().enumerate() {
            if let Some(name) = aligned(reaction, direction) {
                self.directions[k] = self.component(name).cloned();
            }
        }
    }
}

/// Returns the component that is parallel to a direction of a reaction, or `None` if there is no
/// such component.
fn aligned(reaction: &ReactionVerdict, direction: &[f64]) -> Option<&'static str> {
    let mut terms = direction.iter().zip(&reaction.components);
    let (_, component) = terms.find(|(x, _)| **x != 0.0)?;
    let is_alone = terms.all(|(x, _)| *x == 0.0);
    is_alone.then_some(component.name)
}

/// Returns the unique scalar components of a reaction. The scalar components are components along
/// the axes, the named component of the definition of the joint, and components along unique
/// directions that are not parallel to an axis.
fn numbers_of(
    mechanism: &Mechanism,
    reaction: &ReactionVerdict,
) -> Result<Vec<(NumberKey, ReactionNumber)>, ChoiceError> {
    let id = reaction.id;
    let unique = |c: &&crate::judged::ComponentVerdict| c.judgement.verdict.is_unique();
    let mut names: Vec<&'static str> = reaction
        .components
        .iter()
        .filter(unique)
        .map(|c| c.name)
        .collect();
    let named = mechanism.layout().groups[id.0].spec.component;
    names.extend(named.filter(|name| !names.contains(name) && reaction.determines(name)));
    let mut numbers = Vec::new();
    for name in names {
        let number = ReactionNumber::component(mechanism, id, name)?;
        numbers.push((NumberKey::Component(name), number));
    }
    for (k, direction) in reaction.live_directions.iter().flatten().enumerate() {
        if aligned(reaction, direction).is_some() {
            continue;
        }
        let names = reaction.components.iter().map(|c| c.name);
        let terms = names.zip(direction.iter().copied());
        let number = ReactionNumber::direction(mechanism, id, terms)?;
        numbers.push((NumberKey::Direction(k), number));
    }
    Ok(numbers)
}
