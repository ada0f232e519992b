//! Sparse matrices by rows, and elimination orders that preserve their sparsity.

mod matrix;
mod order;
mod tree;

pub use matrix::{SparseError, SparseMatrix};
pub use order::minimum_degree;
pub use tree::EliminationTree;
