//! Bounds of reactions that the rigid model does not determine, for joints that give way by any
//! law in the direction of the load that they carry.
//!
//! All solutions of the equations are `λ₀ + Z·y`. If every joint X gives way in the direction of
//! its force (and of its moment) with a compliance c ≥ 0 that may depend on anything, then
//! `Zᵀ·D·λ = 0` with a diagonal D ≥ 0 for orthonormal components of the wrenches, and by Cramer's
//! rule and the Cauchy–Binet formula
//!
//! y = Σ_m c^m·w_m·y_m / Σ_m c^m·w_m, w_m = Σ_{S ∈ m} det²(Z_S),
//! y_m = Σ_{S ∈ m} det²(Z_S)·y_S / w_m
//!
//! where S are sets of p components with det Z_S ≠ 0, y_S is the solution in which the components
//! of S are zero, and a monomial m collects the sets with equally many components of each force and
//! of each moment. All weights are positive, so every solution lies in the convex hull of the y_m.
//! See A. Ben-Tal and M. Teboulle, Linear Algebra Appl. 139 (1990) 165–170, and G. W. Stewart,
//! Linear Algebra Appl. 112 (1989) 189–193, for one component in each group.

mod hull;
mod of_parts;
mod separation;

#[cfg(test)]
mod tests;

use std::sync::Arc;

use model::{ConstraintId, Frame};

pub use of_parts::ReactionBounds;

use crate::choices::FreeMultipliers;
use crate::groups::{Configuration, LinearForm, RequestError};
use crate::value::NoFiniteReaction;
use crate::verdict::Verdict;
use hull::{Element, Hull, HullError};

/// The force or the moment of a joint or drive, which gives way in its own direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ElasticLoad {
    /// The joint or drive.
    pub reaction: ConstraintId,
    /// Whether the load is the moment about the reference point; otherwise it is the force.
    pub is_moment: bool,
}

/// The smallest and the largest value of a number for joints that give way by any law.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ElasticBounds {
    /// The smallest value (N, N·m).
    pub lowest: f64,
    /// The largest value (N, N·m).
    pub highest: f64,
    /// The loads whose joints give way at the smallest value.
    pub at_lowest: Vec<ElasticLoad>,
    /// The loads whose joints give way at the largest value.
    pub at_highest: Vec<ElasticLoad>,
    /// Whether the smallest and the largest value are reached in the limit of some compliances.
    /// Otherwise the true range may end earlier.
    pub reached: [bool; 2],
}

/// Reason why there are no bounds.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BoundsError {
    /// The rank is undecided.
    #[error("the rank is undecided")]
    Rank,
    /// Whether the number is unique is undecided.
    #[error("its verdict is undecided")]
    Verdict,
    /// Whether a component can be zero is undecided.
    #[error("for `{reaction}` it is undecided which components may be zero at the same time")]
    Undecided {
        /// The joint or drive.
        reaction: String,
    },
    /// The joints that give way do not determine the loads.
    #[error(
        "the joints that give way do not determine {}: let other joints give way, too",
        match free {
            1 => "one load component".to_owned(),
            n => format!("{n} load components"),
        }
    )]
    Rigid {
        /// Number of load components that stay undetermined.
        free: usize,
    },
    /// Too many sets of components can be zero together.
    #[error("more than 100 000 sets of load components would have to be examined")]
    Many,
    /// No finite reactions exist.
    #[error("no finite reaction exists")]
    NoFinite(Arc<NoFiniteReaction>),
    /// The request is invalid.
    #[error(transparent)]
    Request(#[from] RequestError),
}

/// The solutions of a part for joints that give way by any law.
pub struct ElasticSolutions<'c, 'm> {
    configuration: &'c Configuration<'m>,
    free: FreeMultipliers<'c>,
    lambda_0: Vec<f64>,
    loads: Vec<ElasticLoad>,
    hull: Hull,
}

