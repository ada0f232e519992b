#![doc = include_str!("../README.md")]
//!
//! # Code map
//!
//! | module | content |
//! | --- | --- |
//! | `dyadic` | exact numbers `mantissa·2^exponent` |
//! | `elimination` | elimination without fractions |
//! | `solve` | accelerations and multipliers of the equations of motion |
//! | `rank` | rank, left null space, and uniqueness of multipliers and reactions |

mod dyadic;
mod elimination;
mod rank;
mod solve;

pub use dyadic::Dyadic;
pub use rank::Exact;
pub use solve::{Singular, Solution, solve};
