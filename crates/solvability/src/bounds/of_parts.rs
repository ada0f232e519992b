//! Bounds of the reactions of an analysed configuration of any size.

use std::sync::OnceLock;

use model::{ConstraintId, System};
use rayon::prelude::*;

use super::{BoundsError, ElasticBounds, ElasticLoad, ElasticSolutions, Elasticity};
use crate::choices::{Solution, not_finite};
use crate::groups::{Group, LinearForm};
use crate::questions::Questions;

/// The solutions of a part, or the reason why the part has no bounds.
type OfPart<'q, 'm> = Result<ElasticSolutions<'q, 'm>, BoundsError>;

/// The bounds of all reactions of a configuration. The solutions of a part are computed at the
/// first request.
pub struct ReactionBounds<'q, 'm> {
    questions: &'q Questions<'m>,
    solution: &'q Solution,
    elasticity: Elasticity,
    parts: Vec<OnceLock<OfPart<'q, 'm>>>,
}

impl<'m> Questions<'m> {
    /// Returns bounds of the reactions for joints that give way by any law, from one solution.
    #[must_use]
    pub fn bounds<'q>(
        &'q self,
        solution: &'q Solution,
        elasticity: &Elasticity,
    ) -> ReactionBounds<'q, 'm> {
        ReactionBounds {
            questions: self,
            solution,
            elasticity: elasticity.clone(),
            parts: self.parts().iter().map(|_| OnceLock::new()).collect(),
        }
    }
}

impl<'q, 'm> ReactionBounds<'q, 'm> {
    /// Returns the solutions of a part, or `None` if the part has no redundant rows.
    fn part(&self, k: usize) -> Option<&OfPart<'q, 'm>> {
        let part = &self.questions.parts()[k];
        if part.decision.redundancy() == 0 {
            return None;
        }
        Some(self.parts[k].get_or_init(|| {
            let own = |id: ConstraintId| part.extent.own_group(id.0).map(ConstraintId);
            let own = self.elasticity.of_reactions(own);
            let lambda = part.extent.of_rows(self.solution.multipliers.as_chosen());
            self.questions
                .configuration(k)?
                .elastic_solutions(&lambda, &own)
        }))
    }

    /// Computes the solutions of all parts in parallel.
    #[must_use]
    pub fn of_all_parts(self) -> Self {
        (0..self.parts.len()).into_par_iter().for_each(|k| {
            self.part(k);
        });
        self
    }

    /// Returns whether the part of a joint or drive leaves exactly one load component undetermined.
    #[must_use]
    pub fn has_one_free_component(&self, id: ConstraintId) -> bool {
        let part = self.questions.place(id);
        part.is_ok_and(|(k, _)| self.questions.parts()[k].decision.redundancy() == 1)
    }

    /// Returns the bounds of the numbers of a group with their names. A group of several separate
    /// reactions has no numbers.
    ///
    /// # Errors
    /// [`BoundsError`]
    pub fn group(&self, group: &Group) -> Result<Vec<(&'static str, ElasticBounds)>, BoundsError> {
        let mut sums: Vec<(&'static str, ElasticBounds)> = Vec::new();
        for (k, name, form) in self.questions.forms(group)? {
            let own = self.of_part(k, &form)?;
            match sums.iter_mut().find(|(known, _)| *known == name) {
                Some((_, sum)) => *sum = sum.clone().plus(own),
                None => sums.push((name, own)),
            }
        }
        Ok(sums)
    }

    /// Checks that a number of a part has finite values.
    fn check_finite(&self, k: usize, form: &LinearForm) -> Result<(), BoundsError> {
        let extent = &self.questions.parts()[k].extent;
        match not_finite(&self.solution.no_finite, extent, form) {
            Some(why) => Err(BoundsError::NoFinite(why)),
            None => Ok(()),
        }
    }

    /// Returns the bounds of a number of a part.
    fn of_part(&self, k: usize, form: &LinearForm) -> Result<ElasticBounds, BoundsError> {
        self.check_finite(k, form)?;
        let extent = &self.questions.parts()[k].extent;
        match self.part(k) {
            None => {
                let lambda = self.solution.multipliers.as_chosen();
                let configuration = self.questions.configuration(k)?;
                Ok(ElasticBounds::of(
                    configuration.value(form, &extent.of_rows(lambda)),
                ))
            }
            Some(Err(e)) => {
                // The value of a unique number does not depend on bounds of other numbers.
                let configuration = self.questions.configuration(k)?;
                if !configuration.judge(form)?.verdict.is_unique() {
                    return Err(e.clone());
                }
                let lambda = extent.of_rows(self.solution.multipliers.as_chosen());
                Ok(ElasticBounds::of(configuration.value(form, &lambda)))
            }
            Some(Ok(solutions)) => {
                let whole = |load: ElasticLoad| ElasticLoad {
                    reaction: ConstraintId(extent.group(load.reaction.0)),
                    ..load
                };
                let mut bounds = solutions.bounds(form)?;
                for loads in [&mut bounds.at_lowest, &mut bounds.at_highest] {
                    loads.iter_mut().for_each(|load| *load = whole(*load));
                }
                Ok(bounds)
            }
        }
    }

    /// Returns the largest magnitudes of the force (N) and of the moment (N·m) of a joint or drive.
    /// A magnitude is `None` for a load that is identically zero.
    ///
    /// # Errors
    /// [`BoundsError`]
    pub fn largest_magnitudes(&self, id: ConstraintId) -> Result<[Option<f64>; 2], BoundsError> {
        let group = Group::WrenchSum(vec![(1.0, id)]);
        let forms = self.questions.forms(&group)?;
        let space = self.questions.mechanism().space();
        let mut found = [None; 2];
        for (found, range) in found.iter_mut().zip([space.forces(), space.torques()]) {
            let has_load = |k: &usize| {
                let own = self.questions.mechanism().layout().groups[id.0].components();
                own.contains(k)
            };
            if !range.clone().any(|k| has_load(&k)) {
                continue;
            }
            let own: Vec<&(usize, &'static str, LinearForm)> = forms[range].iter().collect();
            let Some((k, ..)) = own.first() else { continue };
            for (k, _, form) in &own {
                self.check_finite(*k, form)?;
            }
            *found = Some(match self.part(*k) {
                Some(Ok(solutions)) => {
                    let forms: Vec<LinearForm> =
                        own.iter().map(|(.., form)| form.clone()).collect();
                    solutions.largest_magnitude(&forms)?
                }
                Some(Err(e)) => return Err(e.clone()),
                None => {
                    let values = own
                        .iter()
                        .map(|(k, _, form)| Ok(self.of_part(*k, form)?.highest));
                    let values: Result<Vec<f64>, BoundsError> = values.collect();
                    linalg::kernels::norm(&values?)
                }
            });
        }
        Ok(found)
    }

    /// Returns the number of examined sets of components.
    #[must_use]
    pub fn sets(&self) -> u64 {
        let known = self.parts.iter();
        let known = known.filter_map(|part| part.get()?.as_ref().ok());
        known.map(ElasticSolutions::sets).sum()
    }
}
