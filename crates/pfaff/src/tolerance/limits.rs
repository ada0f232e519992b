//! How many samples are made, and of what.

/// Largest number of rows: the rank of each sample is decided with dense matrices.
pub const ROWS_MAX: usize = 600;

/// A number of a sample is determined if the choice how redundant rows share loads changes it by
/// no more than this share of them: what changes less is unique within a tolerance, as in
/// verdicts.
pub(super) const SHARED: f64 = 1e-3;

/// Largest number of samples: all of them are held in memory.
pub const SAMPLES_MAX: usize = 100_000;

/// Samples if no other number is asked for: the range of the middle nine tenths is known to some
/// percent.
pub const SAMPLES: usize = 1000;
