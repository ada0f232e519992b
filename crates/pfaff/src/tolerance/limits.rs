//! Limits for the number of samples and for their mechanism.

/// Largest number of rows: the rank of each sample is decided with dense matrices.
pub const ROWS_MAX: usize = 600;

/// A number of a sample is determined if the choice of load sharing among redundant rows changes it
/// by no more than this fraction. Numbers with smaller changes are unique within a tolerance, as in
/// verdicts.
pub(super) const SHARED: f64 = 1e-3;

/// Largest number of samples: all of them are stored in memory.
pub const SAMPLES_MAX: usize = 100_000;

/// Default number of samples: it determines the range of the middle nine tenths to some percent.
pub const SAMPLES: usize = 1000;
