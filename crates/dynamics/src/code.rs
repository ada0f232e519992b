//! What a run asks of straight-line code that was generated for one mechanism. Not here: how such
//! code is made, and when a run may use it ([`Prepared::code_for`](crate::Prepared::code_for)).
//!
//! Code keeps the rows that it was generated for and eliminates in an order that was chosen
//! offline, so it cannot find new pivots. It says how good its pivots are instead: its *health*,
//! the smallest pivot as a signed share of the smallest |pivot| of the same place that its
//! generator saw. 1 is as good; 0 or less has passed a singular pivot; NaN never counts as healthy.
//! Whoever calls it has to look.

mod belongs;

use std::borrow::Cow;

pub use crate::limits::LEAVE;
pub use belongs::{CodeMismatch, NoCode};

/// What code was generated for.
#[derive(Clone, Debug, PartialEq)]
pub struct Facts {
    /// Name of the scene.
    pub name: Cow<'static, str>,
    /// Coordinates.
    pub n_q: usize,
    /// Velocities.
    pub n_v: usize,
    /// Holonomic rows.
    pub m: usize,
    /// Nonholonomic rows.
    pub h: usize,
    /// Kept rows of C, from 0, ascending.
    pub kept: Cow<'static, [usize]>,
    /// Kept rows of Φq, from 0, ascending.
    pub position_kept: Cow<'static, [usize]>,
    /// Times at which a function of time is not smooth (s), ascending.
    pub break_times: Cow<'static, [f64]>,
    /// Operations of each function, in words.
    pub operations: Cow<'static, str>,
}

/// Straight-line code for one mechanism on fixed kept rows.
///
/// ```
/// use std::ops::ControlFlow;
/// use std::sync::Arc;
/// use dynamics::{Facts, MotionOptions, RowChoice, SceneCode, prepare, simulate};
/// use model::{Body, Description, Mechanism, StartOptions};
///
/// /// A stone that falls: nothing holds it.
/// struct Stone(Facts);
///
/// impl SceneCode for Stone {
///     fn facts(&self) -> &Facts { &self.0 }
///     fn acceleration(&self, _: f64, _: &[f64], _: &[f64], a: &mut [f64]) -> f64 {
///         a.copy_from_slice(&[0.0, -10.0, 0.0]);
///         1.0
///     }
///     fn multipliers(&self, _: f64, _: &[f64], _: &[f64], _: &mut [f64]) -> f64 { 1.0 }
///     fn phi(&self, _: f64, _: &[f64], _: &mut [f64]) {}
///     fn velocity_residual(&self, _: f64, _: &[f64], _: &[f64], _: &mut [f64]) {}
///     fn position_correction(&self, _: f64, _: &[f64], _: &[f64], dq: &mut [f64]) -> f64 { dq.fill(0.0); 1.0 }
///     fn velocity_correction(&self, _: f64, _: &[f64], _: &[f64], dv: &mut [f64]) -> f64 { dv.fill(0.0); 1.0 }
/// }
///
/// let stone = Body { name: "stone".into(), mass: 2.0, inertia: 0.1, ..Body::default() };
/// let described = Description { gravity: [0.0, -10.0], bodies: vec![stone], ..Description::default() };
/// let mechanism = Mechanism::build(&described).unwrap();
/// let facts = Facts {
///     name: "stone".into(), n_q: 3, n_v: 3, m: 0, h: 0,
///     kept: vec![].into(), position_kept: vec![].into(), break_times: vec![].into(), operations: "".into(),
/// };
/// let prepared = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic)?.with_code(Arc::new(Stone(facts)))?;
/// let mut y = 0.0;
/// simulate(&prepared, &MotionOptions::to(1.0), |row| {
///     y = row.q[1];
///     Ok(ControlFlow::Continue(()))
/// })?;
/// assert!((y + 5.0).abs() < 1e-14);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// No function allocates or panics on slices of the sizes below; any numbers
/// may come, and the health tells what the result is worth.
///
/// | argument | length | meaning |
/// | --- | --- | --- |
/// | `q` | n_q | coordinates |
/// | `dq` | n_v | a displacement of them, see [`model::System::displace`] |
/// | `v`, `dv`, `a` | n_v | velocities, their changes, and accelerations |
/// | `phi` | m | Φ(q, t) of all holonomic rows |
/// | `residual`, `lambda` | m + h | C·v − b, and multipliers, of all rows |
pub trait SceneCode: Send + Sync {
    /// What it was generated for.
    fn facts(&self) -> &Facts;

    /// `a` from `M·a + C_Kᵀ·λ_K = Q`, `C_K·a = Γ_K`; the health.
    fn acceleration(&self, t: f64, q: &[f64], v: &[f64], a: &mut [f64]) -> f64;

    /// The λ of these equations, 0 for dropped rows; the health.
    fn multipliers(&self, t: f64, q: &[f64], v: &[f64], lambda: &mut [f64]) -> f64;

    /// Φ of all holonomic rows.
    fn phi(&self, t: f64, q: &[f64], phi: &mut [f64]);

    /// `C·v − b` of all rows.
    fn velocity_residual(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]);

    /// The smallest `dq` in the mass metric with `Φq·dq = −phi` on the kept rows of Φq; the health
    /// of their pivots.
    fn position_correction(&self, t: f64, q: &[f64], phi: &[f64], dq: &mut [f64]) -> f64;

    /// The smallest `dv` in the mass metric with `C·dv = −residual` on the kept rows of C; the
    /// health.
    fn velocity_correction(&self, t: f64, q: &[f64], residual: &[f64], dv: &mut [f64]) -> f64;
}
