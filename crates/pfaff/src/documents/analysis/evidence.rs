//! The evidence for a rank: singular values, proofs and comparisons.

use rank::{Grounds, RankStatus};
use serde::Serialize;
use solvability::{Analysis, Generic, PartAnalysis};

/// Evidence for a rank.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct EvidenceDocument {
    /// `decided` or `undecided`.
    pub status: &'static str,
    /// Reason why the rank is undecided: both possible ranks, and the information that would
    /// decide.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// σ_r of the equilibrated matrix; infinite (`null`) for rank 0.
    pub sigma_r: f64,
    /// σ_{r+1} of the equilibrated matrix.
    pub sigma_next: f64,
    /// σ_r/σ_{r+1}; infinite (`null`) if σ_{r+1} = 0.
    pub gap: f64,
    /// Singular values below this tolerance count as zero.
    pub tolerance: f64,
    /// Uncertainty of the entries of the equilibrated matrix, including the residual of the
    /// constraints.
    pub constraint_residual: f64,
    /// Whether the redundancy is the same at other configurations; `None` if unknown.
    pub permanent: Option<bool>,
    /// Whether the rank is decided and a certificate proves that it is not lower; `grounds` states
    /// why it is not higher.
    pub certified: bool,
    /// Proved lower bound on the rank of C.
    pub rank_at_least: Option<usize>,
    /// Proved lower bound on σ_r; 0 if only arithmetic modulo primes proves the rank.
    pub sigma_bound: Option<f64>,
    /// σ_{r+1} in double-double precision.
    pub sigma_next_extended: Option<f64>,
    /// The reason why the rank is not larger: `full_rank`, `exact`, `vanishes`, `within_data` or
    /// `within_tolerance`.
    pub grounds: Option<&'static str>,
    /// Uncertainty of the entries of the equilibrated matrix; 0 for exact entries.
    pub uncertainty: Option<f64>,
    /// Rows that are independent by a small margin only.
    pub nearly_redundant: Option<NearlyRedundantDocument>,
}

/// A decided rank with σ_r below 1e-3: reactions are of size 1/σ_r per unit of load.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct NearlyRedundantDocument {
    /// The singular value σ_r.
    pub sigma: f64,
    /// Relative change of reactions if a point is displaced by 10⁻⁶ m; the value 1 means a change
    /// by the full size of the reactions. This is a first-order estimate.
    pub change_per_micrometre: f64,
    /// Weights of all equilibrated rows; their weighted sum is a row of norm σ_r.
    pub direction: Vec<f64>,
}

/// The misalignment for which the effect is given (m).
const MICROMETRE: f64 = 1e-6;

/// Ranks at other configurations of the same component.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct GenericDocument {
    /// Degree of redundancy at almost all configurations.
    pub redundancy: usize,
    /// The configurations that were compared.
    pub points: Vec<PointDocument>,
}

/// Another configuration.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct PointDocument {
    /// Time (s).
    pub time: f64,
    /// Coordinates.
    pub q: Vec<f64>,
    /// Rank of C.
    pub rank: usize,
    /// Degree of redundancy.
    pub redundancy: usize,
}

impl EvidenceDocument {
    /// Returns the evidence of the part whose rank is least certain. The rank of the whole
    /// mechanism is proved if the ranks of all parts are proved.
    pub(super) fn new(analysis: &Analysis, generic: Option<&Generic>) -> Self {
        let weakest = analysis.weakest();
        let evidence = weakest.decision.evidence();
        let status = weakest.decision.status();
        let is_decided = status == RankStatus::Decided;
        let (status, reason) = match status {
            RankStatus::Decided => ("decided", None),
            RankStatus::Undecided(doubt) => ("undecided", Some(doubt.to_string())),
            _ => ("undecided", None),
        };
        let certificate = weakest.certificate.as_ref();
        let all_proved = analysis.parts.iter().all(PartAnalysis::is_proved);
        Self {
            status,
            reason,
            sigma_r: evidence.sigma_r,
            sigma_next: evidence.sigma_next,
            gap: evidence.gap,
            tolerance: evidence.tolerance,
            constraint_residual: evidence.constraint_residual,
            permanent: generic
                .filter(|_| is_decided)
                .map(|elsewhere| elsewhere.redundancy == analysis.decision.redundancy),
            certified: all_proved,
            rank_at_least: match analysis.parts.len() {
                1 => certificate.map(|c| c.rank_at_least),
                _ => all_proved.then_some(analysis.decision.rank),
            },
            sigma_bound: certificate.map(|c| c.sigma_bound),
            sigma_next_extended: certificate.map(|c| c.sigma_next),
            grounds: certificate
                .filter(|_| is_decided)
                .map(|c| grounds(c.grounds)),
            uncertainty: certificate.map(|c| c.uncertainty),
            nearly_redundant: nearly_redundant(analysis),
        }
    }
}

/// Returns the result of the part whose rows are closest to a dependence, relative to the size of
/// the part.
fn nearly_redundant(analysis: &Analysis) -> Option<NearlyRedundantDocument> {
    let nearly = analysis.nearly_redundant.as_ref()?;
    let is_here = |part: &&PartAnalysis| {
        let own = part.nearly_redundant.as_ref();
        own.is_some_and(|own| own.sigma == nearly.sigma)
    };
    let size = analysis
        .parts
        .iter()
        .find(is_here)
        .map_or(analysis.size, |part| part.size);
    Some(NearlyRedundantDocument {
        sigma: nearly.sigma,
        change_per_micrometre: MICROMETRE / size / nearly.sigma,
        direction: nearly.direction.clone(),
    })
}

fn grounds(grounds: Grounds) -> &'static str {
    match grounds {
        Grounds::FullRank => "full_rank",
        Grounds::Exact => "exact",
        Grounds::Vanishes => "vanishes",
        Grounds::WithinData => "within_data",
        Grounds::WithinTolerance => "within_tolerance",
        _ => "other",
    }
}

impl From<&Generic> for GenericDocument {
    fn from(generic: &Generic) -> Self {
        let points = generic.points.iter().map(|p| PointDocument {
            time: p.time,
            q: p.q.clone(),
            rank: p.rank,
            redundancy: p.redundancy,
        });
        Self {
            redundancy: generic.redundancy,
            points: points.collect(),
        }
    }
}
