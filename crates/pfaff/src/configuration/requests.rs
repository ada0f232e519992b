//! Converts the names of a scene to the joints and drives of its mechanism.

use model::{ConstraintId, Mechanism, System};
use scene::{Combination, GroupContent, Scene, WrenchTerm};
use solvability::{Elasticity, Group, Term};

use crate::elasticity::elasticity;
use crate::error::StudyError;
use crate::refusal::Refusal;

/// Finds the joint or drive with this name.
pub(crate) fn reaction(
    scene: &Scene,
    mechanism: &Mechanism,
    name: &str,
) -> Result<ConstraintId, StudyError> {
    let groups = &mechanism.layout().groups;
    let place = groups.iter().position(|g| g.name == name);
    place.map(ConstraintId).ok_or_else(|| {
        let name = name.to_owned();
        if scene.is_inactive(&name) {
            return StudyError::InactiveReaction { name };
        }
        let nearest = scene.nearest_reaction(&name).map(str::to_owned);
        StudyError::UnknownReaction { name, nearest }
    })
}

/// Returns the elastic joints of the request in the scene, if the scene requests bounds.
pub(crate) fn bounds(
    scene: &Scene,
    mechanism: &Mechanism,
) -> Result<Option<Elasticity>, StudyError> {
    let Some(wanted) = &scene.output.bounds else {
        return Ok(None);
    };
    let reaction = |name: &str| {
        let found = reaction(scene, mechanism, name);
        found.map_err(|e| Refusal::input(e.to_string()))
    };
    let found = elasticity(wanted, mechanism.layout(), &reaction);
    found
        .map(Some)
        .map_err(|e| StudyError::Bounds(e.document().error))
}

/// Returns groups with their names: the groups of the scene, then the requested combinations.
pub(crate) fn groups(
    scene: &Scene,
    mechanism: &Mechanism,
    combine: &[String],
) -> Result<Vec<(String, Group)>, StudyError> {
    let of = |group: &scene::GroupRequest| {
        let content = match &group.content {
            GroupContent::Members(names) => {
                let members = names.iter().map(|n| reaction(scene, mechanism, n));
                Group::Members(members.collect::<Result<_, _>>()?)
            }
            GroupContent::Combination(sum) => sum_of(scene, mechanism, sum)?,
        };
        Ok((group.name.clone(), content))
    };
    let asked = |text: &String| Ok((text.clone(), combination(scene, mechanism, text)?));
    let of_scene = scene.groups.iter().map(of);
    of_scene.chain(combine.iter().map(asked)).collect()
}

/// Parses a combination.
pub(super) fn combination(
    scene: &Scene,
    mechanism: &Mechanism,
    text: &str,
) -> Result<Group, StudyError> {
    let read = scene.combination(text);
    let sum = read.map_err(|error| StudyError::Combination {
        text: text.to_owned(),
        error,
    })?;
    sum_of(scene, mechanism, &sum)
}

fn sum_of(
    scene: &Scene,
    mechanism: &Mechanism,
    combination: &Combination,
) -> Result<Group, StudyError> {
    match combination {
        Combination::Components(terms) => {
            let term = |term: &scene::Term| {
                Ok(Term {
                    reaction: reaction(scene, mechanism, &term.reaction)?,
                    component: term.component.clone(),
                    coefficient: term.coefficient,
                })
            };
            let terms: Result<_, StudyError> = terms.iter().map(term).collect();
            Ok(Group::Combination(terms?))
        }
        Combination::Wrenches(terms) => {
            let term = |term: &WrenchTerm| {
                let id = reaction(scene, mechanism, &term.reaction)?;
                Ok((term.coefficient, id))
            };
            let terms: Result<_, StudyError> = terms.iter().map(term).collect();
            Ok(Group::WrenchSum(terms?))
        }
    }
}
