//! How strongly numbers of reactions depend on the data: by what fraction a component, a direction,
//! a sum or a moment changes if one point moves slightly. A number may be unique and yet be
//! determined by the last digits of a drawing.
//!
//! With the rank and the applied loads held, `M·a + C_Kᵀ·λ = Q`, `C_K·a = Γ` change with a point
//! through its own entries in C and Γ, through the pose, which follows so that `Φ_K = 0`, and
//! through the velocities, which follow so that `C_K·v = b`. For a number `w(q, d)ᵀ·λ` one solution
//! y of the same symmetric equations with right-hand side (0, w) gives the change with respect to
//! all points at once: `−y_aᵀ·δCᵀ·λ + y_λᵀ·(δΓ − δC·a) + δwᵀ·λ`.
//!
//! That is first order. Near a limit position reactions grow faster: where the kept rows are nearly
//! dependent, and a number changes by 1 % to 10 % to first order, the mechanism with the displaced
//! point is solved (`displaced`), and the larger of both changes is told.
//!
//! Size and loads are those of a set of connected bodies: the result for a robot is the same alone
//! and in a fleet, even if springs couple it to others. The load of a spring does not change, so a
//! stiff spring makes no reaction fragile that the constraints determine well.
//!
//! Without any load no reaction could change. Then the result is computed for a load of 1 N on each
//! body, in directions without symmetry, at rest and with equal masses: a combination of rows of
//! norm σ has reactions of about 1/σ of it, which change by the fraction moved/(σ·size).
//!
//! Data whose uncertainty changes the rank itself are the subject of `numerical_rank`.

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
