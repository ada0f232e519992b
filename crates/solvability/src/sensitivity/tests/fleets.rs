//! A machine has the same sensitivities alone, among other machines, at another position, and next
//! to bodies without a joint to it.

use joints::{PointOnLine, Revolute, RevoluteAngleDrive, SpringDamper};
use model::{Body, BodyRef, Description, Function, Mechanism, System};

use crate::value::Sensitivity;

/// Adds a driven crank with a rod whose end moves on an oblique line, at the given position and
/// with the given motion. Returns the crank.
fn add_machine(d: &mut Description, name: &str, [x, y]: [f64; 2], motion: &[f64]) -> BodyRef {
    let crank = d.body(Body {
        position: [x + 0.12, y + 0.08],
        angle: 0.6,
        ..Body::new(&format!("{name}.crank"), 2.0, 0.03)
    });
    let rod = d.body(Body {
        position: [x + 0.65, y + 0.1],
        angle: -0.2,
        ..Body::new(&format!("{name}.rod"), 1.5, 0.1)
    });
    let foot = Revolute {
        s_i: [x, y],
        s_j: [-0.15, 0.0],
    };
    let knee = Revolute {
        s_i: [0.15, 0.0],
        s_j: [-0.4, 0.0],
    };
    d.joint(
        &format!("{name}.A"),
        &[BodyRef::Ground, crank],
        foot.clone(),
    );
    d.joint(&format!("{name}.B"), &[crank, rod], knee);
    let line = joints::Line::new([x, y - 0.1], [x + 1.0, y + 0.1]).expect("a line");
    let end = PointOnLine {
        s: [0.4, 0.02],
        line,
    };
    d.joint(&format!("{name}.end"), &[rod], end);
    let motor = RevoluteAngleDrive::new(foot.s_i, foot.s_j);
    let motion = Function::polynomial(motion).expect("numbers");
    d.drive(
        &format!("{name}.motor"),
        &[BodyRef::Ground, crank],
        motor,
        motion,
    );
    crank
}

/// A spring between points of two bodies.
fn spring(s_i: [f64; 2], s_j: [f64; 2]) -> SpringDamper {
    SpringDamper::new(s_i, s_j, 500.0, 20.0).with_free_length(1.0)
}

/// The mechanism with coordinates and velocities at its start.
fn assembled(d: &Description) -> (Mechanism, Vec<f64>, Vec<f64>) {
    let mut mechanism = Mechanism::build(d).expect("it builds");
    let options = model::StartOptions {
        correction: model::start::CorrectionLimit::Any,
        ..model::StartOptions::default()
    };
    let start = model::start::assemble(&mut mechanism, &options).expect("it assembles");
    let rows: Vec<usize> = (0..mechanism.layout().rows()).collect();
    let given = mechanism.frames().given_velocities(&start.q);
    let v = model::start::consistent_velocity(&mechanism, &options, &start.q, &given, &rows);
    (mechanism, start.q, v.expect("no row is redundant").v)
}

/// Sensitivities of all reactions at the start.
fn started(d: &Description) -> Vec<Sensitivity> {
    let (mechanism, q, v) = assembled(d);
    super::known(&mechanism, 0.0, &q, &v)
}

/// Relative accuracy of an assembled start.
const ASSEMBLED: f64 = 1e-8;

fn agree(found: &[Sensitivity], alone: &[Sensitivity], what: &str) {
    for (k, (found, alone)) in found.iter().zip(alone).enumerate() {
        assert!(
            (found.change - alone.change).abs() <= ASSEMBLED * alone.change,
            "{what}, {k}: {found:?} {alone:?}"
        );
        assert_eq!(found.is_fragile(), alone.is_fragile(), "{what}");
        let name = |s: &Sensitivity| s.by.map(|by| (by.name, by.unit, by.is_number));
        assert_eq!(name(found), name(alone), "{what}");
    }
}

/// Cases: with weights and motion, and without load at rest.
const CASES: [([f64; 2], &[f64]); 2] = [([0.3, -9.81], &[0.0, 3.0, 4.0]), ([0.0; 2], &[0.0])];

#[test]
fn machines_of_a_fleet_are_asked_alone() {
    for (gravity, motion) in CASES {
        let fleet = |places: &[[f64; 2]]| {
            let mut d = Description::new("fleet");
            d.gravity = gravity;
            for (k, &at) in places.iter().enumerate() {
                add_machine(&mut d, &format!("m{k}"), at, motion);
            }
            d
        };
        let alone = started(&fleet(&[[0.0; 2]]));
        assert_eq!(alone.len(), 4);
        for n in [1, 2, 3, 10] {
            let places: Vec<[f64; 2]> = (0..n)
                .map(|k| [3.0 - 2.0 * f64::from(k), 1.5 * f64::from(k)])
                .collect();
            let mut d = fleet(&places);
            // A body without joints does not change the size or the load of others.
            d.body(Body {
                position: [50.0, 80.0],
                ..Body::new("stone", 1e6, 1e6)
            });
            // Joints come before drives.
            let found = started(&d);
            for k in 0..places.len() {
                let own = [3 * k, 3 * k + 1, 3 * k + 2, 3 * places.len() + k];
                let own = own.map(|i| found[i].clone());
                agree(&own, &alone, &format!("{k} of {n}"));
            }
        }
    }
}

/// A spring is a load: a spring to a neighbour is equivalent to a spring to a wall at the same
/// position.
#[test]
fn a_spring_to_a_neighbour_is_one_to_a_wall() {
    for (gravity, motion) in CASES {
        let mut two = Description::new("two");
        two.gravity = gravity;
        let first = add_machine(&mut two, "first", [0.0; 2], motion);
        let second = add_machine(&mut two, "second", [0.0, 2.0], &[0.0]);
        two.force("spring", &[first, second], spring([0.05, 0.0], [0.0; 2]));
        let neighbour = started(&two);
        // The wall is at the position of the second crank after assembly.
        let (_, q, _) = assembled(&two);
        two.forces.clear();
        let wall = spring([0.05, 0.0], [q[6], q[7]]);
        two.force("spring", &[first, BodyRef::Ground], wall);
        let wall = started(&two);
        for k in [0, 1, 2, 6] {
            agree(&neighbour[k..=k], &wall[k..=k], "first");
        }
    }
}
