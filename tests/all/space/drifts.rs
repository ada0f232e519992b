//! Long runs without drift of the energy or off the constraints. Longer runs are a family of
//! `lab stress`.

use dynamics::{Method, MotionOptions};
use lab::mechanisms::space::{bennett, bricard, top};
use model::SpatialDescription;

use super::motion::{options, run};

/// Bounds on the energy relative to the largest kinetic energy, and on |Φ| and |C·v − b| relative
/// to the size and the largest velocity.
const ENERGY: f64 = 1e-11;
const RESIDUAL: f64 = 1e-12;

fn stays(d: &SpatialDescription, t_end: f64) {
    let options = MotionOptions {
        output_step: t_end / 100.0,
        ..options(t_end, Method::Dop853, 1e-14)
    };
    let mut fastest = 1.0_f64;
    let found = run(d, &options, |_, row| {
        fastest = row.v.iter().fold(fastest, |a, v| a.max(v.abs()));
    });
    let name = &d.name;
    assert!(found.largest_kinetic_energy > 1.0, "{name} hardly moves");
    let numbers = [
        found.energy_balance,
        found.max_position_residual,
        found.max_velocity_residual,
    ];
    assert!(numbers[0] <= ENERGY, "{name}: {numbers:?}");
    assert!(numbers[1] <= RESIDUAL, "{name}: {numbers:?}");
    assert!(numbers[2] <= RESIDUAL * fastest, "{name}: {numbers:?}");
}

#[test]
fn a_top_does_not_drift() {
    stays(&top(), 2.0);
}

#[test]
fn bricards_linkage_does_not_drift() {
    stays(&bricard(), 20.0);
}

#[test]
fn bennetts_linkage_does_not_drift() {
    stays(&bennett().expect("a mechanism"), 20.0);
}
