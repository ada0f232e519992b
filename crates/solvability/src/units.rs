//! Distinguishes unique numbers from chosen ones by a change of units. A least norm adds newtons to
//! newton metres, so it depends on the units of the model; a number determined by the model does
//! not. The distribution is computed again in other units, and each number is converted back and
//! compared.
//!
//! If only forces are coupled, millimetres change nothing; so each joint in turn also gets units of
//! its own. If no load acts, every least norm is zero; so the comparison is repeated under a load
//! on all coordinates that has no symmetry. This test does not use Z or its tolerances, so it
//! checks the verdicts independently.

mod rewrite;

use crate::limits::{OF_ONE_JOINT, UNIT_ROUNDING};
use model::codes::Code;
use model::{ColumnKind, ConstraintId, Frame, Mechanism, SpaceKind};
use rank::{RankDecision, RankError};

pub use rewrite::{Dimension, Units};

use crate::choices::{ChoiceError, ChosenValues, Equations, RowTerms, minimise};
use crate::groups::{Configuration, LinearForm, RequestError, check_finite};
use crate::matrices::Solvability;
use rewrite::Rewriting;

/// Result of a change of units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum Nature {
    /// The same in all units, to rounding.
    Fact,
    /// It depends on the units.
    Choice,
}

/// A number under a change of units.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct UnitCheck {
    /// The joint or drive.
    pub id: ConstraintId,
    /// The frame.
    pub frame: Frame,
    /// The component in this frame, as index of [`SpaceKind::components_in`]; their number for the
    /// named component of a definition, which is listed with the global frame where force and
    /// torque may not contain it.
    pub component: usize,
    /// Its name.
    pub name: &'static str,
    /// Its value in the least norm of N and N·m.
    pub value: f64,
    /// Its largest change, relative to the largest force or torque of the whole mechanism.
    pub change: f64,
    /// Whether the number is unique or chosen.
    pub nature: Nature,
}

/// Reason why the numbers cannot be compared.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum UnitError {
    /// There is no distribution to compare.
    #[error(transparent)]
    Choice(#[from] ChoiceError),
    /// An argument is invalid.
    #[error(transparent)]
    Request(#[from] RequestError),
    /// The matrix cannot be analysed in other units.
    #[error(transparent)]
    Rank(#[from] RankError),
    /// The rank depends on the units, so no verdict is reliable.
    #[error("the rank was decided as {rank}, but reads {other} where lengths are multiplied by {}, masses by {}, times by {}",
        units.length, units.mass, units.time)]
    RankChanges {
        /// Rank in the original units.
        rank: usize,
        /// Rank in other units.
        other: usize,
        /// The other units.
        units: Units,
    },
    /// Rows are redundant within a stated tolerance only.
    #[error(
        "rows are redundant within the stated tolerance only, and numbers that are unique are so within it, not to rounding"
    )]
    WithinTolerance,
}

impl UnitError {
    /// Its code; see [`model::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::Choice(e) => e.code(),
            Self::Request(e) => e.code(),
            Self::Rank { .. } | Self::RankChanges { .. } | Self::WithinTolerance => {
                const { Code::new(313) }
            }
        }
    }
}

/// Compares the components of all reactions in all frames, at a state whose rank has been decided:
/// which of them are unique, and which depend on the choice made by a least norm. The rank is read
/// again from what the entries of C are known to; within a stated tolerance it is that of the
/// decision. Torques are listed with the global frame.
///
/// # Errors
/// - [`UnitError::Choice`]: there is no least norm.
/// - [`UnitError::RankChanges`]: no verdict is reliable.
/// - [`UnitError::WithinTolerance`]: rows are redundant within a stated tolerance only.
/// - [`UnitError::Request`], [`UnitError::Rank`]: t, q or v do not fit the mechanism or are not
///   finite.
pub fn check_units(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    v: &[f64],
    decision: &RankDecision,
) -> Result<Vec<UnitCheck>, UnitError> {
    let configuration = Configuration::new(mechanism, t, q, decision)?;
    check_equations(&configuration, &Equations::of(mechanism, t, q, v)?)
}

