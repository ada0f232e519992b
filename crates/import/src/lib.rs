#![doc = include_str!("../README.md")]
//!
//! # Code map, in the order of the data
//!
//! | module | content |
//! | --- | --- |
//! | `limits` | largest sizes |
//! | `xml`, `files` | protected parsing, elements with their positions in the text; included files |
//! | `options` | options of an import |
//! | `findings` | problems, omitted content, digits of numbers |
//! | `vocabulary`, `changing` | the names in a format; unknown names are rejected, and names of content that changes the mechanism |
//! | `mjcf`, `urdf` with `loops`, `sdf` | one reader for each format |
//! | `solids`, `extensions` | common parts of URDF and SDF; elements of other programs that change the mechanism or act on joints |
//! | `mechanism`, `mass` | links, joints, couplings, keyframes; masses and simple solids |
//! | `drives` | drives from actuators |
//! | `couple` | couplings that are not satisfied at the described pose of the links |
//! | `digits`, `tolerance`, `angles` | the decimal places of the numbers of a file, and the accuracy of these numbers; angles in another unit |
//! | `pose` | poses of links for given joint coordinates |
//! | `start`, `assemble` | the initial state: keyframes, poses at which loops are closed |
//! | `axes` | axes that are nearly parallel or nearly intersect |
//! | `merge` | merges fixed links into other links |
//! | `names`, `write` | the text of the scene |

mod angles;
mod assemble;
mod axes;
mod changing;
mod couple;
mod digits;
mod drives;
mod extensions;
mod files;
mod findings;
mod limits;
mod loops;
mod mass;
mod mechanism;
mod merge;
mod mjcf;
mod names;
mod options;
mod pose;
mod sdf;
mod solids;
mod start;
mod tolerance;
mod urdf;
mod vocabulary;
mod write;
mod xml;

use scene::{Diagnostic, SourceText};

pub use axes::Axes;
pub use files::Folder;
pub use findings::Omission;
pub use options::{Base, Drives, FixedLinks, Options};

use findings::{Fault, Findings};
use mechanism::Model;

/// A scene that was created from a file.
#[derive(Clone, Debug)]
pub struct ImportedScene {
    /// The text of the scene.
    pub scene: String,
    /// `MJCF`, `URDF` or `SDF`.
    pub format: &'static str,
    /// Content of the file that the scene omits.
    pub omissions: Vec<Omission>,
    /// Statements about the scene as a whole, which are also at the start of its text.
    pub remarks: Vec<String>,
    /// Number of bodies, and number of joints and couplings, in the file.
    pub counts: [usize; 2],
    /// Number of joint coordinates with an armature.
    pub armatures: usize,
}

impl ImportedScene {
    /// Descriptions of omitted content, by kind, with lines of the file.
    #[must_use]
    pub fn left_out(&self) -> Vec<(&'static str, Vec<String>)> {
        write::by_kind(&self.omissions)
    }
}

/// Reason why a file cannot be imported.
#[derive(Clone, Debug)]
pub struct Refusal {
    /// The file with the problems, which is the given file or an included file.
    pub file: String,
    /// Text of this file.
    pub text: String,
    /// The problems.
    pub diagnostics: Vec<Diagnostic>,
}

impl Refusal {
    fn of(mut diagnostics: Vec<Diagnostic>, more: usize, texts: &[SourceText]) -> Self {
        // Positions refer to the text of one file. Problems of other files are reported after the
        // user has corrected this file.
        let file = diagnostics
            .first()
            .map_or_else(String::new, |d| d.file.clone());
        let all = diagnostics.len() + more;
        diagnostics.retain(|d| d.file == file);
        let text = texts.iter().find(|text| text.name() == file);
        let rest = all - diagnostics.len();
        if let (Some(last), true) = (diagnostics.last_mut(), rest > 0) {
            let help = last
                .help
                .take()
                .map(|help| format!("{help}; "))
                .unwrap_or_default();
            last.help = Some(format!("{help}{rest} more problems are not listed"));
        }
        Self {
            text: text.map_or_else(String::new, |text| text.text().to_owned()),
            file,
            diagnostics,
        }
    }
}

