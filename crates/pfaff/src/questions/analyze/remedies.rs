//! Joints of other types that make reactions unique without a change of motion. Each proposal is
//! written to the text of the scene, read and analysed.

mod answer;
mod types;

use model::words::listed;
use model::{ConstraintId, System};
use scene::{RetypedJoint, retyped};
use solvability::{ReplacedJoints, Verdict, WeakerJoint};

pub use answer::{DirectionDocument, RemedyDocument, ReplacedJointDocument};

use super::options::Analyze;
use crate::assembled::AssembledScene;
use crate::configuration::ConfigurationAnalysis;
use crate::documents::AnalysisDocument;
use crate::error::StudyError;
use crate::start::Start;
use crate::words::Block;
use types::{OtherType, other_types};

/// Largest number of rows of a mechanism for which remedies are computed without a request.
const ROWS: usize = 150;

/// Cost of a joint of another type.
const CHANGED: u32 = 2;
/// Cost of a force component that a joint no longer transmits. Moments are released without a cost.
const FORCE: u32 = 3;
/// Cost of a direction that the scene does not state.
const DIRECTION: u32 = 2;

/// Adds the remedies to the document, if the mechanism is small and the analysis is that of its
/// start.
pub(super) fn add(
    asked: &Analyze,
    start: &Start<'_>,
    of: &ConfigurationAnalysis<'_>,
    document: &mut AnalysisDocument,
) -> Result<(), StudyError> {
    let (layout, analysis) = (of.mechanism.layout(), &of.analysis);
    let is_asked = asked.at_time == 0.0 && asked.drop.is_none();
    let is_regular = analysis.decision.is_decided()
        && analysis.nearly_redundant.is_none()
        && document.evidence.permanent != Some(false);
    if !is_asked || !is_regular || layout.rows() > ROWS || analysis.decision.redundancy == 0 {
        return Ok(());
    }
    let groups = layout.constraint_ids().zip(&layout.groups);
    let open = groups.filter(|(id, _)| {
        analysis.reactions[id.0].wrench.verdict == Verdict::NotUnique
    });
    let types = open.map(|joint| other_types(of, start.registry, joint));
    let types: Vec<Vec<OtherType>> = types.collect::<Result<_, _>>()?;
    let weaker = weaker(start, of, &types)?;
    let rated: Vec<(WeakerJoint, u32)> = weaker.iter().map(|x| (x.joint.clone(), x.cost)).collect();
    if rated.is_empty() {
        return Ok(());
    }
    for found in of.replacements(&rated)? {
        let ways = found.ways.iter().map(|way| {
            let joints = way.iter().map(|&k| &weaker[k]);
            joints.collect::<Vec<_>>()
        });
        let verified = ways.into_iter().find(|way| is_verified(start, of, &found, way));
        let remedy = verified.map(|way| remedy(of, &found, &way));
        document.answers.remedies.extend(remedy);
    }
    Ok(())
}

/// A weaker joint of another type.
struct Weaker<'t> {
    joint: WeakerJoint,
    other: &'t OtherType,
    cost: u32,
    /// Number of force components and of moment components.
    loads: [usize; 2],
}

/// Returns the other types that restrict no new motions.
fn weaker<'t>(
    start: &Start<'_>,
    of: &ConfigurationAnalysis<'_>,
    types: &'t [Vec<OtherType>],
) -> Result<Vec<Weaker<'t>>, StudyError> {
    let most = types.iter().map(Vec::len).max().unwrap_or(0);
    let mut out = Vec::new();
    for k in 0..most {
        // One reading of the text serves one type of each joint.
        let others: Vec<&OtherType> = types.iter().filter_map(|own| own.get(k)).collect();
        compare(start, of, &others, &mut out)?;
    }
    Ok(out)
}

