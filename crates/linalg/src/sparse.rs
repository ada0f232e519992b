//! Sparse constraint matrices: hundreds of thousands of rows, each with entries of a few bodies.
//!
//! The dense code of this crate answers the same questions with more evidence; this one answers them in a time that grows with the
//! number of bodies. Not a sparse linear algebra library: there is what a rank needs, and no more.

mod matrix;
mod order;

pub use matrix::{SparseError, SparseMatrix};
pub use order::minimum_degree;
