//! Tests how formulations differ in reactions, drift and errors; the motion is the same.

use lab::comparators::{Comparator, Drift, Formulation, Method, run};
use lab::mechanisms::cranks::cranks;
use lab::mechanisms::robot::{robot, steering};
use model::System;

use crate::known::{gap, product, started};

/// Reactions of the robot that the model does not determine.
const NOT_UNIQUE: [&str; 6] = ["B", "C", "W1", "W2", "W3", "W4"];

fn way(formulation: Formulation, drift: Drift) -> Comparator {
    Comparator {
        formulation,
        method: Method::Dop853,
        drift,
    }
}

#[test]
fn unique_reactions_are_those_of_every_formulation() {
    let p = started(&robot(steering()));
    let times = [1.0, 3.0, 5.0, 7.0, 9.0];
    let rows = |formulation| {
        let found = run(&p, way(formulation, Drift::Projection), 1e-10, &times);
        found.expect("moves").rows
    };
    let kept = rows(Formulation::KeptRows);
    for formulation in Formulation::ALL {
        let mut largest = 0.0_f64;
        for (found, kept) in rows(formulation).iter().zip(&kept) {
            for (k, group) in p.mechanism.layout().groups.iter().enumerate() {
                let of = |r: &model::Reaction| [r.force[0], r.force[1], r.torque[2]];
                let gap = gap(&of(&found.reactions[k]), &of(&kept.reactions[k]));
                let unique = !NOT_UNIQUE.contains(&group.name.as_str());
                assert!(
                    !unique || gap < 1e-6,
                    "{formulation:?}: {} {gap:e}",
                    group.name
                );
                largest = largest.max(gap);
            }
        }
        let chooses = matches!(
            formulation,
            Formulation::MinimumNorm | Formulation::Proximal
        );
        assert!(!chooses || largest > 1.0, "{formulation:?}: {largest:e}");
    }
}

/// Without projection, states drift from the constraints. Baumgarte stabilisation reduces the
/// drift.
#[test]
fn drift_is_pulled_back() {
    let mut d = cranks(&[-0.8, 0.0, 0.8], 0.5, -1.0);
    d.gravity = [0.0, -9.81];
    let p = started(&d);
    let (q, _) = product(&p, 5.0, 1e-12);
    let opening = |drift| {
        let way = Comparator {
            method: Method::Dopri5,
            ..way(Formulation::KeptRows, drift)
        };
        let found = run(&p, way, 1e-7, &[5.0]).expect("moves").rows.remove(0);
        assert!(gap(&found.q, &q) < 1e-3);
        let mut s = p.mechanism.scratch();
        p.mechanism.pose(5.0, &found.q, &mut s);
        p.mechanism.phi(&mut s);
        s.phi.iter().fold(0.0_f64, |a, phi| a.max(phi.abs()))
    };
    let projected = opening(Drift::Projection);
    let pulled = opening(Drift::BAUMGARTE);
    let drifted = opening(Drift::None);
    assert!(projected < 1e-14, "{projected:e}");
    assert!(drifted > 1e-9 && drifted < 1e-3, "{drifted:e}");
    assert!(
        pulled > 1e-13 && pulled < 0.5 * drifted,
        "{pulled:e} {drifted:e}"
    );
}
