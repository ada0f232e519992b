//! Record of a run: residuals, energy, pivots and events.

use model::Mechanism;

use super::energy::{self, EnergyBalance};
use super::summary::Summary;
use crate::events::Event;
use crate::guards::GUARDED;
use crate::manifold::Correction;

/// Statistics and events of a run so far.
pub(super) struct Record {
    energy: EnergyBalance,
    max_position_residual: f64,
    max_velocity_residual: f64,
    /// Number of quaternions that were scaled at accepted steps.
    pub(super) normalisations: u64,
    pub(super) min_pivot_ratio: f64,
    pub(super) events: Vec<Event>,
    /// Number of events that output rows already contain.
    pub(super) shown: usize,
    /// Whether the motion is unique at a singular configuration, by the number of dependent rows.
    pub(super) uniqueness: Vec<(usize, String)>,
}

impl Record {
    /// Creates the record at the start of a run.
    pub(super) fn new(mechanism: &Mechanism, q: &[f64], v: &[f64]) -> Self {
        Self {
            energy: EnergyBalance::new(mechanism, q, v),
            max_position_residual: 0.0,
            max_velocity_residual: 0.0,
            normalisations: 0,
            min_pivot_ratio: f64::INFINITY,
            events: Vec::new(),
            shown: 0,
            uniqueness: Vec::new(),
        }
    }

    /// Records residuals and energy of a state, and the work up to this state (J).
    pub(super) fn note(
        &mut self,
        mechanism: &Mechanism,
        (q, v, work): (&[f64], &[f64], f64),
        found: Correction,
    ) {
        if GUARDED {
            self.max_position_residual = self.max_position_residual.max(found.position_residual);
            self.max_velocity_residual = self.max_velocity_residual.max(found.velocity_residual);
            self.energy.note(mechanism, q, v, work);
        }
    }

    /// Removes and returns the recorded events.
    pub(super) fn take_events(&mut self) -> Vec<Event> {
        self.shown = 0;
        std::mem::take(&mut self.events)
    }

    /// Returns the recorded uniqueness at singular configurations with this number of dependent
    /// rows.
    pub(super) fn uniqueness_of(&self, dependent: usize) -> Option<&str> {
        let known = self.uniqueness.iter().find(|(d, _)| *d == dependent);
        known.map(|(_, words)| words.as_str())
    }

    /// Returns the summary, without the counts of the integrator.
    pub(super) fn summary(&self) -> Summary {
        let (gap, kinetic) = (self.energy.largest_gap(), self.energy.largest_kinetic());
        Summary {
            max_position_residual: self.max_position_residual,
            max_velocity_residual: self.max_velocity_residual,
            energy_balance: energy::relative(gap, kinetic),
            energy_gap: gap,
            largest_kinetic_energy: kinetic,
            normalisations: self.normalisations,
            min_pivot_ratio: self.min_pivot_ratio,
            events: self.events.clone(),
            ..Summary::default()
        }
    }
}
