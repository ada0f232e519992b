//! The document of `analyze --json`. What was not asked for is absent; keys of the first day keep their meaning.

mod along;
mod choices;
mod deletions;
mod evidence;
mod reaction;

use model::{ConstraintId, Layout};
use serde::Serialize;
use solvability::{
    Analysis, Dependency, Explanation, FrameVerdict, Mixing, ReactionVerdict, Survey,
};

pub use along::{
    AlongDocument, ContinuationDocument, DifferenceDocument, GenericVerdictsDocument,
    NamedVerdictDocument, PassageDocument, StretchDocument,
};
pub use choices::{DistributionDocument, ValueDocument, ValuesDocument};
pub use deletions::{EliminationsDocument, MakeUniqueDocument, WayDocument};
pub use evidence::{
    EvidenceDocument, GenericDocument, NearlyRedundantDocument, PointDocument, Proof,
};
pub use reaction::{
    ComponentDocument, FrameDocument, FreeDirectionDocument, GroupDocument, ReactionDocument,
    RowDocument,
};

use super::{VerdictDocument, from_one};

/// Ranks and verdicts of one configuration.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct AnalysisDocument {
    /// Name of the scene.
    pub scene: String,
    /// Time (s).
    pub time: f64,
    /// Number of bodies.
    pub bodies: usize,
    /// Number of coordinates n_q.
    pub coordinates: usize,
    /// Number of rows m + h.
    pub rows: usize,
    /// m
    pub holonomic_rows: usize,
    /// h
    pub nonholonomic_rows: usize,
    /// r = rank C
    pub rank: usize,
    /// Rank of Φq alone.
    pub rank_holonomic: usize,
    /// Rank of Ψ alone.
    pub rank_nonholonomic: usize,
    /// p = m + h − r
    pub redundancy: usize,
    /// n_v − r
    pub mobility: usize,
    /// r independent rows.
    pub kept_rows: Vec<usize>,
    /// The p others.
    pub dropped_rows: Vec<usize>,
    /// The numbers behind the rank.
    pub evidence: EvidenceDocument,
    /// Ranks at other configurations; `null` if nobody asked, or none could be reached.
    pub generic: Option<GenericDocument>,
    /// Joints and drives in the order of their rows.
    pub reactions: Vec<ReactionDocument>,
    /// Verdicts of combinations that were asked for; [`AnalysisDocument::new`] leaves it empty.
    pub groups: Vec<GroupDocument>,
    /// Minimal sets of dependent rows.
    pub dependencies: Vec<DependencyDocument>,
    /// Joints and drives whose reactions mix.
    pub mixing: Vec<MixingDocument>,
    /// What may be deleted without a change of motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub eliminations: Option<EliminationsDocument>,
    /// What makes reactions unique.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub make_unique: Vec<MakeUniqueDocument>,
    /// Reactions by different choices.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub choices: Vec<DistributionDocument>,
    /// Verdicts along the motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub along: Option<AlongDocument>,
    /// How the motion goes on, where this configuration is singular and the velocities say which motion is meant.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub continuation: Option<ContinuationDocument>,
    /// What else the reader should know.
    pub warnings: Vec<String>,
}

/// A minimal set of dependent rows.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct DependencyDocument {
    /// Rows of C.
    pub rows: Vec<usize>,
    /// Joints and drives of these rows, each once.
    pub joints: Vec<String>,
    /// `Σ coefficient·row = 0`, largest coefficient 1.
    pub coefficients: Vec<f64>,
    /// In words.
    pub text: String,
}

/// Joints and drives whose reactions mix.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct MixingDocument {
    /// Their names.
    pub reactions: Vec<String>,
    /// Rows of C that take part.
    pub rows: Vec<usize>,
    /// How many numbers are missing to tell all of them.
    pub redundancy: usize,
    /// In words.
    pub text: String,
}

