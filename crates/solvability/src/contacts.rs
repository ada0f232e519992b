//! Loads that contacts permit. The contacts are joints that only push or pull, and contacts that
//! slip if the force along them is too large.
//!
//! All solutions of the equations are `λ₀ + Z·y`. While all contacts stay closed, each one-sided
//! joint requires `N ≥ 0` for the force N with which it presses. Each contact with friction
//! requires `|S| ≤ μ·N` for the force S along it. These conditions are half spaces of y, and the
//! permitted y form a polyhedron P. The range of a number `ℓᵀ·λ` over P is given by the values of
//! two linear programs. The range is valid for joints of any stiffness, with any misfit, gap and
//! preload, because some gaps lead to each point of P. A number that is not unique may have only
//! one permitted value. Such a number is unique by the signs of the forces.
//!
//! P is empty iff weights `w ≥ 0` exist with `Z_Uᵀ·w = 0` and `wᵀ·N < 0`. By the fundamental
//! theorem of linear algebra, w then contains the rates of the gaps of a motion that all other rows
//! permit. The loads do work along this motion: the mechanism tips. See A. Schrijver, Theory of
//! Linear and Integer Programming, Wiley 1986, section 7.3 (Farkas' lemma).

mod carried;
mod conditions;
mod error;
mod grip;
mod lifts;
mod range;
mod two_sided;

use model::{ConstraintId, System};

pub use carried::{CarriedContacts, CarriedLoads, Closure};
pub use conditions::{ConditionKind, ContactCondition};
pub use error::PermittedError;
pub use grip::{GripVerdict, Holds};
pub use lifts::{Liftoff, lifted, opened};
pub use range::{PermittedEnd, PermittedRange, RangeKind};
pub use two_sided::TwoSidedContacts;

use crate::choices::{ChosenValues, Distribution, Solution};
use crate::groups::Group;
use crate::polyhedra::polyhedron::Emptiness;
use crate::questions::Questions;
use crate::value::Value;
use conditions::Cluster;

/// The loads that the contacts of a configuration permit.
pub struct PermittedReactions<'q, 'm> {
    questions: &'q Questions<'m>,
    solution: &'q Solution,
    /// Sets of parts whose contacts depend on each other.
    clusters: Vec<Cluster>,
    /// The cluster of each part, or `None` if no contact of the part has a condition.
    cluster_of: Vec<Option<usize>>,
}

/// Contacts that cannot all stay closed.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Impossible {
    /// Conditions with their weights > 0. In every solution, the weighted sum of the margins of the
    /// conditions is `sum` < 0. If all contacts are one-sided joints, the weights are the relative
    /// rates at which their gaps open in a motion along which the loads do work.
    pub weights: Vec<(ContactCondition, f64)>,
    /// The weighted sum of the margins (N), for weights whose sum is 1.
    pub sum: f64,
    /// All other one-sided joints on the bodies of these joints. These joints stay closed.
    pub closed: Vec<ConstraintId>,
}

impl Impossible {
    /// Returns whether all contacts are one-sided joints. In this case, the weights are those of a
    /// motion.
    #[must_use]
    pub fn is_opening(&self) -> bool {
        let mut kinds = self.weights.iter().map(|(c, _)| c.kind);
        kinds.all(|kind| kind == ConditionKind::Presses)
    }
}

impl<'m> Questions<'m> {
    /// Returns the loads that the contacts permit, from one solution. Returns `None` if no joint is
    /// one-sided or can slip.
    ///
    /// # Errors
    /// [`PermittedError`]
    pub fn permitted<'q>(
        &'q self,
        solution: &'q Solution,
    ) -> Result<Option<PermittedReactions<'q, 'm>>, PermittedError> {
        if !self.mechanism().layout().has_contact_limits() {
            return Ok(None);
        }
        let (clusters, cluster_of) = conditions::clusters(self, solution)?;
        Ok(Some(PermittedReactions {
            questions: self,
            solution,
            clusters,
            cluster_of,
        }))
    }

    /// Returns the conditions of contacts that a distribution violates: contacts do not permit it.
    /// The accelerations are those of `solution`.
    ///
    /// # Errors
    /// [`PermittedError`]
    pub fn violated(
        &self,
        solution: &Solution,
        distribution: &Distribution,
    ) -> Result<Vec<ContactCondition>, PermittedError> {
        // Multipliers without a finite value are refused before they are used.
        let values = distribution.multipliers.iter().map(Value::in_solution);
        let lambda = values.map(|value| value.unwrap_or(f64::NAN));
        let chosen = Solution {
            multipliers: ChosenValues::new(lambda.collect(), Vec::new()),
            ..solution.clone()
        };
        let found = self.permitted(&chosen)?;
        let clusters = found.iter().flat_map(|found| &found.clusters);
        Ok(clusters.flat_map(Cluster::violated).collect())
    }
}

