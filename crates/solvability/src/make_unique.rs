//! Finds rows to delete so that a given reaction becomes unique and the motion does not change.
//!
//! The uniqueness then results from a decision of the designer, who assumes that these rows carry
//! no load. The uniqueness is not a result of the model. The rule for proposals is as follows. Any
//! row may be relaxed as long as its joint keeps one row (a revolute becomes a pin in a slot). A
//! joint or drive with a single row may be deleted. If such deletions are not sufficient, whole
//! joints may be deleted as well.

use linalg::Matrix;
use model::{ConstraintId, ConstraintKind, Layout, Mechanism, RowRanges, System};
use rank::{DeletionError, Limits};

use crate::matrices::Solvability;
use crate::words::list;

/// Rows that may be proposed for deletion.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum DeletableRows {
    /// Single rows, but not all rows of a joint with several rows. If such deletions are not
    /// sufficient, any rows.
    #[default]
    Sensible,
    /// Whole joints and drives.
    Whole,
    /// These rows (from 0), in any combination.
    Rows(Vec<usize>),
}

/// One way to make a reaction unique.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Proposal {
    /// Rows to delete (from 0), ascending; empty if no deletion is needed.
    pub rows: Vec<usize>,
    /// The proposal as text.
    pub text: String,
}

/// The ways to make a reaction unique with the smallest number of deletions.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Proposals {
    /// The proposals. Each proposal is sufficient by itself, and each of its rows is needed. The
    /// list is empty if no allowed deletion is sufficient.
    pub ways: Vec<Proposal>,
    /// Whether all proposals with the smallest number of deletions are listed.
    pub complete: bool,
    /// Whether joints with several rows lose all of their rows. Such joints lose all rows if no
    /// deletion that leaves them a row is sufficient.
    pub whole: bool,
}

/// Finds the smallest deletions that make the wrench of a joint or drive unique without changing
/// the motion.
///
/// # Errors
/// Returns an error if the rank is undecided, if it is undecided whether a deletion is sufficient,
/// or if a row does not exist.
pub fn make_unique(
    mechanism: &Mechanism,
    solvability: &Solvability,
    id: ConstraintId,
    allowed: &DeletableRows,
    limits: Limits,
) -> Result<Proposals, DeletionError> {
    let layout = mechanism.layout();
    let candidates: Vec<Vec<usize>> = match allowed {
        DeletableRows::Sensible => (0..layout.rows()).map(|row| vec![row]).collect(),
        DeletableRows::Whole => layout
            .groups
            .iter()
            .map(|g| g.rows.iter().collect())
            .collect(),
        DeletableRows::Rows(rows) => rows.iter().map(|&row| vec![row]).collect(),
    };
    let admits = |rows: &[usize]| {
        *allowed != DeletableRows::Sensible
            || layout
                .groups
                .iter()
                .all(|g| g.rows.len() <= 1 || !g.rows.iter().all(|row| rows.contains(&row)))
    };
    let target = solvability.wrench_combinations(&layout.groups[id.0].rows);
    let decision = solvability.decision();
    let mut found = rank::making_unique(decision, &target, &candidates, admits, limits)?;
    let whole = *allowed == DeletableRows::Sensible && found.sets.is_empty();
    if whole {
        found = rank::making_unique(decision, &target, &candidates, |_| true, limits)?;
    }
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
        whole,
    })
}

impl Solvability {
    /// Returns the combinations of all multipliers that give `C_Xᵀ·λ_X` (n × m), each in the scale
    /// of its equilibrated column.
    fn wrench_combinations(&self, rows: &RowRanges) -> Matrix {
        let decision = self.decision();
        let m = decision.rank + decision.redundancy;
        let c = self.equilibrated();
        Matrix::from_fn(c.ncols(), m, |k, i| {
            if rows.contains(i) {
                c[(i, k)] / decision.scaling.row_factor(i)
            } else {
                0.0
            }
        })
    }
}

/// Returns, for example, "relax row 4 (`B`, y) and delete `W3` and `W4`".
fn sentence(layout: &Layout, rows: &[usize]) -> String {
    let mut actions: Vec<(&str, Vec<String>)> = Vec::new();
    let mut add = |verb, object| match actions.last_mut() {
        Some((last, objects)) if *last == verb => objects.push(object),
        _ => actions.push((verb, vec![object])),
    };
    for group in &layout.groups {
        let own = rows.iter().filter(|row| group.rows.contains(**row));
        let own: Vec<usize> = own.copied().collect();
        if own.is_empty() {
            continue;
        }
        if own.len() == group.rows.len() {
            let verb = match group.kind {
                ConstraintKind::Joint => "delete",
                ConstraintKind::Drive => "release the drive",
            };
            add(verb, format!("`{}`", group.name));
        } else {
            for &row in &own {
                add("relax", format!("row {}", layout.labels[row]));
            }
        }
    }
    let actions = actions.iter();
    let actions = actions.map(|(verb, objects)| format!("{verb} {}", list(objects)));
    let actions: Vec<String> = actions.collect();
    match actions.as_slice() {
        [] => "nothing needs to be deleted".to_owned(),
        actions => list(actions),
    }
}
