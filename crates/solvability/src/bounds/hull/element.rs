//! The components of loads, and the criterion for zero.

use crate::limits::{CLEAR_MINOR, CLEAR_OF_ZERO, ZERO_MINOR};

/// A component of a load: `value + row·y` for the solution `λ₀ + Z·y`.
#[derive(Clone, Debug)]
pub(in super::super) struct Element {
    /// The load to which the component belongs. Components of one load are consecutive.
    pub(in super::super) group: usize,
    /// Coefficients of y.
    pub(in super::super) row: Vec<f64>,
    /// Value for λ₀.
    pub(in super::super) value: f64,
}

/// The criterion for zero.
#[derive(Clone, Copy)]
pub(super) struct Zero {
    /// Numbers up to this size are zero.
    pub(super) zero: f64,
    /// Numbers from this size on are certainly not zero.
    clear: f64,
}

impl Zero {
    pub(super) fn new(tolerance: f64) -> Self {
        Self {
            zero: ZERO_MINOR.max(tolerance),
            clear: CLEAR_MINOR.max(CLEAR_OF_ZERO * tolerance),
        }
    }

    /// Returns whether a number of a load is zero.
    pub(super) fn holds(self, x: f64, group: usize) -> Result<bool, HullError> {
        match x.abs() {
            x if x <= self.zero => Ok(true),
            x if x < self.clear => Err(HullError::Unclear { group }),
            _ => Ok(false),
        }
    }
}

/// Reason why there is no hull.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in super::super) enum HullError {
    /// It is undecided whether components of this load may be zero together with other components.
    Unclear { group: usize },
    /// It is not clear whether one-sided joints press.
    Limits,
    /// There are too many sets.
    Many,
    /// No component depends on `free` of the coordinates y.
    Free { free: usize },
}
