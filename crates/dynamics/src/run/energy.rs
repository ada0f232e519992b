//! The energy balance of a run. The kinetic energy and the potential of the weight are compared
//! with the computed work.

use model::Mechanism;

use crate::limits::ENERGY_ROUNDINGS;

/// Energy at the start, and the largest error of the balance.
#[derive(Clone, Copy, Debug)]
pub(super) struct EnergyBalance {
    start: f64,
    largest_kinetic: f64,
    largest_gap: f64,
    /// Rounding error of the largest potential (J).
    rounding: f64,
}

impl EnergyBalance {
    /// Stores the energy at the start of a run.
    pub(super) fn new(mechanism: &Mechanism, q: &[f64], v: &[f64]) -> Self {
        let kinetic = mechanism.kinetic_energy(q, v);
        Self {
            start: kinetic + mechanism.potential_energy(q),
            largest_kinetic: kinetic,
            largest_gap: 0.0,
            rounding: 0.0,
        }
    }

    /// Adds a state on the constraint manifold and the work up to it (J).
    pub(super) fn note(&mut self, mechanism: &Mechanism, q: &[f64], v: &[f64], work: f64) {
        let kinetic = mechanism.kinetic_energy(q, v);
        let gap = kinetic + mechanism.potential_energy(q) - self.start - work;
        self.largest_kinetic = larger(self.largest_kinetic, kinetic);
        self.largest_gap = larger(self.largest_gap, gap.abs());
        self.rounding = larger(self.rounding, rounding(mechanism, q));
    }

    /// Returns the largest energy error (J). The result is zero for a motion at rest, for which the
    /// error is a rounding error.
    pub(super) fn largest_gap(&self) -> f64 {
        if self.largest_gap.max(self.largest_kinetic) <= self.rounding {
            0.0
        } else {
            self.largest_gap
        }
    }

    /// Returns the largest kinetic energy (J).
    pub(super) fn largest_kinetic(&self) -> f64 {
        self.largest_kinetic
    }
}

/// Returns the rounding error of the potential of the weight at q (J).
fn rounding(mechanism: &Mechanism, q: &[f64]) -> f64 {
    let space = mechanism.space();
    let of_body = |body: usize| -> f64 {
        let weights = &mechanism.weight()[space.translations_of(body)];
        let places = &q[space.coordinates(body)];
        let terms = weights.iter().zip(places);
        terms
            .map(|(w, x)| w.abs() * (x.abs() + mechanism.reach(body)))
            .sum()
    };
    let all: f64 = (0..mechanism.bodies().len()).map(of_body).sum();
    ENERGY_ROUNDINGS * f64::EPSILON * all
}

/// Returns the larger of two values. NaN counts as the largest value; it results from an
/// overflowing energy.
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// Returns an energy error relative to a kinetic energy, or zero if both are zero.
pub(super) fn relative(gap: f64, kinetic: f64) -> f64 {
    if gap > 0.0 || gap.is_nan() {
        gap / kinetic
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_balanced_is_not_balanced() {
        assert_eq!(larger(larger(1.0, 2.0), 0.5), 2.0);
        assert!(larger(larger(1.0, f64::NAN), 3.0).is_nan());
        // The energy ½·m·v² overflows: ∞ − ∞ is NaN.
        assert!(relative(f64::INFINITY - f64::INFINITY, f64::INFINITY).is_nan());
        assert_eq!(relative(0.0, 0.0), 0.0);
    }
}
