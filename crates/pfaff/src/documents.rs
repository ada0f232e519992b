//! Results as JSON documents. A document is a plain struct; its fields are the keys of the
//! document, in the same order. Rows are counted from 1, as in all texts for users. JSON has no NaN
//! and no infinity, so such numbers are written as `null`.

pub(crate) mod analysis;
mod answers;
mod bounds;
mod freedoms;
mod gap;
mod impulses;
mod loads;
mod misfits;
mod motion;
mod peaks;
mod plan;
mod run;
mod sensitivity;
#[cfg(test)]
mod tests;
mod tolerance;
mod verdicts;

use serde::Serialize;
use solvability::{Judgement, Verdict};

pub use analysis::{
    AlongDocument, AlongReactionDocument, AnalysisDocument, AnswersDocument, ComponentDocument,
    ConfigurationDocument, ContinuationDocument, DataDocument, DependencyDocument,
    DifferenceDocument, DistributionDocument, EliminationsDocument, EvidenceDocument,
    FreeDirectionDocument, GenericDocument, GenericRankDocument, GroupDocument, MakeUniqueDocument,
    MixingDocument, NearlyRedundantDocument, NoteDocument, PartsDocument, PassageDocument,
    PointDocument, RanksDocument, ReactionDocument, ReasonsDocument, RowDocument, StretchDocument,
    ValueDocument, ValuesDocument, WayDocument,
};
pub use answers::{
    CodeDocument, CodesDocument, EndedDocument, ImportDocument, NewDocument, OmissionDocument,
    RefusalDocument, TemplateDocument, TemplatesDocument, ViewDocument,
};
pub use bounds::{ExtremeDocument, MagnitudeOfRunDocument, RangeOfRunDocument, RunBoundsDocument};
pub use freedoms::{FreeMotionDocument, FreedomsDocument, LeftOutDocument, WithoutDrivesDocument};
pub use gap::Gap;
pub use impulses::ImpulseDocument;
pub use loads::{LoadsDocument, loads_at};
pub use misfits::{MisfitDocument, SpreadDocument};
pub use motion::{MomentDocument, MotionDocument};
pub(crate) use peaks::LoadPeak;
pub use plan::decision_key;
pub use report::ByName;
pub use report::figures::RangeDocument;
pub use run::{
    BodyOfRunDocument, ChoiceDocument, ComponentRunDocument, Ending, EventDocument,
    LoadOfRunDocument, PullDocument, Run, RunDocument, TRUSTED_BALANCE, choice_file,
};
pub use sensitivity::SensitivityDocument;
pub use tolerance::{
    BoundsOfSamples, DescribedDocument, DrawnDocument, FailureDocument, MarkerRangeDocument,
    MeasureRangeDocument, MovedDocument, OpeningsDocument, PermittedOfSamples,
    QuantityRangeDocument, RankCountDocument, ReactionRangeDocument, RowMisfitDocument,
    ToleranceDocument, VariedDocument, VerdictCounts,
};
pub use verdicts::{
    MagnitudePeakDocument, PeakDocument, RunGroupDocument, RunNumberDocument, RunReactionDocument,
    RunVerdicts, SpecialDocument, TrackDocument,
};

/// A verdict with its number: `verdict`, `margin`, `within_tolerance`, and a `reason` if it is
/// undecided.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct VerdictDocument {
    /// `unique`, `not_unique` or `undecided`.
    pub verdict: &'static str,
    /// Reason why the verdict is undecided.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Distance of the reaction from being unique; 0 for a unique reaction.
    pub margin: f64,
    /// Whether the reaction is unique only within the tolerance that the scene states. Then the
    /// margin is above the rounding of the data, but data within their tolerance explain it.
    pub within_tolerance: bool,
}

impl From<&Judgement> for VerdictDocument {
    fn from(judgement: &Judgement) -> Self {
        let reason = match &judgement.verdict {
            Verdict::Undecided { reason } => Some(reason.clone()),
            _ => None,
        };
        Self {
            verdict: judgement.verdict.word(),
            reason,
            margin: judgement.margin,
            within_tolerance: judgement.within_tolerance,
        }
    }
}

/// Row numbers counted from 1.
fn from_one(rows: &[usize]) -> Vec<usize> {
    rows.iter().map(|row| row + 1).collect()
}
