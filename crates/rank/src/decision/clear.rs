//! Decides whether values are certainly zero or certainly nonzero. The rule of rank decisions
//! requires a clear gap between the two cases. This module applies the rule to single values, and
//! to a few rows of a matrix that has already been equilibrated.

use super::{required, tolerance};
use crate::limits::{CLEARANCE, NOISE_MAX};
use linalg::{Matrix, singular_values};

/// Result of a comparison of a value with its error bound.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Size {
    /// The value is at most the noise, and the noise is at most 1e-4.
    Zero,
    /// The value is between the two limits, so the result is undecided.
    Unclear,
    /// The value exceeds the noise by the clearance of rank decisions, 10³.
    NonZero,
}

pub(crate) fn size(x: f64, noise: f64) -> Size {
    match x.abs() {
        x if x > CLEARANCE * noise => Size::NonZero,
        x if x <= noise && noise <= NOISE_MAX => Size::Zero,
        _ => Size::Unclear,
    }
}

/// Returns whether rows of an equilibrated matrix are certainly independent: `σ_min ≥ max(10³·τ,
/// 10⁻⁷)`. The rows are not equilibrated again. A second equilibration would enlarge entries that
/// are only rounding relative to the rest of their row or column.
pub(crate) fn independent(rows: &Matrix, uncertainty: f64) -> bool {
    let tolerance = tolerance(rows.nrows(), rows.ncols(), uncertainty);
    rows.nrows() <= rows.ncols()
        && singular_values(rows)
            .last()
            .is_none_or(|&smallest| smallest >= required(tolerance))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A value counts as nonzero only if it exceeds its noise by 10³. If the noise is above 1e-4,
    /// no value counts as zero.
    #[test]
    fn a_number_counts_a_thousand_times_above_its_noise() {
        assert_eq!(size(1.2e-6, 1e-9), Size::NonZero);
        assert_eq!(size(0.8e-6, 1e-9), Size::Unclear);
        assert_eq!(size(1e-5, 0.8e-4), Size::Zero);
        assert_eq!(size(1e-5, 1.2e-4), Size::Unclear);
    }
}
