//! Verdicts along a motion.

use serde::Serialize;
use solvability::{Along, Continuation, Difference, Part, Passage, PassageKind, Stretch};

use super::VerdictDocument;

/// The generic verdict of a motion, and the times at which another holds.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct AlongDocument {
    /// Last time that was analysed (s); the first is 0.
    pub to: f64,
    /// Number of analysed states.
    pub samples: usize,
    /// How far a body moves between two of them: a fraction of the size of the mechanism, or as
    /// many radians.
    pub reach: f64,
    /// Reason why the motion stopped at this time, if it did.
    pub stopped: Option<String>,
    /// Time (s) up to which the motion was analysed beyond the singular configuration at which it
    /// stopped, continued smoothly.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub continued_to: Option<f64>,
    /// The verdicts that hold almost everywhere.
    pub generic: GenericVerdictsDocument,
    /// Stretches of time with other verdicts.
    pub stretches: Vec<StretchDocument>,
    /// Instants at which something differs.
    pub passages: Vec<PassageDocument>,
}

/// The verdicts that hold almost everywhere.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct GenericVerdictsDocument {
    /// An instant at which they hold (s).
    pub time: f64,
    /// Rank of C.
    pub rank: usize,
    /// Degree of redundancy.
    pub redundancy: usize,
    /// The verdict of every joint and drive.
    pub reactions: Vec<NamedVerdictDocument>,
}

/// The verdict of a joint or drive, or of one of its components.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct NamedVerdictDocument {
    /// Its name.
    pub name: String,
    /// Its verdict.
    #[serde(flatten)]
    pub verdict: VerdictDocument,
    /// The verdicts of the components of a joint or drive, in ground axes; of a component none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub components: Vec<NamedVerdictDocument>,
}

/// A stretch of time with other verdicts.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct StretchDocument {
    /// Time at which it begins (s).
    pub from: f64,
    /// Time at which it ends (s).
    pub to: f64,
    /// Degree of redundancy on this stretch.
    pub redundancy: usize,
    /// Verdicts that differ from the generic ones.
    pub differences: Vec<DifferenceDocument>,
    /// Description.
    pub text: String,
}

/// An instant at which something differs.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct PassageDocument {
    /// Time (s).
    pub time: f64,
    /// `rank_drops`, `nearly_singular`, `undecided` or `verdicts`.
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
    /// First and last time of the nearly singular interval (s).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nearly_singular: Option<[f64; 2]>,
    /// Verdicts that differ from the generic ones.
    pub differences: Vec<DifferenceDocument>,
    /// Description.
    pub text: String,
}

/// How a motion continues at a singular configuration.
#[derive(Clone, Debug, PartialEq, Serialize)]
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
#[non_exhaustive]
pub struct DifferenceDocument {
    /// Name of the joint or drive.
    pub reaction: String,
    /// `wrench`, a component, or `row` with its number.
    pub part: String,
    /// Verdict almost everywhere.
    pub generic: &'static str,
    /// Verdict here.
    pub here: &'static str,
}

impl AlongDocument {
    /// The document of a motion that was analysed up to a time with this number of samples at this
    /// distance, and that stopped there if a reason is given.
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
            components: (r.components.iter())
                .map(|c| NamedVerdictDocument {
                    name: c.name.to_owned(),
                    verdict: (&c.judgement).into(),
                    components: Vec::new(),
                })
                .collect(),
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
