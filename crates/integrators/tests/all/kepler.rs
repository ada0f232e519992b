//! A Kepler ellipse: a closed orbit of known period, known energy and angular momentum.

use crate::problems::{distance, kepler, run_function};
use pfaff_integrators::{Options, Outcome};
use std::f64::consts::TAU;

/// Eccentricity 0.5 and semi-major axis 1 give the period 2π; the start is at the pericentre.
const ECCENTRICITY: f64 = 0.5;

fn orbit(tolerance: f64) -> Outcome {
    let options = Options::with_tolerance(tolerance, tolerance);
    run_function(kepler, (0.0, TAU), &start(), &options)
}

fn start() -> [f64; 4] {
    let e = ECCENTRICITY;
    [1.0 - e, 0.0, 0.0, ((1.0 + e) / (1.0 - e)).sqrt()]
}

/// Snapshots of runs: rtol = atol, evaluations, accepted, rejected, error at the end after one
/// period (rounded up).
const SNAPSHOTS: [(f64, u64, u64, u64, f64); 3] = [
    (1e-6, 236, 32, 7, 2.4e-4),
    (1e-9, 692, 115, 0, 2.0e-7),
    (1e-12, 2714, 452, 0, 1.2e-10),
];

#[test]
fn orbit_closes_at_recorded_cost() {
    for (tolerance, evaluations, accepted, rejected, error) in SNAPSHOTS {
        let end = orbit(tolerance);
        let s = end.statistics;
        let found = distance(&end.y, &start());
        let counts = (s.evaluations, s.accepted, s.rejected());
        assert_eq!(
            counts,
            (evaluations, accepted, rejected),
            "tolerance {tolerance}, error {found:.2e}"
        );
        assert!(found < error, "tolerance {tolerance}: error {found:.3e}");
    }
}

#[test]
fn invariants_are_kept_to_the_tolerance() {
    let y = orbit(1e-10).y;
    let energy = 0.5 * (y[2] * y[2] + y[3] * y[3]) - 1.0 / y[0].hypot(y[1]);
    let momentum = y[0] * y[3] - y[1] * y[2];
    // The conserved quantities are E = −1/(2a) and L = √(1 − e²); the run has some hundred steps
    // with an error of 1e-10 each.
    assert!((energy + 0.5).abs() < 1e-8, "{energy}");
    assert!(
        (momentum - (1.0 - ECCENTRICITY * ECCENTRICITY).sqrt()).abs() < 1e-8,
        "{momentum}"
    );
}
