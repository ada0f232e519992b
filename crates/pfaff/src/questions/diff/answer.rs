//! The differences between two scenes.

use std::path::Path;

use crate::documents::AnalysisDocument;
use crate::documents::{ComponentDocument, DependencyDocument, ExtremeDocument, ReactionDocument};
use serde::Serialize;

use super::comparison::Comparison;

/// Comparison of two scenes.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DiffAnswer {
    /// `true`
    pub ok: bool,
    /// The first scene.
    pub a: DiffSide,
    /// The second scene.
    pub b: DiffSide,
    /// Joints and drives that only the first scene has.
    pub removed: Vec<DiffReaction>,
    /// Joints and drives that only the second scene has.
    pub added: Vec<DiffReaction>,
    /// Joints and drives that differ.
    pub changed: Vec<DiffChange>,
    /// Dependencies that only the first scene has.
    pub dependencies_gone: Vec<DependencyDocument>,
    /// Dependencies that only the second scene has.
    pub dependencies_new: Vec<DependencyDocument>,
    /// Differences of the motions; `null` if they were not compared.
    pub motion: Option<DiffMotion>,
    /// Reason why the motions were not compared.
    pub motion_not_compared: Option<String>,
}

impl DiffAnswer {
    /// Builds the answer from two starts and from the differences of the motions. If the motions
    /// are not compared, the last argument is the reason. `names` are the names of the scenes in
    /// messages.
    pub(super) fn new(
        names: [&str; 2],
        documents: &[AnalysisDocument; 2],
        motion: Result<DiffMotion, String>,
    ) -> Self {
        let [a, b] = documents;
        let c = Comparison::of(a, b);
        let named = |list: &[&ReactionDocument]| -> Vec<DiffReaction> {
            let named = |r: &&ReactionDocument| DiffReaction {
                name: Some(r.name.clone()),
                ..(*r).into()
            };
            list.iter().map(named).collect()
        };
        let changed = c.verdicts.iter().map(|change| DiffChange {
            name: change.name.to_owned(),
            a: change.sides[0].into(),
            b: change.sides[1].into(),
        });
        let [in_a, in_b] = in_short(names);
        let owned = |list: &[&DependencyDocument]| list.iter().copied().cloned().collect();
        let (motion, motion_not_compared) = match motion {
            Ok(motion) => (Some(motion), None),
            Err(why) => (None, Some(why)),
        };
        Self {
            ok: true,
            a: DiffSide::of(in_a, a),
            b: DiffSide::of(in_b, b),
            removed: named(&c.removed),
            added: named(&c.added),
            changed: changed.collect(),
            dependencies_gone: owned(&c.gone),
            dependencies_new: owned(&c.new),
            motion,
            motion_not_compared,
        }
    }
}

/// Returns names of files without directories. The directories are included only if the names would
/// be equal.
fn in_short(names: [&str; 2]) -> [String; 2] {
    let short = names.map(|name| match Path::new(name).file_name() {
        Some(file) => file.to_string_lossy().into_owned(),
        None => name.to_owned(),
    });
    if short[0] == short[1] {
        names.map(str::to_owned)
    } else {
        short
    }
}

/// One of two scenes.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct DiffSide {
    /// Name of the scene.
    pub scene: String,
    /// Number of bodies.
    pub bodies: usize,
    /// Number of rows.
    pub rows: usize,
    /// Rank of C.
    pub rank: usize,
    /// Degree of redundancy.
    pub redundancy: usize,
    /// Degrees of freedom.
    pub mobility: usize,
    /// Degrees of freedom without the drives, if the scene has drives.
    pub mobility_without_drives: Option<usize>,
    /// Name of the scene file.
    #[serde(skip)]
    pub(super) file: String,
    /// Numbers of joints and drives: in total, with reactions that are not unique, and with
    /// ill-determined reactions.
    #[serde(skip)]
    pub(super) reactions: [usize; 3],
}

impl DiffSide {
    fn of(file: String, d: &AnalysisDocument) -> Self {
        let open = |r: &&ReactionDocument| r.wrench.verdict == "not_unique";
        Self {
            scene: d.configuration.scene.clone(),
            bodies: d.configuration.bodies,
            rows: d.configuration.rows,
            rank: d.ranks.rank,
            redundancy: d.ranks.redundancy,
            mobility: d.ranks.mobility,
            mobility_without_drives: d.ranks.freedoms.mobility_without_drives(),
            file,
            reactions: [
                d.reactions.len(),
                d.reactions.iter().filter(open).count(),
                d.fragile_reactions().count(),
            ],
        }
    }
}

