//! Errors of the search for an equilibrium.

use model::codes::Code;
use model::words::{estimate, listed, quantity, rough};
use model::{ForceWithoutDerivatives, StartError};

/// An unbalanced force along a free motion.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct UnbalancedForce {
    /// Description of the motion.
    pub motion: String,
    /// Force or torque along the motion. The value is the power of the loads divided by the speed
    /// of the fastest body.
    pub force: f64,
    /// Unit of the force: N or N·m.
    pub unit: &'static str,
    /// Descriptions of the acting loads, which are the weight and applied forces.
    pub by: Vec<String>,
}

/// Reason why no equilibrium was found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EquilibriumError {
    /// A row prescribes a velocity.
    #[error(
        "no equilibrium: {} `{name}` prescribes {} at the start; start its function with rate zero, or deactivate it (`active = false`)", if *is_drive { "drive" } else { "joint" }, quantity(*rate, unit))]
    Prescribed {
        /// Name of the drive or joint.
        name: String,
        /// Whether the element is a drive.
        is_drive: bool,
        /// The prescribed rate.
        rate: f64,
        /// Unit of the rate.
        unit: &'static str,
    },
    /// A force acts along a free motion without stiffness.
    #[error("there is no equilibrium: {} at every position; add a force that resists the motion, or lock it", push(.0))]
    Pushed(Vec<UnbalancedForce>),
    /// The search did not converge.
    #[error(
        "no equilibrium was found in {steps} steps: {}, {left} of the largest force; describe a start nearer to the equilibrium",
        push(pushed), left = rough(*left))]
    NotFound {
        /// Number of steps.
        steps: usize,
        /// Remaining force, as a share of the largest force.
        left: f64,
        /// The unbalanced forces at the last configuration.
        pushed: Vec<UnbalancedForce>,
    },
    /// The search reached a configuration from which no further step can be assembled.
    #[error(
        "no equilibrium was found: after {steps} steps the mechanism is at a singular configuration, and no step along {} can be assembled; describe a start nearer to the equilibrium, or correct the dimensions",
        push(pushed)
    )]
    Blocked {
        /// Number of steps.
        steps: usize,
        /// The unbalanced forces at this configuration.
        pushed: Vec<UnbalancedForce>,
    },
    /// No start can be assembled at the equilibrium, although the search reached it on the
    /// constraint manifold.
    #[error(
        "no equilibrium was found: the search ends at a singular configuration, where the constraints determine the positions of the bodies only to {left}; describe a start nearer to the equilibrium, or correct the dimensions", left = estimate(*left, "m"))]
    Singular {
        /// Remaining constraint violation (m).
        left: f64,
    },
    /// A force has no finite value.
    #[error(
        "{what} on body `{body}` is not finite during the search; describe a start nearer to the equilibrium"
    )]
    NotFinite {
        /// The force.
        what: String,
        /// The body.
        body: String,
    },
    /// A force calls an external function, which returns values but no derivatives.
    #[error(
        "the search for an equilibrium needs derivatives of all forces, but {0}; give the drive a law of `measure`, `rate` and `t`, or simulate with dampers until the motion stops"
    )]
    NoDerivatives(ForceWithoutDerivatives),
    /// An intermediate configuration cannot be assembled.
    #[error("during the search for an equilibrium {0}")]
    Start(#[from] StartError),
}

pub(super) fn push(pushed: &[UnbalancedForce]) -> String {
    let each = pushed.iter().map(|pushed| {
        let by = match pushed.by.as_slice() {
            [] => String::new(),
            by => format!(" by {}", listed(by)),
        };
        let force = quantity(pushed.force, pushed.unit);
        format!("{}, pushed with {force}{by}", pushed.motion)
    });
    each.collect::<Vec<_>>().join("; ")
}

impl EquilibriumError {
    /// Returns the error code; see [`model::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::Prescribed { .. } => const { Code::new(225) },
            Self::Pushed(_) => const { Code::new(226) },
            Self::NotFound { .. }
            | Self::Blocked { .. }
            | Self::Singular { .. }
            | Self::NotFinite { .. } => const { Code::new(227) },
            Self::NoDerivatives(_) => const { Code::new(427) },
            Self::Start(error) => error.code(),
        }
    }

    /// Returns whether the scene has no equilibrium as described. In this case, the scene must be
    /// changed.
    #[must_use]
    pub fn is_input(&self) -> bool {
        matches!(
            self,
            Self::Prescribed { .. } | Self::Pushed(_) | Self::NoDerivatives(_)
        )
    }
}
