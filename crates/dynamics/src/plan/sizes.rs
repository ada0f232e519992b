//! Sizes of a component.

use model::System;

use crate::prepare::PreparedMechanism;

/// Sizes of a component.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sizes {
    /// Number of bodies.
    pub bodies: usize,
    /// Number of velocities n_v.
    pub velocities: usize,
    /// Number of holonomic rows m.
    pub holonomic: usize,
    /// Number of nonholonomic rows h.
    pub nonholonomic: usize,
    /// Rank r of C.
    pub rank: usize,
}

impl Sizes {
    pub(super) fn of(prepared: &PreparedMechanism) -> Self {
        let layout = prepared.mechanism.layout();
        Self {
            bodies: prepared.mechanism.bodies().len(),
            velocities: layout.n_v,
            holonomic: layout.m,
            nonholonomic: layout.h,
            rank: prepared.decision.rank,
        }
    }

    /// Returns the number of all rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.holonomic + self.nonholonomic
    }

    /// Returns the degrees of freedom n_v − r.
    #[must_use]
    pub fn mobility(&self) -> usize {
        self.velocities - self.rank
    }

    /// Returns the degree of redundancy m + h − r.
    #[must_use]
    pub fn redundancy(&self) -> usize {
        self.rows() - self.rank
    }
}
