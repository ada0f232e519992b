//! Verdicts of combinations: several reactions together, or one number made of their components.

use linalg::RankDecision;
use model::start::scene_size;
use model::{ConstraintId, Mechanism, System};

use crate::matrices::Solvability;
use crate::mechanism::dimensionless;
use crate::verdict::Judgement;

/// What is to be judged.
#[derive(Clone, Debug, PartialEq)]
pub enum Group {
    /// The reactions of these joints and drives together: unique iff each is.
    Members(Vec<ConstraintId>),
    /// `Σ coefficient · component`
    Combination(Vec<Term>),
}

/// One component of a reaction, times a number.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// The joint or drive.
    pub reaction: ConstraintId,
    /// `Fx`, `Fy`, `T`, or the named component of its definition.
    pub component: String,
    /// The number.
    pub coefficient: f64,
}

/// Judges groups at time t and coordinates q, where the rank has been decided. `None` for a component that does not exist.
#[must_use]
pub fn judge_groups(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    decision: &RankDecision,
    groups: &[Group],
) -> Vec<Option<Judgement>> {
    let layout = mechanism.layout();
    let mut s = mechanism.scratch();
    mechanism.pose(t, q, &mut s);
    mechanism.c(&mut s);
    let solvability = Solvability::from_decision(
        &dimensionless(mechanism, &s, scene_size(mechanism, q)),
        decision.clone(),
    );
    let judge = |group: &Group| match group {
        Group::Members(members) => {
            let rows = members.iter().map(|id| layout.groups[id.0].rows.clone());
            rows.filter_map(|rows| solvability.group(rows).ok())
                .max_by(|a, b| a.margin.total_cmp(&b.margin))
        }
        Group::Combination(terms) => {
            let mut l = vec![0.0; layout.rows()];
            for term in terms {
                let rows = layout.groups[term.reaction.0].rows.clone();
                let coefficients =
                    mechanism.component_coefficients(term.reaction, &term.component, &s)?;
                for (l, c) in l[rows].iter_mut().zip(coefficients) {
                    *l += term.coefficient * c;
                }
            }
            solvability.combination(&l).ok()
        }
    };
    groups.iter().map(judge).collect()
}
