//! Bounds of reactions that the rigid model does not determine. The joints give way by any law in
//! the direction of the load that they carry.
//!
//! All solutions of the equations are `λ₀ + Z·y`. Every joint X gives way in the direction of its
//! force (and of its moment) with a compliance c ≥ 0. The compliance may depend on anything. Then
//! `Zᵀ·D·λ = 0` with a diagonal D ≥ 0 for orthonormal components of the wrenches. By Cramer's rule
//! and the Cauchy–Binet formula,
//!
//! y = Σ_m c^m·w_m·y_m / Σ_m c^m·w_m, w_m = Σ_{S ∈ m} det²(Z_S),
//! y_m = Σ_{S ∈ m} det²(Z_S)·y_S / w_m
//!
//! where S are sets of p components with det Z_S ≠ 0, and y_S is the solution in which the
//! components of S are zero. A monomial m collects the sets with equally many components of each
//! force and of each moment. All weights are positive, so every solution lies in the convex hull of
//! the y_m. See A. Ben-Tal and M. Teboulle, Linear Algebra Appl. 139 (1990) 165–170, and G. W.
//! Stewart, Linear Algebra Appl. 112 (1989) 189–193, for one component in each group.

mod hull;
mod of_parts;
mod separation;

#[cfg(test)]
mod tests;

use std::sync::Arc;

use model::words::whole;
use model::{ConstraintId, Frame};

pub use of_parts::ReactionBounds;

use crate::choices::{Centres, FreeMultipliers};
use crate::groups::{Configuration, LinearForm, RequestError};
use crate::limits::{CLEAR_SUPPORT, ELASTIC_SETS};
use crate::polyhedra::polyhedron::HalfSpace;
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

/// Assumptions about the joints and drives that give way.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Elasticity {
    /// Joints and drives that do not give way.
    pub rigid: Vec<ConstraintId>,
    /// A range of the compliances. Without a range, the compliances are arbitrary.
    pub within: Option<ComplianceRange>,
    /// The points about which moments give way. For joints without a point, the reference point is
    /// used.
    pub centres: Centres,
}

/// Compliances between nominal values and a multiple of them.
#[derive(Clone, Debug, PartialEq)]
pub struct ComplianceRange {
    /// The multiple, at least 1.
    pub factor: f64,
    /// Nominal compliances. The loads of joints and drives without a nominal compliance do not give
    /// way. Without this list, all loads give way equally.
    pub nominal: Option<Vec<NominalCompliance>>,
}

/// Nominal compliance of a joint or drive, equal in all directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NominalCompliance {
    /// The joint or drive.
    pub reaction: ConstraintId,
    /// Compliance along the force (m/N).
    pub force: f64,
    /// Compliance about the moment (rad/(N·m)).
    pub moment: f64,
}

impl Elasticity {
    /// Returns the assumptions about the joints and drives of a part, with the numbers that these
    /// have in the part.
    fn of_reactions(&self, own: impl Fn(ConstraintId) -> Option<ConstraintId>) -> Self {
        Self {
            rigid: self.rigid.iter().filter_map(|id| own(*id)).collect(),
            within: self.within.as_ref().map(|range| range.of_reactions(&own)),
            centres: self.centres.of_reactions(&own),
        }
    }
}

impl ComplianceRange {
    fn of_reactions(&self, own: impl Fn(ConstraintId) -> Option<ConstraintId>) -> Self {
        let of = |c: &NominalCompliance| {
            let reaction = own(c.reaction)?;
            Some(NominalCompliance { reaction, ..*c })
        };
        let nominal = self.nominal.as_ref();
        Self {
            factor: self.factor,
            nominal: nominal.map(|all| all.iter().filter_map(of).collect()),
        }
    }

    /// Returns the nominal compliance of a load, or `None` if the load does not give way.
    fn of(&self, reaction: ConstraintId, is_moment: bool) -> Option<f64> {
        let Some(nominal) = &self.nominal else {
            return Some(1.0);
        };
        let own = nominal.iter().filter(|c| c.reaction == reaction);
        // Compliances of springs in series add up.
        let sum: f64 = own
            .map(|c| if is_moment { c.moment } else { c.force })
            .sum();
        Some(sum).filter(|sum| *sum > 0.0)
    }
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
    /// The loads of the joints that give way if the number has its smallest value.
    pub at_lowest: Vec<ElasticLoad>,
    /// The loads of the joints that give way if the number has its largest value.
    pub at_highest: Vec<ElasticLoad>,
    /// Whether the smallest and the largest value are reached in the limit of some compliances. If
    /// a value is not reached, the true range may end earlier.
    pub reached: [bool; 2],
    /// Whether no compliances give a value outside of the range. If not, there are too many sets of
    /// components to examine all sets, and some compliances give the smallest and the largest
    /// value.
    pub complete: bool,
}

