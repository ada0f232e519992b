//! Monitors of a motion: pivots, kept rows that become nearly dependent, singular passages, and
//! unreliable generated code. They check states at the ends of steps without changing them; the
//! result is a [`Next`]. Residuals of dropped rows are computed in [`crate::manifold`].

mod exchange;
mod handover;
mod judge;
mod passage;
mod pivots;
mod search;

pub(crate) use handover::Handover;
pub(crate) use judge::{Next, Watch};
pub(crate) use passage::Now;
pub(crate) use pivots::{are_delicate, are_worn};
pub(crate) use search::{Search, Singular};
