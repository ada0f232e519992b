//! Tests that a part has the same equations as in the whole mechanism.

use joints::{KnifeEdge, Revolute, RevoluteAngleDrive, SpringDamper};

use super::*;
use crate::{Body, Description, Drive, Force, Joint, System};

fn body(name: &str, x: f64) -> Body {
    Body {
        name: name.into(),
        mass: 1.0 + x,
        inertia: 0.1,
        position: [x, 0.5],
        angle: 0.2 * x,
        ..Body::default()
    }
}

/// Three mechanisms whose bodies alternate in the list: a driven crank, a sledge on a knife edge,
/// and two bodies with a spring.
fn scattered() -> Mechanism {
    let [crank, sledge, left, right] = [0, 1, 2, 3].map(BodyRef::Body);
    let pivot = Revolute {
        s_i: [0.0, 0.5],
        s_j: [0.0; 2],
    };
    let motor = RevoluteAngleDrive::new([0.0, 0.5], [0.0; 2]);
    let edge = KnifeEdge {
        s: [0.1, 0.0],
        normal: joints::Direction::Y,
    };
    let spring = SpringDamper::new([0.0; 2], [0.0; 2], 10.0, 1.0).with_free_length(0.5);
    let d = Description {
        gravity: [0.0, -9.81],
        bodies: vec![
            body("crank", 0.0),
            body("sledge", 1.0),
            body("left", 2.0),
            body("right", 3.0),
        ],
        joints: vec![
            Joint::new("edge", &[sledge], edge),
            Joint::new("pivot", &[BodyRef::Ground, crank], pivot),
        ],
        drives: vec![Drive {
            name: "motor".into(),
            bodies: vec![BodyRef::Ground, crank],
            element: Box::new(motor),
            motion: Function::steps(0.4, &[[1.0, 2.0, 3.0]]).expect("a step"),
            tolerance: None,
        }],
        forces: vec![Force {
            name: "spring".into(),
            bodies: vec![right, left],
            element: Box::new(spring),
            functions: Vec::new(),
        }],
        ..Description::default()
    };
    Mechanism::build(&d).expect("builds")
}

#[test]
fn parts_have_the_equations_of_the_whole() {
    let whole = scattered();
    let sets = whole.components();
    assert_eq!(sets, [vec![0], vec![1], vec![2, 3]]);
    let mut s = whole.scratch();
    let (q, _) = whole.described_state();
    let v: Vec<f64> = (0..12).map(|k| 0.3 - 0.1 * f64::from(k)).collect();
    let evaluate = |m: &Mechanism, s: &mut _, q: &[f64], v: &[f64]| {
        m.pose(1.5, q, s);
        m.phi(s);
        m.c(s);
        m.b(s);
        m.twist(v, s);
        m.gamma(s);
        m.force(s);
    };
    evaluate(&whole, &mut s, &q, &v);
    let c = whole.layout().dense(&s);
    let mut rows = Vec::new();
    for set in &sets {
        let Part {
            mechanism: part,
            places,
        } = whole.part(set);
        let pick =
            |x: &[f64], places: &[usize]| -> Vec<f64> { places.iter().map(|&k| x[k]).collect() };
        let mut own = part.scratch();
        let (q, v) = (pick(&q, &places.coordinates), pick(&v, &places.velocities));
        evaluate(&part, &mut own, &q, &v);
        let layout = part.layout();
        assert_eq!(layout.m + layout.h, places.rows.len());
        let m = places
            .rows
            .iter()
            .filter(|&&i| i < whole.layout().m)
            .count();
        assert_eq!(layout.m, m);
        assert_eq!(own.phi, pick(&s.phi, &places.rows[..m]));
        assert_eq!(own.b, pick(&s.b, &places.rows));
        assert_eq!(own.gamma, pick(&s.gamma, &places.rows));
        assert_eq!(own.force, pick(&s.force, &places.velocities));
        assert_eq!(part.mass(), pick(whole.mass(), &places.velocities));
        let dense = layout.dense(&own);
        for (i, &row) in places.rows.iter().enumerate() {
            assert_eq!(dense.row(i), pick(c.row(row), &places.velocities));
            assert_eq!(layout.labels[i], whole.layout().labels[row]);
        }
        for (k, &body) in places.bodies.iter().enumerate() {
            assert_eq!(part.reach(k), whole.reach(body));
        }
        rows.extend(places.rows);
    }
    rows.sort_unstable();
    assert_eq!(rows, [0, 1, 2, 3]);
    // Only the crank has a drive, so only the crank has break times.
    let breaks: Vec<usize> = sets
        .iter()
        .map(|b| whole.part(b).mechanism.layout().break_times.len())
        .collect();
    assert_eq!(breaks, [2, 0, 0]);
}