impl<'m> Configuration<'m> {
    /// Returns the solutions for joints that give way by any law, from one solution λ₀. The joints
    /// and drives in `rigid` do not give way.
    ///
    /// # Errors
    /// [`BoundsError`]
    pub fn elastic_solutions<'c>(
        &'c self,
        lambda_0: &[f64],
        rigid: &[ConstraintId],
    ) -> Result<ElasticSolutions<'c, 'm>, BoundsError> {
        if !self.solvability().decision().is_decided() {
            return Err(BoundsError::Rank);
        }
        let free = FreeMultipliers::of(self.solvability());
        let p = free.z.ncols();
        let (mut loads, mut elements) = (Vec::new(), Vec::new());
        for id in self
            .layout()
            .constraint_ids()
            .filter(|id| !rigid.contains(id))
        {
            for (is_moment, forms) in self.load_forms(id)? {
                if self.is_unique(&forms)? {
                    continue;
                }
                let group = loads.len();
                elements.extend(forms.iter().map(|form| Element {
                    group,
                    row: along(form, &free),
                    value: form.value(lambda_0),
                }));
                loads.push(ElasticLoad {
                    reaction: id,
                    is_moment,
                });
            }
        }
        let hull = Hull::new(elements, p, free.tolerance).map_err(|e| match e {
            HullError::Unclear { group } => BoundsError::Undecided {
                reaction: self.layout().groups[loads[group].reaction.0].name.clone(),
            },
            HullError::Free { free } => BoundsError::Rigid { free },
            HullError::Many => BoundsError::Many,
        })?;
        Ok(ElasticSolutions {
            configuration: self,
            free,
            lambda_0: lambda_0.to_vec(),
            loads,
            hull,
        })
    }

    /// Returns the components of the force and of the moment of a joint along orthonormal axes:
    /// those of the joint if it has any.
    fn load_forms(&self, id: ConstraintId) -> Result<Vec<(bool, Vec<LinearForm>)>, RequestError> {
        let layout = self.layout();
        let group = &layout.groups[id.0];
        if let Some(name) = group.own_load() {
            return Ok(vec![(false, vec![self.reactions().component(id, name)?])]);
        }
        let space = group.space;
        let own = group.components();
        let of_joint = self.reactions().in_frame(id, Frame::Joint)?;
        let axes = match of_joint {
            Some(frame) => Some(frame),
            None => self.reactions().in_frame(id, Frame::Global)?,
        };
        let forms = axes.map(|frame| frame.components).unwrap_or_default();
        let of = |range: std::ops::Range<usize>| -> Vec<LinearForm> {
            if !own.iter().any(|c| range.contains(c)) {
                return Vec::new();
            }
            forms[range].iter().map(|(_, form)| form.clone()).collect()
        };
        let both = [(false, of(space.forces())), (true, of(space.torques()))];
        Ok(both
            .into_iter()
            .filter(|(_, forms)| !forms.is_empty())
            .collect())
    }

    /// Returns whether all of these components are unique.
    fn is_unique(&self, forms: &[LinearForm]) -> Result<bool, RequestError> {
        for form in forms {
            if !self.judge(form)?.verdict.is_unique() {
                return Ok(false);
            }
        }
        Ok(true)
    }
}

/// Returns ℓᵀ·Z in the coordinates of the free multipliers.
fn along(form: &LinearForm, free: &FreeMultipliers<'_>) -> Vec<f64> {
    let (image, size) = form.image(free);
    image.iter().map(|x| x * size).collect()
}

impl ElasticSolutions<'_, '_> {
    /// Returns the bounds of a number; they are equal if the number is unique.
    ///
    /// # Errors
    /// [`BoundsError::Request`], [`BoundsError::Verdict`]
    pub fn bounds(&self, form: &LinearForm) -> Result<ElasticBounds, BoundsError> {
        let verdict = self.configuration.judge(form)?.verdict;
        let value = self.configuration.value(form, &self.lambda_0);
        match verdict {
            Verdict::Unique => Ok(ElasticBounds::of(value)),
            Verdict::NotUnique => {
                let [lowest, highest] = self.hull.ends(&along(form, &self.free));
                let loads = |groups: &[usize]| groups.iter().map(|&k| self.loads[k]).collect();
                Ok(ElasticBounds {
                    lowest: value + lowest.value,
                    highest: value + highest.value,
                    at_lowest: loads(&lowest.groups),
                    at_highest: loads(&highest.groups),
                    reached: [lowest.is_reached, highest.is_reached],
                })
            }
            _ => Err(BoundsError::Verdict),
        }
    }

    /// Returns the largest magnitude of a vector with these components.
    ///
    /// # Errors
    /// [`BoundsError::Request`], [`BoundsError::Verdict`]
    pub fn largest_magnitude(&self, forms: &[LinearForm]) -> Result<f64, BoundsError> {
        let mut terms = Vec::with_capacity(forms.len());
        for form in forms {
            let value = self.configuration.value(form, &self.lambda_0);
            let along = match self.configuration.judge(form)?.verdict {
                Verdict::Unique => vec![0.0; self.free.z.ncols()],
                Verdict::NotUnique => along(form, &self.free),
                _ => return Err(BoundsError::Verdict),
            };
            terms.push((value, along));
        }
        Ok(self.hull.largest_norm(&terms))
    }

    /// Returns the number of examined sets of components, summed over independent blocks.
    #[must_use]
    pub fn sets(&self) -> u64 {
        self.hull.sets
    }
}

impl ElasticBounds {
    /// Returns the bounds of a number that is unique.
    #[must_use]
    pub fn of(value: f64) -> Self {
        Self {
            lowest: value,
            highest: value,
            at_lowest: Vec::new(),
            at_highest: Vec::new(),
            reached: [true; 2],
        }
    }

    /// Adds the bounds of a number that depends on other joints.
    #[must_use]
    pub fn plus(mut self, other: Self) -> Self {
        self.lowest += other.lowest;
        self.highest += other.highest;
        self.at_lowest.extend(other.at_lowest);
        self.at_highest.extend(other.at_highest);
        for (own, other) in self.reached.iter_mut().zip(other.reached) {
            *own &= other;
        }
        self
    }
}
