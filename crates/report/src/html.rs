//! `report.html` of a run: one file that opens without a network, for a reader who has the
//! mechanism in mind and not the program. The mechanism moves, verdicts are told in words, curves
//! have their cursor where the picture is.
//!
//! A reaction that is not unique has no curve of its own: it is a band between choices that are
//! named ([`Comparison`]).
//!
//! | module | content |
//! | --- | --- |
//! | `comparison` | what several choices say of the same reaction |
//! | `data` | bodies, joints and curves as one JSON document, rounded |
//! | `document`, `verdicts`, `inputs` | the page around them |
//! | `report.css`, `script/` | its looks, and what moves |

mod comparison;
mod data;
mod document;
mod inputs;
mod verdicts;

use model::Mechanism;

use crate::documents::{AnalysisDocument, MakeUniqueDocument, RunDocument};
use crate::recording::Recording;

pub use comparison::{ComparedChoice, Comparison, Freedom};

/// What a page is made of.
pub struct RunPage<'a> {
    /// The mechanism that was run.
    pub mechanism: &'a Mechanism,
    /// Verdicts at the start, with their explanation; nothing where none could be made.
    pub analysis: Option<&'a AnalysisDocument>,
    /// For reactions that are not unique, what would make them so.
    pub hints: &'a [MakeUniqueDocument],
    /// Numbers of the run.
    pub run: &'a RunDocument,
    /// Its rows.
    pub recording: &'a Recording,
    /// Reactions that are not unique, by several choices.
    pub comparisons: &'a [Comparison],
    /// What drives prescribe, at the frames.
    pub drives: &'a [DriveCurve],
    /// How to get the same run again.
    pub origin: &'a Origin,
    /// The text of the scene, where there is one.
    pub scene: Option<&'a str>,
    /// Options of the run, in words.
    pub options: &'a [(String, String)],
    /// What was left out, in sentences.
    pub left_out: &'a [String],
    /// Error against run time, as an SVG figure, where there is one.
    pub work_precision: Option<&'a str>,
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

/// Numbers of a row of a recording: what it holds, and what a page shows of it.
#[must_use]
pub fn numbers_per_row(mechanism: &Mechanism) -> usize {
    data::numbers_per_row(mechanism)
}

/// The page. Same input, same bytes.
#[must_use]
pub fn run_page(page: &RunPage<'_>) -> String {
    document::document(page)
}