/// Reason why there are no bounds.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BoundsError {
    /// The rank is undecided.
    #[error("the rank is undecided")]
    Rank,
    /// It is undecided whether the number is unique.
    #[error("its verdict is undecided")]
    Verdict,
    /// It is undecided whether a component can be zero.
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
    /// Forces and moments share a load, and their compliances cannot be compared.
    #[error(
        "the force of `{force}` and the moment of `{moment}` share a load, and their compliances have different \
         units: state nominal compliances"
    )]
    Mixed {
        /// The joint or drive with the force.
        force: String,
        /// The joint or drive with the moment.
        moment: String,
    },
    /// The range of the compliances is not valid.
    #[error("compliances range from nominal values > 0 to a multiple ≥ 1 of them, not {0}")]
    Range(f64),
    /// Too many sets of components can be zero together.
    #[error(
        "more than {} sets of load components would have to be examined",
        whole(ELASTIC_SETS)
    )]
    Many,
    /// It is not clear whether one-sided joints press.
    #[error("a load is so close to the limit of a one-sided joint that its side is undecided")]
    Limits,
    /// One-sided joints open.
    #[error("one-sided joints cannot all stay closed, however stiff the joints are")]
    Opens,
    /// No finite reactions exist.
    #[error("no finite reaction exists")]
    NoFinite(Arc<NoFiniteReaction>),
    /// The request is invalid.
    #[error(transparent)]
    Request(#[from] RequestError),
}

impl From<HullError> for BoundsError {
    fn from(error: HullError) -> Self {
        match error {
            HullError::Free { free } => Self::Rigid { free },
            HullError::Limits => Self::Limits,
            HullError::Unclear { .. } | HullError::Many => Self::Many,
        }
    }
}

/// The solutions of a part for joints that give way by any law.
pub struct ElasticSolutions<'c, 'm> {
    configuration: &'c Configuration<'m>,
    /// Whether verdicts state which numbers are unique. Otherwise all numbers have a range.
    is_judged: bool,
    free: FreeMultipliers<'c>,
    lambda_0: Vec<f64>,
    loads: Vec<ElasticLoad>,
    hull: Hull,
    /// The forces with which one-sided joints press. These forces are not negative.
    presses: Vec<HalfSpace>,
    /// Size of the loads (N).
    size: f64,
}

