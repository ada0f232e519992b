//! The document of `analyze --json`. Results that were not requested are absent; later versions do
//! not change the meaning of existing keys.

mod along;
mod choices;
mod component;
mod data;
mod deletions;
mod evidence;
mod notes;
mod reaction;

use model::words::rough;
use std::collections::BTreeSet;

use model::{ConstraintId, Layout, Mechanism, SpaceKind};
use serde::Serialize;
use solvability::{
    Analysis, Dependency, Explanation, Freedoms, Generic, GenericVerdict, Mixing, NoFiniteReaction,
    PartAnalysis, ReactionVerdict, Sensitivities,
};

pub use along::{
    AlongDocument, AlongReactionDocument, ContinuationDocument, DifferenceDocument,
    GenericRankDocument, PassageDocument, StretchDocument,
};
pub use choices::{DistributionDocument, ValueDocument, ValuesDocument};
pub use component::ComponentDocument;
pub use data::DataDocument;
pub use deletions::{EliminationsDocument, MakeUniqueDocument, WayDocument};
pub use evidence::{EvidenceDocument, GenericDocument, NearlyRedundantDocument, PointDocument};
pub use notes::NoteDocument;
pub(crate) use reaction::components;
pub use reaction::{FreeDirectionDocument, GroupDocument, ReactionDocument, RowDocument};

use super::{ByName, FreedomsDocument, LoadsDocument, from_one};
use crate::contacts;
use crate::questions::analyze::{bounds, matrices, remedies};

/// Ranks and verdicts of one configuration.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct AnalysisDocument {
    /// The analysed configuration.
    #[serde(flatten)]
    pub configuration: ConfigurationDocument,
    /// The ranks of the constraint matrix.
    #[serde(flatten)]
    pub ranks: RanksDocument,
    /// The accuracy of the data, and the results that depend on it.
    pub data: DataDocument,
    /// The numerical evidence for the rank.
    pub evidence: EvidenceDocument,
    /// Ranks at other configurations; `null` if not requested, or if no other configuration could
    /// be reached.
    pub generic: Option<GenericDocument>,
    /// Joints and drives in the order of their rows.
    pub reactions: Vec<ReactionDocument>,
    /// Verdicts of the requested combinations; [`AnalysisDocument::new`] leaves the list empty.
    pub groups: Vec<GroupDocument>,
    /// Unique reactions and components that are sensitive to the data, with the datum on which each
    /// depends most, as text.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub fragile: Vec<String>,
    /// Reasons why reactions are not unique.
    #[serde(flatten)]
    pub reasons: ReasonsDocument,
    /// Other requested results.
    #[serde(flatten)]
    pub answers: AnswersDocument,
    /// Notes of joint definitions on the reactions of their joints; [`AnalysisDocument::add_notes`]
    /// adds them.
    pub notes: Vec<NoteDocument>,
    /// Further warnings for the reader.
    pub warnings: Vec<String>,
}

/// The analysed configuration: a mechanism at a time, and its size.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ConfigurationDocument {
    /// Name of the scene.
    pub scene: String,
    /// Time (s).
    pub time: f64,
    /// Number of bodies.
    pub bodies: usize,
    /// Number of coordinates n_q.
    pub coordinates: usize,
    /// Number of velocities n_v; the mobility is n_v − rank.
    pub velocities: usize,
    /// Number of rows m + h.
    pub rows: usize,
    /// Number of holonomic rows m.
    pub holonomic_rows: usize,
    /// Number of nonholonomic rows h.
    pub nonholonomic_rows: usize,
}

