//! The watch over a motion: pivots, kept rows that become nearly dependent, singular passages, and
//! generated code that is not sure. It judges states at the ends of steps and changes none; what
//! comes next is a [`Next`]. Not here: what dropped rows miss ([`crate::manifold`]).

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
