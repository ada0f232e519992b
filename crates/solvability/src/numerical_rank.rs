//! The rank of the intended mechanism: the data are uncertain by their rounding, or by a tolerance
//! that the scene states, and the rank is the lowest that data within this uncertainty have.
//!
//! | module | content |
//! | --- | --- |
//! | `matrix` | C without dimensions; forces and levers within their uncertainty are set to zero |
//! | `reading` | the rank of such a matrix |
//! | `share` | change of the data for a lower rank, as a fraction of their uncertainty |
//! | `near` | the same change in metres, and the least rank within a stated tolerance |
//! | `pose` | how C changes with the data at one pose |
//! | `support` | which rows certainly belong to a dependency |
//! | `walk` | other poses of the same mechanism |
//! | `follow` | how poses, and the path to them, change with the data |
//! | `cone` | the smallest change of data that satisfies equations |
//!
//! The proof in double-double is in `certificate`. This module does not say what the rank means for
//! reactions.

mod cone;
mod follow;
mod matrix;
mod near;
mod pose;
mod reading;
mod share;
mod support;
mod walk;

pub(crate) use matrix::UncertainMatrix;
pub(crate) use near::Nearness;
pub(crate) use reading::Reading;
pub(crate) use share::Question;

#[cfg(test)]
mod tests;