/// Adds those of the other types that are weaker. If the scene with all of them is invalid, for
/// example because a drive needs a joint coordinate, they are tried in smaller sets.
fn compare<'t>(
    start: &Start<'_>,
    of: &ConfigurationAnalysis<'_>,
    others: &[&'t OtherType],
    out: &mut Vec<Weaker<'t>>,
) -> Result<(), StudyError> {
    let Some(changed) = read(start, others.iter().map(|other| &other.retyped)) else {
        if others.len() > 1 {
            let (first, second) = others.split_at(others.len() / 2);
            compare(start, of, first, out)?;
            compare(start, of, second, out)?;
        }
        return Ok(());
    };
    let ids: Vec<ConstraintId> = others.iter().map(|other| other.id).collect();
    let found = of.weaker_joints(&changed.mechanism, &ids)?;
    let (old, new) = (of.mechanism.layout(), changed.mechanism.layout());
    for (other, joint) in others.iter().zip(found) {
        let Some(joint) = joint else { continue };
        let forces = |layout: &model::Layout| {
            let group = &layout.groups[other.id.0];
            (0..group.spec.rows.len()).filter(|row| group.pushes(*row)).count()
        };
        let (before, after) = (forces(old), forces(new));
        let directions = other.retyped.directions.len() as u32;
        if after > 0 {
            out.push(Weaker {
                joint,
                other,
                cost: CHANGED + FORCE * (before - after) as u32 + DIRECTION * directions,
                loads: [after, other.spec.rows.len() - after],
            });
        }
    }
    Ok(())
}

/// Reads the scene with other types of joints; `None` if it is invalid.
fn read<'r>(
    start: &Start<'_>,
    joints: impl Iterator<Item = &'r RetypedJoint>,
) -> Option<AssembledScene> {
    let joints: Vec<RetypedJoint> = joints.cloned().collect();
    let text = retyped(&start.text, &joints).ok()?;
    let read = AssembledScene::read(&start.name, &text, start.registry);
    read.and_then(|read| read.stating(start.tolerance)).ok()
}

/// Whether the coupled reactions are unique in the scene with these joints, and the mobility is the
/// same.
fn is_verified(
    start: &Start<'_>,
    of: &ConfigurationAnalysis<'_>,
    found: &ReplacedJoints,
    way: &[&Weaker<'_>],
) -> bool {
    let Some(mut changed) = read(start, way.iter().map(|joint| &joint.other.retyped)) else {
        return false;
    };
    let Ok(changed) = changed.analyse(None) else {
        return false;
    };
    let (old, new) = (&of.analysis, &changed.analysis);
    let is_unique = |id: &ConstraintId| new.reactions[id.0].wrench.verdict.is_unique();
    new.decision.is_decided()
        && new.nearly_redundant.is_none()
        && new.mobility() == old.mobility()
        && new.decision.redundancy + found.redundancy == old.decision.redundancy
        && found.coupled.iter().all(is_unique)
}

fn remedy(
    of: &ConfigurationAnalysis<'_>,
    found: &ReplacedJoints,
    way: &[&Weaker<'_>],
) -> RemedyDocument {
    let layout = of.mechanism.layout();
    let name = |id: &ConstraintId| layout.groups[id.0].name.clone();
    let mut way = way.to_vec();
    way.sort_by_key(|weaker| weaker.other.id);
    let replace = way.iter().map(|weaker| {
        let RetypedJoint {
            joint,
            from,
            to,
            directions,
        } = weaker.other.retyped.clone();
        ReplacedJointDocument {
            joint,
            from: from.scene_type,
            to: to.scene_type,
            directions: directions
                .into_iter()
                .map(|(key, vector)| DirectionDocument { key, vector })
                .collect(),
            loads: weaker.loads,
        }
    });
    let replace: Vec<ReplacedJointDocument> = replace.collect();
    let reactions: Vec<String> = found.coupled.iter().map(name).collect();
    let joints: Vec<String> = replace.iter().map(|x| x.text(layout.space)).collect();
    let marked: Vec<String> = reactions.iter().map(|name| format!("`{name}`")).collect();
    let all = match of.analysis.decision.redundancy - found.redundancy {
        0 => "all reactions are unique".to_owned(),
        _ => format!("{} are unique", listed(&marked)),
    };
    RemedyDocument {
        text: format!("make {}: {all}, and the motion is the same", joints.join("; ")),
        reactions,
        replace,
        verified: true,
    }
}

/// Whether a remedy makes this reaction unique.
pub(super) fn covers(d: &AnalysisDocument, reaction: &str) -> bool {
    let mut all = d.answers.remedies.iter();
    all.any(|remedy| remedy.reactions.iter().any(|name| name == reaction))
}

/// Returns the remedies as text.
pub(super) fn words(d: &AnalysisDocument) -> Vec<Block> {
    let lead = "other joint types (design decision, verified): ";
    let remedies = d.answers.remedies.iter();
    let lines = remedies.map(|remedy| [Block::Gap, Block::after(lead, &remedy.text)]);
    lines.flatten().collect()
}
