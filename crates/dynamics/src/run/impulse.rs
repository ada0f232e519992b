//! If the prescribed rate of a drive jumps, an impulse of the constraints changes the velocities.
//! The change is the smallest change in the mass metric that satisfies the new rates. A jump of the
//! prescribed position would need an infinite force and is rejected.
//!
//! The energy of the impulse is part of the energy balance and is reported as an event. Output rows
//! at a break time contain the values just before the break time.

use model::System;

use crate::error::MotionFault;
use crate::events::{Event, EventKind};
use crate::limits::{NO_JUMP, REMAINS, WIDE};
use crate::motion::KeptRowMotion;
use crate::solve::Evaluation;

/// Change of the motion at a jump of prescribed rates.
pub(crate) struct Impulse {
    /// Work of the impulse (J).
    pub(crate) energy: f64,
    /// Multipliers Λ of all rows (N·s, N·m·s), `M·(v⁺ − v⁻) + Cᵀ·Λ = 0`; zero for redundant rows.
    pub(crate) multipliers: Vec<f64>,
    pub(crate) event: Event,
}

/// Computes the velocities just after a break time from the velocities just before it. The time t
/// is just after the break time.
///
/// # Errors
/// Returns [`MotionFault::PositionJump`] if a constraint requires another position. Otherwise
/// returns the same errors as [`crate::KeptRowMotion::project`].
pub(super) fn cross_break(
    motion: &mut KeptRowMotion<'_>,
    t: f64,
    (q, v): (&mut [f64], &mut [f64]),
) -> Result<Option<Impulse>, MotionFault> {
    let at = &mut motion.equations.at;
    let (mechanism, layout) = (at.mechanism, at.mechanism.layout());
    // Residuals that a state without projection already has do not count as jumps.
    let before = t.next_down();
    let [phi, rate] = change(at, [before.next_down(), t], q, v);
    let wide = WIDE * f64::EPSILON * before.abs().max(f64::MIN_POSITIVE);
    let [phi_wide, rate_wide] = change(at, [before - wide, before + wide], q, v);
    for i in 0..layout.m {
        let jump = phi[i].abs();
        let is_large = jump > NO_JUMP * at.position_scale(i)
            && mechanism.scales(&at.s).relative_to_reach(i, at.size, jump) > NO_JUMP;
        if is_large && jump > REMAINS * phi_wide[i].abs() {
            let (time, row) = (t, at.label(i));
            return Err(MotionFault::PositionJump { time, row, jump });
        }
    }
    let sizes = (0..layout.rows()).map(|i| at.velocity_scale(i, v));
    let largest = sizes.fold(0.0, f64::max);
    let jumps = |&i: &usize| {
        rate[i].abs() > NO_JUMP * largest && rate[i].abs() > REMAINS * rate_wide[i].abs()
    };
    let Some(row) = (0..layout.rows()).find(jumps) else {
        return Ok(None);
    };
    let jump = -rate[row];
    let kinetic = mechanism.kinetic_energy(q, v);
    let v_before = v.to_vec();
    let KeptRowMotion {
        equations,
        manifold,
        watch,
        code,
    } = motion;
    let corrections = manifold.settle(equations, t, q)?;
    manifold.finish(equations, v, corrections)?;
    let change = v.iter().zip(v_before).map(|(v, before)| v - before);
    let change: Vec<f64> = change.collect();
    let multipliers = equations.velocity.impulses(&equations.at, &change)?;
    watch.passage.forget_entry();
    if let Some(code) = code {
        code.restart(equations, watch, t);
    }
    let energy = mechanism.kinetic_energy(q, v) - kinetic;
    let label = &layout.labels[row];
    let text = format!(
        "the rate of row {label} jumps by {jump:.6e}: an impulse changes the velocities instantly, and the kinetic energy by {energy:.6e} J. Reactions are infinite for this instant and not written."
    );
    let event = Event::at(t, EventKind::Impulse, &equations.velocity.dropped, text);
    Ok(Some(Impulse {
        energy,
        multipliers,
        event,
    }))
}

/// Returns the change of Φ and C·v − b for a fixed state between two times. Only functions of time
/// cause this change.
fn change(at: &mut Evaluation<'_>, times: [f64; 2], q: &[f64], v: &[f64]) -> [Vec<f64>; 2] {
    let [[phi_from, rate_from], [phi, rate]] = times.map(|t| {
        at.pose_and_phi(t, q);
        at.b();
        let rows = 0..at.mechanism.layout().rows();
        let rate = rows.map(|i| at.velocity_residual(i, v)).collect();
        [at.s.phi.clone(), rate]
    });
    let less =
        |to: Vec<f64>, from: Vec<f64>| to.iter().zip(from).map(|(to, from)| to - from).collect();
    [less(phi, phi_from), less(rate, rate_from)]
}
