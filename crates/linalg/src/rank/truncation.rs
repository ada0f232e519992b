//! Where a locked rank is given up for one solve.
//!
//! The rank of a motion is decided once. At a singular configuration the decided rank is not there for an instant: a direction whose length
//! has fallen below [`TRUNCATION`] of what it was at the decision is left out of that solve. The value lies in the window in which every
//! measured passage kept the order of its integrator, 1e-3 … 1e-6; below it rounding takes over, above it ordinary configurations are mutilated.

/// Share of its length at the decision below which a direction is left out.
pub(crate) const TRUNCATION: f64 = 1e-6;

/// Share of the longest direction below which one is rounding: a locked rank that reaches it was decided of another matrix.
pub(crate) const ROUNDING: f64 = 16.0 * f64::EPSILON;