impl PermittedReactions<'_, '_> {
    /// Returns the contacts that cannot all stay closed, or cannot all prevent slip. The list is
    /// empty if some distribution of the loads is permitted. If the one-sided joints cannot all
    /// stay closed, the list contains no contact with friction.
    ///
    /// # Errors
    /// [`PermittedError::Unclear`]
    pub fn impossible(&self) -> Result<Vec<Impossible>, PermittedError> {
        let mut all = Vec::new();
        for cluster in &self.clusters {
            // The conditions of the one-sided joints come first.
            let pressed = cluster.of_presses();
            let of = match pressed.emptiness()? {
                Emptiness::Empty { .. } => &pressed,
                Emptiness::Points { .. } => &cluster.permitted,
            };
            if let Emptiness::Empty { weights, depth } = of.emptiness()? {
                let of = cluster.conditions.iter().zip(weights);
                let of = of.filter(|(_, w)| **w > 0.0);
                let weights: Vec<_> = of.map(|(c, w)| (*c, *w)).collect();
                all.push(Impossible {
                    closed: self.closed(&weights),
                    weights: merged(weights),
                    sum: *depth,
                });
            }
        }
        Ok(all)
    }

    /// Returns the one-sided joints without a weight that are on the bodies of the joints with a
    /// weight.
    fn closed(&self, weights: &[(ContactCondition, f64)]) -> Vec<ConstraintId> {
        let layout = self.questions.mechanism().layout();
        let moving = |id: ConstraintId| {
            let bodies = layout.groups[id.0].bodies.iter();
            bodies.filter(|body| **body != model::BodyRef::Ground)
        };
        let opened: Vec<ConstraintId> = weights.iter().map(|(c, _)| c.joint).collect();
        let is_near = |id: &ConstraintId| {
            let mut own = moving(*id);
            own.any(|body| opened.iter().any(|other| moving(*other).any(|b| b == body)))
        };
        layout
            .constraint_ids()
            .filter(|id| layout.groups[id.0].limits.open_side.is_some())
            .filter(|id| !opened.contains(id) && is_near(id))
            .collect()
    }

    /// Returns the depth of the permitted loads (N). The depth is the largest value that the
    /// smallest margin has over all solutions. The depth is negative if no distribution is
    /// permitted, and `None` if it has no limit.
    ///
    /// # Errors
    /// [`PermittedError::Unclear`]
    pub fn depth(&self) -> Result<Option<f64>, PermittedError> {
        let mut least: Option<f64> = None;
        for cluster in &self.clusters {
            let own = match cluster.permitted.emptiness()? {
                Emptiness::Points { depth } => *depth,
                Emptiness::Empty { depth, .. } => Some(*depth),
            };
            least = match (least, own) {
                (Some(a), Some(b)) => Some(a.min(b)),
                (a, b) => a.or(b),
            };
        }
        Ok(least)
    }

    /// Returns the ranges of the numbers of a group, with their names. A group of several separate
    /// reactions has no numbers.
    ///
    /// # Errors
    /// [`PermittedError`]
    pub fn group(
        &self,
        group: &Group,
    ) -> Result<Vec<(&'static str, PermittedRange)>, PermittedError> {
        let mut names: Vec<&'static str> = Vec::new();
        let forms = self.questions.forms(group)?;
        for (_, name, _) in &forms {
            if !names.contains(name) {
                names.push(name);
            }
        }
        let of_name = |name: &'static str| {
            let own = forms.iter().filter(|(_, known, _)| *known == name);
            let own = own.map(|(k, _, form)| (*k, form));
            Ok((name, self.range(&own.collect::<Vec<_>>())?))
        };
        names.into_iter().map(of_name).collect()
    }
}

/// Adds the weights of the half spaces of one condition.
fn merged(weights: Vec<(ContactCondition, f64)>) -> Vec<(ContactCondition, f64)> {
    let mut sums: Vec<(ContactCondition, f64)> = Vec::new();
    for (condition, weight) in weights {
        match sums.iter_mut().find(|(known, _)| *known == condition) {
            Some((_, sum)) => *sum += weight,
            None => sums.push((condition, weight)),
        }
    }
    sums
}
