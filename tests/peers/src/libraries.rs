//! How each library is called: the same right-hand side, the same tolerances, its fast options,
//! without stored output.

pub mod with_differential_equations;
pub mod with_diffsol;
pub mod with_dynamics;
pub mod with_integrators;