/// The rank of C, and the numbers that follow from it alone.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct RanksDocument {
    /// r = rank C
    pub rank: usize,
    /// Rank of Φq alone.
    pub rank_holonomic: usize,
    /// Rank of Ψ alone.
    pub rank_nonholonomic: usize,
    /// Degree of redundancy p = m + h − r.
    pub redundancy: usize,
    /// Mobility n_v − r.
    pub mobility: usize,
    /// The possible motions, with the drives and without them; [`AnalysisDocument::new`] leaves it
    /// empty.
    #[serde(flatten)]
    pub freedoms: FreedomsDocument,
    /// A set of r independent rows.
    pub kept_rows: Vec<usize>,
    /// The p redundant rows.
    pub dropped_rows: Vec<usize>,
    /// Sets of joints on common cycles that were analysed separately; absent if all were analysed
    /// together.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub parts: Option<PartsDocument>,
}

/// Reasons why reactions are not unique.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ReasonsDocument {
    /// Minimal sets of dependent rows.
    pub dependencies: Vec<DependencyDocument>,
    /// Joints and drives whose reactions are coupled.
    pub mixing: Vec<MixingDocument>,
}

/// Results that are computed only on request.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct AnswersDocument {
    /// Sets of rows that may be deleted without a change of motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub eliminations: Option<EliminationsDocument>,
    /// Deletions that make reactions unique.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub make_unique: Vec<MakeUniqueDocument>,
    /// Joint types that make reactions unique without a change of motion; absent if there are none.
    /// These joint types are also computed without a request.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub remedies: Vec<remedies::RemedyDocument>,
    /// Reactions for different choices.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub choices: Vec<DistributionDocument>,
    /// With choices: the loads of force elements on their first bodies (N, N·m), with lengths (m)
    /// and angles (rad) and their rates. The loads of force elements do not depend on the choice.
    #[serde(skip_serializing_if = "ByName::is_empty")]
    pub loads: LoadsDocument,
    /// Verdicts along the motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub along: Option<AlongDocument>,
    /// How the motion continues, if this configuration is singular and the velocities determine the
    /// motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub continuation: Option<ContinuationDocument>,
    /// Assumptions and extent of the bounds, if they were requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bounds: Option<bounds::BoundsDocument>,
    /// What contacts do, if the scene has one-sided joints or grip.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contacts: Option<contacts::ContactsDocument>,
    /// The matrices of the constraints.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub matrices: Option<matrices::MatricesDocument>,
}

/// Sets of joints on common cycles that were analysed separately.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct PartsDocument {
    /// Number of sets.
    pub number: usize,
    /// Number of rows of the largest set.
    pub largest: usize,
}

/// A minimal set of dependent rows.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct DependencyDocument {
    /// Rows of C.
    pub rows: Vec<usize>,
    /// Joints and drives of these rows, each once.
    pub joints: Vec<String>,
    /// Coefficients with `Σ coefficient·row = 0`; the largest coefficient is 1.
    pub coefficients: Vec<f64>,
    /// Whether the dependency of these rows alone is valid only within the tolerance that the scene
    /// states; absent if not.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub within_tolerance: bool,
    /// The largest coefficient that counts as zero for this reason, for scaled rows and relative to
    /// the largest coefficient.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub margin: Option<f64>,
    /// Explanation as text.
    pub text: String,
}

/// Joints and drives whose reactions are coupled.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MixingDocument {
    /// Names of the joints and drives.
    pub reactions: Vec<String>,
    /// Rows of C that are coupled.
    pub rows: Vec<usize>,
    /// Number of further conditions that would determine all of these reactions.
    pub redundancy: usize,
    /// Explanation as text.
    pub text: String,
}

impl AnalysisDocument {
    /// Whether joints of other types make the reaction of this joint or drive unique.
    #[must_use]
    pub fn has_remedy(&self, reaction: &str) -> bool {
        let mut all = self.answers.remedies.iter();
        all.any(|remedy| remedy.reactions.iter().any(|name| name == reaction))
    }

