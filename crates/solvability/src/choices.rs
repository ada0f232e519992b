//! Choices of one of the solutions `λ₀ + Z·y`, if the model does not determine the solution. A
//! choice does not give *the* reaction. Every number that is not unique is returned with the name
//! of its choice and cannot be read without this name.

mod carried;
mod chosen;
mod equations;
mod error;
mod free;
mod label;
mod minimise;
mod multipliers;

#[cfg(test)]
mod tests;

use std::sync::Arc;

use crate::limits::VALUE_ROUNDINGS;
use crate::pose::dimensionless;
use model::{ConstraintId, Layout, RowRanges};
use rank::{KeptRowsError, RankStatus};

pub use carried::{CarriedChoices, CarriedSolution, NamedChoice};
pub use chosen::ChosenValues;
pub(crate) use equations::solution_under;
pub use equations::{Equations, RowTerms, Solution, solution};
pub use error::ChoiceError;
pub use minimise::minimise;

use crate::groups::{Configuration, LinearForm, RequestError, check};
use crate::parts::{Extent, ListedRows};
use crate::value::{Label, NoFiniteReaction, Value};
use crate::verdict::Verdict;
use free::Choosing;
pub(crate) use label::label;
pub(crate) use multipliers::FreeMultipliers;

/// A rule that chooses one of the solutions.
#[derive(Clone, Debug, PartialEq)]
pub enum Choice {
    /// Minimises `Σ (force·F)² + (torque·T)²` over all joints and drives, with the wrench on the
    /// first body at the reference point of the joint.
    MinimumNorm(NormWeights),
    /// The forces that elastic supports with these compliances would carry, in the limit of stiff
    /// supports. The choice minimises the complementary energy
    /// `½·Σ (Σ along_k·F_k² + rotation·T²) − Σ (d·F + φ·T)`. Here T² is the square of the torque
    /// vector, and d and φ are the misfits. Joints and drives without a compliance are rigid.
    Compliance(ElasticSupports),
    /// Sets the reactions in these rows (from 0) to zero.
    Elimination(Vec<usize>),
}

impl Choice {
    /// Returns the part of the choice that belongs to a part of the mechanism. The result contains
    /// the joints, drives and rows of the part, with their numbers in the part.
    #[must_use]
    pub fn share(&self, extent: &Extent) -> Self {
        self.share_of(extent, &self.listed_rows())
    }

    /// Returns the rows that the choice lists.
    pub(crate) fn listed_rows(&self) -> ListedRows<'_> {
        ListedRows::new(self.eliminated())
    }

    /// Returns the rows (from 0) whose multipliers are set to zero.
    #[must_use]
    pub fn eliminated(&self) -> &[usize] {
        match self {
            Self::Elimination(rows) => rows,
            Self::MinimumNorm(_) | Self::Compliance(_) => &[],
        }
    }

    /// Works like [`Self::share`], for many parts.
    pub(crate) fn share_of(&self, extent: &Extent, listed: &ListedRows<'_>) -> Self {
        match self {
            Self::MinimumNorm(weights) => Self::MinimumNorm(*weights),
            Self::Compliance(supports) => {
                let own = |id: ConstraintId| extent.own_group(id.0).map(ConstraintId);
                Self::Compliance(supports.of_reactions(own))
            }
            Self::Elimination(_) => Self::Elimination(extent.own_rows(listed)),
        }
    }
}

/// Weights of forces and torques in a norm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormWeights {
    /// Weight of forces (1/N).
    pub force: f64,
    /// Weight of torques (1/(N·m)).
    pub torque: f64,
}

impl NormWeights {
    /// Norm of the values in N and N·m.
    pub const NEWTON_METRE: Self = Self {
        force: 1.0,
        torque: 1.0,
    };

    /// Norm of the values in N and N·mm.
    pub const NEWTON_MILLIMETRE: Self = Self {
        force: 1.0,
        torque: 1e3,
    };

    /// Returns weights that divide torques by this arm (m), so that torques can be compared with
    /// forces.
    #[must_use]
    pub fn with_arm(length: f64) -> Self {
        Self {
            force: 1.0,
            torque: length.recip(),
        }
    }
}

/// Joints and drives that give way, and joints and drives that do not fit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ElasticSupports {
    /// Compliances; other joints and drives are rigid.
    pub compliances: Vec<Compliance>,
    /// Misfits; other joints and drives fit exactly.
    pub misfits: Vec<Misfit>,
    /// The points about which moments give way. For joints without a point, the reference point is
    /// used.
    pub centres: Centres,
}

/// Points about which the moments of joints give way, in global coordinates at one configuration
/// (m).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Centres(pub Vec<(ConstraintId, [f64; 3])>);

