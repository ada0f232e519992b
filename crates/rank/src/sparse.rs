//! Sparse constraint matrices: hundreds of thousands of rows, each with entries of a few bodies.
//!
//! The dense code of this crate answers the same questions with more evidence; this one answers
//! them in a time that grows with the number of bodies where each has few neighbours: linearly
//! along chains, with the power 3/2 on plane lattices, with the square of the joints that one body
//! has. What would take hours is refused.

mod factor;
mod front;
mod random;
mod rank;
mod reflectors;
mod sketch;
mod smallest;
mod symbolic;
mod trapezoid;

pub use rank::{SparseEvidence, SparsePattern, SparseRank, SparseRankError, decide_sparse};
pub use sketch::Sketch;
