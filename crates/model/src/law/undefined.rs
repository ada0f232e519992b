//! The error if a law or a callback has no finite value.

use super::operation::{Join, UnaryFunction};

/// Reason why a law has no finite value, or no derivatives.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum UndefinedValue {
    /// The value of a function of one variable is not finite.
    Apply(UnaryFunction, f64),
    /// The value of a function of two variables is not finite.
    Join(Join, f64, f64),
    /// The joint coordinate has no gradient at this state, or an argument is not finite.
    Input,
    /// A callback returned this value, which is not finite.
    Returned(String),
    /// A callback failed with this message.
    Failed(String),
    /// A method needs derivatives of a callback, which returns only values.
    ValueAlone,
}

impl UndefinedValue {
    /// Returns whether a callback is the cause. If a callback is the cause, the error does not
    /// disappear at another state.
    #[must_use]
    pub fn is_of_function(&self) -> bool {
        matches!(self, Self::Returned(_) | Self::Failed(_))
    }
}

impl std::error::Error for UndefinedValue {}

impl std::fmt::Display for UndefinedValue {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Join(Join::Divide, _, 0.0) => f.write_str("division by zero"),
            Self::Apply(UnaryFunction::Log, a) => write!(f, "log({a})"),
            Self::Apply(UnaryFunction::Root, a) => write!(f, "sqrt({a})"),
            Self::Apply(UnaryFunction::Asin, a) => write!(f, "asin({a})"),
            Self::Apply(UnaryFunction::Acos, a) => write!(f, "acos({a})"),
            Self::Apply(UnaryFunction::Exp, a) => write!(f, "exp({a})"),
            Self::Apply(UnaryFunction::Whole(n), a) => write!(f, "{a}^{n}"),
            Self::Join(Join::Power, a, b) => write!(f, "{a}^{b}"),
            Self::Join(Join::Angle, a, b) => write!(f, "atan2({a}, {b})"),
            Self::Apply(..) | Self::Join(..) => f.write_str("a result that is too large"),
            Self::Input => f.write_str("a measure without a value"),
            Self::Returned(x) => write!(f, "its function returned {x}"),
            Self::Failed(why) => write!(f, "its function failed: {why}"),
            Self::ValueAlone => f.write_str("a called function has values, but no derivatives"),
        }
    }
}
