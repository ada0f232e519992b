//! Solvability of a mechanism at one configuration: ranks, and a verdict for every joint, drive,
//! row and direction.

use std::ops::Range;

use linalg::Matrix;
use model::reaction::COMPONENTS;
use model::{ConstraintId, Mechanism, Scratch, System};
use rank::RankDecision;

use crate::certificate::Rows;
use crate::error::AnalysisError;
use crate::freedoms::WithoutDrives;
use crate::judged::{ComponentVerdict, Dependency, Judged, ReactionVerdict, RowVerdict};
use crate::matrices::{Basis, QueryError, Solvability};
use crate::parts::{Extent, PartAnalysis, PartDecision};
use crate::pose::TRANSLATIONS;
use crate::verdict::Verdict;
use crate::words;

/// Verdicts of a mechanism that is one part, at the pose of the scratch, in which Φ and C have been
/// evaluated and for which the rank has been decided.
pub(crate) fn judge(
    mechanism: &Mechanism,
    s: &Scratch,
    rows: &Rows,
    decision: RankDecision,
) -> Result<Judged, AnalysisError> {
    let mut found = judge_reactions(mechanism, s, rows, decision, Told::Directions)?;
    if let Some(decision) = found.part.decision.dense() {
        let open = rank::open_rows(decision);
        if !open.is_empty() {
            found.warnings.push(words::open(mechanism, &open));
        }
        let is_known = |rows: &[usize]| !rows.iter().any(|row| open.binary_search(row).is_ok());
        let circuits = rank::short_circuits(decision).into_iter();
        let dependencies = circuits
            .filter(|circuit| is_known(&circuit.rows))
            .map(|circuit| Dependency {
                text: words::describe(mechanism, &circuit),
                left_out: circuit.left_out,
                rows: circuit.rows,
                coefficients: circuit.coefficients,
            });
        found.dependencies = dependencies.collect();
        found.part.nearly_redundant = rows.nearly_redundant(mechanism, s, decision);
    }
    Ok(found)
}

/// How much is reported for each reaction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Told {
    /// The verdicts of its wrench, its components and its rows.
    Verdicts,
    /// Also the directions in which it is unique.
    Directions,
}

/// Like [`judge`], without dependencies and near dependencies.
pub(crate) fn judge_reactions(
    mechanism: &Mechanism,
    s: &Scratch,
    rows: &Rows,
    decision: RankDecision,
    told: Told,
) -> Result<Judged, AnalysisError> {
    let layout = mechanism.layout();
    let t = s.t;
    let solvability = Solvability::from_decision(&rows.matrix(), decision);
    let mut warnings = Vec::new();
    let mut rank_of = |what: &str, part: std::ops::Range<usize>| {
        // An empty range, and the range of all rows, need no decision of their own.
        if part.is_empty() {
            return Ok(0);
        }
        if part == (0..layout.rows()) {
            return Ok(solvability.decision().rank);
        }
        if let Some(rank) = solvability.basis().rank_of(part.clone()) {
            return Ok(rank);
        }
        let decision = rows.select(&part.collect::<Vec<_>>()).decide()?;
        if let rank::RankStatus::Undecided(doubt) = &decision.status {
            warnings.push(format!("the rank of {what} alone is undecided: {doubt}"));
        }
        Ok::<_, AnalysisError>(decision.rank)
    };
    let rank_holonomic = rank_of("Φq", 0..layout.m)?;
    let rank_nonholonomic = rank_of("Ψ", layout.m..layout.rows())?;
    let without_drives = WithoutDrives::of(layout, rows, &solvability, &mut warnings)?;
    let reactions = mechanism
        .layout()
        .constraint_ids()
        .map(|id| {
            let rows = layout.groups[id.0].rows.clone();
            reaction(mechanism, id, s, solvability.basis(), rows, told)
        })
        .collect::<Result<_, _>>()
        .map_err(|source| AnalysisError::Query { time: t, source })?;
    let decision = solvability.decision().clone();
    if let rank::RankStatus::Undecided(doubt) = &decision.status {
        warnings.push(format!(
            "the rank is undecided, and with it every verdict: {doubt}"
        ));
    }
    Ok(Judged {
        part: PartAnalysis {
            extent: Extent::Whole,
            size: rows.size(),
            rank_holonomic,
            rank_nonholonomic,
            without_drives,
            nearly_redundant: None,
            certificate: decision.evidence.certificate.clone(),
            decision: PartDecision::Dense(Box::new(decision)),
        },
        reactions,
        dependencies: Vec::new(),
        warnings,
    })
}

/// The verdict on a joint or drive with these rows of the basis.
pub(crate) fn reaction(
    mechanism: &Mechanism,
    id: ConstraintId,
    s: &Scratch,
    basis: &Basis,
    rows: Range<usize>,
    told: Told,
) -> Result<ReactionVerdict, QueryError> {
    let group = &mechanism.layout().groups[id.0];
    let components = group.components();
    let full = mechanism.reactions(s).wrench_map(id);
    let map = Matrix::from_fn(components.len(), rows.len(), |i, j| {
        full[(components[i], j)]
    });
    let forces = components.iter().filter(|&&c| c < TRANSLATIONS).count();
    let mapped = basis.mapped(&map, rows.clone())?.with_forces(forces);
    let mut zero_components = Vec::new();
    for (i, &c) in components.iter().enumerate() {
        if mapped.is_zero(i)? {
            zero_components.push(COMPONENTS[c]);
        }
    }
    let judged = components.iter().enumerate().map(|(i, &c)| {
        Ok(ComponentVerdict {
            name: COMPONENTS[c],
            judgement: mapped.component(i)?,
        })
    });
    let components = judged.collect::<Result<Vec<_>, QueryError>>()?;
    let on_bodies = basis.group(rows.clone())?;
    let free = components
        .iter()
        .find(|c| c.judgement.verdict == Verdict::NotUnique);
    let wrench = match (free, on_bodies.verdict == Verdict::Unique) {
        (Some(free), true) => free.judgement.clone(),
        _ => on_bodies,
    };
    // If the number of directions is undecided, none are given; the verdicts above say that it is
    // undecided.
    let unique_directions = match told {
        Told::Verdicts => None,
        Told::Directions => match mapped.unique_directions() {
            Err(QueryError::Rank(_) | QueryError::Directions { .. }) => None,
            known => Some(known?),
        },
    };
    let live_directions = unique_directions
        .as_deref()
        .map(|unique| mapped.live_directions(unique));
    let row_verdict = |(row, own)| {
        Ok(RowVerdict {
            row,
            judgement: basis.row(own)?,
        })
    };
    Ok(ReactionVerdict {
        id,
        name: group.name.clone(),
        kind: group.spec.common.scene_type,
        wrench,
        multipliers: basis.multipliers(rows.clone())?,
        rows: (group.rows.clone().zip(rows))
            .map(row_verdict)
            .collect::<Result<_, _>>()?,
        components,
        zero_components,
        unique_directions: unique_directions.unwrap_or_default(),
        directions_left_out: match live_directions {
            Some(_) => mapped.directions_left_out()?,
            None => 0.0,
        },
        live_directions,
    })
}
