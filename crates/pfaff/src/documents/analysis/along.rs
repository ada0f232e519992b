//! Verdicts along a motion.

use model::Layout;
use serde::Serialize;
use solvability::{
    Continuation, Difference, MotionAnalysis, Passage, PassageKind, ReactionStretches, Stretch,
};

use crate::documents::{
    ByName, MagnitudeOfRunDocument, RangeOfRunDocument, RunBoundsDocument, SpecialDocument,
    TrackDocument,
};

/// The verdicts of a motion by stretches of time, and its singular configurations.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct AlongDocument {
    /// Last time that was analysed (s); the first is 0.
    pub to: f64,
    /// Number of analysed states.
    pub samples: usize,
    /// Largest displacement of a body between two analysed states: a fraction of the size of the
    /// mechanism, or an angle (rad).
    pub reach: f64,
    /// Reason why the motion stopped at this time, if it did.
    pub stopped: Option<String>,
    /// Time (s) up to which the analysis extrapolated the motion smoothly beyond the singular
    /// configuration at which it stopped.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub continued_to: Option<f64>,
    /// The rank at almost all times of the motion.
    pub generic: GenericRankDocument,
    /// The verdicts on joints and drives over the motion, in the format of `summary.json` of a run.
    pub reactions: ByName<AlongReactionDocument>,
    /// Instants at which a verdict differs from the verdict of its stretch.
    pub special: Vec<SpecialDocument>,
    /// Stretches of time with another rank.
    pub stretches: Vec<StretchDocument>,
    /// Singular configurations.
    pub passages: Vec<PassageDocument>,
    /// The assumptions of the bounds, if bounds were requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bounds: Option<RunBoundsDocument>,
}

/// The rank at almost all times of the motion.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct GenericRankDocument {
    /// An instant with this rank (s).
    pub time: f64,
    /// Rank of C.
    pub rank: usize,
    /// Degree of redundancy.
    pub redundancy: usize,
}

/// The verdict of a joint or drive over a motion.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct AlongReactionDocument {
    /// The verdict over the motion.
    #[serde(flatten)]
    pub of_run: TrackDocument,
    /// The verdicts of its components by name, in ground axes, for components that are not
    /// identically zero, and the verdict of the named component of its definition.
    pub components: ByName<TrackDocument>,
    /// The range of the bounds of its components over the motion, if bounds were requested.
    #[serde(skip_serializing_if = "ByName::is_empty")]
    pub bounds: ByName<RangeOfRunDocument>,
    /// Upper bounds of the magnitudes over the motion, if bounds were requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub magnitude_at_most: Option<MagnitudeOfRunDocument>,
}

/// A stretch of time with another rank.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct StretchDocument {
    /// Time at which it begins (s).
    pub from: f64,
    /// Time at which it ends (s).
    pub to: f64,
    /// Degree of redundancy on this stretch.
    pub redundancy: usize,
    /// Description.
    pub text: String,
}

/// An instant at which the configuration is singular, or nearly so.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct PassageDocument {
    /// Time (s).
    pub time: f64,
    /// `rank_drops`, `nearly_singular` or `undecided`.
    pub kind: &'static str,
    /// Degree of redundancy if the rank drops.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub redundancy: Option<usize>,
    /// If the rank drops: `unique`, `bifurcation` or `undetermined`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub continuation: Option<&'static str>,
    /// Velocities of other branches at a bifurcation.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub branches: Vec<Vec<f64>>,
    /// The smallest non-zero singular value if the configuration is nearly singular.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sigma: Option<f64>,
    /// First and last time of the interval on which the configuration is nearly singular (s).
    pub nearly_singular: [f64; 2],
    /// Verdicts that differ from the verdicts of the same stretch.
    pub differences: Vec<DifferenceDocument>,
    /// Description.
    pub text: String,
}