/// A joint or drive of one of two scenes.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct DiffReaction {
    /// Name of the joint or drive, unless the object that contains it gives the name.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Type of the joint or drive.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// What the joint cannot do: it is one-sided, or grips with a coefficient of friction.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact: Option<String>,
    /// Rows of the joint or drive, counted from 1.
    pub rows: Vec<usize>,
    /// Verdict on the reaction.
    pub verdict: &'static str,
    /// Whether the reaction, or a component, is ill-determined.
    pub fragile: bool,
    /// Components of the reaction.
    pub components: Vec<ComponentDocument>,
    /// The verdict as text.
    #[serde(skip)]
    pub(super) said: String,
}

impl From<&ReactionDocument> for DiffReaction {
    fn from(r: &ReactionDocument) -> Self {
        Self {
            name: None,
            kind: r.kind,
            contact: r.contact.clone(),
            rows: r.rows.clone(),
            verdict: r.wrench.verdict,
            fragile: r.data.fragile,
            components: r.components.clone(),
            said: said(r),
        }
    }
}

/// Describes the verdict on a reaction. The text includes components that are not unique or are
/// ill-determined.
fn said(r: &ReactionDocument) -> String {
    let names = |is: &dyn Fn(&&ComponentDocument) -> bool| -> String {
        let those = r.components.iter().filter(|c| is(c)).map(|c| c.name);
        those.collect::<Vec<_>>().join(", ")
    };
    let mut notes = vec![names(&|c| c.verdict.verdict == "not_unique")];
    let fragile = r.fragile_names();
    if !fragile.is_empty() && fragile != [r.name.clone()] {
        notes.push(format!("FRAGILE: {}", names(&|c| c.data.fragile)));
    }
    notes.retain(|note| !note.is_empty());
    match notes.as_slice() {
        [] => r.said(),
        notes => format!("{} ({})", r.said(), notes.join("; ")),
    }
}

/// A joint or drive that both scenes have.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DiffChange {
    /// Name of the joint or drive.
    pub name: String,
    /// The joint or drive in the first scene.
    pub a: DiffReaction,
    /// The joint or drive in the second scene.
    pub b: DiffReaction,
}

/// Differences of two motions.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DiffMotion {
    /// Time up to which both scenes were run (s): the earlier of their end times.
    pub t_end: f64,
    /// Bodies that both scenes have, in the order of the first scene.
    pub bodies: Vec<DiffBody>,
    /// The peak loads in both motions, in the order of the first scene.
    pub loads: Vec<DiffLoad>,
}

/// The peaks of a load in two motions.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DiffLoad {
    /// Name of the joint, drive, group or force element.
    pub name: String,
    /// `force` and `moment` for the largest magnitudes, or the name of a component.
    pub load: String,
    /// Unit of the values.
    pub unit: &'static str,
    /// The peak in the first motion; `null` if the first scene has no such load, or if the load is
    /// not determined during the whole motion.
    pub a: Option<ExtremeDocument>,
    /// The same in the second motion.
    pub b: Option<ExtremeDocument>,
}

impl DiffLoad {
    /// Returns the difference of the two peaks, as a fraction of the larger peak. The result is 1
    /// if only one peak exists.
    pub(super) fn change(&self) -> f64 {
        match (self.a, self.b) {
            (Some(a), Some(b)) => {
                let larger = a.value.abs().max(b.value.abs());
                if larger > 0.0 {
                    (b.value - a.value).abs() / larger
                } else {
                    0.0
                }
            }
            (None, None) => 0.0,
            _ => 1.0,
        }
    }
}

/// The largest differences of the motions of a body, with their times (s).
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DiffBody {
    /// Name of the body.
    pub body: String,
    /// Distance between the origins of its frame in both motions (m).
    pub distance: f64,
    /// Time of the largest distance (s).
    pub t_distance: f64,
    /// Difference of angles (rad); in space the angle of the rotation from one orientation to the
    /// other, up to half a turn.
    pub angle: f64,
    /// Time of the largest difference of angles (s).
    pub t_angle: f64,
}