impl Centres {
    /// Returns the point of a joint, or `None` if the reference point is used.
    #[must_use]
    pub fn of(&self, id: ConstraintId) -> Option<[f64; 3]> {
        let own = self.0.iter().find(|(known, _)| *known == id);
        own.map(|(_, point)| *point)
    }

    /// Returns the points of the joints of a part, with their numbers in the part.
    pub(crate) fn of_reactions(&self, own: &impl Fn(ConstraintId) -> Option<ConstraintId>) -> Self {
        let of = |(id, point): &(ConstraintId, [f64; 3])| Some((own(*id)?, *point));
        Self(self.0.iter().filter_map(of).collect())
    }
}

impl From<Vec<Compliance>> for ElasticSupports {
    fn from(compliances: Vec<Compliance>) -> Self {
        Self {
            compliances,
            ..Self::default()
        }
    }
}

impl ElasticSupports {
    /// Returns the joints and drives with a compliance or a misfit.
    pub(crate) fn listed(&self) -> impl Iterator<Item = ConstraintId> + '_ {
        let misfits = self.misfits.iter().map(|m| m.reaction);
        self.compliances.iter().map(|c| c.reaction).chain(misfits)
    }

    /// Returns the share of the joints and drives of a part, with their numbers in the part.
    fn of_reactions(&self, own: impl Fn(ConstraintId) -> Option<ConstraintId>) -> Self {
        let compliance = |c: &Compliance| {
            let reaction = own(c.reaction)?;
            Some(Compliance { reaction, ..*c })
        };
        let misfit = |m: &Misfit| {
            let reaction = own(m.reaction)?;
            Some(Misfit { reaction, ..*m })
        };
        Self {
            compliances: self.compliances.iter().filter_map(compliance).collect(),
            misfits: self.misfits.iter().filter_map(misfit).collect(),
            centres: self.centres.of_reactions(&own),
        }
    }
}

/// Misfit of a joint or drive without loads. The misfit is the displacement of the second member of
/// the joint, or of the ground, from the position at which the joint fits, in global components.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Misfit {
    /// The joint or drive.
    pub reaction: ConstraintId,
    /// Displacement along x, y and z at the reference point (m).
    pub along: [f64; 3],
    /// Rotation about x, y and z (rad); in the plane only about z.
    pub rotation: [f64; 3],
}

/// Compliance of a joint or drive, in global components at its reference point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compliance {
    /// The joint or drive.
    pub reaction: ConstraintId,
    /// Compliance along x, y and z (m/N); in the plane no force acts along z.
    pub along: [f64; 3],
    /// Rotational compliance (rad/(N·m)), in space about every axis.
    pub rotation: f64,
}

/// A solution in which each number is marked as unique or as chosen.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Distribution {
    /// Name of the choice.
    pub label: Label,
    /// Reactions of joints and drives in the order of their rows.
    pub reactions: Vec<ReactionValues>,
    /// The multiplier of each row.
    pub multipliers: Vec<Value>,
    lambda_0: Vec<f64>,
    lambda: Vec<f64>,
    no_finite: Vec<Arc<NoFiniteReaction>>,
}

/// A reaction on the first body, at the reference point of the joint.
#[derive(Clone, Debug)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ReactionValues {
    /// The joint or drive.
    pub id: ConstraintId,
    /// Name of the joint or drive.
    pub name: String,
    /// Components (N, N·m) that are not identically zero, with their names. The list includes the
    /// named component, as in [`crate::ReactionVerdict`].
    pub components: Vec<(&'static str, Value)>,
}

impl Distribution {
    /// Returns a number of this solution, defined by a linear form of the multipliers.
    ///
    /// # Errors
    /// [`RequestError::Length`]: the form belongs to another mechanism.
    pub fn value(
        &self,
        configuration: &Configuration,
        form: &LinearForm,
    ) -> Result<Value, RequestError> {
        self.value_in(&Extent::Whole, configuration, form)
    }

    /// Returns a number of a part. A linear form of the multipliers of the part defines the number.
    pub(crate) fn value_in(
        &self,
        extent: &Extent,
        configuration: &Configuration,
        form: &LinearForm,
    ) -> Result<Value, RequestError> {
        let lambda = extent.of_rows(&self.lambda);
        check("multipliers", &lambda, form.coefficients().len())?;
        let verdict = configuration.judge(form)?.verdict;
        if let Some(why) = not_finite(&self.no_finite, extent, form) {
            return Ok(Value::not_finite(verdict, why));
        }
        // For every choice, a unique number is computed from λ₀, the most accurate solution.
        let value = if verdict.is_unique() {
            configuration.value(form, &extent.of_rows(&self.lambda_0))
        } else {
            configuration.value(form, &lambda)
        };
        Ok(Value::new(value, verdict, Some(&self.label)))
    }

