//! Weaker joints in place of the joints of a mechanism, so that all of their reactions become unique
//! and the motion does not change.
//!
//! The reaction of a joint X is a wrench in the row space of C_X. The rows of a weaker joint span a
//! part of that space, so the weaker joint releases the components along an orthonormal basis E_X
//! of the rest. All solutions are `λ = λ₀ + Z·y`. If components of several joints are released,
//! their values must be zero: `E_Xᵀ·C_Xᵀ·Z_X·y = −E_Xᵀ·C_Xᵀ·λ₀` for all of these joints. This
//! determines all reactions, and the remaining rows have the rank of C, iff these equations are as
//! many as the columns of Z and their matrix is nonsingular. The mechanism then has the same
//! velocities, because its rows span the same space.
//!
//! Joints that share no column of a suitable Z are independent of each other and are replaced
//! separately. For each set of coupled joints, a branch-and-bound search looks for the replacements
//! with the smallest sum of costs. The caller defines the cost of each weaker joint.

mod search;

#[cfg(test)]
mod tests;

use linalg::kernels::{axpy, dot, norm};
use linalg::{DisjointSets, Matrix};
use model::{ConstraintId, Mechanism, System};

use crate::choices::FreeMultipliers;
use crate::groups::{Configuration, RequestError};
use crate::limits::{CLEARLY_RELEASED, SAME_SPAN};
use crate::pose::{dimensionless, evaluated};
use crate::questions::Questions;
use search::{Candidate, cheapest};

/// A weaker joint that may replace a joint of the mechanism.
#[derive(Clone, Debug, PartialEq)]
pub struct WeakerJoint {
    /// The joint that it replaces.
    pub joint: ConstraintId,
    /// Orthonormal basis of the dimensionless load components that it releases.
    released: Vec<Vec<f64>>,
}

/// Coupled joints, and the replacements that make all of their reactions unique.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReplacedJoints {
    /// The joints and drives whose reactions are coupled.
    pub coupled: Vec<ConstraintId>,
    /// Number of their load components that equilibrium does not determine.
    pub redundancy: usize,
    /// Sets of replacements, the cheapest first, as indices of the list of the caller. Each set is
    /// sufficient by itself. The list is empty if no set was found.
    pub ways: Vec<Vec<usize>>,
}

