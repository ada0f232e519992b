#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod dd_matrix;
mod disjoint_sets;
mod eigen;
mod equilibrate;
mod jacobi;
#[cfg(feature = "faer")]
mod large;
mod limits;
mod lu;
mod mass;
mod matrix;
mod qr;
mod regularized;
mod saddle;
mod schur;
mod singular_values;
mod sparse;

pub mod double_double;
pub mod kernels;
pub mod powers;

pub use dd_matrix::DdMatrix;
pub use disjoint_sets::DisjointSets;
pub use double_double::Dd;
pub use eigen::{Eigenpair, ZeroEigenvalue, eigenpairs, zero_eigenvalue};
pub use equilibrate::{Scaling, equilibrate, equilibrate_blocks, equilibrate_sparse};
pub use jacobi::{SmallSvd, SymmetricEigen, small_svd, symmetric_eigen};
pub use limits::GRADED_MASSES;
pub use lu::{Determinant, Lu, SingularPivot};
pub use mass::{AddedMass, MassMatrix};
pub use matrix::{Matrix, ShapeError};
pub use qr::{PivotedQr, RowBasis};
pub use regularized::{DampedRows, StepError, least_squares_step};
pub use saddle::{KeptRowSaddle, Refinement, SaddleError, mass_spread};
pub use schur::{SchurSaddle, SchurStructure};
pub use singular_values::singular_values;
pub use sparse::{EliminationTree, SparseError, SparseMatrix, minimum_degree};
