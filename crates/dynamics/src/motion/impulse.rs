//! Where a drive changes its rate at once, an impulse of the constraints changes the velocities: by the smallest change in the mass
//! metric that the new rates allow. A drive that jumps itself would need an infinite force and is refused.

use model::System;

use super::KeptRowMotion;
use crate::error::Trip;
use crate::events::{Event, EventKind};

/// Residuals below this share of the terms of their row, or for rates of the largest row, are no jumps.
const NO_JUMP: f64 = 1e-9;

/// What a jump of the rates has done.
pub(crate) struct Impulse {
    /// Work of the impulse (J).
    pub(crate) energy: f64,
    pub(crate) event: Event,
}

impl KeptRowMotion<'_> {
    /// Takes the velocities just behind a break time from those just before, at t just behind it.
    ///
    /// # Errors
    /// [`Trip::PositionJump`] if a constraint asks for another position; as [`super::Motion::project`].
    pub(crate) fn cross_break(
        &mut self,
        t: f64,
        q: &mut [f64],
        v: &mut [f64],
    ) -> Result<Option<Impulse>, Trip> {
        let mechanism = self.mechanism;
        let layout = mechanism.layout();
        mechanism.pose(t, q, &mut self.s);
        mechanism.phi(&mut self.s);
        mechanism.c(&mut self.s);
        for i in 0..layout.m {
            let (jump, size) = (self.s.phi[i].abs(), mechanism.position_scale(&self.s, i, q));
            if jump > NO_JUMP * size {
                return Err(Trip::PositionJump {
                    time: t,
                    row: layout.labels[i].clone(),
                    jump,
                });
            }
        }
        self.evaluate_b();
        let sizes = (0..layout.rows()).map(|i| mechanism.velocity_scale(&self.s, i, v));
        let largest = sizes.fold(0.0, f64::max);
        let jumps = |&i: &usize| layout.velocity_residual(&self.s, i, v).abs() > NO_JUMP * largest;
        let Some(row) = (0..layout.rows()).find(jumps) else {
            return Ok(None);
        };
        let jump = -layout.velocity_residual(&self.s, row, v);
        let kinetic = mechanism.kinetic_energy(v);
        let iterations = self.settle(t, q)?;
        self.finish(q, v, iterations)?;
        let energy = mechanism.kinetic_energy(v) - kinetic;
        let redundancy = self.velocity.dropped.len();
        let label = &layout.labels[row];
        let event = Event {
            time: t,
            kind: EventKind::Impulse,
            redundancy_before: redundancy,
            redundancy_after: redundancy,
            dropped: self.velocity.dropped.clone(),
            text: format!(
                "the rate of row {label} jumps by {jump:.6e}: an impulse changes the velocities at once, and the kinetic \
                 energy by {energy:.6e} J. Reactions are infinite for this instant and not written."
            ),
        };
        Ok(Some(Impulse { energy, event }))
    }
}