impl<'m> Configuration<'m> {
    /// Returns the solutions for joints that give way by any law, from one solution λ₀.
    ///
    /// # Errors
    /// [`BoundsError`]
    pub fn elastic_solutions<'c>(
        &'c self,
        lambda_0: &[f64],
        elasticity: &Elasticity,
    ) -> Result<ElasticSolutions<'c, 'm>, BoundsError> {
        if !self.solvability().decision().is_decided() {
            return Err(BoundsError::Rank);
        }
        self.elastic_solutions_of(lambda_0, elasticity, None)
    }

    /// Returns the solutions of the same mechanism with displaced data, from a solution λ₀ of the
    /// displaced mechanism. The self-stresses are those of this configuration with the data as
    /// described. Displaced data weakly couple all loads, and these couplings have no effect. No
    /// verdicts are used.
    ///
    /// # Errors
    /// [`BoundsError`]
    pub fn elastic_solutions_displaced<'c>(
        &'c self,
        displaced: (&'c Configuration<'m>, &Centres),
        lambda_0: &[f64],
        elasticity: &Elasticity,
    ) -> Result<ElasticSolutions<'c, 'm>, BoundsError> {
        self.elastic_solutions_of(lambda_0, elasticity, Some(displaced))
    }

    fn elastic_solutions_of<'c>(
        &'c self,
        lambda_0: &[f64],
        elasticity: &Elasticity,
        displaced: Option<(&'c Configuration<'m>, &Centres)>,
    ) -> Result<ElasticSolutions<'c, 'm>, BoundsError> {
        let free = FreeMultipliers::of(self.solvability());
        let p = free.z.ncols();
        let (mut loads, mut elements) = (Vec::new(), Vec::new());
        let (mut nominal, mut units) = (Vec::new(), Vec::new());
        let gives_way = |id: &ConstraintId| !elasticity.rigid.contains(id);
        for id in self.layout().constraint_ids().filter(gives_way) {
            let own = self.load_forms(id, &elasticity.centres)?;
            let other = displaced.map(|(at, centres)| at.load_forms(id, centres));
            let other = other.transpose()?;
            for (k, (is_moment, unit, forms)) in own.iter().enumerate() {
                let (is_moment, unit) = (*is_moment, *unit);
                let compliance = match &elasticity.within {
                    Some(range) => range.of(id, unit == "N·m"),
                    None => Some(1.0),
                };
                let Some(compliance) = compliance else {
                    continue;
                };
                let load = ElasticLoad {
                    reaction: id,
                    is_moment,
                };
                if are_unique(self, forms)? {
                    continue;
                }
                nominal.push(compliance);
                units.push(unit);
                let group = loads.len();
                let valued = other.as_ref().map_or(forms, |other| &other[k].2);
                let element = |(form, valued): (&LinearForm, &LinearForm)| Element {
                    group,
                    row: along(form, &free),
                    value: valued.value(lambda_0),
                };
                elements.extend(forms.iter().zip(valued).map(element));
                loads.push(load);
            }
        }
        let mut hull = Hull::new(elements, p, free.tolerance).map_err(|e| match e {
            HullError::Unclear { group } => BoundsError::Undecided {
                reaction: self.layout().groups[loads[group].reaction.0].name.clone(),
            },
            other => other.into(),
        })?;
        if let Some(range) = &elasticity.within {
            if range.nominal.is_none() {
                let name = |load: usize| {
                    let ElasticLoad { reaction, .. } = loads[load];
                    self.layout().groups[reaction.0].name.clone()
                };
                let mixed = hull.loads().find_map(|own| {
                    let of = |unit: &str| own.iter().copied().find(|load| units[*load] == unit);
                    Some([of("N")?, of("N·m")?])
                });
                if let Some([force, moment]) = mixed.map(|pair| pair.map(name)) {
                    return Err(BoundsError::Mixed { force, moment });
                }
            }
            if !(range.factor >= 1.0 && range.factor.is_finite()) {
                return Err(BoundsError::Range(range.factor));
            }
            if hull.is_sampled() {
                return Err(BoundsError::Many);
            }
            let factor = range.factor;
            hull.restrict(&hull::Range {
                factor,
                nominal: &nominal,
            });
        }
        let (mut presses, mut size) = (Vec::new(), linalg::kernels::max_abs(lambda_0));
        for id in self.layout().constraint_ids() {
            let Some(own) = self.press(id)? else {
                continue;
            };
            let other = displaced.map(|(at, _)| at.press(id)).transpose()?.flatten();
            let value = other.as_ref().unwrap_or(&own).value(lambda_0);
            size = size.max(value.abs());
            let row = match self.judge(&own)?.verdict {
                Verdict::Unique => vec![0.0; p],
                _ => along(&own, &free),
            };
            presses.push(HalfSpace { row, value });
        }
        Ok(ElasticSolutions {
            presses,
            size: if size > 0.0 { size } else { 1.0 },
            configuration: displaced.map_or(self, |(at, _)| at),
            is_judged: displaced.is_none(),
            free,
            lambda_0: lambda_0.to_vec(),
            loads,
            hull,
        })
    }

    /// Returns the components of the force and of the moment of a joint along orthonormal axes. The
    /// axes are those of the joint, if it has axes. Each item states whether the components belong
    /// to a moment, and their unit.
    fn load_forms(
        &self,
        id: ConstraintId,
        centres: &Centres,
    ) -> Result<Vec<LoadForms>, RequestError> {
        let layout = self.layout();
        let group = &layout.groups[id.0];
        if let Some(name) = group.own_load() {
            let forms = vec![self.reactions().component(id, name)?];
            return Ok(vec![(false, layout.load_unit(id, name), forms)]);
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
        let moments = match centres.of(id) {
            Some(about) if !of(space.torques()).is_empty() => {
                self.reactions().moments(id, about)?
            }
            _ => of(space.torques()),
        };
        let both = [(false, "N", of(space.forces())), (true, "N·m", moments)];
        Ok(both
            .into_iter()
            .filter(|(.., forms)| !forms.is_empty())
            .collect())
    }
}

