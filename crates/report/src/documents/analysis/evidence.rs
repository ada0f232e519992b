//! The numbers behind a rank: what was read, what was proved, what was compared.

use linalg::{Certificate, Evidence, Grounds, NearlyRedundant, RankStatus};
use serde::Serialize;
use solvability::{Analysis, Generic, PartVerdicts, Survey};

/// What is known of the rank beyond the decision at one configuration.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Proof<'a> {
    /// Ranks at other configurations; `None` if nobody asked, or none could be reached.
    pub generic: Option<&'a Generic>,
    /// The proof of the rank, if there is one.
    pub certificate: Option<&'a Certificate>,
}

/// The numbers behind a rank.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct EvidenceDocument {
    /// `decided` or `undecided`.
    pub status: &'static str,
    /// Why it is undecided: both readings, and what would decide.
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
    /// What the entries of the equilibrated matrix are known to, the open constraints included.
    pub constraint_residual: f64,
    /// Whether the redundancy is the same at other configurations; `None` if that is not known.
    pub permanent: Option<bool>,
    /// Whether the rank is decided and a certificate proves that it is not less; `grounds` say why it is not more.
    pub certified: bool,
    /// Proved: the rank is at least this.
    pub rank_at_least: Option<usize>,
    /// Proved lower bound of σ_r; 0 if only arithmetic modulo primes proves the rank.
    pub sigma_bound: Option<f64>,
    /// σ_{r+1} in double-double precision.
    pub sigma_next_extended: Option<f64>,
    /// Why the rank is not larger: `full_rank`, `exact`, `vanishes` or `within_data`.
    pub grounds: Option<&'static str>,
    /// What the entries of the equilibrated matrix are known to; 0 if they are meant exactly.
    pub uncertainty: Option<f64>,
    /// Rows that are independent, but only just.
    pub nearly_redundant: Option<NearlyRedundantDocument>,
}

/// A decided rank with σ_r below 1e-3: reactions are of size 1/σ_r per unit of load.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct NearlyRedundantDocument {
    /// σ_r
    pub sigma: f64,
    /// Share by which reactions change if a point is off by 10⁻⁶ m: 1 is their own size. An estimate of the first order.
    pub change_per_micrometre: f64,
    /// Weights of all rows, equilibrated, with which they sum to a row of norm σ_r.
    pub direction: Vec<f64>,
}

/// The misalignment of which the effect is told (m).
const MICROMETRE: f64 = 1e-6;

/// Ranks at other configurations of the same component.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct GenericDocument {
    /// Degree of redundancy at almost all configurations.
    pub redundancy: usize,
    /// What was compared.
    pub points: Vec<PointDocument>,
}

/// Another configuration.
#[derive(Clone, Debug, PartialEq, Serialize)]
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

/// What was decided, of a mechanism or a part of one.
#[derive(Clone, Copy)]
struct Decided<'a> {
    status: RankStatus,
    rank: usize,
    redundancy: usize,
    evidence: &'a Evidence,
    size: f64,
    nearly_redundant: Option<&'a NearlyRedundant>,
}

impl<'a> From<&'a Analysis> for Decided<'a> {
    fn from(analysis: &'a Analysis) -> Self {
        Self {
            status: analysis.decision.status,
            rank: analysis.decision.rank,
            redundancy: analysis.decision.redundancy,
            evidence: &analysis.decision.evidence,
            size: analysis.size,
            nearly_redundant: analysis.nearly_redundant.as_ref(),
        }
    }
}

impl<'a> From<&'a PartVerdicts> for Decided<'a> {
    fn from(part: &'a PartVerdicts) -> Self {
        Self {
            status: part.rows.status,
            rank: part.rows.rank,
            redundancy: part.rows.redundancy,
            evidence: &part.evidence,
            size: part.size,
            nearly_redundant: part.nearly_redundant.as_ref(),
        }
    }
}

