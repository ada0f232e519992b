//! The calls of the libraries. All get the same right-hand side and the same tolerances, each with
//! its fast options, and without stored output.

pub mod with_differential_equations;
pub mod with_diffsol;
pub mod with_dynamics;
pub mod with_integrators;
