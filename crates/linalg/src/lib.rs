#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod circuits;
mod dd_matrix;
mod deletions;
mod dual;
mod equilibrate;
mod jacobi;
mod kernels;
#[cfg(feature = "faer")]
mod large;
mod lu;
mod matrix;
mod null_space;
mod prime_field;
mod qr;
mod rank;
mod regularized;
mod saddle;
mod schur;
mod singular_values;
mod sparse;
mod strong_basis;
mod structure;
mod weakest;

pub mod double_double;

pub use circuits::{Circuit, circuits, short_circuits};
pub use dd_matrix::DdMatrix;
pub use deletions::{
    DeletionError, Limits, Substitutes, count_deletions, deletions, making_unique,
};
pub use double_double::Dd;
pub use equilibrate::{Scaling, equilibrate, equilibrate_blocks, equilibrate_sparse};
pub use jacobi::{SmallSvd, small_svd};
pub use lu::{Lu, SingularPivot};
pub use matrix::{Matrix, ShapeError};
pub use null_space::{
    Components, components, dependencies, open_rows, orthonormal, support_tolerance,
};
pub use qr::PivotedQr;
pub use rank::{
    Certificate, CoefficientReading, Doubt, Evidence, ExactNullSpace, Grounds, KeptRowsError,
    NEARLY_REDUNDANT, NEARLY_SINGULAR, NearlyRedundant, RankDecision, RankError, RankReading,
    RankStatus, Readings, Uncertainty, certify_exact, certify_rank, certify_within, decide,
    decide_dropping, decide_keeping, promising_rows,
};
pub use regularized::{StepError, least_squares_step};
pub use saddle::{GRADED_MASSES, KeptRowSaddle, Refinement, SaddleError, mass_spread};
pub use schur::{SchurSaddle, SchurStructure};
pub use singular_values::singular_values;
pub use sparse::{
    Sketch, SparseError, SparseEvidence, SparseMatrix, SparsePattern, SparseRank, SparseRankError,
    decide_sparse, minimum_degree,
};
pub use structure::{Part, RowGroup, Settled, Structure, cycles, structure};
pub use weakest::{WeakestCombination, weakest_combination};
