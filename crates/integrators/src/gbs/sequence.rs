//! The numbers of substeps and the weights of the extrapolation.
//!
//! The numbers 2, 6, 10, … differ by multiples of four, so that the middle of the step is reached after an odd number of substeps in
//! every column: errors of differences around it have then the same expansion, which dense output needs (HNW I, II.9). Without output
//! the sequence 2, 4, 6, … would need a quarter to a third less evaluations for the same error.

/// Columns there are.
pub(super) const COLUMNS: usize = 9;

/// n_j for j = 1, 2, …
pub(super) const fn substeps(j: usize) -> usize {
    4 * j - 2
}

/// Evaluations for columns 1 to j, the derivative at the end included.
pub(super) fn work(j: usize) -> f64 {
    (1 + (1..=j).map(|l| substeps(l) - 1).sum::<usize>()) as f64
}

/// Weights w of columns `first` to `last`: Σ w_j·c_j is the value at h = 0 of the polynomial in h² through the c_j at
/// h = 1/n_j: `w_j = Π_{l ≠ j} n_j² / (n_j² − n_l²)`. Weights of other columns are zero.
pub(super) fn weights(first: usize, last: usize) -> [f64; COLUMNS] {
    let mut w = [0.0; COLUMNS];
    for j in first..=last {
        let square = |l: usize| (substeps(l) * substeps(l)) as f64;
        w[j - 1] = (first..=last)
            .filter(|&l| l != j)
            .map(|l| square(j) / (square(j) - square(l)))
            .product();
    }
    w
}
