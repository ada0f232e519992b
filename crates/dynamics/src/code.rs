//! The interface between a run and straight-line code that was generated for one mechanism. Another
//! crate generates such code. [`PreparedMechanism::code_for`](crate::PreparedMechanism::code_for)
//! decides when a run may use the code.
//!
//! Generated code has fixed independent rows and a fixed order of elimination, so it cannot choose
//! new pivots. Instead it returns the quality of its pivots, called its *health*. Each pivot, with
//! its sign, is divided by the smallest |pivot| that the generator found at the same position. The
//! health is the smallest of these ratios. A health of 1 means that the pivots are as large as in
//! the generator. At 0 or less, a pivot is zero or has changed its sign. NaN counts as unreliable.
//! The caller must check the health.

mod belongs;
mod inputs;

use std::borrow::Cow;
use std::sync::Arc;

pub use crate::limits::LEAVE;
pub use belongs::{CodeMismatch, NoCode};
pub use inputs::{CodeInput, CodeInputs};

/// The mechanism for which code was generated, and its sizes.
#[derive(Clone, Debug, PartialEq)]
pub struct CodeSpec {
    /// Name of the scene.
    pub name: Cow<'static, str>,
    /// Number of coordinates.
    pub n_q: usize,
    /// Number of velocities.
    pub n_v: usize,
    /// Number of holonomic rows.
    pub m: usize,
    /// Number of nonholonomic rows.
    pub h: usize,
    /// Independent rows of C, from 0, ascending.
    pub kept: Cow<'static, [usize]>,
    /// Independent rows of Φq, from 0, ascending.
    pub position_kept: Cow<'static, [usize]>,
    /// Times at which a function of time is not smooth (s), ascending.
    pub break_times: Cow<'static, [f64]>,
    /// Operation counts of each function, as text.
    pub operations: Cow<'static, str>,
}

/// Straight-line code for one mechanism with fixed independent rows.
///
/// ```
/// use std::ops::ControlFlow;
/// use std::sync::Arc;
/// use pfaff_dynamics::{CodeSpec, MotionOptions, RowChoice, SceneCode, prepare, simulate};
/// use model::{Body, Description, Mechanism, StartOptions};
///
/// /// A falling stone without constraints.
/// struct Stone(CodeSpec);
///
/// impl SceneCode for Stone {
///     fn spec(&self) -> &CodeSpec { &self.0 }
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
/// let spec = CodeSpec {
///     name: "stone".into(), n_q: 3, n_v: 3, m: 0, h: 0,
///     kept: vec![].into(), position_kept: vec![].into(), break_times: vec![].into(), operations: "".into(),
/// };
/// let prepared = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic)?.with_code(Arc::new(Stone(spec)))?;
/// let mut y = 0.0;
/// simulate(&prepared, &MotionOptions::to(1.0), |row| {
///     y = row.q[1];
///     Ok(ControlFlow::Continue(()))
/// })?;
/// assert!((y + 5.0).abs() < 1e-14);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// No function allocates memory, and no function panics on slices of the lengths below. The
/// arguments may have any values; the health shows whether the result can be used.
///
/// | argument | length | meaning |
/// | --- | --- | --- |
/// | `q` | n_q | coordinates |
/// | `dq` | n_v | a displacement of the coordinates, see [`model::System::displace`] |
/// | `v`, `dv`, `a` | n_v | velocities, changes of velocities, and accelerations |
/// | `phi` | m | Φ(q, t) of all holonomic rows |
/// | `residual`, `lambda` | m + h | C·v − b, and multipliers, of all rows |
pub trait SceneCode {
    /// Returns the mechanism for which the code was generated.
    fn spec(&self) -> &CodeSpec;

    /// Computes `a` from `M·a + C_Kᵀ·λ_K = Q`, `C_K·a = Γ_K`. Returns the health.
    fn acceleration(&self, t: f64, q: &[f64], v: &[f64], a: &mut [f64]) -> f64;

    /// Computes the multipliers λ of the equations of [`SceneCode::acceleration`], with 0 for
    /// redundant rows. Returns the health.
    fn multipliers(&self, t: f64, q: &[f64], v: &[f64], lambda: &mut [f64]) -> f64;

    /// Computes Φ of all holonomic rows.
    fn phi(&self, t: f64, q: &[f64], phi: &mut [f64]);

    /// Computes `C·v − b` of all rows.
    fn velocity_residual(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]);

    /// Computes the `dq` of smallest norm in the mass metric that satisfies `Φq·dq = −phi` for the
    /// independent rows of Φq. Returns the health of the pivots of these rows.
    fn position_correction(&self, t: f64, q: &[f64], phi: &[f64], dq: &mut [f64]) -> f64;

    /// Computes the `dv` of smallest norm in the mass metric that satisfies `C·dv = −residual` for
    /// the independent rows of C. Returns the health.
    fn velocity_correction(&self, t: f64, q: &[f64], residual: &[f64], dv: &mut [f64]) -> f64;

    /// Returns the parameters of a mechanism that the code takes as inputs. Returns `None` if all
    /// parameters are constants in the code.
    fn inputs(&self) -> Option<&CodeInputs> {
        None
    }

    /// Returns the same code with these input values, in the order of the inputs. Returns `None` if
    /// the code has no inputs or expects another number of inputs.
    fn with_inputs(&self, _values: &[f64]) -> Option<Arc<SharedCode>> {
        None
    }
}

/// Generated code that several threads can share.
pub type SharedCode = dyn SceneCode + Send + Sync;

/// Identifies a function of [`SceneCode`], for programs that evaluate the code by other means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CodeFunction {
    /// The function [`SceneCode::acceleration`].
    Acceleration,
    /// The function [`SceneCode::multipliers`].
    Multipliers,
    /// The function [`SceneCode::phi`].
    Phi,
    /// The function [`SceneCode::velocity_residual`].
    VelocityResidual,
    /// The function [`SceneCode::position_correction`].
    PositionCorrection,
    /// The function [`SceneCode::velocity_correction`].
    VelocityCorrection,
}

impl CodeFunction {
    /// All functions, each at its index.
    pub const ALL: [Self; 6] = [
        Self::Acceleration,
        Self::Multipliers,
        Self::Phi,
        Self::VelocityResidual,
        Self::PositionCorrection,
        Self::VelocityCorrection,
    ];

    /// Returns the index in [`CodeFunction::ALL`].
    #[must_use]
    pub fn index(self) -> usize {
        self as usize
    }

    /// Returns the name of the function.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Acceleration => "acceleration",
            Self::Multipliers => "multipliers",
            Self::Phi => "phi",
            Self::VelocityResidual => "velocity_residual",
            Self::PositionCorrection => "position_correction",
            Self::VelocityCorrection => "velocity_correction",
        }
    }
}