/// Like [`check_units`], with the equations of the configuration.
pub(crate) fn check_equations(
    configuration: &Configuration<'_>,
    real: &Equations,
) -> Result<Vec<UnitCheck>, UnitError> {
    if configuration.solvability.decision().is_within_tolerance() {
        return Err(UnitError::WithinTolerance);
    }
    let numbers = ComparedNumbers::of(configuration)?;
    let mut checks = numbers.checks.clone();
    let decision = configuration.solvability.decision();
    if !configuration.reactions.mechanism.has_tolerances() {
        real.multipliers(decision)?;
    }
    if configuration.solvability.null_space().ncols() == 0 {
        // Starts from one solution of the equations.
        let lambda = real.solution_of_kept(&decision.into())?.multipliers;
        for (check, form) in checks.iter_mut().zip(&numbers.forms) {
            check.value = form.value(lambda.as_chosen());
        }
        return Ok(checks);
    }
    let in_si = numbers.rewritten(real, Units::SI)?;
    let others = [Units::MILLIMETRE, Units::GRAM, Units::MILLISECOND]
        .map(|units| numbers.rewritten(real, units))
        .into_iter()
        .collect::<Result<Vec<_>, _>>()?;
    for (is_real, equations) in [(true, real), (false, &numbers.probing_load(real))] {
        let lambda_0 = in_si.multipliers(equations)?;
        let lambda_0 = lambda_0.as_chosen();
        let reference = numbers.least(&in_si, lambda_0, None)?;
        let scale = numbers.scale(equations, &reference);
        let mut compare = |other: &[f64]| {
            for (k, check) in checks.iter_mut().enumerate() {
                let unit = numbers.unit(check, scale);
                check.change = check.change.max((other[k] - reference[k]).abs() / unit);
            }
        };
        for other in &others {
            let own = other.multipliers(equations)?;
            compare(&numbers.least(other, own.as_chosen(), None)?);
        }
        for id in configuration.layout().constraint_ids() {
            compare(&numbers.least(&in_si, lambda_0, Some(id))?);
        }
        if is_real {
            for (check, value) in checks.iter_mut().zip(reference) {
                check.value = value;
            }
        }
    }
    for check in &mut checks {
        check.nature = if check.change <= UNIT_ROUNDING {
            Nature::Fact
        } else {
            Nature::Choice
        };
    }
    Ok(checks)
}

/// C in other units, with its rank decided again.
struct Rewritten {
    units: Units,
    rewriting: Rewriting,
    solvability: Solvability,
}

impl Rewritten {
    /// One solution in these units; the given equations are in SI units.
    fn multipliers(&self, equations: &Equations) -> Result<ChosenValues<f64>, ChoiceError> {
        let equations = self.rewriting.equations(equations);
        let solution = equations.solution_of_kept(&self.solvability.decision().into())?;
        Ok(solution.multipliers)
    }
}

/// The numbers that are compared, and the wrenches whose norm is minimised.
struct ComparedNumbers<'a> {
    configuration: &'a Configuration<'a>,
    checks: Vec<UnitCheck>,
    /// The linear form of each check.
    forms: Vec<LinearForm>,
    wrenches: Vec<(ConstraintId, Dimension, LinearForm)>,
}

impl<'a> ComparedNumbers<'a> {
    fn of(configuration: &'a Configuration<'a>) -> Result<Self, RequestError> {
        let (mut checks, mut forms, mut wrenches) = (Vec::new(), Vec::new(), Vec::new());
        let layout = configuration.layout();
        for (k, group) in layout.groups.iter().enumerate() {
            let id = ConstraintId(k);
            for component in group.components() {
                let name = layout.space.components()[component];
                let form = configuration.reactions.component(id, name)?;
                wrenches.push((id, dimension(layout.space, component), form));
            }
            for frame in Frame::ALL {
                let found = configuration.reactions.in_frame(id, frame)?;
                let forces_only = frame != Frame::Global;
                let mut components = found.map_or(Vec::new(), |f| f.components);
                if let Some(name) = group.own_load().filter(|_| !forces_only) {
                    components.push((name, configuration.reactions.component(id, name)?));
                }
                for (component, (name, form)) in components.into_iter().enumerate() {
                    if forces_only && dimension(layout.space, component) == Dimension::Torque {
                        continue;
                    }
                    forms.push(form);
                    checks.push(UnitCheck {
                        id,
                        frame,
                        component,
                        name,
                        value: 0.0,
                        change: 0.0,
                        nature: Nature::Fact,
                    });
                }
            }
        }
        Ok(Self {
            configuration,
            checks,
            forms,
            wrenches,
        })
    }

