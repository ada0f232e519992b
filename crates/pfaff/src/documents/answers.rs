//! Documents of commands whose result is a few numbers, and documents of errors. The key `ok`
//! states whether there is a result.

use model::codes::{Code, Entry, Example};
use serde::Serialize;

/// Reason why there is no result.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RefusalDocument<'a, P> {
    /// `false`
    pub ok: bool,
    /// Code of the reason.
    pub code: Option<Code>,
    /// The reason as one line of text.
    pub error: String,
    /// Invalid positions in the scene.
    pub problems: &'a [P],
}

/// Codes of errors and warnings with their meanings.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CodesDocument {
    /// `true`
    pub ok: bool,
    /// The codes, in ascending order.
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

/// Meaning of one code.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CodeDocument {
    code: Code,
    title: &'static str,
    advice: &'static str,
    /// Arguments of `pfaff` with which the code is reported.
    arguments: Option<&'static str>,
    /// The scene that these arguments need on standard input.
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

/// The summary of a run whose process ended before it could write its own summary.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct EndedDocument {
    /// Name of the scene.
    pub scene: String,
    /// `true`
    pub partial: bool,
    /// Code of the reason why it ended.
    pub code: Code,
    /// Reason why the process ended.
    pub error: &'static str,
}

/// A picture that was written to a file.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ViewDocument<'a> {
    /// `true`
    pub ok: bool,
    /// Name of the scene.
    pub scene: &'a str,
    /// The file.
    pub file: String,
    /// Size of the file (bytes).
    pub bytes: usize,
    /// Width and height of a PNG in pixels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pixels: Option<[u32; 2]>,
    /// Characters that are drawn as boxes in a PNG because no font contains them.
    #[serde(skip_serializing_if = "str::is_empty")]
    pub boxes: &'a str,
    /// Number of joints and drives.
    pub reactions: usize,
    /// Number of reactions that are not unique.
    pub not_unique: usize,
    /// Number of reactions with an ill-determined unique component.
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

/// A scene that was converted from a file of another format.
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
    /// Number of joint coordinates with an armature.
    pub armatures: usize,
    /// Statements about the scene as a whole.
    pub remarks: &'a [String],
    /// Elements of the file that the scene does not contain.
    pub left_out: Vec<OmissionDocument<'a>>,
    /// The first error of the scene, if the scene has an error.
    pub scene_error: Option<String>,
}

/// An element of a file that the converted scene does not contain.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OmissionDocument<'a> {
    /// Kind of the element.
    pub kind: &'a str,
    /// Name of the element.
    pub subject: &'a str,
    /// File of the element, if it is an included file.
    pub file: Option<&'a str>,
    /// Line of the element in its file.
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
    /// Name of the template.
    pub name: &'a str,
    /// Description of the template.
    pub summary: String,
}
