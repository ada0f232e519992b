//! The rank of the mechanism that is meant: its data are known to their rounding, or to a tolerance
//! that the scene states, and the rank is that of the data within what they are known to.
//!
//! | module | content |
//! | --- | --- |
//! | `matrix` | C without dimensions, with the forces and levers that are none set to zero, and one scale for each force and lever |
//! | `reading` | the rank of such a matrix |
//! | `share` | by what share of their uncertainty the data would have to be wrong for a lower rank |
//! | `near` | by how many metres, and the least rank within a stated tolerance |
//! | `pose` | how C changes with the data at one pose |
//! | `support` | which rows belong to a dependency beyond doubt |
//! | `walk` | other poses of the same mechanism |
//! | `follow` | how poses, and the way to them, follow the data |
//! | `cone` | the smallest change of data that satisfies equations |
//!
//! Not here: the proof in double-double (`certificate`), and what the rank means for reactions.

mod cone;
mod follow;
mod matrix;
mod near;
mod pose;
mod reading;
mod share;
mod support;
mod walk;

pub(crate) use matrix::MeantMatrix;
pub(crate) use near::Nearness;
pub(crate) use reading::Reading;
pub(crate) use share::Question;

#[cfg(test)]
mod tests;