/// How a motion continues at a singular configuration.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ContinuationDocument {
    /// `unique`, `bifurcation` or `undetermined`.
    pub kind: &'static str,
    /// Velocities of other branches at a bifurcation.
    pub branches: Vec<Vec<f64>>,
    /// Description.
    pub text: String,
}

/// One verdict that differs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct DifferenceDocument {
    /// Name of the joint or drive.
    pub reaction: String,
    /// A component, or `wrench` for the whole reaction.
    pub part: &'static str,
    /// Verdict on the stretch of time that contains the instant.
    pub generic: &'static str,
    /// Verdict at this instant.
    pub here: &'static str,
}

impl AlongDocument {
    /// Builds the document of a motion that was analysed up to a time. The other arguments are the
    /// number of samples and the largest distance between samples. `stopped` and `continued_to`
    /// stay empty.
    #[must_use]
    pub fn new(
        along: &MotionAnalysis,
        layout: &Layout,
        to: f64,
        (samples, reach): (usize, f64),
    ) -> Self {
        let generic = &along.generic;
        let reaction = |found: &ReactionStretches| {
            let own = found.components.iter();
            let components = own.map(|(name, track)| ((*name).to_owned(), track.into()));
            let document = AlongReactionDocument {
                of_run: (&found.whole).into(),
                components: ByName(components.collect()),
                bounds: ByName(Vec::new()),
                magnitude_at_most: None,
            };
            (layout.groups[found.id.0].name.clone(), document)
        };
        Self {
            to,
            samples,
            reach,
            bounds: None,
            stopped: None,
            continued_to: None,
            generic: GenericRankDocument {
                time: generic.time,
                rank: generic.rank,
                redundancy: generic.redundancy,
            },
            reactions: ByName(along.verdicts.reactions.iter().map(reaction).collect()),
            special: SpecialDocument::all::<()>(&along.verdicts, &[], layout),
            stretches: along.stretches.iter().map(Into::into).collect(),
            passages: along.passages.iter().map(Into::into).collect(),
        }
    }
}

impl From<&Stretch> for StretchDocument {
    fn from(stretch: &Stretch) -> Self {
        Self {
            from: stretch.from,
            to: stretch.to,
            redundancy: stretch.redundancy,
            text: stretch.text.clone(),
        }
    }
}

impl From<&Passage> for PassageDocument {
    fn from(passage: &Passage) -> Self {
        let mut document = Self {
            time: passage.time,
            kind: "undecided",
            redundancy: None,
            continuation: None,
            branches: Vec::new(),
            sigma: None,
            nearly_singular: passage.nearly_singular,
            differences: passage.differences.iter().map(Into::into).collect(),
            text: passage.text.clone(),
        };
        match &passage.kind {
            PassageKind::RankDrops {
                redundancy,
                continuation,
            } => {
                document.kind = "rank_drops";
                document.redundancy = Some(*redundancy);
                let continuation = ContinuationDocument::from(continuation);
                document.continuation = Some(continuation.kind);
                document.branches = continuation.branches;
            }
            PassageKind::NearlySingular { sigma } => {
                document.kind = "nearly_singular";
                document.sigma = Some(*sigma);
            }
            _ => {}
        }
        document
    }
}

impl From<&Continuation> for ContinuationDocument {
    fn from(continuation: &Continuation) -> Self {
        let (kind, branches) = match continuation {
            Continuation::Unique => ("unique", Vec::new()),
            Continuation::Bifurcation { branches } => ("bifurcation", branches.clone()),
            _ => ("undetermined", Vec::new()),
        };
        Self {
            kind,
            branches,
            text: continuation.to_string(),
        }
    }
}

impl From<&Difference> for DifferenceDocument {
    fn from(difference: &Difference) -> Self {
        Self {
            reaction: difference.reaction.clone(),
            part: difference.component.unwrap_or("wrench"),
            generic: difference.generic.word(),
            here: difference.here.word(),
        }
    }
}
