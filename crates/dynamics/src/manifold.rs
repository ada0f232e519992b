//! The constraint manifold: moves q and v onto it, along it and back to it, and tells what they
//! miss. Nothing else writes accepted coordinates and velocities, neither on kept rows nor on
//! generated code. Not here: whether a step may end there ([`crate::watch`]).

mod coordinates;
mod dropped;
mod generated;
mod levels;
mod newton;
mod project;

pub(crate) use coordinates::Origin;
pub use dropped::Correction;
pub(crate) use generated::CodeProjection;
pub(crate) use project::{Manifold, inspect};
