//! Computes the changes of reaction components, and of sums of components, if data change. A sum
//! may contain components of several sets of connected bodies. Each set is treated separately.
//!
//! A datum belongs to only one set. Therefore the largest change of a sum by one datum is the
//! largest change of the contribution of one set.

use model::{ConstraintId, Mechanism, System};

use super::instant::{Change, SolvedEquations};
use super::joined::{JoinedBodies, each_joined};
use super::number::ReactionNumber;
use crate::choices::{ChoiceError, solution_under};
use crate::limits::ROWS_MAX;
use crate::parts::{Extent, Partition};
use crate::row_decision::RowDecision;

/// The contribution of one set of connected bodies to a reaction component, or to a sum of
/// components.
struct Share {
    /// Index of the component or sum in the list.
    number: usize,
    /// Number of terms of the sum that belong to the set.
    terms: usize,
    change: Change,
}

/// Reason why a set has no result.
#[derive(Debug, thiserror::Error)]
enum SetError {
    #[error("{rows} rows share cycles, and matrices of all of them are made up to {max} rows", max = ROWS_MAX)]
    TooLarge { rows: usize },
    #[error("the applied forces are not finite")]
    Loads,
    #[error(transparent)]
    Equations(#[from] ChoiceError),
}

/// The largest change of each number, and the reasons why some changes are not known.
pub(super) struct Changes {
    pub(super) each: Vec<Option<Change>>,
    pub(super) left_out: Vec<String>,
}

/// Returns the largest change of each number at time t, coordinates q and velocities v. The
/// function treats one set of connected bodies after the other. The change is `None` if a share is
/// not known.
pub(super) fn changes(
    mechanism: &Mechanism,
    state: (f64, &[f64], &[f64]),
    kept: &[usize],
    numbers: &[ReactionNumber],
) -> Changes {
    let of_joint = by_joint(mechanism, numbers);
    let shares = each_joined(mechanism, state, |joined, extent| {
        of_set(joined, state.0, kept, numbers, &of_joint).map_err(|reason| {
            format!(
                "the sensitivity of the reactions of {} to the data is not known: {reason}",
                extent.name(mechanism)
            )
        })
    });
    let mut found: Vec<(usize, Option<Change>)> = vec![(0, None); numbers.len()];
    let mut left_out = Vec::new();
    for shares in shares {
        match shares {
            Ok(shares) => shares.into_iter().for_each(|share| {
                let (terms, change) = &mut found[share.number];
                *terms += share.terms;
                *change = Some(match change.take() {
                    Some(known) => known.and(share.change),
                    None => share.change,
                });
            }),
            Err(reason) => left_out.push(reason),
        }
    }
    let complete = found
        .into_iter()
        .zip(numbers)
        .map(|((terms, change), number)| change.filter(|_| terms == number.terms()));
    Changes {
        each: complete.collect(),
        left_out,
    }
}

/// Returns, for each joint or drive, the indices of the reaction components and sums that contain
/// the reaction of this joint or drive.
fn by_joint(mechanism: &Mechanism, numbers: &[ReactionNumber]) -> Vec<Vec<usize>> {
    let mut of_joint = vec![Vec::new(); mechanism.layout().groups.len()];
    for (k, number) in numbers.iter().enumerate() {
        for joint in number.joints() {
            if let Some(numbers) = of_joint.get_mut(joint) {
                numbers.push(k);
            }
        }
    }
    of_joint
}

/// Returns the ascending indices of the reaction components and sums that contain a reaction of
/// this part.
fn within(extent: &Extent, part: &Mechanism, of_joint: &[Vec<usize>]) -> Vec<usize> {
    let groups = 0..part.layout().groups.len();
    let mut own: Vec<usize> = groups
        .flat_map(|k| of_joint[extent.group(k)].iter().copied())
        .collect();
    own.sort_unstable();
    own.dedup();
    own
}

fn of_set(
    joined: &JoinedBodies<'_>,
    t: f64,
    kept: &[usize],
    numbers: &[ReactionNumber],
    of_joint: &[Vec<usize>],
) -> Result<Vec<Share>, SetError> {
    let (part, extent) = (joined.mechanism, joined.extent);
    let wanted = within(extent, part, of_joint);
    if wanted.is_empty() {
        return Ok(Vec::new());
    }
    if joined.force.iter().any(|force| !force.is_finite()) {
        return Err(SetError::Loads);
    }
    let kept = own_kept(kept, extent, part);
    // The same components, in which the joints have the numbers of the set.
    let own: Vec<ReactionNumber> = wanted.iter().map(|&k| numbers[k].within(extent)).collect();
    let mut shares = if part.layout().rows() <= ROWS_MAX {
        let places: Vec<usize> = (0..own.len()).collect();
        of_joined(joined, t, &kept, &own, &places)?
    } else {
        by_parts(joined, t, kept, &own)?
    };
    for share in &mut shares {
        share.number = wanted[share.number];
        place(&mut share.change, extent);
    }
    Ok(shares)
}

/// Returns the rows of the whole mechanism (ascending) that belong to this part. The rows have the
/// numbers of the part.
fn own_kept(kept: &[usize], extent: &Extent, part: &Mechanism) -> Vec<usize> {
    let is_kept = |&row: &usize| kept.binary_search(&extent.row(row)).is_ok();
    (0..part.layout().rows()).filter(is_kept).collect()
}

/// Renumbers the joint of the datum from the part to the whole mechanism.
fn place(change: &mut Change, extent: &Extent) {
    if let Some(by) = &mut change.by {
        by.joint = ConstraintId(extent.group(by.joint.0));
    }
}

/// Returns the contribution of one set of connected bodies to each reaction component in `own`, and
/// the change of this contribution when data of these bodies change. `places` contains the index of
/// each component in the list of the caller.
fn of_joined(
    joined: &JoinedBodies<'_>,
    t: f64,
    kept: &[usize],
    own: &[ReactionNumber],
    places: &[usize],
) -> Result<Vec<Share>, SetError> {
    let mut instant = SolvedEquations::new(joined, t, kept)?;
    let changes = instant.changes(own)?.into_iter();
    let shares = changes.zip(own).zip(places);
    let share = |((change, own), &number): ((Change, &ReactionNumber), &usize)| Share {
        number,
        terms: own.terms(),
        change,
    };
    Ok(shares.map(share).collect())
}

/// Works like [`of_joined`], but treats each part separately, and changes only data of this part.
/// Parts that are too large are omitted.
fn by_parts(
    joined: &JoinedBodies<'_>,
    t: f64,
    kept: Vec<usize>,
    numbers: &[ReactionNumber],
) -> Result<Vec<Share>, SetError> {
    let rows = joined.mechanism.layout().rows();
    let is_kept = |row: &usize| kept.binary_search(row).is_ok();
    let decision = RowDecision {
        rank: kept.len(),
        redundancy: rows - kept.len(),
        dropped: (0..rows).filter(|row| !is_kept(row)).collect(),
        kept: kept.clone(),
        ..RowDecision::empty()
    };
    let state = (t, &joined.q[..], &joined.v[..]);
    let solution = solution_under(joined.mechanism, state, &joined.force, &decision)?;
    let of_joint = by_joint(joined.mechanism, numbers);
    let parts = Partition::by_cycles(joined.mechanism, t, &joined.q);
    let found = parts.map(joined.mechanism, |part, extent| {
        let wanted = within(&extent, part, &of_joint);
        if wanted.is_empty() || part.layout().rows() > ROWS_MAX {
            return Ok(Vec::new());
        }
        let kept = own_kept(&kept, &extent, part);
        let alone = joined.of_part(part, &extent, t, &solution);
        let own: Vec<ReactionNumber> = wanted.iter().map(|&k| numbers[k].within(&extent)).collect();
        let mut shares = of_joined(&alone, t, &kept, &own, &wanted)?;
        shares
            .iter_mut()
            .for_each(|share| place(&mut share.change, &extent));
        Ok::<_, SetError>(shares)
    })?;
    match parts {
        Partition::One => Err(SetError::TooLarge { rows }),
        Partition::Several(_) => Ok(found.into_iter().flatten().collect()),
    }
}
