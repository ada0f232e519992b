//! The constraint manifold: moves q and v onto it and along it, and computes residuals. No other
//! module writes accepted coordinates and velocities, neither for kept rows nor for generated code.
//! Whether a step may end at a state is decided in [`crate::watch`].

mod coordinates;
mod dropped;
mod generated;
mod held;
mod levels;
mod newton;
mod project;

pub(crate) use coordinates::Origin;
pub use dropped::Correction;
pub(crate) use generated::CodeProjection;
pub(crate) use project::{Manifold, inspect};