impl Questions<'_> {
    /// Compares joints with those of a changed mechanism with the same bodies, joints and drives,
    /// in the same order. A result is `None` if the changed joint has not fewer rows, or if its
    /// rows are dependent or restrict other motions than the original rows.
    ///
    /// # Errors
    /// [`RequestError::Large`]: the mechanism has too many rows.
    pub fn weaker_joints(
        &self,
        changed: &Mechanism,
        joints: &[ConstraintId],
    ) -> Result<Vec<Option<WeakerJoint>>, RequestError> {
        let (own, other) = (self.mechanism().layout(), changed.layout());
        let sizes = [own, other].map(|l| (l.n_q, l.n_v, l.groups.len()));
        let Some(configuration) = self.whole()?.filter(|_| sizes[0] == sizes[1]) else {
            return Ok(vec![None; joints.len()]);
        };
        let size = configuration.size();
        let s = evaluated(changed, self.time(), self.q());
        let rows = dimensionless(self.mechanism(), configuration.scratch(), size);
        let fewer = dimensionless(changed, &s, size);
        let of = |&joint: &ConstraintId| {
            let of_rows = |c: &Matrix, layout: &model::Layout| -> Vec<Vec<f64>> {
                let group = layout.groups.get(joint.0);
                let rows = group.iter().flat_map(|group| group.rows.iter());
                rows.map(|row| unit(c.row(row))).collect()
            };
            let (rows, fewer) = (of_rows(&rows, own), of_rows(&fewer, other));
            let mut basis = Vec::new();
            extend(&mut basis, &fewer, SAME_SPAN);
            let are_independent = basis.len() == fewer.len() && fewer.len() < rows.len();
            extend(&mut basis, &rows, SAME_SPAN);
            let released = basis.split_off(fewer.len().min(basis.len()));
            (are_independent && fewer.len() + released.len() == rows.len())
                .then_some(WeakerJoint { joint, released })
        };
        Ok(joints.iter().map(of).collect())
    }

    /// Finds replacements of joints that make all of their reactions unique and do not change the
    /// motion. At most one of the weaker joints of each joint is used. The cost of a set is the sum
    /// of the costs of its weaker joints.
    ///
    /// # Errors
    /// [`RequestError::Large`]: the mechanism has too many rows.
    pub fn replacements(
        &self,
        weaker: &[(WeakerJoint, u32)],
    ) -> Result<Vec<ReplacedJoints>, RequestError> {
        let Some(configuration) = self.whole()? else {
            return Ok(Vec::new());
        };
        let free = FreeMultipliers::of(configuration.solvability());
        let c = dimensionless(
            self.mechanism(),
            configuration.scratch(),
            configuration.size(),
        );
        let groups = &self.mechanism().layout().groups;
        let coupled = coupled(configuration, &free).into_iter().map(|joints| {
            let rows = joints.iter().flat_map(|id| groups[id.0].rows.iter());
            let z: Vec<Vec<f64>> = rows.map(|row| free.z.row(row).to_vec()).collect();
            let mut basis = Vec::new();
            extend(&mut basis, &z, CLEARLY_RELEASED);
            // The load component along `direction` as a function of the free multipliers, relative
            // to the size of its terms.
            let form = |id: ConstraintId, direction: &Vec<f64>| {
                let own = groups[id.0].rows.iter();
                let own: Vec<usize> = own.collect();
                let share = |&row: &usize| dot(c.row(row), direction) * free.row_factor[row];
                let shares = unit(&own.iter().map(share).collect::<Vec<f64>>());
                let mut form = vec![0.0; free.z.ncols()];
                for (row, share) in own.iter().zip(&shares) {
                    axpy(*share, free.z.row(*row), &mut form);
                }
                basis.iter().map(|column| dot(&form, column)).collect()
            };
            let candidates = |id: &ConstraintId| {
                let own = weaker.iter().enumerate();
                let own = own.filter(|(_, (joint, _))| joint.joint == *id);
                own.map(|(index, (joint, cost))| Candidate {
                    index,
                    forms: joint.released.iter().map(|d| form(*id, d)).collect(),
                    cost: *cost,
                })
                .collect()
            };
            let candidates: Vec<Vec<Candidate>> = joints.iter().map(candidates).collect();
            ReplacedJoints {
                redundancy: basis.len(),
                ways: cheapest(candidates, basis.len()),
                coupled: joints,
            }
        });
        Ok(coupled.collect())
    }

    /// Returns the configuration of the whole mechanism, if it is one part.
    fn whole(&self) -> Result<Option<&Configuration<'_>>, RequestError> {
        match self.parts() {
            [one] if one.extent.is_whole() => self.configuration(0).map(Some),
            _ => Ok(None),
        }
    }
}

/// Returns the sets of joints and drives with coupled multipliers.
fn coupled(
    configuration: &Configuration<'_>,
    free: &FreeMultipliers<'_>,
) -> Vec<Vec<ConstraintId>> {
    let groups = &configuration.layout().groups;
    let tolerance = free.tolerance.max(SAME_SPAN);
    // Entries of Z·Zᵀ do not depend on the choice of Z.
    let are_coupled = |a: usize, b: usize| {
        let mut rows = groups[a].rows.iter();
        rows.any(|i| {
            let mut others = groups[b].rows.iter();
            others.any(|k| dot(free.z.row(i), free.z.row(k)).abs() > tolerance)
        })
    };
    let mut sets = DisjointSets::new(groups.len());
    for a in 0..groups.len() {
        (0..a).filter(|&b| are_coupled(a, b)).for_each(|b| sets.join(a, b));
    }
    let sets = sets.sets().into_iter();
    let sets = sets.filter(|set| set.iter().any(|&a| are_coupled(a, a)));
    sets.map(|set| set.into_iter().map(ConstraintId).collect())
        .collect()
}

/// Returns the vector with the length 1; the zero vector is not changed.
fn unit(vector: &[f64]) -> Vec<f64> {
    let length = norm(vector);
    let scale = if length > 0.0 { length } else { 1.0 };
    vector.iter().map(|x| x / scale).collect()
}

/// Adds the directions of these vectors that an orthonormal basis does not contain. A vector whose
/// remainder is not longer than `zero` is in the span. Returns the lengths of the added remainders.
fn extend(basis: &mut Vec<Vec<f64>>, vectors: &[Vec<f64>], zero: f64) -> Vec<f64> {
    let mut added = Vec::new();
    for vector in vectors {
        let mut rest = vector.clone();
        // The second round removes the rounding of the first one.
        for _ in 0..2 {
            for known in basis.iter() {
                let along = dot(known, &rest);
                axpy(-along, known, &mut rest);
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
