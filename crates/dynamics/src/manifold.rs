//! The constraint manifold. This module moves q and v onto the manifold and along it, and computes
//! residuals. No other module writes accepted coordinates and velocities, neither for independent
//! rows nor for generated code. The module [`crate::watch`] decides whether a step may end at a
//! state.

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
