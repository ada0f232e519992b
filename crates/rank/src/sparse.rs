//! Sparse constraint matrices: hundreds of thousands of rows, each with entries for a few bodies.
//!
//! The dense code of this crate gives the same results with more evidence. If each body has few
//! neighbours, the time of the sparse code grows with the number of bodies. The time grows linearly
//! for chains, and with the power 3/2 for plane lattices. The time also grows with the square of
//! the number of joints on a single body. A matrix that would take hours is rejected.

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
