//! Documents of commands whose result is a few numbers, and of errors. `ok` states whether there is
//! a result.

use model::codes::{Code, Entry, Example};
use serde::Serialize;

/// Reason why there is no result.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
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
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
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
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
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
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
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

/// A picture that was written.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
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
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
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
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
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
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
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
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TemplatesDocument<'a> {
    /// `true`
    pub ok: bool,
    /// Each template with its description.
    pub templates: Vec<TemplateDocument<'a>>,
}

/// A template.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TemplateDocument<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its description.
    pub summary: String,
}
