//! Documents of commands whose result is a few numbers, and of errors. `ok` states whether there is
//! a result.

use model::codes::{Code, Entry, Example};
use serde::Serialize;

use super::{AnalysisDocument, ComponentDocument, DependencyDocument, ReactionDocument};

/// Reason why there is no result.
#[derive(Clone, Debug, Serialize)]
pub struct RefusalDocument<'a, P> {
    /// `false`
    pub ok: bool,
    /// Its code.
    pub code: Option<Code>,
    /// The reason in one line.
    pub error: String,
    /// Places in the scene that are wrong.
    pub problems: &'a [P],
}

/// Codes of errors and warnings with what they mean.
#[derive(Clone, Debug, Serialize)]
pub struct CodesDocument {
    /// `true`
    pub ok: bool,
    /// The codes, ascending.
    pub codes: Vec<CodeDocument>,
}

impl CodesDocument {
    /// The document of these entries of the table.
    #[must_use]
    pub fn new(entries: &[Entry]) -> Self {
        let codes = entries.iter().map(CodeDocument::from).collect();
        Self { ok: true, codes }
    }
}

/// What one code means.
#[derive(Clone, Debug, Serialize)]
pub struct CodeDocument {
    code: Code,
    title: &'static str,
    advice: &'static str,
    /// Arguments of `pfaff` with which it is reported.
    arguments: Option<&'static str>,
    /// The scene on standard input that they need.
    scene: Option<&'static str>,
}

impl From<&Entry> for CodeDocument {
    fn from(entry: &Entry) -> Self {
        let (arguments, scene) = match entry.example {
            Example::Scene(arguments, scene) => (Some(arguments), Some(scene)),
            Example::Command(arguments) => (Some(arguments), None),
            Example::None(_) => (None, None),
        };
        Self {
            code: entry.code,
            title: entry.title,
            advice: entry.advice,
            arguments,
            scene,
        }
    }
}

/// The summary of a run whose process was ended before it could write its own.
#[derive(Clone, Debug, Serialize)]
pub struct EndedDocument {
    /// Name of the scene.
    pub scene: String,
    /// `true`
    pub partial: bool,
    /// Code of the reason why it ended.
    pub code: Code,
    /// Why it ended.
    pub error: &'static str,
}

/// A scene that was read and assembled.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CheckDocument<'a, P> {
    /// `true`
    pub ok: bool,
    /// Name of the scene.
    pub scene: &'a str,
    /// Number of bodies.
    pub bodies: usize,
    /// Number of coordinates n_q.
    pub coordinates: usize,
    /// Number of velocities n_v.
    pub velocities: usize,
    /// Number of holonomic rows m.
    pub holonomic_rows: usize,
    /// Number of nonholonomic rows h.
    pub nonholonomic_rows: usize,
    /// The largest correction of a coordinate of the start (m, rad).
    pub start_correction: f64,
    /// The largest correction of a velocity (m/s, rad/s), if there is a motion.
    pub start_velocity_correction: Option<f64>,
    /// Mobility n_v − r.
    pub mobility: Option<usize>,
    /// Mobility without the drives.
    pub mobility_without_drives: Option<usize>,
    /// Whether no motion is possible; `null` if this is not decided.
    pub cannot_move: Option<bool>,
    /// Joints, drives, forces and groups that are in the scene, but not active.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    pub inactive: &'a [String],
    /// The warnings of the text with their places: a scene with errors is refused.
    pub problems: &'a [P],
    /// Other remarks for the reader.
    pub warnings: &'a [String],
}

/// A picture that was written.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ViewDocument<'a> {
    /// `true`
    pub ok: bool,
    /// Name of the scene.
    pub scene: &'a str,
    /// The file.
    pub file: String,
    /// Its size (bytes).
    pub bytes: usize,
    /// Width and height of a PNG in pixels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pixels: Option<[u32; 2]>,
    /// Characters that are boxes in a PNG because no font has them.
    #[serde(skip_serializing_if = "str::is_empty")]
    pub boxes: &'a str,
    /// Number of joints and drives.
    pub reactions: usize,
    /// Number of reactions that are not unique.
    pub not_unique: usize,
    /// Number of reactions with a unique component that is fragile.
    pub fragile: usize,
    /// Mobility n_v − r.
    pub mobility: usize,
    /// Mobility without the drives.
    pub mobility_without_drives: Option<usize>,
}

/// A template that was written.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NewDocument<'a> {
    /// `true`
    pub ok: bool,
    /// Name of the template.
    pub template: &'a str,
    /// The file.
    pub file: &'a str,
}

