//! Tests of the continuation from a configuration: the rows that the continuation satisfies, and
//! its change with the data.

use joints::{Direction, KnifeEdge, Revolute, Translational};
use model::start::{assemble, scene_size};
use model::{Body, BodyRef, DataUnit, Description, Mechanism, StartOptions, System};

use super::*;

/// A continuation from the described positions of the bodies.
fn walked(description: &Description, kept: &[usize]) -> (Mechanism, Vec<f64>, Walk) {
    let mut mechanism = Mechanism::build(description).expect("it builds");
    let start = assemble(&mut mechanism, &StartOptions::default()).expect("it assembles");
    let q = start.q;
    let s = crate::pose::evaluated(&mechanism, 0.0, &q);
    let places: Vec<usize> = (0..mechanism.layout().rows()).collect();
    let question = Question {
        mechanism: &mechanism,
        s: &s,
        q: &q,
        places: &places,
        size: scene_size(&mechanism, &q),
    };
    let walk = walk(&question, kept);
    (mechanism, q, walk)
}

/// Two sliders of a tonne on the axes, connected by a rod of four metres and one gram. The middle
/// of the rod moves on a circle of two metres. After a step along the tangent there is a residual
/// that only the sliders can correct. With masses as weights, the correction would rotate the rod
/// instead of moving the sliders.
#[test]
fn a_long_arm_of_a_light_body_is_no_obstacle() {
    let (length, turn) = (4.0_f64, -0.7_f64);
    let [x, y] = [length * turn.cos(), -length * turn.sin()];
    let mut d = Description::new("trammel");
    let heavy = |name: &str, position: [f64; 2]| Body {
        position,
        ..Body::new(name, 1e3, 1e3)
    };
    let along = d.body(heavy("along x", [x, 0.0]));
    let up = d.body(heavy("along y", [0.0, y]));
    let rod = d.body(Body {
        position: [x / 2.0, y / 2.0],
        angle: turn,
        ..Body::new("rod", 1e-3, 1e-9)
    });
    for (name, slider, axis) in [("X", along, Direction::X), ("Y", up, Direction::Y)] {
        let guide = Translational::new([0.0; 2], [0.0; 2], axis);
        d.joint(name, &[BodyRef::Ground, slider], guide);
    }
    for (name, slider, end) in [("A", along, length / 2.0), ("B", up, -length / 2.0)] {
        let pin = Revolute {
            s_i: [0.0; 2],
            s_j: [end, 0.0],
        };
        d.joint(name, &[slider, rod], pin);
    }
    let (mechanism, _, walk) = walked(&d, &(0..8).collect::<Vec<_>>());
    assert_eq!(walk.reach(), [WALK_POSES; 2]);
    for (q, _) in (0..2).flat_map(|side| walk.poses(side)) {
        let s = crate::pose::evaluated(&mechanism, 0.0, q);
        let missed = s.phi.iter().fold(0.0_f64, |a, phi| a.max(phi.abs()));
        assert!(missed < 1e-13, "{missed:e}");
        let radius = q[6].hypot(q[7]);
        assert!((radius - length / 2.0).abs() < 1e-12, "{radius}");
    }
}

/// Two bodies with a hinge at (3, 1). Each body is on two knife edges whose normals intersect at
/// the origin. Both bodies rotate about the origin together, although no row constrains their
/// positions. If steps left the circles, the two centres would move away from each other and the
/// hinge would lock.
#[test]
fn what_edges_lead_stays_on_its_way() {
    let mut d = Description::new("carts");
    let hinge = [3.0, 1.0];
    let mut carts = Vec::new();
    for (k, at) in [[2.0, 0.5], [4.0, -1.0]].into_iter().enumerate() {
        let cart = d.body(Body {
            position: at,
            ..Body::new(["rear", "front"][k], 1.0, 1.0)
        });
        carts.push((cart, at));
        for (i, p) in [[1.0, 2.0 + k as f64], [-2.0, 1.0]].into_iter().enumerate() {
            let edge = KnifeEdge {
                s: [p[0] - at[0], p[1] - at[1]],
                normal: Direction::new(p).expect("a direction"),
            };
            d.joint(&format!("edge {k}{i}"), &[cart], edge);
        }
    }
    let local = |at: [f64; 2]| [hinge[0] - at[0], hinge[1] - at[1]];
    let pin = Revolute {
        s_i: local(carts[0].1),
        s_j: local(carts[1].1),
    };
    d.joint("hinge", &[carts[0].0, carts[1].0], pin);
    // Both rows of the hinge and three edges are kept. The row of the fourth edge follows from the
    // kept rows.
    let (_, start, walk) = walked(&d, &[0, 1, 2, 3, 4]);
    assert_eq!(walk.reach(), [WALK_POSES; 2]);
    for (q, _) in (0..2).flat_map(|side| walk.poses(side)) {
        let turned = q[2] - start[2];
        assert!(turned.abs() > 1e-3, "{turned:e}");
        assert!((q[5] - start[5] - turned).abs() < 1e-10);
        for (body, (_, at)) in carts.iter().enumerate() {
            let (sin, cos) = turned.sin_cos();
            let right = [cos * at[0] - sin * at[1], sin * at[0] + cos * at[1]];
            for (q, right) in q[3 * body..].iter().zip(right) {
                assert!((q - right).abs() < 1e-10, "{:e}", q - right);
            }
        }
    }
}

/// A cart on one edge moves straight ahead. If the direction of the edge or the cart at the start
/// is rotated by α, the cart is displaced sideways by s·α after s metres.
#[test]
fn what_the_data_make_of_the_way_adds_up() {
    let mut d = Description::new("cart");
    let cart = d.body(Body::new("cart", 1.0, 1.0));
    let edge = KnifeEdge {
        s: [0.0; 2],
        normal: Direction::Y,
    };
    d.joint("edge", &[cart], edge);
    let mechanism = Mechanism::build(&d).expect("it builds");
    let (mut q, _) = mechanism.described_state();
    let ground = Ground {
        mechanism: &mechanism,
        kept: &[0],
        units: &velocity_units(&mechanism, 1.0),
        size: 1.0,
        t: 0.0,
    };
    let mut way = Vec::new();
    for _ in 0..8 {
        let (there, step) = ground.flow(&q, vec![0.05, 0.0, 0.0]).expect("it continues");
        q = there;
        way.push(step);
    }
    assert!((q[0] - 0.4).abs() < 1e-14 && q[1].abs() < 1e-14, "{q:?}");
    let (mut pose, mut data) = (vec![0.0, 1.0, 0.0], vec![0.0; mechanism.data().count()]);
    for step in way.iter().rev() {
        step.carry_back(&mechanism, &mut pose, &mut data);
    }
    for (pose, right) in pose.iter().zip([0.0, 1.0, 0.4]) {
        assert!((pose - right).abs() < 1e-12, "{pose}");
    }
    let s = crate::pose::evaluated(&mechanism, 0.0, &q);
    for block in mechanism.data().blocks(&s) {
        let change = block.change(&data, 1.0);
        let right = if block.unit == DataUnit::Angle {
            0.4
        } else {
            0.0
        };
        assert!((change - right).abs() < 1e-12, "{}: {change}", block.name);
    }
}

#[test]
fn a_way_is_led_by_one_freedom_and_takes_the_others_along() {
    let way = mixed(&Matrix::identity(3), -1.0);
    assert_eq!(way[0], -1.0);
    assert!(way[1..].iter().all(|x| (-0.5..-0.1).contains(x)), "{way:?}");
}
