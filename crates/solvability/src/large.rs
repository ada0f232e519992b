//! A large set of joints on common cycles: its rank, and verdicts from random combinations of its
//! left null space.
//!
//! The verdict on a joint is read from its own rows of `W = Z·Ω` alone, as it is read from its rows
//! of Z in a small mechanism; the cost does not depend on the degree of redundancy. Dependencies
//! are reported if the dependent rows split into small sets of cycles.

use crate::error::AnalysisError;
use crate::judged::{Dependency, Judged, ReactionVerdict};
use crate::limits::ROWS_MAX;
use crate::pose::evaluated;
use std::ops::Range;

use model::start::scene_size;
use model::{ConstraintId, Mechanism, Scratch, System};
use rank::{Evidence, RankStatus, SparseRank};

use crate::analysis::analyse;
use crate::freedoms::WithoutDrives;
use crate::mechanism::{Told, reaction};
use crate::parts::{Extent, PartAnalysis, PartDecision, parts};
use crate::sparse::{Decided, decide_range};

/// Ranks and verdicts of a large mechanism at the pose of the scratch, in which Φ and C have been
/// evaluated at coordinates q.
///
/// # Errors
/// If C is not finite, or too dense for a sparse decision.
pub(crate) fn judge_sparse(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
) -> Result<Judged, AnalysisError> {
    let layout = mechanism.layout();
    let all = Decided::of(mechanism, s, q, 0..layout.rows())?;
    let mut warnings = Vec::new();
    let mut rank_of = |what: &str, rows: Range<usize>| {
        if rows.is_empty() {
            return Ok(0);
        }
        if rows == (0..layout.rows()) {
            return Ok(all.found.rank);
        }
        let found = decide_range(mechanism, s, q, rows)?;
        if let RankStatus::Undecided(doubt) = found.status {
            warnings.push(format!("the rank of {what} alone is undecided: {doubt}"));
        }
        Ok::<_, AnalysisError>(found.rank)
    };
    let rank_holonomic = rank_of("Φq", 0..layout.m)?;
    let rank_nonholonomic = rank_of("Ψ", layout.m..layout.rows())?;
    let without_drives = without_drives(mechanism, s, q)?;
    let verdict = |id: ConstraintId| {
        let rows = layout.groups[id.0].rows.clone();
        let own = 0..rows.len();
        reaction(mechanism, id, s, &all.basis(rows), own, Told::Directions)
    };
    let reactions: Vec<ReactionVerdict> = mechanism
        .layout()
        .constraint_ids()
        .map(verdict)
        .collect::<Result<_, _>>()
        .map_err(|source| AnalysisError::Query { time: s.t, source })?;
    if let RankStatus::Undecided(doubt) = all.found.status {
        warnings.push(format!(
            "the rank is undecided, and with it every verdict: {doubt}"
        ));
    }
    let dependencies = match all.found.status {
        RankStatus::Decided if all.found.redundancy > 0 => {
            dependencies(mechanism, s, q, &reactions)?
        }
        _ => Vec::new(),
    };
    let told = dependencies.len();
    if told < all.found.redundancy && all.found.is_decided() {
        warnings.push(format!(
            "{told} of {} dependencies are listed: {} rows share cycles, and more than {ROWS_MAX} of them depend on each other",
            all.found.redundancy,
            layout.rows()
        ));
    }
    Ok(Judged {
        part: PartAnalysis {
            extent: Extent::Whole,
            size: scene_size(mechanism, q),
            rank_holonomic,
            rank_nonholonomic,
            without_drives,
            decision: PartDecision::Sparse {
                rows: (&all.found).into(),
                evidence: Box::new(evidence(&all.found)),
            },
            certificate: None,
            nearly_redundant: None,
        },
        reactions,
        dependencies,
        warnings,
    })
}

/// Rank and redundancy without the drives, decided in the same way as for all rows. `None` if there
/// are no drives.
fn without_drives(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
) -> Result<Option<WithoutDrives>, AnalysisError> {
    let groups = mechanism.layout().groups.iter().enumerate();
    let joints = groups.filter(|(_, group)| !group.is_drive());
    let joints: Vec<usize> = joints.map(|(k, _)| k).collect();
    if joints.len() == mechanism.layout().groups.len() {
        return Ok(None);
    }
    if joints.is_empty() {
        return Ok(Some(WithoutDrives::default()));
    }
    let part = mechanism.part_of_groups(&joints);
    let q: Vec<f64> = part.places.coordinates.iter().map(|&j| q[j]).collect();
    let rows = 0..part.mechanism.layout().rows();
    let s = evaluated(&part.mechanism, s.t, &q);
    let found = decide_range(&part.mechanism, &s, &q, rows)?;
    Ok(Some(WithoutDrives {
        rank: found.rank,
        redundancy: found.redundancy,
    }))
}

/// Minimal dependent sets of rows, for those joints with dependent rows that share small sets of
/// cycles.
fn dependencies(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
    reactions: &[ReactionVerdict],
) -> Result<Vec<Dependency>, AnalysisError> {
    let dependent = reactions
        .iter()
        .filter(|r| !r.multipliers.verdict.is_unique());
    let dependent: Vec<usize> = dependent.map(|r| r.id.0).collect();
    let among = mechanism.part_of_groups(&dependent);
    let own = |q: &[f64], places: &[usize]| places.iter().map(|&j| q[j]).collect::<Vec<f64>>();
    let among_q = own(q, &among.places.coordinates);
    let among_s = evaluated(&among.mechanism, s.t, &among_q);
    let mut all = Vec::new();
    for groups in parts(&among.mechanism, &among_s) {
        let part = among.mechanism.part_of_groups(&groups);
        if part.mechanism.layout().rows() > ROWS_MAX {
            continue;
        }
        let part_q = own(&among_q, &part.places.coordinates);
        let analysis = analyse(&part.mechanism, s.t, &part_q)?;
        all.extend(analysis.dependencies.into_iter().map(|mut dependency| {
            for row in &mut dependency.rows {
                *row = among.places.rows[part.places.rows[*row]];
            }
            dependency
        }));
    }
    Ok(all)
}

/// Converts the evidence of a sparse rank to that of a dense one.
fn evidence(found: &SparseRank) -> Evidence {
    let e = found.evidence;
    Evidence {
        singular_values: Vec::new(),
        sigma_r: e.sigma_r,
        sigma_next: e.sigma_next,
        gap: e.sigma_r / e.sigma_next,
        tolerance: e.tolerance,
        constraint_residual: e.uncertainty,
        dependence_residual: e.sigma_next,
        certificate: None,
    }
}
