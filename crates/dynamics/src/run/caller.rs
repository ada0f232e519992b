//! What the caller of a run is asked and reported, and the error that it is given.

use std::ops::ControlFlow;

use integrators::{Cause, IntegrationError};

use super::sample::Sample;
use crate::error::{MotionError, MotionFault};

/// Receives each row. A trait object, so that a run is compiled once, here, and not for each
/// caller.
pub(super) type ShowRow<'r> =
    dyn FnMut(&mut Sample<'_, '_>) -> Result<ControlFlow<()>, MotionFault> + 'r;

/// Receives the time (s) of each accepted step of each component, and may end the run.
pub type Watch<'w> = dyn Fn(f64) -> ControlFlow<()> + Sync + 'w;

/// Whether the caller wants a run to end. Asked at each evaluation, by all threads of a run, so
/// that it is heard within a step; it should cost no more than reading a flag.
pub type Stop<'w> = dyn Fn() -> bool + Sync + 'w;

/// The cause behind a collapsed step, if it is ours.
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
