//! Decides whether the motion is unique at a configuration at which the rank drops. At such a
//! configuration, more velocities satisfy `C·v = b` than at other configurations. However, a motion
//! with such a velocity requires accelerations: `z·Γ(v) = 0` for every z of the left null space.
//! This condition applies to self-stresses that exist at all configurations and to new
//! self-stresses. The conditions are quadratic equations in the velocities, and the motion through
//! the point satisfies them.
//!
//! If there is no other solution, the new motions are blocked at second order. If there is another
//! solution, the motion branches. If the second order is not sufficient for a decision, the result
//! is undecided.
//!
//! The same equations restrict the free velocities of a mechanism whose functions of time are
//! locked ([`restrictions()`]). A locked drive is then a constraint like any other.
//!
//! Source: S. Pellegrino, C. R. Calladine, Matrix analysis of statically and kinematically
//! indeterminate frameworks, Int. J. Solids Structures 22 (1986) 409–428, here with velocities of
//! the motion and drives.

mod branches;
mod definite;
mod forms;
mod restrictions;
mod undetermined;
mod zeros;

use linalg::Matrix;
use model::{Mechanism, System};
use rank::{Grounds, RankDecision};

use crate::limits::KERNEL_MAX;
use crate::state::{self, StateError};
use forms::Forms;

pub(crate) use restrictions::AccelerationVerdict;
pub use restrictions::{RestrictedVelocities, Restrictions, SecondOrder};
pub use undetermined::SecondOrderDoubt;
pub use zeros::{CommonZero, common_zero};

/// The possible continuations of a motion at a configuration at which the rank drops.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum Continuation {
    /// No other velocity is compatible. The new motions are blocked at second order.
    Unique,
    /// Other velocities are compatible to second order. The constraints do not determine on which
    /// branch the mechanism continues.
    Bifurcation {
        /// Velocities of other branches, n_v values each. Without drives, the new motions are as
        /// fast as the given motion and may be reversed. If a branch has several degrees of
        /// freedom, the listed velocities are examples.
        branches: Vec<Vec<f64>>,
    },
    /// The conditions of second order are not sufficient to decide whether a motion exists.
    Undetermined(SecondOrderDoubt),
}

impl std::fmt::Display for Continuation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Unique => f.write_str("the motion stays unique (second order)"),
            Self::Bifurcation { branches } => {
                let others = match branches.len() {
                    1 => "another branch is".to_owned(),
                    n => format!("{n} other branches are"),
                };
                write!(
                    f,
                    "a bifurcation: {others} compatible with the constraints, which do not determine how the motion continues"
                )
            }
            Self::Undetermined(reason) => write!(
                f,
                "whether the motion stays unique is not decided at second order: {reason}"
            ),
        }
    }
}

/// Performs the second-order test at time t, coordinates q on the constraints and velocities v with
/// `C·v = b`. `decision` is the rank at this configuration.
///
/// `regular` (n_v × k) contains the velocities `w` with `C·w = 0` that are also possible at
/// neighbouring configurations. For a mechanism with one degree of freedom and without drives, it
/// consists of the column v. For a driven mechanism without freedom, it has no column.
///
/// # Errors
/// Returns an error if the state has the wrong number of values, or if a value is not finite.
pub fn second_order(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    v: &[f64],
    decision: &RankDecision,
    regular: &Matrix,
) -> Result<Continuation, StateError> {
    state::check_state(mechanism, t, q, v)?;
    for k in 0..regular.ncols() {
        let column: Vec<f64> = (0..regular.nrows()).map(|i| regular[(i, k)]).collect();
        state::check_state(mechanism, t, q, &column)?;
    }
    let forms = Forms::new(mechanism, t, q, v, decision, regular);
    Ok(match forms {
        Err(reason) => Continuation::Undetermined(reason),
        Ok(forms) if is_unique(&forms, mechanism, q) => Continuation::Unique,
        Ok(forms) if forms.y() > KERNEL_MAX => {
            Continuation::Undetermined(SecondOrderDoubt::Kernel {
                found: forms.y(),
                most: KERNEL_MAX,
            })
        }
        Ok(forms) => match branches::others(&forms) {
            found if found.is_empty() => Continuation::Undetermined(SecondOrderDoubt::Open),
            found => Continuation::Bifurcation {
                branches: found.iter().map(|a| forms.velocity(a)).collect(),
            },
        },
    })
}

/// Returns whether the quadratic forms exclude every other velocity.
fn is_unique(forms: &Forms, mechanism: &Mechanism, q: &[f64]) -> bool {
    match (forms.x(), forms.y()) {
        (_, 0) => true,
        (0, _) => Restrictions::of(forms, mechanism, q).exclude_all() == Some(true),
        _ => definite::is_blocked(forms),
    }
}

/// Returns the second-order restrictions on the velocities with `C·v = 0` if functions of time are
/// locked. A locked drive is a row like any other row.
///
/// Rows that are redundant only within a stated tolerance do not restrict motions within this
/// tolerance. If the rank is undecided, there are no restrictions.
///
/// # Errors
/// Returns an error if the configuration has the wrong number of values, or if a value is not
/// finite.
pub fn restrictions(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    decision: &RankDecision,
) -> Result<Restrictions, StateError> {
    let n = mechanism.layout().n_v;
    state::check_state(mechanism, t, q, &vec![0.0; n])?;
    let unrestricted = n.saturating_sub(decision.rank);
    if !may_block(mechanism, decision) {
        return Ok(Restrictions {
            unrestricted,
            ..Restrictions::default()
        });
    }
    Ok(match Forms::held(mechanism, t, q, decision) {
        Ok(forms) => Restrictions::of(&forms, mechanism, q),
        Err(SecondOrderDoubt::NoTerms) => Restrictions {
            unrestricted,
            ..Restrictions::default()
        },
        Err(reason) => Restrictions {
            unrestricted,
            undetermined: Some(reason),
            ..Restrictions::default()
        },
    })
}

/// Returns whether the mechanism cannot move although C leaves velocities free, if functions of
/// time are locked. In this case, every velocity with `C·v = 0` is excluded at second order, and
/// the mobility exists only to first order. Returns `None` if the second order is not sufficient
/// for a decision, or if the rank is undecided.
///
/// # Errors
/// Returns the same errors as [`restrictions()`].
pub fn is_locked(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    decision: &RankDecision,
) -> Result<Option<bool>, StateError> {
    let found = restrictions(mechanism, t, q, decision)?;
    Ok(found.exclude_all().filter(|_| decision.is_decided()))
}

/// Returns velocities with `C·v = 0` that are excluded at second order if functions of time are
/// locked, n_v values each. In dimensionless form, they are orthogonal to the velocities that no
/// quadratic form contains. The list is empty if the second order is not sufficient for a decision.
///
/// # Errors
/// Returns the same errors as [`restrictions()`].
pub fn blocked_velocities(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    decision: &RankDecision,
) -> Result<Vec<Vec<f64>>, StateError> {
    Ok(restrictions(mechanism, t, q, decision)?.velocities(SecondOrder::Blocked))
}

/// Returns whether velocities can be excluded at second order.
fn may_block(mechanism: &Mechanism, decision: &RankDecision) -> bool {
    let has_freedom = decision.is_decided() && decision.rank < mechanism.layout().n_v;
    // Rows that are redundant only within a tolerance do not block motions within this tolerance.
    let certificate = decision.evidence.certificate.as_ref();
    let is_within = certificate.is_some_and(|c| c.grounds == Grounds::WithinTolerance);
    has_freedom && decision.redundancy > 0 && !is_within
}
