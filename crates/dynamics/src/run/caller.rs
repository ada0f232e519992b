//! Functions of the caller that a run calls, and the error that the run returns.

use std::ops::ControlFlow;

use integrators::{Cause, IntegrationError};

use super::sample::Sample;
use crate::error::{MotionError, MotionFault};

/// Receives each row. It is a trait object. Therefore a run is compiled only once, and not for each
/// caller.
pub(super) type ShowRow<'r> =
    dyn FnMut(&mut Sample<'_, '_>) -> Result<ControlFlow<()>, MotionFault> + 'r;

/// Receives the time (s) of each accepted step of each component, and may end the run.
pub type Watch<'w> = dyn Fn(f64) -> ControlFlow<()> + Sync + 'w;

/// Returns whether the caller wants a run to end. All threads of a run call this function at each
/// evaluation, so that a run ends within a step. A call should cost no more than reading a flag.
pub type Stop<'w> = dyn Fn() -> bool + Sync + 'w;

/// Returns the cause of a collapsed step size as the error, if the cause is an error of this crate.
pub(super) fn named(error: IntegrationError<MotionFault>) -> MotionError {
    match error {
        IntegrationError::StepSizeCollapsed {
            cause: Cause::Problem(fault),
            ..
        }
        | IntegrationError::StartFailed {
            cause: Cause::Problem(fault),
            ..
        } => MotionError::Fault(fault),
        other => MotionError::Integration(Box::new(other)),
    }
}
