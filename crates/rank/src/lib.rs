#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod circuits;
mod decision;
mod deletions;
mod dual;
mod limits;
mod null_space;
mod prime_field;
mod sparse;
mod strong_basis;
mod structure;
mod weakest;

pub use circuits::{Circuit, circuits, short_circuits};
pub use decision::{
    Accuracy, Certificate, CoefficientReading, Doubt, Evidence, ExactNullSpace, Grounds,
    KeptRowsError, NearlyRedundant, RankDecision, RankError, RankReading, RankStatus, Readings,
    Spectrum, carried, certify_exact, certify_rank, certify_within, decide, decide_dropping,
    decide_keeping, decide_of_rank, dropping_of_rank, promising_rows, with_dropped,
};
pub use deletions::{
    DeletionError, Limits, Substitutes, count_deletions, deletions, making_unique,
};
pub use limits::{
    BEYOND_DOUBT, COEFFICIENT_ROUNDING, HIDDEN, NEARLY_REDUNDANT, NEARLY_SINGULAR, NOISE_FACTOR,
    NOT_ROUNDING, SIGNIFICANT, STATED_ZERO,
};
pub use null_space::{
    Components, components, dependencies, open_rows, orthonormal, support_tolerance,
};
pub use sparse::{
    Sketch, SparseEvidence, SparsePattern, SparseRank, SparseRankError, decide_sparse,
};
pub use structure::{Part, RowGroup, Structure, StructureVerdict, cycles, structure};
pub use weakest::{WeakestCombination, weakest_combination};
