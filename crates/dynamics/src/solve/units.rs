//! Units of a mechanism: lengths are divided by its size, rounded to a power of two so that scaling
//! causes no rounding; and the sizes and masses that decide whether solutions are refined.

use model::{Mechanism, System};

use crate::limits::FAR_FROM_A_METRE;

/// The unit of each column of C for a mechanism of this size (m).
pub(super) fn units(mechanism: &Mechanism, size: f64) -> Vec<f64> {
    let exponents = mechanism.layout().dimension_scaling(size).cols;
    exponents.iter().map(|&e| f64::from(e).exp2()).collect()
}

/// Masses and moments of inertia in these units.
pub(super) fn mass_in_units(mechanism: &Mechanism, units: &[f64]) -> Vec<f64> {
    let mass = units.iter().zip(mechanism.mass());
    mass.map(|(unit, m)| unit * m * unit).collect()
}

/// The same where holonomic rows alone are solved: what only nonholonomic rows hold is free there,
/// and in the metric of a body without mass or inertia no correction of it would be the smallest.
/// So what has none gets the smallest value among those that have some, or 1.
pub(super) fn mass_of_positions(mechanism: &Mechanism, units: &[f64]) -> Vec<f64> {
    let mut mass = mass_in_units(mechanism, units);
    let some = mass.iter().copied().filter(|&m| m > 0.0);
    let smallest = some.reduce(f64::min).unwrap_or(1.0);
    for m in mass.iter_mut().filter(|m| **m == 0.0) {
        *m = smallest;
    }
    mass
}

/// Whether the size of a mechanism (m) is far from that of ordinary machines: then the terms that
/// are added up, such as weights and centrifugal terms, also differ by many powers of ten.
pub(crate) fn is_far(size: f64) -> bool {
    !(1.0 / FAR_FROM_A_METRE..=FAR_FROM_A_METRE).contains(&size)
}

/// The largest mass divided by the smallest non-zero one, with moments of inertia divided by the
/// square of the size of the mechanism (m). It decides whether solutions are refined.
pub(crate) fn mass_spread(mechanism: &Mechanism, size: f64) -> f64 {
    linalg::mass_spread(&mass_in_units(mechanism, &units(mechanism, size)))
}