    /// Returns the solution without the values of reaction components that are not finite.
    pub(crate) fn without(mut self, no_finite: &[Arc<NoFiniteReaction>]) -> Self {
        let remove = |value: &mut Value, why: &Arc<NoFiniteReaction>| {
            *value = Value::not_finite(value.verdict().clone(), Arc::clone(why));
        };
        for why in no_finite {
            for id in &why.reactions {
                let components = self.reactions[id.0].components.iter_mut();
                components.for_each(|(_, value)| remove(value, why));
            }
            for &row in &why.rows {
                remove(&mut self.multipliers[row], why);
            }
        }
        self.no_finite = no_finite.to_vec();
        self
    }

    /// Assembles one solution of the whole mechanism from the solutions of its parts. `reactions`
    /// and `rows` are the numbers of joints and of rows.
    pub(crate) fn of_parts(
        label: Label,
        lambda_0: &[f64],
        reactions: usize,
        parts: Vec<(&Extent, Self)>,
    ) -> Self {
        let rows = lambda_0.len();
        let mut whole = Self {
            label,
            reactions: Vec::with_capacity(reactions),
            multipliers: vec![Value::unique(0.0); rows],
            lambda_0: lambda_0.to_vec(),
            lambda: vec![0.0; rows],
            no_finite: Vec::new(),
        };
        for (extent, part) in parts {
            let own = part.multipliers.into_iter().zip(part.lambda);
            for (k, (value, lambda)) in own.enumerate() {
                whole.multipliers[extent.row(k)] = value;
                whole.lambda[extent.row(k)] = lambda;
            }
            whole.reactions.extend(part.reactions.into_iter().map(|r| {
                let id = ConstraintId(extent.group(r.id.0));
                ReactionValues { id, ..r }
            }));
        }
        whole.reactions.sort_unstable_by_key(|r| r.id.0);
        whole
    }
}

/// Returns the reason why a linear form has no value, if the form uses a row whose multiplier is
/// not finite. The form belongs to the part `extent`.
pub(crate) fn not_finite(
    no_finite: &[Arc<NoFiniteReaction>],
    extent: &Extent,
    form: &LinearForm,
) -> Option<Arc<NoFiniteReaction>> {
    let is_in = |why: &&Arc<NoFiniteReaction>| {
        let coefficients = form.coefficients().iter().enumerate();
        let mut rows = coefficients.filter(|(_, x)| **x != 0.0);
        rows.any(|(own, _)| why.rows.binary_search(&extent.row(own)).is_ok())
    };
    no_finite.iter().find(is_in).map(Arc::clone)
}

/// Returns the error for rows whose reactions cannot be zero.
pub(crate) fn rows_refused(
    layout: &Layout,
    rows: &[usize],
    is_unique: impl Fn(usize) -> bool,
    source: KeptRowsError,
) -> ChoiceError {
    let known = rows.iter().copied().filter(|&i| i < layout.rows());
    let label = |i: usize| layout.labels[i].clone();
    ChoiceError::Rows {
        rows: known.clone().map(label).collect(),
        unique: known.filter(|&i| is_unique(i)).map(label).collect(),
        source,
    }
}

