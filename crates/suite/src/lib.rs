#![doc = include_str!("../README.md")]
//!
//! # Code map
//!
//! | module | content |
//! | --- | --- |
//! | [`cases`] | which cases there are |
//! | [`reference`](mod@reference) | named values at instants, and how far to trust them |
//! | `table` | reference values as text |
//! | [`closed_forms`] | motions that elementary functions describe |

pub mod cases;
pub mod closed_forms;
pub mod reference;
mod table;

pub use cases::{CHECKED, COMPARED, Case, all, find};
pub use reference::{Fact, Instant, Kind, Quantity, Reference, Trust};
