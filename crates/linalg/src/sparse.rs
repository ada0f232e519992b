//! Sparse matrices by rows, and orders of elimination that keep them sparse.

mod matrix;
mod order;
mod tree;

pub use matrix::{SparseError, SparseMatrix};
pub use order::minimum_degree;
pub use tree::EliminationTree;
