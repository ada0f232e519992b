#![doc = include_str!("../README.md")]
//!
//! # Code map
//!
//! | module | content |
//! | --- | --- |
//! | [`cases`] | the list of cases |
//! | [`reference`](mod@reference) | named values at instants, and their accuracy |
//! | `table` | reference values as text |
//! | [`closed_forms`] | motions with a closed form |
//! | [`generate`] | scenes of any size, with their results |
//! | [`numbers`] | pseudo-random numbers, the same on every machine |

pub mod cases;
pub mod closed_forms;
pub mod generate;
pub mod numbers;
pub mod reference;
mod table;

pub use cases::{CHECKED, COMPARED, Case, ROBOT, all, find};
pub use reference::{Fact, Instant, Kind, Quantity, Reference, Trust};
