//! The balance of energy of a run: kinetic energy and potential of the weight against the work that was measured.

use model::Mechanism;

/// Energy at the start, and how far the balance has been off.
#[derive(Clone, Copy, Debug)]
pub(super) struct EnergyBalance {
    start: f64,
    largest_kinetic: f64,
    largest_gap: f64,
}

impl EnergyBalance {
    /// At the start of a run.
    pub(super) fn new(mechanism: &Mechanism, q: &[f64], v: &[f64]) -> Self {
        let kinetic = mechanism.kinetic_energy(v);
        Self {
            start: kinetic + mechanism.potential_energy(q),
            largest_kinetic: kinetic,
            largest_gap: 0.0,
        }
    }

    /// Takes a state on the constraints and the work until then (J).
    pub(super) fn note(&mut self, mechanism: &Mechanism, q: &[f64], v: &[f64], work: f64) {
        let kinetic = mechanism.kinetic_energy(v);
        let gap = kinetic + mechanism.potential_energy(q) - self.start - work;
        self.largest_kinetic = self.largest_kinetic.max(kinetic);
        self.largest_gap = self.largest_gap.max(gap.abs());
    }

    /// The largest gap (J).
    pub(super) fn largest_gap(&self) -> f64 {
        self.largest_gap
    }

    /// The largest kinetic energy (J).
    pub(super) fn largest_kinetic(&self) -> f64 {
        self.largest_kinetic
    }
}

/// A gap relative to a kinetic energy; none is none.
pub(super) fn relative(gap: f64, kinetic: f64) -> f64 {
    match gap > 0.0 || gap.is_nan() {
        true => gap / kinetic,
        false => 0.0,
    }
}