    /// Builds the document of an analysis with the ranks at other configurations. `generic` is
    /// `None` if these ranks were not requested, or if no other configuration could be reached. The
    /// evidence is the evidence of the part whose rank is least certain.
    #[must_use]
    pub fn new(scene: &str, analysis: &Analysis, generic: Option<&Generic>) -> Self {
        let decision = &analysis.decision;
        let dependencies = analysis.dependencies.iter();
        let group_of = groups_of_rows(analysis);
        let rows_of_parts = analysis.parts.iter().map(PartAnalysis::rows);
        Self {
            configuration: ConfigurationDocument {
                scene: scene.to_owned(),
                time: analysis.time,
                bodies: analysis.bodies,
                coordinates: analysis.coordinates,
                velocities: analysis.velocities,
                rows: analysis.holonomic_rows + analysis.nonholonomic_rows,
                holonomic_rows: analysis.holonomic_rows,
                nonholonomic_rows: analysis.nonholonomic_rows,
            },
            ranks: RanksDocument {
                rank: decision.rank,
                rank_holonomic: analysis.rank_holonomic,
                rank_nonholonomic: analysis.rank_nonholonomic,
                redundancy: decision.redundancy,
                mobility: analysis.mobility(),
                freedoms: FreedomsDocument::default(),
                kept_rows: from_one(&decision.kept),
                dropped_rows: from_one(&decision.dropped),
                parts: (analysis.parts.len() > 1).then(|| PartsDocument {
                    number: analysis.parts.len(),
                    largest: rows_of_parts.max().unwrap_or(0),
                }),
            },
            data: DataDocument::new(analysis),
            evidence: EvidenceDocument::new(analysis, generic),
            generic: generic.map(Into::into),
            reactions: analysis.reactions.iter().map(Into::into).collect(),
            groups: Vec::new(),
            fragile: Vec::new(),
            reasons: ReasonsDocument {
                dependencies: dependencies
                    .map(|d| DependencyDocument::new(d, &analysis.reactions, &group_of))
                    .collect(),
                mixing: Vec::new(),
            },
            answers: AnswersDocument::default(),
            notes: Vec::new(),
            warnings: analysis.warnings.clone(),
        }
    }

    /// Adds the possible motions. `freedoms` must belong to the mechanism and configuration of the
    /// analysis.
    #[must_use]
    pub fn with_freedoms(mut self, freedoms: &Freedoms, mechanism: &Mechanism) -> Self {
        self.ranks.freedoms = FreedomsDocument::new(freedoms, mechanism);
        self
    }

    /// Adds the verdicts that are valid at nearly all configurations, one verdict for each joint
    /// and drive. Generic verdicts come from the stretches of the motion that contain the instant,
    /// or from other configurations.
    pub fn add_generic_verdicts(&mut self, generic: &[GenericVerdict]) {
        for (reaction, generic) in self.reactions.iter_mut().zip(generic) {
            reaction.add_generic(generic);
        }
    }

    /// Adds the sensitivities of unique components and directions of reactions to the data. The
    /// sensitivities must belong to the analysis.
    pub fn add_sensitivities(&mut self, all: &Sensitivities, layout: &Layout) {
        self.fragile = all.sentences(layout);
        for (k, reaction) in self.reactions.iter_mut().enumerate() {
            reaction.add_sensitivities(all, ConstraintId(k), layout);
        }
    }

    /// Iterates over the reactions with an ill-determined component.
    pub fn fragile_reactions(&self) -> impl Iterator<Item = &ReactionDocument> {
        self.reactions.iter().filter(|r| r.data.fragile)
    }

    /// Returns the names of the ill-determined reactions, or of their components if only components
    /// are ill-determined.
    #[must_use]
    pub fn fragile_names(&self) -> Vec<String> {
        let reactions = self.reactions.iter();
        reactions
            .flat_map(ReactionDocument::fragile_names)
            .collect()
    }

