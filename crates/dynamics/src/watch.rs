//! Monitors of a motion. The monitors detect small pivots, independent rows that become
//! ill-conditioned, singular configurations, and unreliable generated code. The checks read the
//! states at the ends of steps without changing them; the result is a [`Next`]. The module
//! [`crate::manifold`] computes the residuals of redundant rows.
//!
//! If the rank drops for an instant, the accelerations are quotients whose numerator and
//! denominator both vanish. Let σ be the smallest pivot relative to its reference. A stage at a
//! distance δ from the constraints has an error of about δ/σ, and rounding causes an error of about
//! eps/σ². The run therefore predicts the singular configuration from the pivots, and places the
//! step so that the singular instant is in the widest gap between two stages
//! (`Ode::delicate_time`). The run moves stages near this instant onto the constraints before their
//! evaluation, and skips rows with vanished pivots in the solution. The run accepts the step only
//! if the correction is small relative to the distance of the branches, and if the velocities
//! continue the velocities before the step. Otherwise the run stops with an error. An accepted step
//! is reported as an event, with the second-order result on other branches.

mod code_switch;
mod exchange;
mod passage;
mod pivots;
mod search;
mod step_end;

pub(crate) use code_switch::CodeSwitch;
pub(crate) use passage::Now;
pub(crate) use pivots::{are_delicate, are_worn};
pub(crate) use search::{SearchResult, Singular, SingularitySearch};
pub(crate) use step_end::{Monitors, Next};
