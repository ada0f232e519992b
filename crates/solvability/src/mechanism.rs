//! Solvability of a mechanism at one configuration: ranks, and a verdict for each joint, drive, row
//! and direction.

use linalg::Matrix;
use model::{ConstraintId, Mechanism, Scratch, System};
use rank::{RankDecision, RankStatus};

use crate::certificate::UncertainRows;
use crate::directions::readable;
use crate::error::AnalysisError;
use crate::freedoms::PartialRanks;
use crate::judged::{ComponentVerdict, Dependency, PartResults, ReactionVerdict, RowVerdict};
use crate::matrices::{Basis, QueryError, Solvability};
use crate::parts::PartDecision;
use crate::verdict::Verdict;
use crate::{explain, words};

/// Returns the verdicts of a mechanism that is one part, at the configuration of the scratch. Φ and
/// C must have been evaluated in the scratch, and the rank must have been decided.
pub(crate) fn part_verdicts(
    mechanism: &Mechanism,
    s: &Scratch,
    rows: &UncertainRows,
    decision: RankDecision,
) -> Result<PartResults, AnalysisError> {
    let mut found = reaction_verdicts(mechanism, s, rows, decision)?;
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
                text: explain::describe(mechanism, &circuit),
                left_out: circuit.left_out,
                rows: circuit.rows,
                coefficients: circuit.coefficients,
            });
        found.dependencies = dependencies.collect();
        found.part.nearly_redundant = rows.nearly_redundant(mechanism, s, decision);
    }
    Ok(found)
}

/// Works like [`part_verdicts`], without dependencies and near dependencies.
fn reaction_verdicts(
    mechanism: &Mechanism,
    s: &Scratch,
    rows: &UncertainRows,
    decision: RankDecision,
) -> Result<PartResults, AnalysisError> {
    let layout = mechanism.layout();
    let solvability = Solvability::from_decision(&rows.matrix(), decision);
    let (decision, basis) = (solvability.decision(), solvability.basis());
    let ranks = PartialRanks::of(layout, decision.rank, |own| match basis.rank_of(own) {
        Some(rank) => Ok((rank, RankStatus::Decided)),
        None => {
            let decision = rows.select(own).decide()?;
            Ok((decision.rank, decision.status))
        }
    })?;
    let verdict = |id: ConstraintId| {
        let own: Vec<usize> = layout.groups[id.0].rows.iter().collect();
        reaction(mechanism, id, s, basis, &own)
    };
    let decision = PartDecision::Dense(Box::new(decision.clone()));
    PartResults::new(mechanism, s.t, rows.size(), decision, ranks, verdict)
}

/// Returns the verdict on a joint or drive with these rows of the basis.
pub(crate) fn reaction(
    mechanism: &Mechanism,
    id: ConstraintId,
    s: &Scratch,
    basis: &Basis,
    rows: &[usize],
) -> Result<ReactionVerdict, QueryError> {
    let group = &mechanism.layout().groups[id.0];
    let names = group.space.components();
    let (components, map) = component_map(mechanism, id, s);
    let forces = components
        .iter()
        .filter(|&c| group.space.forces().contains(c))
        .count();
    let mapped = basis
        .mapped(&map, rows.iter().copied())?
        .with_forces(forces);
    let mut zero_components = Vec::new();
    for (i, &c) in components.iter().enumerate() {
        if mapped.is_zero(i)? {
            zero_components.push(names[c]);
        }
    }
    let judged = components.iter().enumerate().map(|(i, &c)| {
        Ok(ComponentVerdict {
            name: names[c],
            judgement: mapped.component(i)?,
        })
    });
    let mut components = judged.collect::<Result<Vec<_>, QueryError>>()?;
    components.extend(own_load(mechanism, id, s, basis, rows)?);
    let on_bodies = basis.group(rows.iter().copied())?;
    let free = components
        .iter()
        .find(|c| c.judgement.verdict == Verdict::NotUnique);
    let wrench = match (free, on_bodies.verdict == Verdict::Unique) {
        (Some(free), true) => free.judgement.clone(),
        _ => on_bodies,
    };
    // In the plane, directions with three components are readable without a change of basis.
    let told = |directions| match group.space.n_rotations() {
        1 => directions,
        _ => readable(directions),
    };
    // If the number of directions is undecided, no directions are returned. The verdicts on the
    // components state that this number is undecided.
    let unique_directions = match mapped.unique_directions() {
        Err(QueryError::Rank(_) | QueryError::Directions { .. }) => None,
        known => Some(told(known?)),
    };
    let live_directions = unique_directions
        .as_deref()
        .map(|unique| told(mapped.live_directions(unique)));
    let row_verdict = |(row, own): (usize, &usize)| {
        Ok(RowVerdict {
            row,
            judgement: basis.row(*own)?,
        })
    };
    Ok(ReactionVerdict {
        id,
        name: group.name.clone(),
        space: group.space,
        kind: group.spec.common.scene_type,
        wrench,
        multipliers: basis.multipliers(rows.iter().copied())?,
        rows: (group.rows.iter().zip(rows))
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

/// Returns the components of a reaction that are not identically zero, as indices of
/// [`model::SpaceKind::components`]. Also returns the map from the multipliers of the rows of the
/// reaction to these components.
pub(crate) fn component_map(
    mechanism: &Mechanism,
    id: ConstraintId,
    s: &Scratch,
) -> (Vec<usize>, Matrix) {
    let components = mechanism.layout().groups[id.0].components();
    let full = mechanism.reactions(s).wrench_map(id);
    let map = Matrix::from_fn(components.len(), full.ncols(), |i, j| {
        full[(components[i], j)]
    });
    (components, map)
}

/// Returns the verdict on the load of a coupling.
fn own_load(
    mechanism: &Mechanism,
    id: ConstraintId,
    s: &Scratch,
    basis: &Basis,
    rows: &[usize],
) -> Result<Option<ComponentVerdict>, QueryError> {
    let Some(name) = mechanism.layout().groups[id.0].own_load() else {
        return Ok(None);
    };
    let coefficients = mechanism.reactions(s).component_coefficients(id, name);
    let coefficients = coefficients.unwrap_or_else(|| vec![0.0; rows.len()]);
    let map = Matrix::from_fn(1, rows.len(), |_, j| coefficients[j]);
    let judgement = basis.mapped(&map, rows.iter().copied())?.component(0)?;
    Ok(Some(ComponentVerdict { name, judgement }))
}

#[cfg(test)]
mod tests;
