//! Decides the rank of the intended mechanism. The uncertainty of the data is their rounding, or a
//! tolerance that the scene states. The rank is the lowest rank of all data within this
//! uncertainty.
//!
//! | module | content |
//! | --- | --- |
//! | `matrix` | dimensionless C, in which forces and levers within their uncertainty are set to zero |
//! | `reading` | the rank of such a matrix |
//! | `share` | change of the data for a lower rank, as a fraction of their uncertainty |
//! | `near` | this change in metres, and the lowest rank within a stated tolerance |
//! | `pose` | the changes of C with the data at one configuration |
//! | `support` | the rows that certainly belong to a dependency |
//! | `walk` | other configurations of the same mechanism |
//! | `follow` | changes of configurations, and of the paths to them, with the data |
//! | `cone` | the smallest change of data that satisfies equations |
//!
//! The module `certificate` contains the proof in double-double. This module does not determine
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
