//! Joints of other types that make reactions unique without a change of the motion. Each proposal
//! is written to the text of the scene. The resulting scene is then read and analysed.

mod answer;
mod coupled_search;
mod types;

use std::iter;

use model::words::{estimate, marked};
use model::{ConstraintId, System};
use report::ByName;
use scene::{RetypedJoint, retyped};
use solvability::CoupledJoints;

pub use answer::{RemedyDocument, ReplacedJointDocument};

use super::options::Analyze;
use crate::assembled::AssembledScene;
use crate::configuration::ConfigurationAnalysis;
use crate::documents::AnalysisDocument;
use crate::error::StudyError;
use crate::start::Start;
use crate::study::Study;
use crate::words::{Block, grouped};
use coupled_search::CoupledSearch;
use types::{OtherType, other_types};

/// Largest number of rows of a mechanism for which remedies are computed without a request.
const ROWS: usize = 150;

/// Largest number of remedies in the text.
const LISTED: usize = 5;

/// Adds the remedies to the document, if the mechanism is small and the analysis is an analysis of
/// the start. If a motion is locked only because the data are rounded, the remedies belong to the
/// mechanism that can move.
pub(super) fn add(
    asked: &Analyze,
    start: &Start<'_>,
    of: &ConfigurationAnalysis<'_>,
    document: &mut AnalysisDocument,
) -> Result<(), StudyError> {
    let is_wanted = asked.remedies || of.mechanism.layout().rows() <= ROWS;
    let is_open = document.ranks.redundancy > 0;
    if !(is_wanted && is_open)
        || document.configuration.time != of.mechanism.layout().start_time
        || asked.drop.is_some()
    {
        return Ok(());
    }
    let remedies = &mut document.answers.remedies;
    if let Some(tolerance) = document.data.freeing_tolerance() {
        let stated = read(start, &[]).and_then(|scene| scene.stating(tolerance).ok());
        if let Some(mut freed) = stated
            && let Ok(freed) = freed.analyse_configuration()
        {
            let mobility = freed.analysis.mobility();
            let accuracy = estimate(tolerance.length.unwrap_or_default(), "m");
            let motion =
                format!("and the mobility is {mobility}, as for data accurate to {accuracy}");
            *remedies = Search { start, of: &freed }.remedies(&motion)?;
        }
    } else if document.evidence.permanent != Some(false)
        && of.freedoms()?.blocked.is_empty()
        && (of.cannot_move()? != Some(true) || document.ranks.mobility == 0)
    {
        *remedies = Search { start, of }.remedies("with the same motion")?;
    }
    Ok(())
}

/// Returns the remedies at the start of a run, if the mechanism is small.
pub(crate) fn of_run(start: &Start<'_>, study: &Study) -> Result<Vec<RemedyDocument>, StudyError> {
    let mechanism = &study.prepared.mechanism;
    if study.prepared.decision.redundancy == 0 || mechanism.layout().rows() > ROWS {
        return Ok(Vec::new());
    }
    let of = study.analyse(study.start_time(), None)?;
    // Other parts of the document do not influence the remedies.
    let generic = of.generic();
    let mut document = AnalysisDocument::new(of.scene.name(), &of.analysis, generic.as_ref());
    add(&Analyze::default(), start, &of, &mut document)?;
    Ok(document.answers.remedies)
}

/// Reads the scene with other types of joints. Returns `None` if the scene is invalid.
fn read(start: &Start<'_>, joints: &[&OtherType]) -> Option<AssembledScene> {
    let joints: Vec<&RetypedJoint> = joints.iter().map(|joint| &joint.retyped).collect();
    let text = retyped(&start.text, &joints)?;
    let read = AssembledScene::read(&start.name, &text, start.registry);
    read.and_then(|read| read.stating(start.tolerance)).ok()
}

/// A search for remedies of the scene at its start, or of the scene with a tolerance.
struct Search<'s, 'r, 'm> {
    start: &'s Start<'r>,
    of: &'s ConfigurationAnalysis<'m>,
}

