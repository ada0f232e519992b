//! Requests about the reactions of an analysed configuration of any size. The result of a request
//! is computed from the parts that it involves.
//!
//! The left null space of C is the direct sum of the left null spaces of the parts. Therefore a
//! number that depends on reactions of several parts is unique iff its contribution from each part
//! is unique. A choice among the solutions is a separate choice in each part. Rows may be deleted
//! together iff the rows of each part may be deleted.

mod eliminations;

use crate::judged::ComponentVerdict;
use crate::limits::ROWS_MAX;
use std::sync::{Arc, OnceLock};

use model::words::in_same_units;
use model::{BodyRef, ConstraintId, Mechanism, System};
use rayon::prelude::*;

use crate::analysis::Analysis;
use crate::choices::{
    Choice, ChoiceError, Distribution, ReactionValues, Solution, label, not_finite,
};
use crate::explain::{Explanation, ExplanationError, explain};
use crate::frames::FrameVerdict;
use crate::groups::{
    Configuration, Group, GroupVerdict, LinearForm, NO_REACTION, RequestError, Term,
};
use crate::moments::MomentVerdict;
use crate::parts::{ListedRows, PartAnalysis};
use crate::value::Value;
use crate::verdict::{Judgement, Verdict, worst};
use crate::weaker::Replacements;

pub use eliminations::EliminationError;

/// An analysed configuration that accepts requests about its reactions.
///
/// ```
/// use joints::{Direction, KnifeEdge};
/// use model::{Body, BodyRef, ConstraintId, Description, Joint, Mechanism};
/// use pfaff_solvability::{Group, Questions, analyse};
/// // A cart on two wheels of one axle: each stops the same sideways motion.
/// let edge = |name: &str, y: f64| {
///     let element = KnifeEdge { s: [0.0, y], normal: Direction::Y };
///     Joint::new(name, &[BodyRef::Body(0)], element)
/// };
/// let cart = Description {
///     bodies: vec![Body { name: "cart".into(), mass: 10.0, inertia: 1.0, ..Body::default() }],
///     joints: vec![edge("left", 0.5), edge("right", -0.5)],
///     ..Description::default()
/// };
/// let mechanism = Mechanism::build(&cart).unwrap();
/// let q = [0.0; 3];
/// let questions = Questions::new(&mechanism, &q, analyse(&mechanism, 0.0, &q)?.into());
/// assert_eq!(questions.eliminations(), Ok(2));
/// let both = Group::WrenchSum(vec![(1.0, ConstraintId(0)), (1.0, ConstraintId(1))]);
/// let verdict = questions.group(&both)?;
/// assert_eq!(verdict.components[1].judgement.verdict.word(), "unique");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Questions<'a> {
    mechanism: &'a Mechanism,
    pub(crate) q: Vec<f64>,
    analysis: Arc<Analysis>,
    /// Configuration of each part, created at the first request.
    configurations: Vec<OnceLock<Configuration<'a>>>,
    /// The part of each joint and drive.
    part_of: Vec<usize>,
}