/// A scene that was made of a file of another format.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ImportDocument<'a> {
    /// Whether the scene that was written has no error.
    pub ok: bool,
    /// Format of the file.
    pub source_format: &'a str,
    /// The scene file.
    pub file: &'a str,
    /// Number of bodies.
    pub bodies: usize,
    /// Number of joints and couplings.
    pub joints: usize,
    /// Number of rotors for armatures: each is one more body with a joint and a coupling.
    pub rotors: usize,
    /// Statements about the scene as a whole.
    pub remarks: &'a [String],
    /// What the scene does not contain.
    pub left_out: Vec<OmissionDocument<'a>>,
    /// The first error of the scene, where it has one.
    pub scene_error: Option<String>,
}

/// Something of a file that its scene does not contain.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OmissionDocument<'a> {
    /// What kind of thing.
    pub kind: &'a str,
    /// Which one.
    pub subject: &'a str,
    /// Its file, if it is an included one.
    pub file: Option<&'a str>,
    /// Its line.
    pub line: usize,
}

/// All templates.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TemplatesDocument<'a> {
    /// `true`
    pub ok: bool,
    /// Each template with its description.
    pub templates: Vec<TemplateDocument<'a>>,
}

/// A template.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TemplateDocument<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its description.
    pub summary: String,
}

/// Comparison of two scenes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DiffDocument<'a> {
    /// `true`
    pub ok: bool,
    /// The first scene.
    pub a: DiffSide<'a>,
    /// The second scene.
    pub b: DiffSide<'a>,
    /// Joints and drives that only the first scene has.
    pub removed: Vec<DiffReaction<'a>>,
    /// Joints and drives that only the second scene has.
    pub added: Vec<DiffReaction<'a>>,
    /// Joints and drives that differ.
    pub changed: Vec<DiffChange<'a>>,
    /// Dependencies that only the first scene has.
    pub dependencies_gone: &'a [&'a DependencyDocument],
    /// Dependencies that only the second scene has.
    pub dependencies_new: &'a [&'a DependencyDocument],
    /// Differences of the motions; `null` if they were not compared.
    pub motion: Option<&'a DiffMotion>,
    /// Why they were not.
    pub motion_not_compared: Option<&'a str>,
}

/// One of two scenes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DiffSide<'a> {
    scene: &'a str,
    bodies: usize,
    rows: usize,
    rank: usize,
    redundancy: usize,
    mobility: usize,
    mobility_without_drives: Option<usize>,
}

impl<'a> From<&'a AnalysisDocument> for DiffSide<'a> {
    fn from(d: &'a AnalysisDocument) -> Self {
        Self {
            scene: &d.configuration.scene,
            bodies: d.configuration.bodies,
            rows: d.configuration.rows,
            rank: d.ranks.rank,
            redundancy: d.ranks.redundancy,
            mobility: d.ranks.mobility,
            mobility_without_drives: d.ranks.freedoms.mobility_without_drives(),
        }
    }
}

/// A joint or drive of one of two scenes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DiffReaction<'a> {
    /// Its name, unless the object that contains it gives the name.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<&'a str>,
    #[serde(rename = "type")]
    kind: &'a str,
    rows: &'a [usize],
    verdict: &'static str,
    fragile: bool,
    components: &'a [ComponentDocument],
}

impl<'a> From<&'a ReactionDocument> for DiffReaction<'a> {
    fn from(r: &'a ReactionDocument) -> Self {
        Self {
            name: None,
            kind: r.kind,
            rows: &r.rows,
            verdict: r.wrench.verdict,
            fragile: r.data.fragile,
            components: &r.components,
        }
    }
}

impl<'a> DiffReaction<'a> {
    /// With the name of the reaction.
    #[must_use]
    pub fn named(r: &'a ReactionDocument) -> Self {
        Self {
            name: Some(&r.name),
            ..r.into()
        }
    }
}

/// A joint or drive that both scenes have.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DiffChange<'a> {
    /// Its name.
    pub name: &'a str,
    /// In the first scene.
    pub a: DiffReaction<'a>,
    /// In the second scene.
    pub b: DiffReaction<'a>,
}

/// Differences of two motions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DiffMotion {
    /// How far both were run (s): to the earlier of their ends.
    pub t_end: f64,
    /// Bodies that both scenes have, in the order of the first.
    pub bodies: Vec<DiffBody>,
}

/// The largest differences of the motions of a body, and when (s).
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct DiffBody {
    /// The body.
    pub body: String,
    /// Distance of the origins of its frame (m).
    pub distance: f64,
    /// Time of the largest distance (s).
    pub t_distance: f64,
    /// Difference of angles (rad); in space the angle of the rotation from one orientation to the
    /// other, up to half a turn.
    pub angle: f64,
    /// Time of the largest difference of angles (s).
    pub t_angle: f64,
}