/// Imports a text; `name` is the name of its file.
///
/// ```
/// let file = r#"<mujoco model="pendulum"><worldbody><body name="rod">
///   <joint name="hinge" axis="0 1 0"/>
///   <inertial pos="0 0 -0.5" mass="2" diaginertia="0.17 0.17 0.001"/>
/// </body></worldbody></mujoco>"#;
/// let imported = pfaff_import::import("pendulum.xml", file, &pfaff_import::Options::default()).unwrap();
/// assert!(imported.scene.contains("type = \"revolute\""));
/// assert!(imported.omissions.is_empty());
/// ```
///
/// # Errors
/// All problems of the file, with their positions.
pub fn import(name: &str, text: &str, options: &Options) -> Result<ImportedScene, Box<Refusal>> {
    let mut findings = Findings::new(name);
    let source = SourceText::new(name, text);
    let loops = options.loops.as_ref();
    let loops = loops.map(|(name, text)| SourceText::new(name, text));
    let texts = files::load(source, &options.folder, &mut findings);
    let refused = |findings: &mut Findings| {
        let refusal = findings.refusal();
        let all: Vec<SourceText> = texts.all.iter().chain(&loops).cloned().collect();
        refusal.map(|(found, more)| Box::new(Refusal::of(found, more, &all)))
    };
    let mut documents = Vec::new();
    for text in &texts.all {
        match xml::parse(text) {
            Ok(document) => documents.push(document),
            Err(problem) => return Err(Box::new(Refusal::of(vec![*problem], 0, &texts.all))),
        }
    }
    // A file whose included files have problems is rejected here, because files that include each
    // other would be read without end.
    if let Some(refusal) = refused(&mut findings) {
        return Err(refusal);
    }
    let files = files::Files::new(&documents, &texts);
    let (mut model, format) = read(&files, options, loops.as_ref(), &mut findings);
    if let Some(refusal) = refused(&mut findings) {
        return Err(refusal);
    }
    check(&model, files.root(), &mut findings);
    settle(&mut model, files.root(), &mut findings);
    if let Some(refusal) = refused(&mut findings) {
        return Err(refusal);
    }
    drives::add(&mut model, options.drives, format, &mut findings);
    let tolerance = tolerance::tolerances(&model, &mut findings);
    let mut gap = 0.0;
    let motions = start::start(
        &mut model,
        options,
        tolerance[1],
        files.root(),
        (&mut gap, &mut findings),
    );
    let tolerance = tolerance::covering(tolerance, gap, &model, &mut findings);
    if let Some(refusal) = refused(&mut findings) {
        return Err(refusal);
    }
    let (mut motions, moves) = motions.map_or((Vec::new(), false), |(m, moves)| (m, moves));
    let starts = !motions.is_empty();
    let described = model.links.iter().map(|link| link.pose);
    let poses: Vec<_> = if starts {
        motions.iter().map(|motion| motion.pose).collect()
    } else {
        described.collect()
    };
    axes::look(&mut model, &poses, tolerance, options.axes, &mut findings);
    if options.fixed == FixedLinks::Merged {
        merge::merge(&mut model, &mut motions, &mut findings);
    }
    if model.links.is_empty() {
        let message = "every link is fixed to the ground, so no link moves";
        let help = start::nothing_moves(format, options.base);
        let root = files.root();
        let fault = Fault::Structure;
        findings.fault_with_help(fault, root.source, root.span(), message, "", help);
    }
    if let Some(refusal) = refused(&mut findings) {
        return Err(refusal);
    }
    let heading = write::Heading {
        source: (name, format),
        tolerance,
        start: starts.then_some((motions.as_slice(), moves)),
    };
    let scene = write::scene(&model, &heading, &mut findings);
    let joints = model
        .joints
        .iter()
        .filter(|joint| joint.kind.name().is_some())
        .count();
    Ok(ImportedScene {
        scene,
        format,
        counts: [model.links.len(), joints + model.couplings.len()],
        armatures: model.armatures(),
        omissions: findings.omissions,
        remarks: findings.remarks,
    })
}

