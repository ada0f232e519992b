//! Reasons why no place of rest was found.

use model::codes::Code;
use model::words::{listed, rounded};
use model::{CalledForce, StartError};

/// What pushes a free motion.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct UnbalancedForce {
    /// The motion, in words.
    pub motion: String,
    /// Force or torque along it, for its fastest translation or rotation.
    pub force: f64,
    /// N or N·m.
    pub unit: &'static str,
    /// What pushes: the weight and applied forces, in words.
    pub by: Vec<String>,
}

/// Reason why no place of rest was found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EquilibriumError {
    /// A row prescribes a velocity.
    #[error(
        "nothing rests: {} `{name}` prescribes {} {unit} at the start; let its function begin with rate zero, \
         or leave it out (`active = false`)", if *is_drive { "drive" } else { "joint" }, rounded(*rate))]
    Prescribed {
        /// The drive or joint.
        name: String,
        /// Whether it is a drive.
        is_drive: bool,
        /// The rate that it prescribes.
        rate: f64,
        /// Unit of the rate.
        unit: &'static str,
    },
    /// A free motion is pushed, and nothing resists it.
    #[error("there is no rest: {}, wherever it goes; add what resists it, or hold it", push(.0))]
    Pushed(Vec<UnbalancedForce>),
    /// The search did not end.
    #[error(
        "no place of rest was found in {steps} steps: {}, a share of {left:.1e} of the largest force; \
         describe a start nearer to rest",
        push(pushed)
    )]
    NotFound {
        /// Number of steps.
        steps: usize,
        /// What is left, as a share of the largest force.
        left: f64,
        /// What is pushed there.
        pushed: Vec<UnbalancedForce>,
    },
    /// The search came to a configuration from which no step can be assembled.
    #[error(
        "no place of rest was found: after {steps} steps the mechanism is at a singular configuration, from which no step \
         can be assembled along {}; describe a start nearer to rest, or correct the dimensions",
        push(pushed)
    )]
    Blocked {
        /// Number of steps.
        steps: usize,
        /// What is pushed there.
        pushed: Vec<UnbalancedForce>,
    },
    /// At the place that was found no start can be assembled, although the search reached it on
    /// the constraints.
    #[error(
        "no place of rest was found: the search ends at a singular configuration, at which the constraints determine \
         the places of the bodies to {left:.1e} m only; describe a start nearer to rest, or correct the dimensions"
    )]
    Singular {
        /// What the constraints still miss there (m).
        left: f64,
    },
    /// A force has no finite value.
    #[error(
        "{what} on body `{body}` is not finite on the way to rest; describe a start nearer to rest"
    )]
    NotFinite {
        /// The force.
        what: String,
        /// The body.
        body: String,
    },
    /// A force calls a function, of which values alone are known.
    #[error(
        "a search for rest needs derivatives of all forces, and {0}; give the drive a law of `measure`, `rate` and `t`, \
         or let a run with dampers come to rest"
    )]
    NoDerivatives(CalledForce),
    /// A configuration on the way cannot be reached.
    #[error("on the way to rest {0}")]
    Start(#[from] StartError),
}

pub(super) fn push(pushed: &[UnbalancedForce]) -> String {
    let each = pushed.iter().map(|pushed| {
        let by = match pushed.by.as_slice() {
            [] => String::new(),
            by => format!(" by {}", listed(by)),
        };
        let force = rounded(pushed.force);
        format!("{}, pushed with {force} {}{by}", pushed.motion, pushed.unit)
    });
    each.collect::<Vec<_>>().join("; ")
}

impl EquilibriumError {
    /// Its code; see [`model::codes`].
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

    /// Whether other input may have a place of rest.
    #[must_use]
    pub fn is_input(&self) -> bool {
        matches!(
            self,
            Self::Prescribed { .. } | Self::Pushed(_) | Self::NoDerivatives(_)
        )
    }
}