    /// Decides the free directions in other units.
    fn rewritten(&self, equations: &Equations, units: Units) -> Result<Rewritten, UnitError> {
        let decided = self.configuration.solvability.decision();
        let layout = self.configuration.layout();
        let rewriting = Rewriting::new(equations, units, &layout.column_kinds());
        let equations = rewriting.equations(equations);
        let dimensions = layout.dimension_scaling(self.configuration.reactions.size);
        let known = rewriting.matrix(&dimensions.undo(&self.configuration.uncertainty));
        let mut decision = rank::decide(&equations.c, &known)?;
        // Data within a stated tolerance may have a lower rank than any matrix shows.
        if self.configuration.reactions.mechanism.has_tolerances() {
            decision = rank::decide_of_rank(&equations.c, &known, decided.rank)?;
        }
        if decision.rank != decided.rank {
            return Err(UnitError::RankChanges {
                rank: decided.rank,
                other: decision.rank,
                units,
            });
        }
        Ok(Rewritten {
            units,
            solvability: Solvability::from_decision(&equations.c, decision),
            rewriting,
        })
    }

    /// The numbers in SI units that the least norm in other units gives, starting from one solution
    /// in these units; the reaction `alone` has units of its own.
    fn least(
        &self,
        rewritten: &Rewritten,
        lambda_0: &[f64],
        alone: Option<ConstraintId>,
    ) -> Result<Vec<f64>, UnitError> {
        let Rewritten {
            units,
            rewriting,
            solvability,
        } = rewritten;
        let wrench = |(id, dimension, form): &(ConstraintId, Dimension, LinearForm)| {
            let own = if alone == Some(*id) {
                OF_ONE_JOINT
            } else {
                1.0
            };
            (rewriting.form(form, own * units.of(*dimension)), 1.0)
        };
        let wrenches: Vec<_> = self.wrenches.iter().map(wrench).collect();
        let lambda = minimise(solvability, lambda_0, &wrenches)?;
        // Each number is divided by its unit, which gives SI units.
        let numbers: Vec<f64> = self
            .forms
            .iter()
            .map(|form| rewriting.form(form, 1.0).value(&lambda))
            .collect();
        check_finite("least norm", &numbers)?;
        Ok(numbers)
    }

    /// The same mechanism at rest, under a load on every coordinate without symmetry: golden-ratio
    /// fractions of 1 N, and for rotations of 1 N times the size of the mechanism.
    fn probing_load(&self, equations: &Equations) -> Equations {
        let golden = 0.618_033_988_749_894_9;
        let kinds = self.configuration.layout().column_kinds();
        let load = |(k, kind): (usize, &ColumnKind)| {
            let arm = match kind {
                ColumnKind::Translation => 1.0,
                ColumnKind::Rotation => self.configuration.reactions.size,
            };
            arm * ((golden * (k + 1) as f64).fract() - 0.5)
        };
        let rows = equations.gamma.len();
        Equations {
            force: kinds.iter().enumerate().map(load).collect(),
            gamma: vec![0.0; rows],
            terms: RowTerms {
                gamma: vec![0.0; rows],
                ..equations.terms.clone()
            },
            ..equations.clone()
        }
    }

    /// The largest force among the numbers, the loads and the inertia forces at these velocities;
    /// the rounding of reactions is proportional to it.
    fn scale(&self, equations: &Equations, numbers: &[f64]) -> f64 {
        let largest = |x: &[f64]| x.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
        let size = self.configuration.reactions.size;
        let forces = self
            .checks
            .iter()
            .zip(numbers)
            .map(|(check, x)| x.abs() / self.unit(check, 1.0));
        let kinds = self.configuration.layout().column_kinds();
        let loads = kinds
            .iter()
            .zip(&equations.force)
            .map(|(kind, x)| match kind {
                ColumnKind::Translation => x.abs(),
                ColumnKind::Rotation => x.abs() / size,
            });
        let inertia = largest(&equations.mass) * largest(&equations.terms.gamma);
        match forces.chain(loads).fold(inertia, f64::max) {
            0.0 => 1.0,
            scale => scale,
        }
    }

    /// A force of this size, or its torque with the size of the mechanism as arm.
    fn unit(&self, check: &UnitCheck, force: f64) -> f64 {
        match dimension(self.configuration.layout().space, check.component) {
            Dimension::Force => force,
            Dimension::Torque => force * self.configuration.reactions.size,
        }
    }
}

/// Whether a component of a wrench is a force or a torque.
fn dimension(space: SpaceKind, component: usize) -> Dimension {
    if space.torques().contains(&component) {
        Dimension::Torque
    } else {
        Dimension::Force
    }
}
