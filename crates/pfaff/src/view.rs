//! The assembled start as a page, or as a picture with joints marked by their verdicts.

use std::path::Path;

use crate::documents::AnalysisDocument;
use crate::page::{Origin, RunPage, Shows, run_page};
use model::System;
use model::words::in_units_of_scenes;
use report::figures::{Labels, Marking, labelled_mechanism, png};
use report::{Frame, Recording};

use crate::configuration::ConfigurationAnalysis;
use crate::error::StudyError;
use crate::question::Control;
use crate::refusal::Refusal;
use crate::start::{Start, document_of, verdicts_of};

/// Format of the drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// A page for any browser.
    Page,
    /// A picture as SVG.
    Svg,
    /// A picture as PNG.
    Png,
}

impl Form {
    /// All formats, by the extension of the file name.
    pub const ALL: [(&str, Self); 3] =
        [("html", Self::Page), ("svg", Self::Svg), ("png", Self::Png)];

    /// Returns the format for the extension of a file name.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        let end = path.extension()?;
        let mut forms = Self::ALL.into_iter();
        forms.find_map(|(name, form)| end.eq_ignore_ascii_case(name).then_some(form))
    }
}

/// A drawn start.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Drawing {
    /// Name of the scene.
    pub scene: String,
    /// Contents of the file.
    pub content: Vec<u8>,
    /// Size of a PNG (pixels).
    pub pixels: Option<[u32; 2]>,
    /// Characters that are drawn as boxes in a PNG because no font contains them.
    pub boxes: String,
    /// Document of the verdicts that the drawing shows.
    pub document: AnalysisDocument,
}

impl Drawing {
    /// Draws the start of a scene. `scale` is the number of pixels of a PNG for each px.
    ///
    /// # Errors
    /// Returns an error if the scene has no start, or if the picture cannot be painted.
    pub fn new(
        of: &Start<'_>,
        form: Form,
        scale: Option<f64>,
        control: &Control<'_>,
    ) -> Result<Self, Refusal> {
        in_units_of_scenes(|| Self::drawn(of, (form, scale), control, document_of))
    }

    /// Draws the page of a start while a user drags a body. The page has no sensitivities.
    ///
    /// # Errors
    /// Returns an error if the scene has no start.
    pub fn while_dragged(of: &Start<'_>, control: &Control<'_>) -> Result<Self, Refusal> {
        in_units_of_scenes(|| Self::drawn(of, (Form::Page, None), control, verdicts_of))
    }

    fn drawn(
        of: &Start<'_>,
        (form, scale): (Form, Option<f64>),
        control: &Control<'_>,
        document: impl Fn(&ConfigurationAnalysis<'_>) -> Result<AnalysisDocument, StudyError>,
    ) -> Result<Self, Refusal> {
        let judged = of.judged(control)?;
        let start = of.configuration(&judged, judged.start_time(), control, |_| ());
        let start = start.map_err(|e| of.refusal(e))?;
        let document = document(&start).map_err(|e| of.refusal(e))?;
        let (mut pixels, mut boxes) = (None, String::new());
        let content = match form {
            Form::Page => page(&start, &document, &control.provenance.into()).into_bytes(),
            Form::Svg => figure(&start)?.into_bytes(),
            Form::Png => {
                let painted = png(&figure(&start)?, scale)?;
                (pixels, boxes) = (Some(painted.pixels), painted.boxes);
                painted.bytes
            }
        };
        Ok(Self {
            scene: start.scene.name().to_owned(),
            content,
            pixels,
            boxes,
            document,
        })
    }
}

/// Returns the picture of the start as SVG.
fn figure(start: &ConfigurationAnalysis<'_>) -> Result<String, Refusal> {
    let marking = Marking::Verdicts(&start.analysis.reactions);
    let labels = Labels::NamesAndRows;
    labelled_mechanism(
        start.mechanism,
        start.mechanism.layout().start_time,
        &start.state.q,
        marking,
        labels,
    )
    .map_err(|e| Refusal::stopped(e.to_string()))
}

/// Returns the page for the start, without a run.
fn page(start: &ConfigurationAnalysis<'_>, document: &AnalysisDocument, origin: &Origin) -> String {
    let layout = start.mechanism.layout();
    let mut recording = Recording::new(layout.start_time, 1.0, 1);
    let frame = Frame::at_rest(layout.start_time, &start.state.q, layout.n_v);
    recording.frames.push(frame);
    run_page(&RunPage {
        mechanism: start.mechanism,
        analysis: Some(document),
        hints: &[],
        shows: Shows::Start,
        stretches: None,
        recording: &recording,
        comparisons: &[],
        bands: &[],
        groups: &[],
        plots: &[],
        drives: &[],
        origin,
        scene: crate::written_scene(start.scene),
        options: &[],
        left_out: &[],
        work_precision: None,
    })
}