impl Configuration<'_> {
    /// Returns the solution that a choice selects, starting from one solution λ₀ as returned by
    /// [`Equations::multipliers`].
    ///
    /// # Errors
    /// - [`ChoiceError::Undecided`]: the rank is undecided.
    /// - [`ChoiceError::Rows`]: these rows cannot be eliminated.
    /// - [`ChoiceError::Indeterminate`], [`ChoiceError::Hidden`]: the choice does not determine the
    ///   solution.
    /// - [`ChoiceError::Weight`], [`ChoiceError::NormWeight`], [`ChoiceError::Request`]: invalid
    ///   numbers.
    pub fn distribute(
        &self,
        lambda_0: &[f64],
        choice: &Choice,
    ) -> Result<Distribution, ChoiceError> {
        let rigid = match choice {
            Choice::Compliance(supports) => self.rigid(&supports.compliances),
            _ => Vec::new(),
        };
        self.distribute_as(lambda_0, choice, label(self.layout(), choice, &rigid))
    }

    /// Works like [`Self::distribute`], and gives the distribution this label.
    pub(crate) fn distribute_as(
        &self,
        lambda_0: &[f64],
        choice: &Choice,
        label: Label,
    ) -> Result<Distribution, ChoiceError> {
        let layout = self.layout();
        check("multipliers", lambda_0, layout.rows())?;
        if let RankStatus::Undecided(doubt) = self.solvability.decision().status {
            return Err(ChoiceError::Undecided(doubt));
        }
        let lambda = match choice {
            Choice::MinimumNorm(weights) => self.least_norm(lambda_0, *weights)?,
            Choice::Compliance(supports) => self.choosing().elastic(lambda_0, supports)?,
            Choice::Elimination(rows) => self.eliminated(lambda_0, rows)?,
        };
        let mut distribution = Distribution {
            label,
            reactions: Vec::new(),
            multipliers: Vec::new(),
            lambda_0: lambda_0.to_vec(),
            lambda,
            no_finite: Vec::new(),
        };
        for (k, group) in layout.groups.iter().enumerate() {
            let id = ConstraintId(k);
            let mut components = Vec::new();
            for name in group.component_names() {
                let form = self.reactions.component(id, name)?;
                components.push((name, distribution.value(self, &form)?));
            }
            distribution.reactions.push(ReactionValues {
                id,
                name: group.name.clone(),
                components,
            });
        }
        for row in 0..layout.rows() {
            let mut form = LinearForm::zero(layout.rows());
            form.add(&[(row, 1.0)])?;
            let value = distribution.value(self, &form)?;
            distribution.multipliers.push(value);
        }
        Ok(distribution)
    }

    /// Returns the value of a linear form of the multipliers. The result is zero if the value is
    /// below the rounding error of the multipliers.
    ///
    /// # Panics
    /// The function panics if the number of multipliers differs from the number of rows.
    #[must_use]
    pub fn value(&self, form: &LinearForm, lambda: &[f64]) -> f64 {
        let value = form.value(lambda);
        let scaling = &self.solvability.decision().scaling;
        let equal = |(i, l): (usize, &f64)| (l / scaling.row_factor(i)).abs();
        let largest = lambda.iter().enumerate().map(equal).fold(0.0, f64::max);
        let size = form.size(|i| scaling.row_factor(i));
        if value.abs() <= VALUE_ROUNDINGS * f64::EPSILON * size * largest {
            0.0
        } else {
            value
        }
    }

    /// Returns the λ of least norm with these weights among all solutions `λ₀ + Z·y`.
    ///
    /// # Errors
    /// - [`ChoiceError::Hidden`]: some free direction does not change the wrenches on the first
    ///   bodies.
    /// - [`ChoiceError::NormWeight`], [`ChoiceError::Request`]: invalid numbers.
    pub fn least_norm(&self, lambda_0: &[f64], w: NormWeights) -> Result<Vec<f64>, ChoiceError> {
        self.choosing().least_norm(lambda_0, w)
    }

    /// Returns all solutions at this configuration.
    fn choosing(&self) -> Choosing<'_> {
        let b_x = |rows: &RowRanges| Ok(self.solvability.b_x(rows.clone())?);
        Choosing {
            reactions: &self.reactions,
            free: FreeMultipliers::of(&self.solvability),
            b_x: Box::new(b_x),
        }
    }

    /// Returns the solution that is exactly zero in these rows (from 0).
    ///
    /// # Errors
    /// [`ChoiceError::Rows`]: the other rows are dependent, or their number is below the rank.
    pub fn eliminated(&self, lambda_0: &[f64], rows: &[usize]) -> Result<Vec<f64>, ChoiceError> {
        let c = dimensionless(
            &self.reactions.mechanism,
            &self.reactions.s,
            self.reactions.size,
        );
        rank::with_dropped(self.solvability.decision(), &c, rows)
            .map_err(|source| self.refused(rows, source))?;
        Ok(self.eliminated_unchecked(lambda_0, rows))
    }

    /// Works like [`Self::eliminated`], without a check. The caller must ensure that the other rows
    /// are independent and that their number is the rank.
    #[must_use]
    pub fn eliminated_unchecked(&self, lambda_0: &[f64], rows: &[usize]) -> Vec<f64> {
        FreeMultipliers::of(&self.solvability).eliminated(lambda_0, rows)
    }

    fn refused(&self, rows: &[usize], source: KeptRowsError) -> ChoiceError {
        let is_unique =
            |i: usize| matches!(self.solvability.row(i), Ok(row) if row.verdict.is_unique());
        rows_refused(self.layout(), rows, is_unique, source)
    }

    /// Returns the joints and drives that share loads with other joints but are not listed. These
    /// joints and drives count as rigid.
    pub(crate) fn rigid(&self, listed: &[Compliance]) -> Vec<ConstraintId> {
        let groups = &self.layout().groups;
        let shares = |id: &ConstraintId| {
            let judged = self.solvability.group(groups[id.0].rows.clone());
            matches!(judged, Ok(judged) if judged.verdict == Verdict::NotUnique)
        };
        let ids = self.layout().constraint_ids();
        ids.filter(|id| listed.iter().all(|j| j.reaction != *id) && shares(id))
            .collect()
    }
}
