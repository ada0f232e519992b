//! Verdicts along a motion.

use serde::Serialize;
use solvability::{Along, Continuation, Difference, Part, Passage, PassageKind, Stretch};

use super::VerdictDocument;

/// One verdict for almost all of a motion, and where another holds.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct AlongDocument {
    /// Last time that was judged (s); the first is 0.
    pub to: f64,
    /// Number of judged states.
    pub samples: usize,
    /// How far a body moves between two of them: a share of the mechanism's size, or as many
    /// radians.
    pub reach: f64,
    /// Why the motion stopped there, if it did.
    pub stopped: Option<String>,
    /// Until when (s) the motion was judged beyond the singular configuration at which it stopped,
    /// continued as smoothly as it came.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub continued_to: Option<f64>,
    /// The verdicts that hold almost always.
    pub generic: GenericVerdictsDocument,
    /// Stretches of time with other verdicts.
    pub stretches: Vec<StretchDocument>,
    /// Instants where something is different.
    pub passages: Vec<PassageDocument>,
}

/// The verdicts that hold almost always.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct GenericVerdictsDocument {
    /// An instant where they do (s).
    pub time: f64,
    /// Rank of C.
    pub rank: usize,
    /// Degree of redundancy.
    pub redundancy: usize,
    /// The verdict of every joint and drive.
    pub reactions: Vec<NamedVerdictDocument>,
}

/// The verdict of a joint or drive.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct NamedVerdictDocument {
    /// Its name.
    pub name: String,
    /// Its verdict.
    #[serde(flatten)]
    pub verdict: VerdictDocument,
}

/// A stretch of time with other verdicts.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct StretchDocument {
    /// Where it begins (s).
    pub from: f64,
    /// Where it ends (s).
    pub to: f64,
    /// Degree of redundancy on it.
    pub redundancy: usize,
    /// What differs.
    pub differences: Vec<DifferenceDocument>,
    /// In words.
    pub text: String,
}

/// An instant where something is different.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct PassageDocument {
    /// When (s).
    pub time: f64,
    /// `rank_drops`, `nearly_singular`, `undecided` or `verdicts`.
    pub kind: &'static str,
    /// Degree of redundancy, where the rank drops.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub redundancy: Option<usize>,
    /// Where the rank drops: `unique`, `bifurcation` or `undetermined`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub continuation: Option<&'static str>,
    /// Velocities of other branches at a bifurcation.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub branches: Vec<Vec<f64>>,
    /// The smallest non-zero singular value, where the configuration is nearly singular.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sigma: Option<f64>,
    /// From when to when the configuration is nearly singular (s).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nearly_singular: Option<[f64; 2]>,
    /// What differs.
    pub differences: Vec<DifferenceDocument>,
    /// In words.
    pub text: String,
}

/// How a motion goes on at a singular configuration.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ContinuationDocument {
    /// `unique`, `bifurcation` or `undetermined`.
    pub kind: &'static str,
    /// Velocities of other branches at a bifurcation.
    pub branches: Vec<Vec<f64>>,
    /// In words.
    pub text: String,
}

/// One verdict that differs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct DifferenceDocument {
    /// Name of the joint or drive.
    pub reaction: String,
    /// `wrench`, a component, or `row` with its number.
    pub part: String,
    /// Almost always.
    pub generic: &'static str,
    /// Here.
    pub here: &'static str,
}

impl AlongDocument {
    /// The document of a motion that was judged up to a time, at so many samples so far apart, and
    /// stopped there if a reason is given.
    #[must_use]
    pub fn new(
        along: &Along,
        to: f64,
        (samples, reach): (usize, f64),
        stopped: Option<String>,
    ) -> Self {
        let analysis = &along.generic;
        let reactions = analysis.reactions.iter().map(|r| NamedVerdictDocument {
            name: r.name.clone(),
            verdict: (&r.wrench).into(),
        });
        Self {
            to,
            samples,
            reach,
            stopped,
            continued_to: None,
            generic: GenericVerdictsDocument {
                time: analysis.time,
                rank: analysis.decision.rank,
                redundancy: analysis.decision.redundancy,
                reactions: reactions.collect(),
            },
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
            differences: stretch.differences.iter().map(Into::into).collect(),
            text: stretch.text.clone(),
        }
    }
}

impl From<&Passage> for PassageDocument {
    fn from(passage: &Passage) -> Self {
        let mut document = Self {
            time: passage.time,
            kind: "verdicts",
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
            PassageKind::Undecided { .. } => document.kind = "undecided",
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
        let part = match &difference.part {
            Part::Wrench => "wrench".to_owned(),
            Part::Component(name) => (*name).to_owned(),
            Part::Row(label) => format!("row {}", label.number),
        };
        Self {
            reaction: difference.reaction.clone(),
            part,
            generic: difference.generic.word(),
            here: difference.here.word(),
        }
    }
}
