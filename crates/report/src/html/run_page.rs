//! What a page is made of.

use model::Mechanism;

use super::comparison::Comparison;
use crate::documents::{AnalysisDocument, FreedomsDocument, MakeUniqueDocument, RunDocument};
use crate::recording::Recording;

/// What a page is made of.
pub struct RunPage<'a> {
    /// The mechanism that was run.
    pub mechanism: &'a Mechanism,
    /// Verdicts at the start, with their explanation; `None` if none could be made.
    pub analysis: Option<&'a AnalysisDocument>,
    /// For reactions that are not unique, what would make them so.
    pub hints: &'a [MakeUniqueDocument],
    /// Numbers of the run; `None` for the page of a start alone.
    pub run: Option<&'a RunDocument>,
    /// Its rows.
    pub recording: &'a Recording,
    /// Reactions that are not unique, by several choices.
    pub comparisons: &'a [Comparison],
    /// What drives prescribe, at the frames.
    pub drives: &'a [DriveCurve],
    /// How to get the same run again.
    pub origin: &'a Origin,
    /// The text of the scene, if there is one.
    pub scene: Option<&'a str>,
    /// Options of the run, in words.
    pub options: &'a [(String, String)],
    /// What was left out, in sentences.
    pub left_out: &'a [String],
    /// Error against run time, as an SVG figure, if there is one.
    pub work_precision: Option<&'a str>,
}

impl RunPage<'_> {
    /// What can move at the start.
    pub(super) fn freedoms(&self) -> Option<&FreedomsDocument> {
        let of_run = self.run.map(|run| &run.freedoms);
        of_run.or(self.analysis.map(|a| &a.ranks.freedoms))
    }

    /// Joints and drives at the start: name, verdict, and whether they are fragile.
    pub(super) fn verdicts(&self) -> Vec<(&str, &'static str, bool)> {
        match (self.run, self.analysis) {
            (Some(run), _) => {
                let all = run.reactions.0.iter();
                all.map(|(name, r)| (name.as_str(), r.verdict.verdict, r.data.fragile))
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

/// What a drive prescribes.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveCurve {
    /// Its name.
    pub name: String,
    /// What is driven, in words.
    pub text: String,
    /// `m` or `rad`.
    pub unit: &'static str,
    /// Change since the start, at the frames.
    pub values: Vec<f64>,
}

/// By whom and how a page was made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Origin {
    /// The command line, or where there was none, who called.
    pub command: String,
    /// Versions of program and compiler.
    pub versions: String,
}

impl Default for Origin {
    fn default() -> Self {
        Self {
            command: "called from a program".to_owned(),
            versions: format!("pfaff {}", env!("CARGO_PKG_VERSION")),
        }
    }
}
