//! Limits for the number of samples and for the size of the mechanism.

/// Largest number of rows. The number is limited because the rank of each sample is decided with
/// dense matrices.
pub const ROWS_MAX: usize = 600;

/// A number of a sample counts as determined if the distribution of the loads over redundant rows
/// changes the number by at most this fraction. Such a number is unique within a tolerance, as in
/// verdicts.
pub(super) const SHARED: f64 = 1e-3;

/// Largest number of samples. All samples are in memory.
pub const SAMPLES_MAX: usize = 100_000;

/// Default number of samples. With this number, the range of the middle nine tenths is accurate to
/// some percent.
pub const SAMPLES: usize = 1000;
