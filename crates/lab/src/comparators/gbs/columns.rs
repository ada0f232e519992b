//! Number of substeps and work of the columns of the extrapolation.

/// Number of columns.
pub(super) const COLUMNS: usize = 9;

/// Returns n_j for j = 1, 2, …
pub(super) const fn substeps(j: usize) -> usize {
    2 * j
}

/// Returns the number of evaluations for columns 1 to j, including the derivative at the end.
pub(super) fn work(j: usize) -> f64 {
    (1 + (1..=j).map(|l| substeps(l) - 1).sum::<usize>()) as f64
}
