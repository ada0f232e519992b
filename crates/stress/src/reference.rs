//! What is right, in exact arithmetic: an `f64` is a whole number times a power of two, so that what is asked of a matrix of them has one
//! answer. Shares no code and no idea with the crates that are judged by it: no floating point, no prime field, no singular value.
//!
//! | module | content |
//! | --- | --- |
//! | `dyadic` | numbers `mantissa·2^exponent` |
//! | `elimination` | elimination without fractions |
//! | `solve` | accelerations and multipliers of the equations of motion |
//! | `rank` | rank, left null space, and the verdicts that follow from it |

mod dyadic;
mod elimination;
mod rank;
mod solve;

pub use dyadic::Dyadic;
pub use rank::Exact;
pub use solve::{Singular, Solution, solve};
