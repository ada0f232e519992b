//! Computes how strongly reactions depend on the data. If one point moves slightly, the module
//! computes the relative change of a component, of a component along any direction, of a sum or of
//! a moment. A component may be unique and nevertheless depend on the last digits of the data of a
//! drawing.
//!
//! The rank and the applied loads are constant. The equations `M·a + C_Kᵀ·λ = Q`, `C_K·a = Γ` then
//! depend on a point in three ways. The point has its own entries in C and Γ. The configuration
//! changes with the point so that `Φ_K = 0`. The velocities change so that `C_K·v = b`. For a
//! component `w(q, d)ᵀ·λ`, one solution y of the same symmetric equations with right-hand side (0,
//! w) gives the derivatives with respect to all points: `−y_aᵀ·δCᵀ·λ + y_λᵀ·(δΓ − δC·a) + δwᵀ·λ`.
//!
//! This estimate is of first order. Near a limit position, reactions grow faster. If the
//! independent rows are nearly dependent and the first-order change of a component is 1 % to 10 %,
//! the equations of the mechanism with the displaced point are also solved (module `displaced`).
//! The larger of the two changes is reported.
//!
//! Size and loads are those of a set of connected bodies. Therefore the result for a robot is the
//! same for the robot alone and in a fleet, even if springs couple it to other robots. The load of
//! a spring is constant. Therefore a stiff spring does not make a reaction sensitive that the
//! constraints determine well.
//!
//! Without any load, no reaction could change. In this case the result is computed for a load of 1
//! N on each body, in directions without symmetry, at rest and with equal masses. If a combination
//! of rows has the norm σ, its reactions are about 1/σ of this load. The reactions change by the
//! fraction moved/(σ·size).
//!
//! The module `numerical_rank` considers data whose uncertainty changes the rank.

mod by_sets;
mod displaced;
mod groups;
mod held;
mod instant;
mod joined;
mod number;
mod reactions;
#[cfg(test)]
mod tests;

pub use groups::GroupSensitivities;
pub use number::ReactionNumber;
pub use reactions::{ReactionSensitivities, Sensitivities};