impl Search<'_, '_, '_> {
    /// Returns one remedy for each set of coupled joints that has a remedy. `motion` describes the
    /// motion of the analysed mechanism.
    fn remedies(&self, motion: &str) -> Result<Vec<RemedyDocument>, StudyError> {
        let analysis = &self.of.analysis;
        let is_regular = analysis.decision.is_decided() && analysis.nearly_redundant.is_none();
        let Some(search) = self.of.replacements()?.filter(|_| is_regular) else {
            return Ok(Vec::new());
        };
        let coupled = search.coupled();
        let types = coupled.iter().map(|set| self.types(set));
        let types: Vec<Vec<Vec<OtherType>>> = types.collect();
        let sets = coupled.iter().zip(&types);
        let mut searches: Vec<CoupledSearch> = sets
            .map(|(set, types)| CoupledSearch::new(set, types))
            .collect();
        let mut alone = Vec::new();
        for round in 0.. {
            let open = searches.iter().filter(|own| own.remedy.is_none());
            let tried: Vec<&OtherType> = open.flat_map(|own| own.tried(round)).collect();
            if tried.is_empty() {
                break;
            }
            // Each reading of the text tests one other type of each joint. A joint is tested alone
            // if the reader has rejected one of its types.
            let is_together = |other: &&OtherType| !alone.contains(&other.id);
            let (together, others): (Vec<_>, Vec<_>) = tried.into_iter().partition(is_together);
            let sets = iter::once(&together[..]).chain(others.chunks(1));
            for set in sets.filter(|set| !set.is_empty()) {
                for (scene, tried) in self.compare(set, &mut alone) {
                    let ids: Vec<ConstraintId> = tried.iter().map(|other| other.id).collect();
                    for joint in search.weaker_joints(&scene.mechanism, &ids) {
                        let sets = searches.iter_mut();
                        sets.for_each(|own| own.add(&joint, tried));
                    }
                }
            }
            for own in &mut searches {
                if own.remedy.is_none() {
                    let below = own.least_cost(round + 1);
                    let ways = search.cheapest(own.set, &own.weaker, below);
                    let is_verified = |way: &[&OtherType]| self.is_verified(own.set, way);
                    if let Some(way) = own.verified(ways, is_verified) {
                        own.remedy = Some(self.remedy(own.set, &way, motion));
                    }
                }
            }
        }
        let remedies = searches.into_iter().filter_map(|own| own.remedy);
        Ok(remedies.collect())
    }

    /// Returns the other types of each joint of a set. The cheapest type comes first.
    fn types(&self, set: &CoupledJoints) -> Vec<Vec<OtherType>> {
        let (mechanism, analysis) = (self.of.mechanism, &self.of.analysis);
        let mut s = mechanism.scratch();
        mechanism.pose(analysis.time, &self.of.state.q, &mut s);
        let (layout, reactions) = (mechanism.layout(), &analysis.reactions);
        let open = set.joints.iter();
        let open = open.filter(|id| !reactions[id.0].wrench.verdict.is_unique());
        let types = open.map(|id| {
            let joint = (*id, &layout.groups[id.0]);
            let of = mechanism.reactions(&s);
            other_types(of, self.start.registry, joint, set.redundancy)
        });
        types.collect()
    }

    /// Returns the scene with these types. This scene may be invalid, for example because a drive
    /// needs a joint coordinate. In this case, the result contains scenes with fewer changes, and
    /// the joints with invalid types are added to a list.
    fn compare<'a, 't>(
        &self,
        tried: &'a [&'t OtherType],
        invalid: &mut Vec<ConstraintId>,
    ) -> Vec<(AssembledScene, &'a [&'t OtherType])> {
        if let Some(scene) = read(self.start, tried) {
            return vec![(scene, tried)];
        }
        if let [other] = tried {
            invalid.push(other.id);
            return Vec::new();
        }
        let (first, second) = tried.split_at(tried.len() / 2);
        let mut scenes = self.compare(first, invalid);
        scenes.extend(self.compare(second, invalid));
        scenes
    }

    /// Whether the coupled reactions are unique in the scene with these joints, and the mobility is
    /// the same.
    fn is_verified(&self, set: &CoupledJoints, way: &[&OtherType]) -> bool {
        let Some(mut changed) = read(self.start, way) else {
            return false;
        };
        let Ok(changed) = changed.analyse_configuration() else {
            return false;
        };
        let (old, new) = (&self.of.analysis, &changed.analysis);
        let is_unique = |id: &ConstraintId| new.reactions[id.0].wrench.verdict.is_unique();
        new.decision.is_decided()
            && new.nearly_redundant.is_none()
            && new.mobility() == old.mobility()
            && new.decision.redundancy + set.redundancy == old.decision.redundancy
            && set.joints.iter().all(is_unique)
    }

    fn remedy(&self, set: &CoupledJoints, way: &[&OtherType], motion: &str) -> RemedyDocument {
        let layout = self.of.mechanism.layout();
        let name = |id: &ConstraintId| layout.groups[id.0].name.clone();
        let replace = way.iter().map(|other| {
            let RetypedJoint {
                joint,
                from,
                to,
                directions,
            } = &other.retyped;
            let directions = directions.iter().map(|(k, v)| ((*k).to_owned(), v.clone()));
            let directions: Vec<(String, Vec<f64>)> = directions.collect();
            ReplacedJointDocument {
                joint: joint.clone(),
                from: from.scene_type,
                to: to.scene_type,
                directions: (!directions.is_empty()).then_some(ByName(directions)),
            }
        });
        let joints = way
            .iter()
            .map(|other| (other.words(layout.space), &other.retyped.joint));
        // Equal types are described together.
        let joints = grouped(joints)
            .into_iter()
            .map(|(kind, names)| match names.len() {
                1 => format!("{} {kind}", and(&names)),
                _ => format!("each of {} {kind}", and(&names)),
            });
        let joints: Vec<String> = joints.collect();
        let reactions: Vec<String> = set.joints.iter().map(name).collect();
        let unique = match self.of.analysis.decision.redundancy - set.redundancy {
            0 => "all reactions are unique".to_owned(),
            _ => format!("the reactions of {} are unique", and(&reactions)),
        };
        RemedyDocument {
            text: format!("make {}: {unique}, {motion}", joints.join("; ")),
            replace: replace.collect(),
            reactions,
            verified: true,
        }
    }
}

/// Lists names in grave accents, such as `` `A`, `B` and `C` ``.
fn and(names: &[impl AsRef<str>]) -> String {
    match names {
        [first @ .., last] if !first.is_empty() => {
            format!("{} and `{}`", marked(first), last.as_ref())
        }
        names => marked(names),
    }
}

/// Returns the remedies as text.
pub(super) fn words(d: &AnalysisDocument) -> Vec<Block> {
    let all = &d.answers.remedies;
    let lead = "Design change (deletions: `--make-unique NAME`):";
    if let [remedy] = all.as_slice() {
        return vec![Block::sentence(format!("{lead} {}", remedy.text))];
    }
    let items = all.iter().take(LISTED).map(|remedy| remedy.text.clone());
    let more = all.len().saturating_sub(LISTED);
    let more = (more > 0).then(|| format!("and {more} more (`--json` prints all)"));
    let items = items.chain(more).map(|text| Block::after("- ", text));
    let lead = (!all.is_empty()).then(|| Block::Heading(lead.to_owned()));
    lead.into_iter().chain(items).collect()
}
