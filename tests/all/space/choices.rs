//! Compares choices among loads in space with closed forms: a table on four legs, a door on three
//! hinges.

use model::System;
use pfaff::{RunOptions, Study};
use solvability::{Choice, Compliance, Distribution, NormWeights};

use crate::examples;

const G: f64 = 9.81;

/// Rounding of sums of about ten terms.
const CLOSE: f64 = 1e-11;

fn chosen(name: &str, choice: impl Fn(&Study) -> Choice) -> Distribution {
    let text = examples::read(&examples::scene(name));
    let registry = model::Registry::standard();
    let study = Study::read(name, &text, &registry, &RunOptions::default());
    let study = study.unwrap_or_else(|e| panic!("{name}: {e}"));
    let analysis = study.analyse(0.0, None).unwrap_or_else(|e| panic!("{e}"));
    let choice = choice(&study);
    let found = analysis.distribution(&choice);
    found.unwrap_or_else(|e| panic!("{name}, {choice:?}: {e}"))
}

fn elastic<const N: usize>(study: &Study, joints: [(&str, [f64; 3], f64); N]) -> Choice {
    let groups = &study.prepared.mechanism.layout().groups;
    let compliance = |(name, along, rotation): (&str, [f64; 3], f64)| Compliance {
        reaction: model::ConstraintId(groups.iter().position(|g| g.name == name).expect("a joint")),
        along,
        rotation,
    };
    Choice::Compliance(joints.map(compliance).to_vec().into())
}

/// Returns a component of a reaction on the body: the ground is the first body of all joints.
fn on_body(d: &Distribution, joint: &str, component: &str) -> f64 {
    let reaction = d.reactions.iter().find(|r| r.name == joint);
    let components = &reaction.expect("a joint").components;
    let found = components.iter().find(|(name, _)| *name == component);
    let value = &found.expect("a component").1;
    -value.in_solution().expect("finite reactions")
}

fn close(found: f64, expected: f64, size: f64, what: &str) {
    assert!(
        (found - expected).abs() < CLOSE * size,
        "{what}: {found} instead of {expected}"
    );
}

/// All loads that carry the weight W at (x, y) are W·(1 + x/X_k + y/Y_k)/4 + s·(±1) for legs at
/// (X_k, Y_k), with the signs of X_k·Y_k. The energy ½·Σ c·F² is least if Σ ± c·F = 0.
#[test]
fn a_table_on_elastic_legs() {
    let legs = [
        ("A", 0.6, 0.4),
        ("B", -0.6, 0.4),
        ("C", -0.6, -0.4),
        ("D", 0.6, -0.4),
    ];
    let (weight, place) = (12.0 * G, [0.2, 0.1]);
    let even = legs.map(|(_, x, y)| 0.25 * weight * (1.0 + place[0] / x + place[1] / y));
    let signs = [1.0, -1.0, 1.0, -1.0];
    for along_z in [[1e-6; 4], [1e-6, 2e-6, 5e-6, 3e-6], [0.0, 1e-6, 0.0, 0.0]] {
        let weighted = |x: [f64; 4]| (0..4).map(|k| signs[k] * along_z[k] * x[k]).sum::<f64>();
        let shift = -weighted(even) / weighted(signs);
        // Components that the legs do not carry have no effective compliance.
        let d = chosen("table", |study| {
            let leg = |k: usize| (legs[k].0, [7e-6, 8e-6, along_z[k]], 9e-6);
            elastic(study, [0, 1, 2, 3].map(leg))
        });
        for (k, (name, ..)) in legs.iter().enumerate() {
            let expected = even[k] + shift * signs[k];
            close(on_body(&d, name, "Fz"), expected, weight, name);
        }
    }
}

/// Hinges at the heights z_k relative to the middle carry the weight W with Fz. They carry its
/// moment about y, W·x for the centre x off their axis, with Fx and Ty:
///
/// | energy | Σ F = | least for |
/// | --- | --- | --- |
/// | ½·Σ c·Fz² | W | c·Fz equal |
/// | ½·Σ (c·Fx² + r·Ty²) | 0, Σ (z·Fx + Ty) = M | c·Fx = α + μ·z, r·Ty = μ |
///
/// The weight acts along −z at +x: its moment about y is +W·x, and the moment of the hinges is
/// −W·x. A norm with the arm L corresponds to c = 1, r = 1/L².
#[test]
fn a_door_on_three_hinges() {
    let (heights, weight, arm) = ([-0.75_f64, 0.0, 0.75], 20.0 * G, 0.4);
    let names = ["lower", "middle", "upper"];
    let cases: [(Option<f64>, [f64; 3], [f64; 3]); 4] = [
        (Some(1.0), [1.0; 3], [1.0; 3]),
        (Some(0.5), [1.0; 3], [4.0; 3]),
        (None, [1e-6, 2e-6, 3e-6], [1e-5, 3e-5, 2e-5]),
        (None, [4e-6, 1e-6, 1e-6], [1e-3, 1e-3, 1e-7]),
    ];
    for (length, c, r) in cases {
        let d = chosen("hinges", |study| match length {
            Some(length) => Choice::MinimumNorm(NormWeights::with_arm(length)),
            None => elastic(study, [0, 1, 2].map(|k| (names[k], [c[k]; 3], r[k]))),
        });
        let sum = |of: &dyn Fn(usize) -> f64| (0..3).map(of).sum::<f64>();
        // The conditions are Σ (α + μ·z)/c = 0 and Σ z·(α + μ·z)/c + Σ μ/r = M.
        let [s0, s1, s2] = [0, 1, 2].map(|n| sum(&|k| heights[k].powi(n) / c[k]));
        let turning = s2 - s1 * s1 / s0 + sum(&|k| r[k].recip());
        let mu = -weight * arm / turning;
        let alpha = -mu * s1 / s0;
        for (k, name) in names.iter().enumerate() {
            let vertical = weight / (c[k] * s0);
            close(on_body(&d, name, "Fz"), vertical, weight, name);
            let sideways = (alpha + mu * heights[k]) / c[k];
            close(on_body(&d, name, "Fx"), sideways, weight, name);
            close(on_body(&d, name, "Ty"), mu / r[k], weight, name);
        }
    }
}
