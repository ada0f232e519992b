//! The error of a solution relative to the exact solution.

use dynamics::{KeptRowMotion, PreparedMechanism};
use model::System;

use crate::stress::motion::worst;
use exact::Solution;

/// If an acceleration is below this fraction of the largest acceleration of the same body and kind,
/// the error is relative to this fraction of the largest acceleration.
const LEAST: f64 = 1e-3;

/// Errors of one solution.
pub(super) struct Errors {
    /// Largest error of accelerations. Each error is relative to the acceleration, or to a fraction
    /// of the largest acceleration of the same body and kind.
    pub(super) acceleration: f64,
    /// Error of the multipliers of independent rows, relative to the largest multiplier of the same
    /// joint.
    pub(super) multipliers: f64,
    /// The largest mass or moment of inertia divided by the smallest mass or moment of inertia.
    pub(super) spread: f64,
}

/// Computes all errors.
pub(super) fn errors(
    prepared: &PreparedMechanism,
    motion: &KeptRowMotion<'_>,
    (a, lambda): (&[f64], &[f64]),
    exact: &Solution,
) -> Errors {
    Errors {
        acceleration: of_accelerations(prepared, a, &exact.a),
        multipliers: of_multipliers(prepared, motion, lambda, &exact.lambda),
        spread: linalg::mass_spread(prepared.mechanism.mass()),
    }
}

/// Returns `x − y` relative to a size. If the size is zero, any nonzero difference becomes
/// infinite.
fn relative(x: f64, y: f64, size: f64) -> f64 {
    match x - y {
        0.0 => 0.0,
        missed => missed / size,
    }
}

/// Returns the largest size of the terms of accelerations, in units of the mechanism: Q/m, v²/L, or
/// the accelerations.
fn rate(prepared: &PreparedMechanism, exact: &[f64]) -> f64 {
    let mechanism = &prepared.mechanism;
    let unit = |j: usize| mechanism.space().unit(j, prepared.assembly.size);
    let terms = (0..exact.len()).map(|j| {
        let speed = prepared.v[j] / unit(j);
        let weight = match mechanism.mass()[j] {
            m if m > 0.0 => mechanism.weight()[j] / (m * unit(j)),
            _ => 0.0,
        };
        worst([exact[j] / unit(j), speed * speed, weight])
    });
    worst(terms)
}

/// Returns the largest error of accelerations. Each error is relative to the acceleration, or to a
/// fraction of the largest acceleration of the same body and kind.
pub(super) fn of_accelerations(prepared: &PreparedMechanism, a: &[f64], exact: &[f64]) -> f64 {
    let mechanism = &prepared.mechanism;
    let kind = |j: usize| {
        let body = mechanism.space().body_of(j);
        (body, mechanism.space().is_rotation(j))
    };
    let rate = rate(prepared, exact);
    worst((0..a.len()).map(|j| {
        let alike = (0..a.len()).filter(|&l| kind(l) == kind(j));
        let size = match worst(alike.map(|l| exact[l])) {
            0.0 => rate * mechanism.space().unit(j, prepared.assembly.size),
            largest => exact[j].abs().max(LEAST * largest),
        };
        relative(a[j], exact[j], size)
    }))
}

fn of_multipliers(
    prepared: &PreparedMechanism,
    motion: &KeptRowMotion<'_>,
    lambda: &[f64],
    exact: &[f64],
) -> f64 {
    let kept = &prepared.decision.kept;
    let force = worst(motion.scratch().force.iter().copied());
    worst(prepared.mechanism.layout().groups.iter().map(|group| {
        let of_group = || {
            kept.iter()
                .zip(exact)
                .filter(|(i, _)| group.rows.contains(**i))
        };
        let size = match worst(of_group().map(|(_, l)| *l)) {
            0.0 => force,
            largest => largest,
        };
        worst(of_group().map(|(&i, &l)| relative(lambda[i], l, size)))
    }))
}