/// Numbers of a group, with their names.
pub type Numbers = Vec<(&'static str, Value)>;

impl<'a> Questions<'a> {
    /// Combines a mechanism with the analysis of its configuration q.
    #[must_use]
    pub fn new(mechanism: &'a Mechanism, q: &[f64], analysis: Arc<Analysis>) -> Self {
        let mut part_of = vec![0; mechanism.layout().groups.len()];
        for (k, part) in analysis.parts.iter().enumerate() {
            part.extent
                .groups()
                .iter()
                .for_each(|&group| part_of[group] = k);
        }
        Self {
            mechanism,
            q: q.to_vec(),
            configurations: analysis.parts.iter().map(|_| OnceLock::new()).collect(),
            analysis,
            part_of,
        }
    }

    pub(crate) fn mechanism(&self) -> &'a Mechanism {
        self.mechanism
    }

    pub(crate) fn parts(&self) -> &[PartAnalysis] {
        &self.analysis.parts
    }

    /// Returns the configuration of a part.
    pub(crate) fn configuration(&self, k: usize) -> Result<&Configuration<'a>, RequestError> {
        let cell = &self.configurations[k];
        if let Some(made) = cell.get() {
            return Ok(made);
        }
        let part = &self.parts()[k];
        let decision = part.decision.dense().ok_or_else(|| RequestError::Large {
            joints: part.extent.name(self.mechanism),
            rows: part.rows(),
            most: ROWS_MAX,
        })?;
        let q = part.extent.coordinates(&self.q);
        let mechanism = part.extent.mechanism(self.mechanism);
        let made = Configuration::of(mechanism, self.analysis.time, &q, decision)?;
        Ok(cell.get_or_init(|| made))
    }

    /// Returns the search for replacements of joints, or `None` if the mechanism was not analysed
    /// as one part.
    ///
    /// # Errors
    /// [`RequestError::Large`]
    pub fn replacements(&self) -> Result<Option<Replacements<'_, 'a>>, RequestError> {
        let whole = matches!(self.parts(), [one] if one.extent.is_whole());
        let configuration = whole.then(|| self.configuration(0)).transpose()?;
        Ok(configuration.map(|own| Replacements::new(own, &self.q)))
    }

    /// Returns the part of a joint or drive, and its number in that part.
    pub(crate) fn place(&self, id: ConstraintId) -> Result<(usize, ConstraintId), RequestError> {
        let reactions = self.part_of.len();
        let part = self.part_of.get(id.0).copied();
        let own = part.and_then(|k| Some((k, self.parts()[k].extent.own_group(id.0)?)));
        own.map(|(k, own)| (k, ConstraintId(own)))
            .ok_or(RequestError::UnknownReaction {
                id: id.0,
                reactions,
            })
    }

    /// Returns the contribution of each part that a group involves.
    fn shares(&self, group: &Group) -> Result<Vec<(usize, Group)>, RequestError> {
        if let [one] = self.parts()
            && one.extent.is_whole()
        {
            return Ok(vec![(0, group.clone())]);
        }
        Ok(match group {
            Group::Members(ids) => {
                let placed = ids.iter().map(|&id| self.place(id));
                by_part(placed)?
                    .map(|(k, ids)| (k, Group::Members(ids)))
                    .collect()
            }
            Group::OneJoint(ids) => {
                let placed = ids.iter().map(|&id| self.place(id));
                by_part(placed)?
                    .map(|(k, ids)| (k, Group::OneJoint(ids)))
                    .collect()
            }
            Group::Combination(terms) => {
                let placed = terms.iter().map(|term| {
                    let (k, reaction) = self.place(term.reaction)?;
                    let term = Term {
                        reaction,
                        ..term.clone()
                    };
                    Ok((k, term))
                });
                by_part(placed)?
                    .map(|(k, terms)| (k, Group::Combination(terms)))
                    .collect()
            }
            Group::WrenchSum(terms) => {
                let placed = terms.iter().map(|&(factor, id)| {
                    let (k, id) = self.place(id)?;
                    Ok((k, (factor, id)))
                });
                by_part(placed)?
                    .map(|(k, terms)| (k, Group::WrenchSum(terms)))
                    .collect()
            }
            Group::Resultant(bodies) => {
                let share = |(k, part): (usize, &PartAnalysis)| {
                    let own: Vec<usize> = bodies
                        .iter()
                        .filter_map(|&b| part.extent.own_body(b))
                        .collect();
                    (!own.is_empty()).then_some((k, Group::Resultant(own)))
                };
                self.parts().iter().enumerate().filter_map(share).collect()
            }
        })
    }

    /// Returns the reference point for the torques T of a sum of wrenches or a resultant. Also
    /// checks the bodies.
    fn about(&self, group: &Group) -> Result<Option<[f64; 3]>, RequestError> {
        match group {
            Group::WrenchSum(terms) => {
                let &(_, first) = terms.first().ok_or(NO_REACTION)?;
                self.reference_point(first).map(Some)
            }
            Group::Resultant(all) => {
                let bodies = self.mechanism.bodies().len();
                if let Some(&body) = all.iter().find(|&&body| body >= bodies) {
                    return Err(RequestError::UnknownBody { body, bodies });
                }
                let &first = all.first().ok_or(RequestError::Empty { of: "body" })?;
                let mut s = self.mechanism.scratch();
                self.mechanism.pose(self.analysis.time, &self.q, &mut s);
                Ok(Some(s.bodies.origin(first)))
            }
            _ => Ok(None),
        }
    }

    /// Returns the verdict on a group. The group is unique iff its contribution from each part is
    /// unique. The margin is the largest margin of the parts.
    ///
    /// # Errors
    /// Returns the same errors as [`crate::judge_groups`], and [`RequestError::Large`] if the group
    /// involves a part with too many rows.
    pub fn group(&self, group: &Group) -> Result<GroupVerdict, RequestError> {
        let about = self.about(group)?;
        let judged = self.shares(group)?.into_iter();
        let judged = judged.map(|(k, share)| self.configuration(k)?.group_about(&share, about));
        let judged: Vec<GroupVerdict> = judged.collect::<Result<_, _>>()?;
        let [first, others @ ..] = judged.as_slice() else {
            return self.of_nothing(group, about);
        };
        let component = |(i, of_first): (usize, &ComponentVerdict)| {
            let of_others = others.iter().filter_map(|g| g.components.get(i));
            let all = std::iter::once(of_first).chain(of_others);
            ComponentVerdict {
                name: of_first.name,
                judgement: worst(all.map(|c| c.judgement.clone()))
                    .unwrap_or_else(|| of_first.judgement.clone()),
            }
        };
        Ok(GroupVerdict {
            space: self.mechanism.space(),
            components: first.components.iter().enumerate().map(component).collect(),
            judgement: worst(judged.iter().map(|g| g.judgement.clone())).ok_or(NO_REACTION)?,
            about,
        })
    }

    /// Returns the verdict on a group without reactions. The resultant on bodies without joints is
    /// unique. Any other empty group is an error.
    fn of_nothing(
        &self,
        group: &Group,
        about: Option<[f64; 3]>,
    ) -> Result<GroupVerdict, RequestError> {
        let judgement = Judgement::new(Verdict::Unique, 0.0);
        match group {
            Group::Resultant(_) => Ok(GroupVerdict {
                space: self.mechanism.space(),
                components: (self.mechanism.space().components().iter())
                    .map(|name| ComponentVerdict {
                        name,
                        judgement: judgement.clone(),
                    })
                    .collect(),
                judgement,
                about,
            }),
            Group::Combination(_) => Err(RequestError::Empty { of: "term" }),
            _ => Err(NO_REACTION),
        }
    }

    /// Returns the numbers of a group with their names and verdicts. Values that differ between the
    /// solutions are omitted. A group of several separate reactions has no numbers.
    ///
    /// # Errors
    /// Returns the same errors as [`Questions::group`].
    pub fn determined(&self, group: &Group, solution: &Solution) -> Result<Numbers, RequestError> {
        let lambda = solution.multipliers.as_chosen();
        self.numbers(group, |k, configuration, form| {
            let verdict = configuration.judge(form)?.verdict;
            let extent = &self.parts()[k].extent;
            let own = extent.of_rows(lambda);
            Ok(match not_finite(&solution.no_finite, extent, form) {
                Some(why) => Value::not_finite(verdict, why),
                None => Value::new(configuration.value(form, &own), verdict, None),
            })
        })
    }

    /// Returns the components of all joints and drives that are not identically zero, with their
    /// verdicts. Values that differ between the solutions are omitted.
    ///
    /// # Errors
    /// Returns the same errors as [`Questions::group`].
    pub fn determined_reactions(
        &self,
        solution: &Solution,
    ) -> Result<Vec<ReactionValues>, RequestError> {
        let layout = self.mechanism.layout();
        let of = |id: ConstraintId| {
            let group = &layout.groups[id.0];
            let component = |name: &'static str| {
                let term = Term {
                    reaction: id,
                    component: name.to_owned(),
                    coefficient: 1.0,
                };
                let numbers = self.determined(&Group::Combination(vec![term]), solution)?;
                Ok(numbers.into_iter().map(move |(_, value)| (name, value)))
            };
            let components = group.component_names().map(component);
            let components = components.collect::<Result<Vec<_>, RequestError>>()?;
            Ok(ReactionValues {
                id,
                name: group.name.clone(),
                components: components.into_iter().flatten().collect(),
            })
        };
        layout.constraint_ids().map(of).collect()
    }

    /// Returns all numbers of a group for a given choice.
    ///
    /// # Errors
    /// Returns the same errors as [`Questions::group`].
    pub fn chosen(
        &self,
        group: &Group,
        distribution: &Distribution,
    ) -> Result<Numbers, RequestError> {
        self.numbers(group, |k, configuration, form| {
            let extent = &self.parts()[k].extent;
            distribution.value_in(extent, configuration, form)
        })
    }

    /// Sums the numbers over the parts.
    fn numbers(
        &self,
        group: &Group,
        value: impl Fn(usize, &Configuration<'a>, &LinearForm) -> Result<Value, RequestError>,
    ) -> Result<Numbers, RequestError> {
        let mut sums: Numbers = Vec::new();
        for (k, name, form) in self.forms(group)? {
            let own = value(k, self.configuration(k)?, &form)?;
            match sums.iter_mut().find(|(known, _)| *known == name) {
                Some((_, sum)) => *sum = sum.clone() + own,
                None => sums.push((name, own)),
            }
        }
        Ok(sums)
    }

    /// Returns the contribution of each part to the numbers of a group. Each item contains the
    /// part, the name and the number.
    pub(crate) fn forms(
        &self,
        group: &Group,
    ) -> Result<Vec<(usize, &'static str, LinearForm)>, RequestError> {
        let about = self.about(group)?;
        let mut all = Vec::new();
        for (k, share) in self.shares(group)? {
            let forms = self
                .configuration(k)?
                .reactions
                .numbers_about(&share, about)?;
            all.extend(forms.into_iter().map(|(name, form)| (k, name, form)));
        }
        Ok(all)
    }

    /// Returns the reference point of a joint or drive, in ground axes (m).
    ///
    /// # Errors
    /// [`RequestError::UnknownReaction`], [`RequestError::Large`]
    pub fn reference_point(&self, id: ConstraintId) -> Result<[f64; 3], RequestError> {
        let (k, own) = self.place(id)?;
        self.configuration(k)?.reactions.place(own)
    }

    /// Returns the verdicts on a reaction in all of its frames.
    ///
    /// # Errors
    /// [`RequestError::UnknownReaction`], [`RequestError::Large`]
    pub fn frames(&self, id: ConstraintId) -> Result<Vec<FrameVerdict>, RequestError> {
        let (k, own) = self.place(id)?;
        self.configuration(k)?.frames(own)
    }

    /// Returns the verdict on the moment of a reaction about a point (m, ground axes).
    ///
    /// # Errors
    /// Returns the same errors as [`Configuration::moment`], and [`RequestError::Large`].
    pub fn moment(&self, id: ConstraintId, about: [f64; 3]) -> Result<MomentVerdict, RequestError> {
        let (k, own) = self.place(id)?;
        self.configuration(k)?.moment(own, about)
    }

    /// Returns the nearest point about which the moment of a reaction is unique, if the moment is
    /// not unique about the reference point of the joint.
    ///
    /// # Errors
    /// Returns the same errors as [`Configuration::centre_of_moments`], and
    /// [`RequestError::Large`].
    pub fn centre_of_moments(&self, id: ConstraintId) -> Result<Option<[f64; 3]>, RequestError> {
        let (k, own) = self.place(id)?;
        self.configuration(k)?.centre_of_moments(own)
    }

    /// Returns the distribution that a choice selects, starting from one solution. The choice is
    /// applied in each part separately.
    ///
    /// # Errors
    /// Returns the same errors as [`Configuration::distribute`], and [`RequestError::Large`].
    pub fn distribute(
        &self,
        solution: &Solution,
        choice: &Choice,
    ) -> Result<Distribution, ChoiceError> {
        let lambda = solution.multipliers.as_chosen();
        if let [one] = self.parts()
            && one.extent.is_whole()
        {
            let found = self.configuration(0)?.distribute(lambda, choice)?;
            return Ok(found.without(&solution.no_finite));
        }
        let reactions = self.part_of.len();
        let eliminated = choice.listed_rows();
        let rigid = match choice {
            Choice::Compliance(supports) => {
                for id in supports.listed() {
                    self.place(id)?;
                }
                self.rigid(choice)?
            }
            Choice::Elimination(_) => {
                self.check_counts(&eliminated)?;
                Vec::new()
            }
            Choice::MinimumNorm(_) => Vec::new(),
        };
        let label = label(self.mechanism.layout(), choice, &rigid);
        let share = |k: usize| {
            let extent = &self.parts()[k].extent;
            let own = choice.share_of(extent, &eliminated);
            let configuration = self.configuration(k)?;
            let found = configuration.distribute_as(&extent.of_rows(lambda), &own, label.clone());
            let found = found.map_err(|source| match source {
                ChoiceError::Indeterminate { .. } => ChoiceError::InPart {
                    joints: extent.name(self.mechanism),
                    source: Box::new(source),
                },
                other => other,
            });
            Ok((extent, found?))
        };
        let parts: Vec<Result<_, ChoiceError>> = (0..self.parts().len())
            .into_par_iter()
            .map(in_same_units(share))
            .collect();
        let parts = parts.into_iter().collect::<Result<Vec<_>, _>>()?;
        let found = Distribution::of_parts(label.clone(), lambda, reactions, parts);
        Ok(found.without(&solution.no_finite))
    }

    /// Checks that the number of listed rows in each part equals the redundancy of the part.
    fn check_counts(&self, rows: &ListedRows<'_>) -> Result<(), ChoiceError> {
        for part in self.parts() {
            let (own, listed) = (part.decision.redundancy(), part.extent.own_rows(rows).len());
            let is_decided = part.decision.status() == rank::RankStatus::Decided;
            if is_decided && own != listed {
                return Err(ChoiceError::Count {
                    redundancy: self.analysis.decision.redundancy,
                    joints: part.extent.name(self.mechanism),
                    own,
                    listed,
                });
            }
        }
        Ok(())
    }

    /// Returns the joints and drives that share loads but have no compliance in a choice.
    fn rigid(&self, choice: &Choice) -> Result<Vec<ConstraintId>, RequestError> {
        let mut rigid = Vec::new();
        for (k, part) in self.parts().iter().enumerate() {
            if part.decision.redundancy() == 0 {
                continue;
            }
            if let Choice::Compliance(supports) = choice.share(&part.extent) {
                let own = self.configuration(k)?.rigid(&supports.compliances);
                rigid.extend(own.iter().map(|id| ConstraintId(part.extent.group(id.0))));
            }
        }
        rigid.sort_unstable();
        Ok(rigid)
    }

    /// Explains why the reactions are not unique. Parts with an undecided rank, and parts that are
    /// too large, are omitted. Returns `None` if no part can be explained.
    ///
    /// # Errors
    /// [`ExplanationError::Rank`], [`ExplanationError::Query`]
    pub fn explanation(&self) -> Result<Option<Explanation>, ExplanationError> {
        let of_part = |k: usize| {
            let Ok(configuration) = self.configuration(k) else {
                return Ok(None);
            };
            let extent = &self.parts()[k].extent;
            let q = extent.coordinates(&self.q);
            let solvability = configuration.solvability();
            match explain(
                &configuration.reactions.mechanism,
                &configuration.reactions.s,
                &q,
                solvability,
            ) {
                Ok(mut found) => {
                    if !extent.is_whole() {
                        found.renumber(
                            |row| extent.row(row),
                            |id| ConstraintId(extent.group(id.0)),
                            |body| match body {
                                BodyRef::Ground => BodyRef::Ground,
                                BodyRef::Body(k) => BodyRef::Body(extent.body(k)),
                            },
                        );
                    }
                    Ok(Some(found))
                }
                Err(ExplanationError::Undecided(_)) => Ok(None),
                Err(e) => Err(e),
            }
        };
        let parts: Vec<Result<_, ExplanationError>> = (0..self.parts().len())
            .into_par_iter()
            .map(in_same_units(of_part))
            .collect();
        let mut all: Option<Explanation> = None;
        for part in parts {
            match (&mut all, part?) {
                (Some(all), Some(part)) => all.add(part),
                (None, Some(part)) => all = Some(part),
                (_, None) => {}
            }
        }
        if self.parts().len() > 1
            && let Some(all) = &mut all
        {
            all.sort();
        }
        Ok(all)
    }
}

/// Collects items by part, in the order of parts.
fn by_part<T>(
    placed: impl Iterator<Item = Result<(usize, T), RequestError>>,
) -> Result<impl Iterator<Item = (usize, Vec<T>)>, RequestError> {
    let mut parts = std::collections::BTreeMap::<usize, Vec<T>>::new();
    for item in placed {
        let (k, item) = item?;
        parts.entry(k).or_default().push(item);
    }
    Ok(parts.into_iter())
}