fn read<'a>(
    files: &'a files::Files<'a>,
    options: &Options,
    loops: Option<&SourceText>,
    findings: &mut Findings,
) -> (Model, &'static str) {
    let root = files.root();
    let format = match root.name() {
        "mujoco" => "MJCF",
        "robot" => "URDF",
        "sdf" => "SDF",
        other => {
            let shown: String = other.chars().take(40).collect();
            let message =
                format!("the root is `<{shown}>`, expected `<mujoco>`, `<robot>` or `<sdf>`");
            findings.of(Fault::Format, root, message);
            return (Model::default(), "");
        }
    };
    match format {
        "MJCF" => vocabulary::check(root, mjcf::NAMES, Some(files), findings),
        "URDF" => vocabulary::check(root, urdf::NAMES, None, findings),
        // The reader of SDF also checks the names of included files.
        _ => vocabulary::check(root, sdf::NAMES, None, findings),
    }
    if options.base == Base::Free && format != "URDF" {
        let message = format!(
            "the option for a free base is only for URDF: a {format} file states which bodies are fixed to the ground"
        );
        findings.of(Fault::Unsupported, root, message);
    }
    if options.model.is_some() && format != "SDF" {
        let message =
            format!("the option for a model is only for SDF: a {format} file has one model");
        findings.of(Fault::Unsupported, root, message);
    }
    // A file with misspelt names is rejected here. The readers would report the intended names as
    // missing.
    if findings.has_problems() {
        return (Model::default(), format);
    }
    let mut model = match format {
        "MJCF" => mjcf::read(files, options.keyframe.as_deref(), findings),
        "URDF" => urdf::read(root, options.base, findings),
        _ => sdf::read(files, options.model.as_deref(), findings),
    };
    let told = angles::remarks(&findings.degrees, &findings.radians);
    findings.remarks.extend(told);
    match loops {
        Some(text) if format == "URDF" && !findings.has_problems() => {
            urdf::close_loops(&mut model, text, findings);
        }
        Some(text) if format != "URDF" => {
            let message = "a file of loops is only for URDF; other formats contain their loops";
            findings.fault(Fault::Loops, text, 0..0, message, "");
        }
        _ => {}
    }
    (model, format)
}

/// Satisfies the couplings at the described pose, or reports a coupling that contradicts others.
fn settle(model: &mut Model, root: xml::Element, findings: &mut Findings) {
    let Err((name, error)) = couple::settle(model, findings) else {
        return;
    };
    let message = format!(
        "no positions of the joints were found that satisfy all couplings: `{name}` is violated by {} m or rad",
        model::words::rough(error.abs())
    );
    let help =
        "remove a coupling of this joint or of a joint that it depends on, or set it inactive";
    let (fault, source, span) = (Fault::Structure, root.source, root.span());
    findings.fault_with_help(fault, source, span, message, "", help.to_owned());
}

/// Checks for bodies that no scene can contain.
fn check(model: &Model, root: xml::Element, findings: &mut Findings) {
    if model.links.is_empty() {
        findings.of(Fault::Structure, root, "the file has no body");
    }
    for link in &model.links {
        let mass = &link.mass;
        let is_finite = mass
            .inertia
            .iter()
            .chain(&mass.centre)
            .all(|x| x.is_finite());
        let is_fine = is_finite && mass.mass.is_finite();
        let numbers = link
            .pose
            .translation
            .vector
            .iter()
            .chain(link.pose.rotation.coords.iter());
        if !is_fine || numbers.into_iter().any(|x| !x.is_finite()) {
            let message = format!("the numbers of body `{}` are too large", link.name);
            findings.of(Fault::Range, root, message);
        }
    }
}
