//! Errors of the linearisation of a motion.

use model::codes::Code;
use model::words::{quantity, rounded, short};

use crate::error::MotionFault;

/// Reason why a motion cannot be linearised about a state.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LineariseError {
    /// The state is neither an equilibrium nor steady.
    #[error(
        "at t = {t} s the motion is not steady: body `{body}` {what} {left}; {advice}",
        t = rounded(*time), what = what(unit),
        advice = advice(*moves, falls.as_deref()), left = quantity(*left, unit))]
    NotSteady {
        /// Time (s).
        time: f64,
        /// The body.
        body: String,
        /// Acceleration of the body, or the rate of this acceleration.
        left: f64,
        /// Unit.
        unit: &'static str,
        /// Whether the state has a velocity.
        moves: bool,
        /// Description of the bodies that fall freely because they have no connection to the
        /// ground, and of the loads on these bodies.
        falls: Option<String>,
    },
    /// The accelerations have no derivative at this state.
    #[error(
        "at t = {t} s the accelerations of body `{body}` have no derivative: a force or a function has a kink there; linearise at another state, or use a smooth function", t = rounded(*time))]
    NotSmooth {
        /// Time (s).
        time: f64,
        /// The body with the largest error estimate.
        body: String,
    },
    /// No coordinate has this name.
    #[error("there is no coordinate `{name}`: {hint}")]
    Coordinate {
        /// The name.
        name: String,
        /// The existing coordinates.
        hint: String,
    },
    /// The requested coordinates do not determine the state.
    #[error("`{name}` is not independent of {others}: leave it out")]
    Dependent {
        /// The coordinate.
        name: String,
        /// The coordinates that determine this coordinate.
        others: String,
    },
    /// The motion depends on a cyclic coordinate.
    #[error(
        "the motion depends on `{name}` (the rate of `{state}` changes by {change}), so it is not cyclic; remove it from `--follow`", change = short(*change))]
    NotASymmetry {
        /// Name of the cyclic coordinate.
        name: String,
        /// A coordinate whose rate changes.
        state: String,
        /// Change of the rate, for a unit change of the coordinate.
        change: f64,
    },
    /// The coordinates do not determine the state.
    #[error(
        "the independent coordinates do not determine the state: the configuration is singular"
    )]
    Singular,
    /// The equations have no solution at the state.
    #[error(transparent)]
    Fault(#[from] MotionFault),
}

/// Returns advice for a state that is not steady.
fn advice(moves: bool, falls: Option<&str>) -> String {
    match falls {
        Some(falls) => format!(
            "there is no equilibrium: {falls} at every position; add a joint to the ground, or describe the \
             support"
        ),
        None if moves => {
            "let the axes rotate with a body (`--follow BODY.wz`), or choose another time"
                .to_owned()
        }
        None => {
            "find an equilibrium with `pfaff equilibrium`, or simulate with dampers until the motion stops"
                .to_owned()
        }
    }
}

impl LineariseError {
    /// Returns the error code; see [`model::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::NotSteady { .. } => const { Code::new(220) },
            Self::NotSmooth { .. } => const { Code::new(221) },
            Self::Coordinate { .. } | Self::Dependent { .. } => const { Code::new(222) },
            Self::NotASymmetry { .. } => const { Code::new(223) },
            Self::Singular => const { Code::new(224) },
            Self::Fault(fault) => fault.code(),
        }
    }

    /// Returns whether a linearisation may be possible with other input.
    #[must_use]
    pub fn is_input(&self) -> bool {
        match self {
            Self::Singular => false,
            Self::Fault(fault) => matches!(fault, MotionFault::NoDerivatives { .. }),
            _ => true,
        }
    }
}

fn what(unit: &str) -> &'static str {
    if unit.ends_with('²') {
        "accelerates by"
    } else {
        "changes its acceleration by"
    }
}
