//! Joints of other types that make reactions unique without a change of motion. Each proposal is
//! written to the text of the scene, read and analysed.

mod answer;
mod types;

use model::words::estimate;
use model::{ConstraintId, System};
use scene::{RetypedJoint, retyped};
use solvability::{ReplacedJoints, WeakerJoint};

use answer::and;
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
const CHANGED: u32 = 1;
/// Cost of a force component that a joint no longer transmits; two components of one joint cost
/// four times as much, because a joint should keep its direction of load. Moments are released
/// without a cost.
const FORCE: u32 = 4;
/// Cost of a direction that the scene does not state.
const DIRECTION: u32 = 6;

/// Largest number of remedies in the text.
const LISTED: usize = 5;

/// Adds the remedies to the document, if the mechanism is small and the analysis is that of its
/// start. If only the rounding of the data locks a motion, the remedies are those of the mechanism
/// that can move.
pub(super) fn add(
    asked: &Analyze,
    start: &Start<'_>,
    of: &ConfigurationAnalysis<'_>,
    document: &mut AnalysisDocument,
) -> Result<(), StudyError> {
    let is_small = of.mechanism.layout().rows() <= ROWS;
    let is_start = asked.at_time == 0.0 && asked.drop.is_none();
    if !is_small || !is_start || document.ranks.redundancy == 0 {
        return Ok(());
    }
    if let Some(tolerance) = document.data.freeing_tolerance() {
        let stated = read(start, &[]).and_then(|scene| scene.stating(tolerance).ok());
        if let Some(mut freed) = stated
            && let Ok(freed) = freed.analyse(None)
        {
            let mobility = freed.analysis.mobility();
            let accuracy = estimate(tolerance.length.unwrap_or_default(), "m");
            let motion = format!("the mobility is {mobility}, as for data accurate to {accuracy}");
            document.answers.remedies = remedies(start, &freed, &motion)?;
        }
    } else if document.evidence.permanent != Some(false) {
        document.answers.remedies = remedies(start, of, "the motion is the same")?;
    }
    Ok(())
}

/// Returns one remedy for each set of coupled joints, if there is one. `motion` describes the
/// motion of the analysed mechanism.
fn remedies(
    start: &Start<'_>,
    of: &ConfigurationAnalysis<'_>,
    motion: &str,
) -> Result<Vec<RemedyDocument>, StudyError> {
    let (layout, analysis) = (of.mechanism.layout(), &of.analysis);
    if !analysis.decision.is_decided() || analysis.nearly_redundant.is_some() {
        return Ok(Vec::new());
    }
    let groups = layout.constraint_ids().zip(&layout.groups);
    let is_open = |id: ConstraintId| !analysis.reactions[id.0].wrench.verdict.is_unique();
    let open = groups.filter(|(id, _)| is_open(*id));
    let types = open.map(|joint| other_types(of, start.registry, joint));
    let types: Vec<Vec<OtherType>> = types.collect::<Result<_, _>>()?;
    let weaker = weaker(start, of, &types)?;
    if weaker.is_empty() {
        return Ok(Vec::new());
    }
    let rated: Vec<(WeakerJoint, u32)> = weaker.iter().map(|x| (x.joint.clone(), x.cost)).collect();
    let found = of.replacements(&rated)?;
    let remedy = |found: &ReplacedJoints| {
        let mut ways = found.ways.iter().map(|way| {
            let mut way: Vec<&Weaker<'_>> = way.iter().map(|&k| &weaker[k]).collect();
            way.sort_by_key(|weaker| weaker.other.id);
            way
        });
        let verified = ways.find(|way| is_verified(start, of, found, way))?;
        Some(remedy(of, found, &verified, motion))
    };
    Ok(found.iter().filter_map(remedy).collect())
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
    let joints: Vec<&RetypedJoint> = others.iter().map(|other| &other.retyped).collect();
    let Some(changed) = read(start, &joints) else {
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
        let after = forces(new);
        let released = (forces(old) - after) as u32;
        let directions = other.retyped.directions.len() as u32;
        if after > 0 {
            out.push(Weaker {
                joint,
                other,
                cost: CHANGED + FORCE * released * released + DIRECTION * directions,
                loads: [after, other.spec.rows.len() - after],
            });
        }
    }
    Ok(())
}

/// Reads the scene with other types of joints; `None` if it is invalid.
fn read(start: &Start<'_>, joints: &[&RetypedJoint]) -> Option<AssembledScene> {
    let text = retyped(&start.text, joints).ok()?;
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
    let joints: Vec<&RetypedJoint> = way.iter().map(|joint| &joint.other.retyped).collect();
    let Some(mut changed) = read(start, &joints) else {
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
    motion: &str,
) -> RemedyDocument {
    let layout = of.mechanism.layout();
    let name = |id: &ConstraintId| layout.groups[id.0].name.clone();
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
    let all = match of.analysis.decision.redundancy - found.redundancy {
        0 => "all reactions are unique".to_owned(),
        _ => format!("the reactions of {} are unique", and(&reactions)),
    };
    let joints = ReplacedJointDocument::text(&replace, layout.space);
    RemedyDocument {
        text: format!("{joints}: {all}, and {motion}"),
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
    let remedies = d.answers.remedies.iter().take(LISTED);
    let lines = remedies.map(|remedy| {
        let lead = "Other joint types (design decision, analysed with these joints)";
        [Block::Gap, Block::sentence(format!("{lead}: {}", remedy.text))]
    });
    lines.flatten().collect()
}
