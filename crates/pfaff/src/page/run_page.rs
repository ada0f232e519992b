//! The data from which a page is made.

use model::{ConstraintId, Mechanism};
use scene::{Cover, PrintStyle};
use solvability::Stretches;

use super::comparison::Comparison;
use crate::documents::{AnalysisDocument, FreedomsDocument, MakeUniqueDocument, RunDocument};
use crate::words::SceneUnits;
use report::Provenance;
use report::Recording;

/// The data from which a page is made.
pub struct RunPage<'a> {
    /// The mechanism that was run.
    pub mechanism: &'a Mechanism,
    /// Verdicts at the start, with their explanation. `None` if there is no analysis.
    pub analysis: Option<&'a AnalysisDocument>,
    /// Deletions that would make non-unique reactions unique.
    pub hints: &'a [MakeUniqueDocument],
    /// Kind of the page.
    pub shows: Shows<'a>,
    /// The verdicts on each stretch of time of the run. `None` if there is no run, or if no
    /// reactions were requested.
    pub stretches: Option<&'a Stretches>,
    /// Recorded rows of the run.
    pub recording: &'a Recording,
    /// Non-unique reactions for several choices.
    pub comparisons: &'a [Comparison],
    /// Bounds of components that are not unique, if bounds were requested.
    pub bands: &'a [Band],
    /// Sums of reactions of groups. A sum that is not unique has bounds, if bounds were requested.
    pub groups: &'a [Plot],
    /// Plots that the scene requests.
    pub plots: &'a [Plot],
    /// The values that drives prescribe, at the frames.
    pub drives: &'a [DriveCurve],
    /// Information to reproduce the run.
    pub origin: &'a Origin,
    /// The text of the scene with its units.
    pub scene: WrittenScene<'a>,
    /// Options of the run, as text.
    pub options: &'a [(String, String)],
    /// Sentences about the omitted parts.
    pub left_out: &'a [String],
    /// Figure of error against run time, as SVG, if there is one.
    pub work_precision: Option<&'a str>,
}

/// Bounds of a component of a reaction at the frames. A frame without bounds has NaN.
#[derive(Clone, Debug)]
pub struct Band {
    /// The joint or drive.
    pub id: ConstraintId,
    /// Name of the component.
    pub component: &'static str,
    /// The smallest and the largest value at each frame (N, N·m).
    pub ends: Vec<[f64; 2]>,
}

/// Curves of one unit in a plot.
#[derive(Clone, Debug)]
pub struct Plot {
    /// Title.
    pub title: String,
    /// SI unit.
    pub unit: &'static str,
    /// The curves.
    pub curves: Vec<PlotCurve>,
}

/// A number of a run at the frames.
#[derive(Clone, Debug)]
pub struct PlotCurve {
    /// Name of the column in the tables.
    pub name: String,
    /// The verdict over the run.
    pub verdict: &'static str,
    /// The values in the SI unit. A value is NaN if the model does not determine it.
    pub values: Vec<f64>,
    /// The smallest and the largest value at each frame. Both are NaN without bounds.
    pub band: Option<Vec<[f64; 2]>>,
}

impl PlotCurve {
    /// Whether the curve has no value.
    pub(super) fn is_empty(&self) -> bool {
        self.values.iter().all(|value| value.is_nan())
    }
}

/// Kind of a page.
#[derive(Clone, Copy)]
pub enum Shows<'a> {
    /// Page of the initial state only.
    Start,
    /// Page of a run, with its results.
    Run(&'a RunDocument),
    /// Page that animates one mode of the linearised motion. The text is a sentence about the mode.
    Mode(&'a str),
}

/// Information about the text of a scene for the page.
#[derive(Clone, Debug, Default)]
pub struct WrittenScene<'a> {
    /// The text, if there is one.
    pub text: Option<&'a str>,
    /// Joints, drives, forces and groups that are in the scene, but not active.
    pub inactive: Vec<String>,
    /// Units of the scene.
    pub units: SceneUnits,
    /// Acceleration due to gravity (m/s²).
    pub gravity: Vec<f64>,
    /// Title, author, project and date.
    pub cover: Cover,
    /// Style of the page of a run.
    pub print: PrintStyle,
}

impl RunPage<'_> {
    /// Returns the numbers of the run, if the page shows a run.
    pub(super) fn run(&self) -> Option<&RunDocument> {
        match self.shows {
            Shows::Run(run) => Some(run),
            Shows::Start | Shows::Mode(_) => None,
        }
    }

    /// Whether the page is a short report for print. Only runs have a page of this style.
    pub(super) fn is_for_customer(&self) -> bool {
        self.run().is_some() && self.scene.print == PrintStyle::Customer
    }

    /// Title of the page.
    pub(super) fn title(&self) -> &str {
        let title = self.scene.cover.title.as_deref();
        title.unwrap_or(self.mechanism.name())
    }

    /// Whether the picture is animated.
    pub(super) fn moves(&self) -> bool {
        !matches!(self.shows, Shows::Start)
    }

    /// Returns the free motions at the start.
    pub(super) fn freedoms(&self) -> Option<&FreedomsDocument> {
        let of_run = self.run().map(|run| &run.freedoms);
        of_run.or(self.analysis.map(|a| &a.ranks.freedoms))
    }

    /// Returns the name and the verdict of each joint and drive, and whether it is ill-determined.
    /// The verdict is the verdict over the run. Without a run, it is the verdict at the start.
    pub(super) fn verdicts(&self) -> Vec<(&str, &'static str, bool)> {
        match (self.run(), self.analysis) {
            (Some(run), _) => {
                let all = run.reactions.0.iter();
                all.map(|(name, r)| (name.as_str(), r.verdict(), r.data.fragile))
                    .collect()
            }
            (None, Some(a)) => {
                let all = a.reactions.iter();
                all.map(|r| (r.name.as_str(), r.wrench.verdict, r.data.fragile))
                    .collect()
            }
            (None, None) => Vec::new(),
        }
    }
}

/// The prescribed motion of a drive.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveCurve {
    /// Name of the drive.
    pub name: String,
    /// The driven quantity, as text.
    pub text: String,
    /// `m` or `rad`.
    pub unit: &'static str,
    /// Change of the driven quantity since the start, at the frames.
    pub values: Vec<f64>,
}

/// The origin of a page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Origin {
    /// The command line. If there was no command line, the name of the caller.
    pub command: String,
    /// Versions of program and compiler.
    pub versions: String,
}

impl From<&Provenance> for Origin {
    fn from(p: &Provenance) -> Self {
        Self {
            command: p.command.clone(),
            versions: p.versions.clone(),
        }
    }
}

impl Default for Origin {
    fn default() -> Self {
        Self {
            command: "none (the library was called directly)".to_owned(),
            versions: format!("pfaff {}", env!("CARGO_PKG_VERSION")),
        }
    }
}
