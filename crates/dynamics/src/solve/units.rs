//! Units of a mechanism: lengths count in its size, rounded to a power of two, so that scaling
//! rounds nothing; and what sizes and masses say of the solutions.

use model::{Mechanism, System};

use crate::limits::FAR_FROM_A_METRE;

/// What each column of C counts in units of a mechanism of this size (m).
pub(super) fn units(mechanism: &Mechanism, size: f64) -> Vec<f64> {
    let exponents = mechanism.layout().dimension_scaling(size).cols;
    exponents.iter().map(|&e| f64::from(e).exp2()).collect()
}

/// Masses and moments of inertia in those units.
pub(super) fn mass_in_units(mechanism: &Mechanism, units: &[f64]) -> Vec<f64> {
    let mass = units.iter().zip(mechanism.mass());
    mass.map(|(unit, m)| unit * m * unit).collect()
}

/// Whether a mechanism of this size (m) is far larger or smaller than those of people: what is
/// added up then, weights and centrifugal terms, differs by many powers of ten as well.
pub(crate) fn is_far(size: f64) -> bool {
    !(1.0 / FAR_FROM_A_METRE..=FAR_FROM_A_METRE).contains(&size)
}

/// The largest mass divided by the smallest that is not zero, moments of inertia divided by the
/// square of the mechanism's size (m): the spread that decides whether solutions are refined.
pub(crate) fn mass_spread(mechanism: &Mechanism, size: f64) -> f64 {
    linalg::mass_spread(&mass_in_units(mechanism, &units(mechanism, size)))
}
