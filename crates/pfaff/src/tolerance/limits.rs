//! How many samples are made, and of what.

/// Largest number of rows: the rank of each sample is decided with dense matrices.
pub const ROWS_MAX: usize = 600;

/// Largest number of samples: all of them are held in memory.
pub const SAMPLES_MAX: usize = 100_000;

/// Samples if no other number is asked for: the range of the middle nine tenths is known to some
/// percent.
pub const SAMPLES: usize = 1000;
