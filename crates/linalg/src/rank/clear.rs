//! Zero or not, with a clear gap between: the rule of rank decisions for single numbers, and for a few rows of a matrix that is
//! equilibrated already.

use super::{CLEARANCE, NEARLY_SINGULAR, NOISE_FACTOR};
use crate::{Matrix, singular_values};

/// How a number reads against its noise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Size {
    /// At most the noise.
    Zero,
    /// Between: neither may be built on.
    Unclear,
    /// Above the noise by the clearance of rank decisions, 10³.
    NonZero,
}

pub(crate) fn size(x: f64, noise: f64) -> Size {
    match x.abs() {
        x if x > CLEARANCE * noise => Size::NonZero,
        x if x <= noise => Size::Zero,
        _ => Size::Unclear,
    }
}

/// Whether rows of an equilibrated matrix are certainly independent, as they stand: `σ_min ≥ max(10³·τ, 10⁻⁷)`. They are not
/// equilibrated again, because that would blow up entries that are rounding beside the rest of their row or column.
pub(crate) fn independent(rows: &Matrix, constraint_residual: f64) -> bool {
    let (m, n) = (rows.nrows(), rows.ncols());
    let noise = f64::EPSILON * (m as f64 * n as f64).sqrt();
    let tolerance = NOISE_FACTOR * noise.max(constraint_residual);
    m <= n
        && singular_values(rows)
            .last()
            .is_none_or(|&smallest| smallest >= (CLEARANCE * tolerance).max(NEARLY_SINGULAR))
}
