//! The document of `analyze --json`.

use linalg::RankStatus;
use serde::Serialize;
use solvability::{Analysis, Dependency, ReactionVerdict};

use super::{VerdictDocument, from_one};

/// What is known of the rank beyond the decision at one configuration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Proof {
    /// Whether the rank is the same at every generic configuration; `None` if nobody asked.
    pub permanent: Option<bool>,
    /// Whether the rank was proved in exact or interval arithmetic.
    pub certified: bool,
}

/// Ranks and verdicts of one configuration.
#[derive(Clone, Debug, PartialEq, Serialize)]
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
    /// Joints and drives in the order of their rows.
    pub reactions: Vec<ReactionDocument>,
    /// Verdicts of combinations that were asked for; [`AnalysisDocument::new`] leaves it empty.
    pub groups: Vec<GroupDocument>,
    /// Minimal sets of dependent rows.
    pub dependencies: Vec<DependencyDocument>,
    /// What else the reader should know.
    pub warnings: Vec<String>,
}

/// The numbers behind a rank.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EvidenceDocument {
    /// `decided` or `undecided`.
    pub status: &'static str,
    /// Why it is undecided.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// σ_r of the equilibrated matrix; infinite (`null`) for rank 0.
    pub sigma_r: f64,
    /// σ_{r+1}
    pub sigma_next: f64,
    /// σ_r/σ_{r+1}; infinite (`null`) if σ_{r+1} = 0.
    pub gap: f64,
    /// Below it a singular value counts as zero.
    pub tolerance: f64,
    /// Relative residual of the constraints at the configuration.
    pub constraint_residual: f64,
    /// As in [`Proof`].
    pub permanent: Option<bool>,
    /// As in [`Proof`].
    pub certified: bool,
}

/// The verdict of a joint or drive.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ReactionDocument {
    /// Its name.
    pub name: String,
    /// Its scene type.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Its rows of C.
    pub rows: Vec<usize>,
    /// Verdict of force and torque, with ‖B_X‖ as margin.
    #[serde(flatten)]
    pub wrench: VerdictDocument,
    /// Verdict of all its multipliers together.
    pub multipliers: &'static str,
    /// Verdict of the multiplier of each row.
    pub row_verdicts: Vec<RowDocument>,
    /// Verdicts of the components that are not identically zero.
    pub components: Vec<ComponentDocument>,
    /// Basis of the unique directions in these components.
    pub unique_directions: Vec<Vec<f64>>,
}

/// The verdict of a multiplier.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RowDocument {
    /// Row of C.
    pub row: usize,
    /// Its verdict.
    #[serde(flatten)]
    pub verdict: VerdictDocument,
}

/// The verdict of a component of a reaction.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ComponentDocument {
    /// `Fx`, `Fy` or `T`.
    pub name: &'static str,
    /// Its verdict.
    #[serde(flatten)]
    pub verdict: VerdictDocument,
}

/// The verdict of a combination of reactions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GroupDocument {
    /// Its name or expression.
    pub name: String,
    /// Its verdict.
    #[serde(flatten)]
    pub verdict: VerdictDocument,
}

/// A minimal set of dependent rows.
#[derive(Clone, Debug, PartialEq, Serialize)]
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

impl AnalysisDocument {
    /// The document of an analysis.
    #[must_use]
    pub fn new(scene: &str, analysis: &Analysis, proof: Proof) -> Self {
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
            evidence: EvidenceDocument::new(decision, proof),
            reactions: analysis.reactions.iter().map(Into::into).collect(),
            groups: Vec::new(),
            dependencies: dependencies
                .map(|d| DependencyDocument::new(d, &analysis.reactions))
                .collect(),
            warnings: analysis.warnings.clone(),
        }
    }
}

impl EvidenceDocument {
    fn new(decision: &linalg::RankDecision, proof: Proof) -> Self {
        let evidence = &decision.evidence;
        let (status, reason) = match decision.status {
            RankStatus::Decided => ("decided", None),
            RankStatus::Undecided(doubt) => ("undecided", Some(doubt.to_string())),
            _ => ("undecided", None),
        };
        Self {
            status,
            reason,
            sigma_r: evidence.sigma_r,
            sigma_next: evidence.sigma_next,
            gap: evidence.gap,
            tolerance: evidence.tolerance,
            constraint_residual: evidence.constraint_residual,
            permanent: proof.permanent,
            certified: proof.certified,
        }
    }
}

impl From<&ReactionVerdict> for ReactionDocument {
    fn from(r: &ReactionVerdict) -> Self {
        let rows = r.rows.iter().map(|row| RowDocument {
            row: row.row + 1,
            verdict: (&row.judgement).into(),
        });
        let components = r.components.iter().map(|c| ComponentDocument {
            name: c.name,
            verdict: (&c.judgement).into(),
        });
        Self {
            name: r.name.clone(),
            kind: r.kind,
            rows: r.rows.iter().map(|row| row.row + 1).collect(),
            wrench: (&r.wrench).into(),
            multipliers: r.multipliers.verdict.word(),
            row_verdicts: rows.collect(),
            components: components.collect(),
            unique_directions: r.unique_directions.clone(),
        }
    }
}

impl DependencyDocument {
    fn new(dependency: &Dependency, reactions: &[ReactionVerdict]) -> Self {
        let concerned = reactions
            .iter()
            .filter(|r| r.rows.iter().any(|row| dependency.rows.contains(&row.row)));
        Self {
            rows: from_one(&dependency.rows),
            joints: concerned.map(|r| r.name.clone()).collect(),
            coefficients: dependency.coefficients.clone(),
            text: dependency.text.clone(),
        }
    }
}