    /// Adds the explanation why the reactions are not unique. The explanation must belong to the
    /// analysis.
    pub fn explain(&mut self, explanation: &Explanation, layout: &Layout) {
        ReactionDocument::explain_all(&mut self.reactions, explanation);
        let stress = |stress: &solvability::SelfStress| {
            let joints = stress
                .directions
                .iter()
                .map(|d| &layout.groups[d.joint.0].name);
            let joints = joints.cloned().collect();
            let (rows, coefficients) = (&stress.rows, &stress.coefficients);
            DependencyDocument::of(rows, joints, coefficients, stress.left_out, &stress.text)
        };
        // Results for parts that were not explained remain unchanged.
        let told: Vec<DependencyDocument> = explanation.stresses.iter().map(stress).collect();
        let mut others = std::mem::replace(&mut self.reasons.dependencies, told);
        if self.ranks.parts.is_some() {
            let all = &mut self.reasons.dependencies;
            let told: BTreeSet<&Vec<usize>> = all.iter().map(|d| &d.rows).collect();
            others.retain(|d| !told.contains(&d.rows));
            all.append(&mut others);
        }
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
        self.reasons.mixing = explanation.mixing.iter().map(mixing).collect();
    }

    /// Adds the reactions that have no finite value in the motion, with a warning for each set.
    pub fn add_no_finite(&mut self, found: &NoFiniteReaction) {
        for id in &found.reactions {
            self.reactions[id.0].no_finite_reaction = Some(found.clone());
        }
        let names = found.reactions.iter();
        let names: Vec<String> = names
            .map(|id| format!("`{}`", self.reactions[id.0].name))
            .collect();
        self.warnings.push(format!(
            "{} without numbers: {found}",
            model::words::listed(&names)
        ));
    }

    /// Adds the notes of the definitions of the joints on their reactions.
    pub fn add_notes(&mut self, layout: &Layout) {
        self.notes = NoteDocument::all(layout);
    }

    /// Adds what contacts cannot do.
    pub fn add_contacts(&mut self, layout: &Layout) {
        for (reaction, group) in self.reactions.iter_mut().zip(&layout.groups) {
            reaction.contact = group.limits.in_words();
        }
    }

    /// Adds the point about which the moment of a reaction is unique.
    pub fn add_centre(&mut self, id: ConstraintId, space: SpaceKind, centre: [f64; 3]) {
        self.reactions[id.0].moment_unique_about = Some(components(space, centre));
    }
}

impl DependencyDocument {
    fn new(dependency: &Dependency, reactions: &[ReactionVerdict], group_of: &[usize]) -> Self {
        let mut concerned: Vec<usize> = dependency.rows.iter().map(|&row| group_of[row]).collect();
        concerned.sort_unstable();
        concerned.dedup();
        let joints = concerned.iter().map(|&k| reactions[k].name.clone());
        let (rows, coefficients) = (&dependency.rows, &dependency.coefficients);
        let (left_out, text) = (dependency.left_out, &dependency.text);
        Self::of(rows, joints.collect(), coefficients, left_out, text)
    }

    /// Converts a dependency (rows 0-based). `left_out` is the part that counts as zero only within
    /// the tolerance.
    fn of(
        rows: &[usize],
        joints: Vec<String>,
        coefficients: &[f64],
        left_out: f64,
        text: &str,
    ) -> Self {
        let margin = (left_out > 0.0).then_some(left_out);
        Self {
            rows: from_one(rows),
            joints,
            coefficients: coefficients.to_vec(),
            within_tolerance: margin.is_some(),
            margin,
            text: match margin {
                Some(margin) => format!(
                    "{text}; within the tolerance (margin {margin})",
                    margin = rough(margin)
                ),
                None => text.to_owned(),
            },
        }
    }
}

/// The index of the joint or drive of each row.
fn groups_of_rows(analysis: &Analysis) -> Vec<usize> {
    let mut group_of = vec![0; analysis.holonomic_rows + analysis.nonholonomic_rows];
    for (k, reaction) in analysis.reactions.iter().enumerate() {
        reaction.rows.iter().for_each(|row| group_of[row.row] = k);
    }
    group_of
}
