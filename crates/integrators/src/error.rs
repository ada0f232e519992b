//! Errors of an integration, with their names and data.

use crate::statistics::Statistics;
use std::error::Error;
use thiserror::Error;

/// Reason why a trial step was rejected.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Cause<E: Error + 'static> {
    /// Error control requires shorter steps.
    #[error("error control (the last estimated local error is {norm:.3e} of the permitted one)")]
    ErrorTest {
        /// Weighted norm of the last estimated error. If the norm is ≤ 1, the step with this error
        /// was accepted, and error control then required a shorter next step.
        norm: f64,
    },
    /// A derivative or a new state was not finite.
    #[error("component {component} (counted from 0) of a stage or of the new state is not finite")]
    NonFinite {
        /// First component that is not finite, counted from 0.
        component: usize,
    },
    /// The right-hand side or the hook returned an error.
    #[error("the problem reports: {0}")]
    Problem(#[source] E),
    /// Newton's method for the stages does not converge.
    #[error(
        "Newton's iteration for the stages does not converge (rate {rate:.2e} after {iterations} iterations)"
    )]
    NewtonDiverges {
        /// Last increment divided by the previous increment. The quotient is NaN or infinite if an
        /// increment is not finite.
        rate: f64,
        /// Number of iterations with the last Jacobian.
        iterations: u32,
    },
    /// The hook returned [`crate::StepEnd::Reject`].
    #[error("the hook at the end of the step rejects the step")]
    RejectedByHook,
}

/// Reason why an integration could not start or continue.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum IntegrationError<E: Error + 'static> {
    /// The initial state does not fit the problem.
    #[error("the initial state has {found} components, the problem has {expected}")]
    DimensionMismatch {
        /// Number n of components of the problem.
        expected: usize,
        /// Length of the initial state.
        found: usize,
    },
    /// The initial state contains a NaN or an infinity.
    #[error("component {component} (counted from 0) of the initial state is {value}")]
    NonFiniteInitialState {
        /// First component that is NaN or infinite, counted from 0.
        component: usize,
        /// Value of this entry of the state.
        value: f64,
    },
    /// A time is not finite, or the interval is longer than the largest number.
    #[error("{name} = {value} is not a time one can integrate from or to")]
    InvalidTime {
        /// Name of the time.
        name: &'static str,
        /// Value of the time (s).
        value: f64,
    },
    /// An option is outside its range.
    #[error("{option} = {value}, expected {expected}")]
    InvalidOption {
        /// Name of the field.
        option: &'static str,
        /// Value of the option.
        value: f64,
        /// The allowed values.
        expected: &'static str,
    },
    /// A list of tolerances does not fit the problem.
    #[error("{found} values for {tolerance}, the problem has {expected} components")]
    ToleranceLength {
        /// `rtol` or `atol`.
        tolerance: &'static str,
        /// Number n of components of the problem.
        expected: usize,
        /// Length of the list.
        found: usize,
    },
    /// An output time is outside the interval or out of order.
    #[error(
        "output time {t} (number {index}, counted from 0) is outside [{t0}, {t_end}] or out of order"
    )]
    InvalidOutputTime {
        /// Index in the list, counted from 0.
        index: usize,
        /// The time.
        t: f64,
        /// Start of the interval.
        t0: f64,
        /// End of the interval.
        t_end: f64,
    },
    /// f could not be evaluated at the start or just after a break time. Therefore a shorter step
    /// is not useful.
    #[error("f(t, y) cannot be evaluated at the start of a step, t = {t}: {cause}")]
    StartFailed {
        /// The time.
        t: f64,
        /// Cause.
        #[source]
        cause: Cause<E>,
    },
    /// The step size has become too small to continue.
    #[error(
        "step size collapsed at t = {t} (h = {h:.3e} after {failures} rejected trials in a row): {cause}; \
         is there a singularity, a jump that is not declared as break time, or a tolerance that cannot be met?"
    )]
    StepSizeCollapsed {
        /// Time reached.
        t: f64,
        /// Signed size of the next trial step.
        h: f64,
        /// Number of rejected trials since the last accepted step.
        failures: u32,
        /// Norm of the last estimated error, if there was an estimate.
        last_error_norm: Option<f64>,
        /// Cause of the last rejection.
        #[source]
        cause: Cause<E>,
    },
    /// `Options::max_steps` was reached.
    #[error(
        "{steps} steps ended at t = {t} (h = {h:.3e}), before t_end: raise max_steps or loosen the tolerance"
    )]
    TooManySteps {
        /// Time reached.
        t: f64,
        /// Number of accepted and rejected steps.
        steps: u64,
        /// Signed size of the next trial step.
        h: f64,
    },
    /// The value of the function whose zeros are events is NaN.
    #[error("the event function is not a number at t = {t}")]
    EventUndefined {
        /// The time.
        t: f64,
    },
    /// The extra evaluations for accurate output inside an accepted step failed.
    #[error("no output at t = {t}: {cause}")]
    OutputFailed {
        /// The output time.
        t: f64,
        /// Cause.
        #[source]
        cause: Cause<E>,
    },
}

/// An error, and the results that were reached before it.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{error}")]
pub struct Failure<E: Error + 'static> {
    /// The error.
    #[source]
    pub error: IntegrationError<E>,
    /// Time of the last accepted step, or t0.
    pub t: f64,
    /// State at this time.
    pub y: Vec<f64>,
    /// Statistics up to the failure.
    pub statistics: Statistics,
}