impl Decided<'_> {
    fn is_certain(&self) -> bool {
        self.status == RankStatus::Decided
    }

    /// Whether it is proved that the rank is not less.
    fn is_proved_by(&self, certificate: Option<&Certificate>) -> bool {
        self.is_certain() && certificate.is_some_and(|c| c.rank_at_least == self.rank)
    }
}

impl EvidenceDocument {
    pub(super) fn new(analysis: &Analysis, proof: Proof<'_>) -> Self {
        Self::of(analysis.into(), proof)
    }

    fn of(found: Decided<'_>, proof: Proof<'_>) -> Self {
        let evidence = found.evidence;
        let (status, reason) = match found.status {
            RankStatus::Decided => ("decided", None),
            RankStatus::Undecided(doubt) => ("undecided", Some(doubt.to_string())),
            _ => ("undecided", None),
        };
        let certificate = proof.certificate;
        Self {
            status,
            reason,
            sigma_r: evidence.sigma_r,
            sigma_next: evidence.sigma_next,
            gap: evidence.gap,
            tolerance: evidence.tolerance,
            constraint_residual: evidence.constraint_residual,
            permanent: proof
                .generic
                .filter(|_| found.is_certain())
                .map(|elsewhere| elsewhere.redundancy == found.redundancy),
            certified: found.is_proved_by(certificate),
            rank_at_least: certificate.map(|c| c.rank_at_least),
            sigma_bound: certificate.map(|c| c.sigma_bound),
            sigma_next_extended: certificate.map(|c| c.sigma_next),
            grounds: certificate
                .filter(|_| found.is_certain())
                .map(|c| grounds(c.grounds)),
            uncertainty: certificate.map(|c| c.uncertainty),
            nearly_redundant: found.nearly_redundant.map(|n| NearlyRedundantDocument {
                sigma: n.sigma,
                change_per_micrometre: MICROMETRE / found.size / n.sigma,
                direction: n.direction.clone(),
            }),
        }
    }
}

impl EvidenceDocument {
    /// That of the part whose rank is least certain; the rank of the whole is proved where those of all parts are.
    pub(super) fn of_survey(survey: &Survey) -> Self {
        let Some(weakest) = survey.weakest() else {
            return Self::of_nothing();
        };
        let proof = Proof {
            generic: None,
            certificate: weakest.verdicts.evidence.certificate.as_ref(),
        };
        let all_proved = survey.parts.iter().all(|part| {
            let certificate = part.verdicts.evidence.certificate.as_ref();
            Decided::from(&part.verdicts).is_proved_by(certificate)
        });
        let mut document = Self::of((&weakest.verdicts).into(), proof);
        document.certified = all_proved;
        document.rank_at_least = all_proved.then(|| survey.rank());
        if let Some(nearly) = &mut document.nearly_redundant {
            let mut direction = vec![0.0; survey.holonomic_rows + survey.nonholonomic_rows];
            for (&row, x) in weakest.places.rows.iter().zip(&nearly.direction) {
                direction[row] = *x;
            }
            nearly.direction = direction;
        }
        document
    }

    /// Of no rows.
    fn of_nothing() -> Self {
        Self {
            status: "decided",
            reason: None,
            sigma_r: f64::INFINITY,
            sigma_next: 0.0,
            gap: f64::INFINITY,
            tolerance: 0.0,
            constraint_residual: 0.0,
            permanent: None,
            certified: true,
            rank_at_least: Some(0),
            sigma_bound: None,
            sigma_next_extended: None,
            grounds: Some(grounds(Grounds::FullRank)),
            uncertainty: None,
            nearly_redundant: None,
        }
    }
}

fn grounds(grounds: Grounds) -> &'static str {
    match grounds {
        Grounds::FullRank => "full_rank",
        Grounds::Exact => "exact",
        Grounds::Vanishes => "vanishes",
        Grounds::WithinData => "within_data",
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
