//! Analysis of a large set of joints on common cycles. The module determines the rank of the rows
//! of these joints, and a verdict on each joint. The columns of the matrix Z are a basis of the
//! left null space of the rows. The module does not compute Z, because Z may be too large. The
//! module computes the matrix `W = Z·Ω`, whose columns are random combinations of the columns of Z.
//!
//! In a small mechanism, the verdict on a joint follows from the rows of Z that belong to the
//! joint. In a large set, the verdict follows from the same rows of W. The number of columns of W
//! does not depend on the degree of redundancy, so the cost does not depend on it either.
//! Dependencies are reported if the dependent rows split into small sets of cycles.

use crate::error::AnalysisError;
use crate::judged::{Dependency, PartResults, ReactionVerdict};
use crate::limits::ROWS_MAX;
use crate::pose::evaluated;

use model::start::scene_size;
use model::{ConstraintId, Mechanism, Scratch, System};
use rank::{Evidence, SparseRank};

use crate::analysis::analyse;
use crate::freedoms::PartialRanks;
use crate::mechanism::reaction;
use crate::parts::{PartDecision, parts};
use crate::sparse::{SparseDecision, decide_some};

/// Returns ranks and verdicts of a large mechanism at the configuration of the scratch, in which Φ
/// and C have been evaluated at coordinates q.
///
/// # Errors
/// Returns an error if C is not finite, or too dense for a sparse decision.
pub(crate) fn judge_sparse(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
) -> Result<PartResults, AnalysisError> {
    let layout = mechanism.layout();
    let all = SparseDecision::of(mechanism, s, q, 0..layout.rows())?;
    let ranks = PartialRanks::of(layout, all.found.rank, |own| {
        let found = decide_some(mechanism, s, q, own.iter().copied())?;
        Ok((found.rank, found.status))
    })?;
    let verdict = |id: ConstraintId| {
        let rows: Vec<usize> = layout.groups[id.0].rows.iter().collect();
        let own: Vec<usize> = (0..rows.len()).collect();
        reaction(mechanism, id, s, &all.basis(&rows), &own)
    };
    let decision = PartDecision::Sparse {
        rows: (&all.found).into(),
        evidence: Box::new(evidence(&all.found)),
    };
    let size = scene_size(mechanism, q);
    let mut judged = PartResults::new(mechanism, s.t, size, decision, ranks, verdict)?;
    let redundancy = all.found.redundancy;
    if all.found.is_decided() && redundancy > 0 {
        judged.dependencies = dependencies(mechanism, s, q, &judged.reactions)?;
        let told = judged.dependencies.len();
        if told < redundancy {
            judged.warnings.push(format!(
                "{told} of {redundancy} dependencies are listed: {} rows share cycles, and more than {ROWS_MAX} of them are dependent",
                layout.rows()
            ));
        }
    }
    Ok(judged)
}

/// Returns minimal dependent sets of rows, for joints whose dependent rows share small sets of
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

/// Converts the evidence of a sparse rank to the evidence of a dense rank.
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
