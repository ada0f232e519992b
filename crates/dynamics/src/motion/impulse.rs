//! Where a drive changes its rate at once, an impulse of the constraints changes the velocities: by
//! the smallest change in the mass metric that the new rates allow. A drive that jumps itself would
//! need an infinite force and is refused.

use model::System;

use super::KeptRowMotion;
use crate::error::MotionFault;
use crate::events::{Event, EventKind};

/// Residuals below this share of the terms of their row, or for rates of the largest row, are no
/// jumps.
const NO_JUMP: f64 = 1e-9;

/// Between times that are so many roundings apart a continuous function changes much more than
/// between neighbouring ones: what remains of the wider change is a jump.
const WIDE: f64 = 1e6;
const REMAINS: f64 = 0.5;

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
    /// [`MotionFault::PositionJump`] if a constraint asks for another position; as
    /// [`super::Motion::project`].
    pub(crate) fn cross_break(
        &mut self,
        t: f64,
        q: &mut [f64],
        v: &mut [f64],
    ) -> Result<Option<Impulse>, MotionFault> {
        let mechanism = self.mechanism;
        let layout = mechanism.layout();
        // What a state misses already, where it is not projected, is no jump.
        let at = t.next_down();
        let [phi, rate] = self.change([at.next_down(), t], q, v);
        let wide = WIDE * f64::EPSILON * at.abs().max(f64::MIN_POSITIVE);
        let [phi_wide, rate_wide] = self.change([at - wide, at + wide], q, v);
        for i in 0..layout.m {
            let jump = phi[i].abs();
            let is_large = jump > NO_JUMP * mechanism.position_scale(&self.s, i)
                && mechanism.relative_to_reach(&self.s, i, self.size, jump) > NO_JUMP;
            if is_large && jump > REMAINS * phi_wide[i].abs() {
                return Err(MotionFault::PositionJump {
                    time: t,
                    row: layout.labels[i].clone(),
                    jump,
                });
            }
        }
        let sizes = (0..layout.rows()).map(|i| mechanism.velocity_scale(&self.s, i, v));
        let largest = sizes.fold(0.0, f64::max);
        let jumps = |&i: &usize| {
            rate[i].abs() > NO_JUMP * largest && rate[i].abs() > REMAINS * rate_wide[i].abs()
        };
        let Some(row) = (0..layout.rows()).find(jumps) else {
            return Ok(None);
        };
        let jump = -rate[row];
        let kinetic = mechanism.kinetic_energy(v);
        let iterations = self.settle(t, q)?;
        self.finish(v, iterations)?;
        self.passage.forget_entry();
        self.restart_code(t);
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

    /// By how much Φ and C·v − b of a state change from one time to another, where only functions
    /// of time change.
    fn change(&mut self, [from, to]: [f64; 2], q: &[f64], v: &[f64]) -> [Vec<f64>; 2] {
        let [phi_from, rate_from] = self.missed(from, q, v);
        let [mut phi, mut rate] = self.missed(to, q, v);
        for (to, from) in phi.iter_mut().zip(phi_from) {
            *to -= from;
        }
        for (to, from) in rate.iter_mut().zip(rate_from) {
            *to -= from;
        }
        [phi, rate]
    }

    /// Φ and C·v − b at a state.
    fn missed(&mut self, t: f64, q: &[f64], v: &[f64]) -> [Vec<f64>; 2] {
        let layout = self.mechanism.layout();
        self.mechanism.pose(t, q, &mut self.s);
        self.mechanism.phi(&mut self.s);
        self.mechanism.c(&mut self.s);
        self.evaluate_b();
        let rate = (0..layout.rows()).map(|i| layout.velocity_residual(&self.s, i, v));
        [self.s.phi.clone(), rate.collect()]
    }
}
