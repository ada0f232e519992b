//! What to delete so that a wanted reaction becomes unique, and the motion stays as it is.
//!
//! Deleting rows makes the rest unique by decree: it is a decision of the designer that these rows
//! carry nothing, not a finding. The rule for what may be proposed is simple: any row may be
//! relaxed as long as its joint keeps one row (a revolute becomes a pin in a slot), and a joint or
//! drive of one row may be deleted.

use std::ops::Range;

use linalg::Matrix;
use model::{ConstraintId, ConstraintKind, Layout, Mechanism, System};
use rank::{DeletionError, Limits};

use crate::matrices::Solvability;

/// What may be proposed for deletion.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Allowed {
    /// Single rows, but no joint of several rows loses all of them.
    #[default]
    Sensible,
    /// Joints and drives as a whole.
    Whole,
    /// These rows (from 0), in any combination.
    Rows(Vec<usize>),
}

/// One way to make a reaction unique.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Proposal {
    /// Rows to delete (from 0), ascending; empty if nothing needs to be.
    pub rows: Vec<usize>,
    /// What that means, in words.
    pub text: String,
}

/// The ways to make a reaction unique with the fewest deletions.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Proposals {
    /// Each is enough by itself, and no part of it is. None if nothing that is allowed helps.
    pub ways: Vec<Proposal>,
    /// Whether these are all of that size.
    pub complete: bool,
}

/// The smallest deletions that make the wrench of a joint or drive unique without a change of
/// motion.
///
/// # Errors
/// If the rank is undecided, an answer lies between yes and no, or a row does not exist.
pub fn make_unique(
    mechanism: &Mechanism,
    solvability: &Solvability,
    id: ConstraintId,
    allowed: &Allowed,
    limits: Limits,
) -> Result<Proposals, DeletionError> {
    let layout = mechanism.layout();
    let candidates: Vec<Vec<usize>> = match allowed {
        Allowed::Sensible => (0..layout.rows()).map(|row| vec![row]).collect(),
        Allowed::Whole => layout
            .groups
            .iter()
            .map(|g| g.rows.clone().collect())
            .collect(),
        Allowed::Rows(rows) => rows.iter().map(|&row| vec![row]).collect(),
    };
    let admits = |rows: &[usize]| {
        *allowed != Allowed::Sensible
            || layout
                .groups
                .iter()
                .all(|g| g.rows.len() <= 1 || !g.rows.clone().all(|row| rows.contains(&row)))
    };
    let target = solvability.wrench_combinations(layout.groups[id.0].rows.clone());
    let decision = solvability.decision();
    let found = rank::making_unique(decision, &target, &candidates, admits, limits)?;
    let proposal = |set: &Vec<usize>| {
        let mut rows: Vec<usize> = set.iter().flat_map(|&k| candidates[k].clone()).collect();
        rows.sort_unstable();
        rows.dedup();
        Proposal {
            text: sentence(layout, &rows),
            rows,
        }
    };
    Ok(Proposals {
        ways: found.sets.iter().map(proposal).collect(),
        complete: found.complete,
    })
}

impl Solvability {
    /// The combinations of all multipliers that make up `C_Xᵀ·λ_X` (n × m), each in the scale of
    /// its equilibrated column.
    fn wrench_combinations(&self, rows: Range<usize>) -> Matrix {
        let decision = self.decision();
        let m = decision.rank + decision.redundancy;
        let c = self.equilibrated();
        Matrix::from_fn(c.ncols(), m, |k, i| {
            if rows.contains(&i) {
                c[(i, k)] / decision.scaling.row_factor(i)
            } else {
                0.0
            }
        })
    }
}

/// "delete `W4` and relax row 4 (`B`, y)"
fn sentence(layout: &Layout, rows: &[usize]) -> String {
    let mut words: Vec<String> = Vec::new();
    for group in &layout.groups {
        let own: Vec<usize> = rows
            .iter()
            .copied()
            .filter(|row| group.rows.contains(row))
            .collect();
        if own.is_empty() {
            continue;
        }
        if own.len() == group.rows.len() {
            let verb = match group.kind {
                ConstraintKind::Joint => "delete",
                ConstraintKind::Drive => "release the drive",
            };
            words.push(format!("{verb} `{}`", group.name));
        } else {
            words.extend(
                own.iter()
                    .map(|&row| format!("relax row {}", layout.labels[row])),
            );
        }
    }
    match words.as_slice() {
        [] => "nothing needs to be deleted".to_owned(),
        words => words.join(" and "),
    }
}
