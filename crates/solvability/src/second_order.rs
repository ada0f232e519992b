//! Is the motion unique at a configuration at which the rank drops? There more velocities satisfy
//! `C·v = b` than elsewhere, but a velocity can continue only if accelerations exist: `z·Γ(v) = 0`
//! for every z of the left null space, both for self-stresses that exist everywhere and for new
//! ones. These are quadratic equations in the velocities, and the motion through the point solves
//! them.
//!
//! If there is no other solution, the new motions are blocked at second order. If there is one, the
//! motion branches. If second order does not decide, the result says so.
//!
//! Source: S. Pellegrino, C. R. Calladine, Matrix analysis of statically and kinematically
//! indeterminate frameworks, Int. J. Solids Structures 22 (1986) 409–428, here with velocities of
//! the motion and drives.

mod blocked;
mod branches;
mod forms;
mod undetermined;

use linalg::Matrix;
use model::{Mechanism, System};
use rank::{Grounds, RankDecision};

use crate::limits::KERNEL_MAX;
use crate::state::{self, StateError};
use forms::Forms;

pub use undetermined::Undetermined;

/// How a motion continues at a configuration at which the rank drops.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Continuation {
    /// No other velocity is compatible: the new motions are blocked at second order.
    Unique,
    /// Other velocities are compatible to second order: the constraints do not determine on which
    /// branch the mechanism continues.
    Bifurcation {
        /// Velocities of other branches, n_v each. Without drives they are as fast as the motion,
        /// and may be reversed. If a branch has several degrees of freedom, these are examples.
        branches: Vec<Vec<f64>>,
    },
    /// Second order does not decide.
    Undetermined(Undetermined),
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

/// Second-order test at time t, coordinates q on the constraints and velocities v with `C·v = b`;
/// `decision` is the rank at this configuration.
///
/// `regular` (n_v × k) holds the velocities `w` with `C·w = 0` that the mechanism also has at
/// neighbouring configurations: the column v for a mechanism with one degree of freedom and without
/// drives, no column for a driven one without freedom.
///
/// # Errors
/// If the state has the wrong number of values, or one of them is not finite.
pub fn second_order(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    v: &[f64],
    decision: &RankDecision,
    regular: &Matrix,
) -> Result<Continuation, StateError> {
    state::check(mechanism, t, q, v)?;
    for k in 0..regular.ncols() {
        let column: Vec<f64> = (0..regular.nrows()).map(|i| regular[(i, k)]).collect();
        state::check(mechanism, t, q, &column)?;
    }
    let forms = Forms::new(mechanism, t, q, v, decision, regular);
    Ok(match forms {
        Err(reason) => Continuation::Undetermined(reason),
        Ok(forms) if forms.y() == 0 || blocked::is_blocked(&forms) => Continuation::Unique,
        Ok(forms) if forms.y() > KERNEL_MAX => Continuation::Undetermined(Undetermined::Kernel {
            found: forms.y(),
            most: KERNEL_MAX,
        }),
        Ok(forms) => match branches::others(&forms) {
            found if found.is_empty() => Continuation::Undetermined(Undetermined::Open),
            found => Continuation::Bifurcation {
                branches: found.iter().map(|a| forms.velocity(a)).collect(),
            },
        },
    })
}

/// Whether the mechanism cannot move although C leaves velocities free: second order excludes every
/// velocity with `C·v = 0`, so its mobility exists to first order only. Always `false` for
/// mechanisms with functions of time, which move by these.
///
/// # Errors
/// If the configuration has the wrong number of values, or one of them is not finite.
pub fn is_locked(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    decision: &RankDecision,
) -> Result<bool, StateError> {
    if !may_block(mechanism, decision) {
        return Ok(false);
    }
    let n = mechanism.layout().n_v;
    let found = second_order(
        mechanism,
        t,
        q,
        &vec![0.0; n],
        decision,
        &Matrix::zeros(n, 0),
    )?;
    Ok(found == Continuation::Unique)
}

/// Velocities with `C·v = 0` that second order excludes, n_v each: a combination of the forms
/// `z·Γ(v)` is definite in them. They are orthogonal, without dimensions, to the velocities that no
/// form contains. Empty if second order does not decide, and for mechanisms with functions of time.
///
/// # Errors
/// As [`is_locked`].
pub fn blocked_velocities(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    decision: &RankDecision,
) -> Result<Vec<Vec<f64>>, StateError> {
    if !may_block(mechanism, decision) {
        return Ok(Vec::new());
    }
    let n = mechanism.layout().n_v;
    let rest = vec![0.0; n];
    state::check(mechanism, t, q, &rest)?;
    let forms = Forms::new(mechanism, t, q, &rest, decision, &Matrix::zeros(n, 0));
    let blocked = forms.ok().and_then(|forms| {
        let basis = blocked::blocked(&forms)?.transpose();
        Some(
            (0..basis.nrows())
                .map(|k| forms.velocity(basis.row(k)))
                .collect(),
        )
    });
    Ok(blocked.unwrap_or_default())
}

/// Whether second order can exclude velocities at all.
fn may_block(mechanism: &Mechanism, decision: &RankDecision) -> bool {
    let layout = mechanism.layout();
    let has_freedom = decision.is_decided() && decision.rank < layout.n_v;
    // Rows that are redundant within a tolerance only block nothing within it.
    let certificate = decision.evidence.certificate.as_ref();
    let is_within = certificate.is_some_and(|c| c.grounds == Grounds::WithinTolerance);
    has_freedom && decision.redundancy > 0 && !layout.rheonomic && !is_within
}