impl AnalysisDocument {
    /// The document of an analysis.
    #[must_use]
    pub fn new(scene: &str, analysis: &Analysis, proof: Proof<'_>) -> Self {
        let decision = &analysis.decision;
        let dependencies = analysis.dependencies.iter();
        Self {
            scene: scene.to_owned(),
            time: analysis.time,
            bodies: analysis.bodies,
            coordinates: analysis.coordinates,
            rows: analysis.holonomic_rows + analysis.nonholonomic_rows,
            holonomic_rows: analysis.holonomic_rows,
            nonholonomic_rows: analysis.nonholonomic_rows,
            rank: decision.rank,
            rank_holonomic: analysis.rank_holonomic,
            rank_nonholonomic: analysis.rank_nonholonomic,
            redundancy: decision.redundancy,
            mobility: analysis.mobility(),
            kept_rows: from_one(&decision.kept),
            dropped_rows: from_one(&decision.dropped),
            evidence: EvidenceDocument::new(analysis, proof),
            generic: proof.generic.map(Into::into),
            reactions: analysis.reactions.iter().map(Into::into).collect(),
            groups: Vec::new(),
            dependencies: dependencies
                .map(|d| DependencyDocument::new(d, &analysis.reactions))
                .collect(),
            mixing: Vec::new(),
            eliminations: None,
            make_unique: Vec::new(),
            choices: Vec::new(),
            along: None,
            continuation: None,
            warnings: analysis.warnings.clone(),
        }
    }

    /// The document of a survey. Evidence is that of the part whose rank is least certain.
    #[must_use]
    pub fn of_survey(scene: &str, survey: &Survey) -> Self {
        let [kept, dropped] = survey.rows();
        let rows = survey.holonomic_rows + survey.nonholonomic_rows;
        let dependencies = survey.parts.iter().flat_map(|part| {
            let all = part.verdicts.dependencies.iter();
            all.map(|d| DependencyDocument::new(d, &part.verdicts.reactions))
        });
        Self {
            scene: scene.to_owned(),
            time: survey.time,
            bodies: survey.bodies,
            coordinates: survey.coordinates,
            rows,
            holonomic_rows: survey.holonomic_rows,
            nonholonomic_rows: survey.nonholonomic_rows,
            rank: survey.rank(),
            rank_holonomic: survey.rank_holonomic(),
            rank_nonholonomic: survey.rank_nonholonomic(),
            redundancy: survey.redundancy(),
            mobility: survey.mobility(),
            kept_rows: from_one(&kept),
            dropped_rows: from_one(&dropped),
            evidence: EvidenceDocument::of_survey(survey),
            generic: None,
            reactions: survey.reactions().into_iter().map(Into::into).collect(),
            groups: Vec::new(),
            dependencies: dependencies.collect(),
            mixing: Vec::new(),
            eliminations: None,
            make_unique: Vec::new(),
            choices: Vec::new(),
            along: None,
            continuation: None,
            warnings: survey.warnings().cloned().collect(),
        }
    }

    /// Adds why the reactions are not unique. The explanation must be that of the analysis.
    pub fn explain(&mut self, explanation: &Explanation, layout: &Layout) {
        for (k, reaction) in self.reactions.iter_mut().enumerate() {
            reaction.explain(explanation, ConstraintId(k));
        }
        let stress = |stress: &solvability::SelfStress| {
            let joints = stress
                .directions
                .iter()
                .map(|d| &layout.groups[d.joint.0].name);
            DependencyDocument {
                rows: from_one(&stress.rows),
                joints: joints.cloned().collect(),
                coefficients: stress.coefficients.clone(),
                text: stress.text.clone(),
            }
        };
        self.dependencies = explanation.stresses.iter().map(stress).collect();
        let mixing = |mixing: &Mixing| {
            let reactions = mixing.reactions.iter();
            MixingDocument {
                reactions: reactions
                    .map(|id| layout.groups[id.0].name.clone())
                    .collect(),
                rows: from_one(&mixing.rows),
                redundancy: mixing.redundancy,
                text: mixing.text.clone(),
            }
        };
        self.mixing = explanation.mixing.iter().map(mixing).collect();
    }

    /// Adds the verdicts in other frames, joint by joint.
    pub fn add_frames(&mut self, frames: &[Vec<FrameVerdict>]) {
        for (reaction, frames) in self.reactions.iter_mut().zip(frames) {
            reaction.frames = frames.iter().map(Into::into).collect();
        }
    }
}

impl DependencyDocument {
    fn new(dependency: &Dependency, reactions: &[ReactionVerdict]) -> Self {
        let reactions = reactions.iter();
        let concerned =
            reactions.filter(|r| r.rows.iter().any(|row| dependency.rows.contains(&row.row)));
        Self {
            rows: from_one(&dependency.rows),
            joints: concerned.map(|r| r.name.clone()).collect(),
            coefficients: dependency.coefficients.clone(),
            text: dependency.text.clone(),
        }
    }
}
