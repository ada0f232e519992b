//! Weaker joints that replace joints of a mechanism. With these joints, all reactions become unique
//! and the motion does not change.
//!
//! The reaction of a joint X is a wrench in the row space of C_X. The rows of a weaker joint span a
//! part of this space. Therefore the weaker joint releases the components along an orthonormal
//! basis E_X of the remaining space. All solutions are `λ = λ₀ + Z·y`. If components of several
//! joints are released, their values must be zero: `E_Xᵀ·C_Xᵀ·Z_X·y = −E_Xᵀ·C_Xᵀ·λ₀` for all of
//! these joints. All reactions are determined, and the remaining rows have the rank of C, iff the
//! number of these equations is the number of columns of Z and their matrix is nonsingular. The
//! mechanism then has the same velocities, because its rows span the same space.
//!
//! Joints that share no column of a suitable Z are independent of each other and are replaced
//! separately. For each set of coupled joints, a branch-and-bound search finds the replacements
//! with the smallest sum of costs. The caller defines the cost of each weaker joint.

mod search;

#[cfg(test)]
mod tests;

use linalg::kernels::{axpy, dot, norm};
use linalg::{DisjointSets, Matrix};
use model::{ConstraintId, Layout, Mechanism, System};

use crate::choices::FreeMultipliers;
use crate::groups::Configuration;
use crate::limits::{CLEARLY_RELEASED, SAME_SPAN};
use crate::pose::{dimensionless, evaluated};
use search::{Candidate, cheapest};

/// A weaker joint that may replace a joint of the mechanism.
#[derive(Clone, Debug, PartialEq)]
pub struct WeakerJoint {
    /// The joint that the weaker joint replaces.
    pub joint: ConstraintId,
    /// Orthonormal basis of the dimensionless load components that the weaker joint releases.
    released: Vec<Vec<f64>>,
}

/// Joints and drives whose reactions are coupled.
#[derive(Clone, Debug, PartialEq)]
pub struct CoupledJoints {
    /// The joints and drives.
    pub joints: Vec<ConstraintId>,
    /// Number of load components of the joints that equilibrium does not determine. If weaker
    /// joints release more components, the motion changes.
    pub redundancy: usize,
    /// Orthonormal basis of the free multipliers that change the reactions of the joints.
    basis: Vec<Vec<f64>>,
}

/// Finds replacements of joints at one configuration of a mechanism.
pub struct Replacements<'q, 'm> {
    configuration: &'q Configuration<'m>,
    q: &'q [f64],
    /// Dimensionless C.
    c: Matrix,
    free: FreeMultipliers<'q>,
}

impl<'q, 'm> Replacements<'q, 'm> {
    /// Creates the search for a configuration with the coordinates q. The search uses the rank that
    /// was decided at this configuration.
    pub(crate) fn new(configuration: &'q Configuration<'m>, q: &'q [f64]) -> Self {
        let (mechanism, s) = (&configuration.reactions.mechanism, configuration.scratch());
        let c = dimensionless(mechanism, s, configuration.size());
        Self {
            configuration,
            q,
            c,
            free: FreeMultipliers::of(configuration.solvability()),
        }
    }

    /// Compares joints with the joints of a changed mechanism with the same bodies, joints and
    /// drives, in the same order. A changed joint is not in the result if it does not have fewer
    /// rows, if its rows are dependent, or if its rows restrict motions other than those of the
    /// original rows.
    #[must_use]
    pub fn weaker_joints(&self, changed: &Mechanism, joints: &[ConstraintId]) -> Vec<WeakerJoint> {
        let (own, other) = (self.configuration.layout(), changed.layout());
        if (own.n_q, own.n_v, own.groups.len()) != (other.n_q, other.n_v, other.groups.len()) {
            return Vec::new();
        }
        let s = evaluated(changed, self.configuration.scratch().t, self.q);
        let fewer = dimensionless(changed, &s, self.configuration.size());
        let released = |joint: &ConstraintId| {
            let [rows, fewer] = [(&self.c, own), (&fewer, other)].map(|(c, layout)| {
                rows(c, layout, *joint)
                    .map(|row| unit(&row))
                    .collect::<Vec<_>>()
            });
            let mut basis = Vec::new();
            extend(&mut basis, &fewer, SAME_SPAN);
            let independent = basis.len();
            extend(&mut basis, &rows, SAME_SPAN);
            let is_weaker = independent == fewer.len() && basis.len() == rows.len();
            (is_weaker && independent < rows.len()).then(|| WeakerJoint {
                joint: *joint,
                released: basis.split_off(independent),
            })
        };
        joints.iter().filter_map(released).collect()
    }

