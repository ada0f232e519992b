//! Monitors of a motion: pivots, kept rows that become nearly dependent, singular passages, and
//! unreliable generated code. They check states at the ends of steps without changing them; the
//! result is a [`Next`]. Residuals of dropped rows are computed in [`crate::manifold`].

mod code_switch;
mod exchange;
mod passage;
mod pivots;
mod search;
mod step_end;

pub(crate) use code_switch::CodeSwitch;
pub(crate) use passage::Now;
pub(crate) use pivots::{are_delicate, are_worn};
pub(crate) use search::{Singular, SingularitySearch};
pub(crate) use step_end::{Monitors, Next};
