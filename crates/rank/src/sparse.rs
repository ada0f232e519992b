//! Sparse constraint matrices: hundreds of thousands of rows, each with entries for a few bodies.
//!
//! The dense code of this crate gives the same results with more evidence. The time of the sparse
//! code grows with the number of bodies if each has few neighbours: linearly along chains, with the
//! power 3/2 on plane lattices, with the square of the number of joints on a single body. A matrix
//! that would take hours is refused.

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