    /// Returns the sets of coupled joints and drives.
    #[must_use]
    pub fn coupled(&self) -> Vec<CoupledJoints> {
        let layout = self.configuration.layout();
        let sets = coupled(layout, &self.free).into_iter();
        let set = |joints: Vec<ConstraintId>| {
            let z = joints.iter().flat_map(|id| rows(&self.free.z, layout, *id));
            let mut basis = Vec::new();
            extend(&mut basis, &z.collect::<Vec<_>>(), CLEARLY_RELEASED);
            CoupledJoints {
                redundancy: basis.len(),
                joints,
                basis,
            }
        };
        sets.map(set).collect()
    }

    /// Finds sets of weaker joints that make all reactions of coupled joints unique and do not
    /// change the motion. At most one weaker joint replaces each joint. The cost of a set is the
    /// sum of the costs of its weaker joints, and must be less than `below`. The cheapest set comes
    /// first. A set is a list of indices into the list of weaker joints. Each set is sufficient by
    /// itself. The result is empty if no set was found.
    #[must_use]
    pub fn cheapest(
        &self,
        of: &CoupledJoints,
        weaker: &[(WeakerJoint, usize)],
        below: Option<usize>,
    ) -> Vec<Vec<usize>> {
        let (layout, free) = (self.configuration.layout(), &self.free);
        // A load component as a function of the free multipliers, relative to the size of its
        // terms.
        let form = |id: ConstraintId, direction: &Vec<f64>| {
            let own = || layout.groups[id.0].rows.iter();
            let share = |row: usize| dot(self.c.row(row), direction) * free.row_factor[row];
            let shares = unit(&own().map(share).collect::<Vec<f64>>());
            let mut form = vec![0.0; free.z.ncols()];
            for (row, share) in own().zip(&shares) {
                axpy(*share, free.z.row(row), &mut form);
            }
            of.basis.iter().map(|column| dot(&form, column)).collect()
        };
        let candidates = |id: &ConstraintId| {
            let own = weaker.iter().enumerate();
            let own = own.filter(|(_, (weaker, _))| weaker.joint == *id);
            let candidate = |(index, (weaker, cost)): (usize, &(WeakerJoint, usize))| Candidate {
                index,
                forms: weaker.released.iter().map(|d| form(*id, d)).collect(),
                cost: *cost,
            };
            own.map(candidate).collect()
        };
        cheapest(
            of.joints.iter().map(candidates).collect(),
            of.redundancy,
            below,
        )
    }
}

/// Returns the rows of a matrix that belong to a joint.
fn rows(c: &Matrix, layout: &Layout, id: ConstraintId) -> impl Iterator<Item = Vec<f64>> {
    let rows = layout.groups[id.0].rows.iter();
    rows.map(|row| c.row(row).to_vec())
}

/// Returns the sets of joints and drives with coupled multipliers.
fn coupled(layout: &Layout, free: &FreeMultipliers<'_>) -> Vec<Vec<ConstraintId>> {
    let rows = |k: usize| layout.groups[k].rows.iter();
    // Entries of Z·Zᵀ do not depend on the choice of Z.
    let tolerance = free.tolerance.max(SAME_SPAN);
    let is_entry = |i: usize, k: usize| dot(free.z.row(i), free.z.row(k)).abs() > tolerance;
    let are_coupled = |a: usize, b: usize| rows(a).any(|i| rows(b).any(|k| is_entry(i, k)));
    let mut sets = DisjointSets::new(layout.groups.len());
    for a in 0..layout.groups.len() {
        let others = (0..a).filter(|&b| are_coupled(a, b));
        others.for_each(|b| sets.join(a, b));
    }
    let open = sets.sets().into_iter();
    let open = open.filter(|set| set.iter().any(|&a| are_coupled(a, a)));
    open.map(|set| set.into_iter().map(ConstraintId).collect())
        .collect()
}

/// Returns the vector scaled to length 1. The zero vector is not changed.
fn unit(vector: &[f64]) -> Vec<f64> {
    let length = norm(vector);
    let scale = if length > 0.0 { length } else { 1.0 };
    vector.iter().map(|x| x / scale).collect()
}

/// Adds the directions of these vectors that an orthonormal basis does not contain. If the
/// remainder of a vector is not longer than `zero`, the vector is in the span. Returns the lengths
/// of the added remainders.
fn extend(basis: &mut Vec<Vec<f64>>, vectors: &[Vec<f64>], zero: f64) -> Vec<f64> {
    let mut added = Vec::new();
    for vector in vectors {
        let mut rest = vector.clone();
        // The second round removes the rounding of the first round.
        for _ in 0..2 {
            for known in basis.iter() {
                axpy(-dot(known, &rest), known, &mut rest);
            }
        }
        let left = norm(&rest);
        if left > zero {
            basis.push(unit(&rest));
            added.push(left);
        }
    }
    added
}