/// Returns whether all of these components are unique.
fn are_unique(
    configuration: &Configuration<'_>,
    forms: &[LinearForm],
) -> Result<bool, RequestError> {
    for form in forms {
        if !configuration.judge(form)?.verdict.is_unique() {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Components of a load, with a flag for moments, and the unit of the components.
type LoadForms = (bool, &'static str, Vec<LinearForm>);

/// Returns ℓᵀ·Z in the coordinates of the free multipliers.
fn along(form: &LinearForm, free: &FreeMultipliers<'_>) -> Vec<f64> {
    let (image, size) = form.image(free);
    image.iter().map(|x| x * size).collect()
}

impl ElasticSolutions<'_, '_> {
    /// Returns the bounds of a number. The two bounds are equal if the number is unique.
    ///
    /// # Errors
    /// [`BoundsError::Request`], [`BoundsError::Verdict`]
    pub fn bounds(&self, form: &LinearForm) -> Result<ElasticBounds, BoundsError> {
        let value = self.configuration.value(form, &self.lambda_0);
        match self.verdict(form)? {
            Verdict::Unique => Ok(ElasticBounds::of(value)),
            Verdict::NotUnique => {
                let along = along(form, &self.free);
                let [lowest, highest] = self.hull.ends(&along)?;
                let loads = |groups: &[usize]| groups.iter().map(|&k| self.loads[k]).collect();
                let complete = lowest.is_bound && highest.is_bound;
                let is_reached = lowest.is_reached && highest.is_reached;
                if !(complete || is_reached) {
                    return Err(BoundsError::Many);
                }
                let mut bounds = ElasticBounds {
                    lowest: value + lowest.value,
                    highest: value + highest.value,
                    at_lowest: loads(&lowest.groups),
                    at_highest: loads(&highest.groups),
                    reached: [lowest.is_reached, highest.is_reached],
                    complete,
                };
                if complete && !self.presses.is_empty() {
                    self.press_on_all(&along, value, &mut bounds)?;
                }
                Ok(bounds)
            }
            _ => Err(BoundsError::Verdict),
        }
    }

    /// Restricts bounds to loads for which all one-sided joints press.
    fn press_on_all(
        &self,
        along: &[f64],
        value: f64,
        bounds: &mut ElasticBounds,
    ) -> Result<(), BoundsError> {
        let found = self.hull.ends_within(along, &self.presses, self.size)?;
        let [lowest, highest] = found.ok_or(BoundsError::Opens)?.map(|end| value + end);
        let rounding = CLEAR_SUPPORT * self.size;
        // With one coordinate, compliances reach every value between two values that they reach.
        let is_line = self.free.z.ncols() == 1 && bounds.reached == [true; 2];
        if lowest > bounds.lowest + rounding {
            (bounds.lowest, bounds.reached[0]) = (lowest, is_line);
            bounds.at_lowest.clear();
        }
        if highest < bounds.highest - rounding {
            (bounds.highest, bounds.reached[1]) = (highest, is_line);
            bounds.at_highest.clear();
        }
        Ok(())
    }

    /// Returns the largest magnitude of a vector with these components.
    ///
    /// # Errors
    /// [`BoundsError::Request`], [`BoundsError::Verdict`]
    pub fn largest_magnitude(&self, forms: &[LinearForm]) -> Result<f64, BoundsError> {
        let mut terms = Vec::with_capacity(forms.len());
        for form in forms {
            let value = self.configuration.value(form, &self.lambda_0);
            let along = match self.verdict(form)? {
                Verdict::Unique => vec![0.0; self.free.z.ncols()],
                Verdict::NotUnique => along(form, &self.free),
                _ => return Err(BoundsError::Verdict),
            };
            terms.push((value, along));
        }
        let largest = self.hull.largest_norm(&terms)?;
        if self.presses.is_empty() {
            return Ok(largest);
        }
        let bounds = forms.iter().map(|form| self.bounds(form));
        let bounds = bounds.collect::<Result<Vec<_>, _>>()?;
        let ends = bounds.iter().map(|b| b.lowest.abs().max(b.highest.abs()));
        Ok(largest.min(linalg::kernels::norm(&ends.collect::<Vec<_>>())))
    }

    fn verdict(&self, form: &LinearForm) -> Result<Verdict, RequestError> {
        if self.is_judged {
            Ok(self.configuration.judge(form)?.verdict)
        } else {
            Ok(Verdict::NotUnique)
        }
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
            complete: true,
        }
    }

    /// Returns the sum of the bounds of two numbers that depend on different joints.
    #[must_use]
    pub fn plus(mut self, other: Self) -> Self {
        self.lowest += other.lowest;
        self.highest += other.highest;
        self.at_lowest.extend(other.at_lowest);
        self.at_highest.extend(other.at_highest);
        for (own, other) in self.reached.iter_mut().zip(other.reached) {
            *own &= other;
        }
        self.complete &= other.complete;
        self
    }
}
