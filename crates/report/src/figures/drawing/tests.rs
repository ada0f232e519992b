//! Tests that figures and the scripts of pages draw a body in the same way for inertia tensors with
//! different products of inertia.

use joints::space3::{Axes, Pose, Revolute};
use model::{BodyRef, Marker, Mechanism, SpatialBody, SpatialDescription, System};
use serde_json::Value;

use super::{DrawingModel, Stage};
use crate::recording::Frame;

/// Figures use all digits, so only rounding errors remain.
const ROUNDING: f64 = 1e-12;

/// Curves of pages have 100 000 levels. Here centres of mass move by up to 1 m, so the error of a
/// centre is half a level of 1e-5 m. Components of a quaternion change by up to 2, so each of two
/// components has an error of 1e-5. The rotation error of an arm of 1 m is twice as large.
const PAGE: f64 = 0.5e-5 + 2.0 * 1.414 * 1e-5;

const DIAGONAL: [[f64; 3]; 3] = [[0.02, 0.0, 0.0], [0.0, 0.03, 0.0], [0.0, 0.0, 0.04]];

/// Tensors whose principal axes are the axes of the frame, nearly these axes, these axes in another
/// order, and rotated axes.
const TENSORS: [[[f64; 3]; 3]; 4] = [
    DIAGONAL,
    [[0.02, 0.0, 1e-19], [0.0, 0.03, 0.0], [1e-19, 0.0, 0.03]],
    [[0.03, 0.0, 0.0], [0.0, 0.02, 1e-19], [0.0, 1e-19, 0.04]],
    [
        [0.02, 0.004, 0.001],
        [0.004, 0.03, 0.002],
        [0.001, 0.002, 0.04],
    ],
];

/// Points of the first body in its frame: its centre of mass, both hinges and a marker.
const CENTRE: [f64; 3] = [0.5, 0.0, 0.0];
const TIP: [f64; 3] = [0.5, 0.3, 0.2];
const HINGE: [f64; 3] = [1.0, 0.0, 0.0];

/// An arm on a hinge about y, rotated by `turn` about this hinge, with a second arm.
fn arms(tensor: [[f64; 3]; 3], turn: f64) -> Mechanism {
    let mut d = SpatialDescription::new("arms");
    let (sin, cos) = (0.5 * turn).sin_cos();
    let body = |name: &str, position, inertia| SpatialBody {
        position,
        centre: CENTRE,
        orientation: [cos, 0.0, sin, 0.0],
        ..SpatialBody::new(name, 1.0, inertia)
    };
    let far = turned(turn, HINGE);
    let first = d.body(body("a", [0.0; 3], tensor));
    let second = d.body(body("b", far, DIAGONAL));
    let axis = Axes::new([0.0, 1.0, 0.0], None).expect("an axis");
    for (name, bodies, at) in [
        ("j", [BodyRef::Ground, first], [0.0; 3]),
        ("k", [first, second], far),
    ] {
        let [s_i, s_j] = bodies.map(|body| d.local(body, at));
        d.joint(name, &bodies, Revolute::new(s_i, s_j, axis, axis));
    }
    d.observed.markers.push(Marker::new("tip", first, TIP));
    Mechanism::build(&d).expect("builds")
}

/// A vector rotated about y.
fn turned(turn: f64, [x, y, z]: [f64; 3]) -> [f64; 3] {
    let (sin, cos) = turn.sin_cos();
    [cos * x + sin * z, y, cos * z - sin * x]
}

const TURNS: [f64; 3] = [0.0, 0.7, -2.1];

/// The drawing of a run with frames at three rotations.
fn drawn(tensor: [[f64; 3]; 3]) -> DrawingModel {
    let mechanism = arms(tensor, TURNS[0]);
    let frames = TURNS.map(|turn| {
        let q = arms(tensor, turn).described_state().0;
        Frame::at_rest(turn.abs(), &q, mechanism.layout().n_v)
    });
    let coordinates: Vec<usize> = (0..mechanism.layout().n_q).collect();
    let stage = Stage {
        mechanism: &mechanism,
        bodies: &[0, 1],
        coordinates: &coordinates,
        frames: &frames,
    };
    stage.drawing(&mechanism)
}

/// The values of a curve, as the scripts decode them.
fn decoded(curve: &Value) -> [f64; 3] {
    if let Some(x) = curve.as_f64() {
        return [x; 3];
    }
    let number = |x: &Value| x.as_f64().expect("a number");
    let mut level = 0.0;
    std::array::from_fn(|k| {
        level += number(&curve["d"][k]);
        number(&curve["o"]) + number(&curve["s"]) * level
    })
}

/// A point `{b, p}` of a page at a frame, as the scripts place it.
fn placed(page: &Value, point: &Value, frame: usize) -> [f64; 3] {
    let body = point["b"].as_i64().expect("a body");
    let p = [0, 1, 2].map(|k| point["p"][k].as_f64().expect("a number"));
    let Ok(body) = usize::try_from(body) else {
        return p;
    };
    let curve = |name: &str| decoded(&page["bodies"][body][name])[frame];
    let r = ["x", "y", "z"].map(curve);
    Pose::new(r, ["qw", "qx", "qy", "qz"].map(curve)).to_global(p)
}

fn assert_near(found: [f64; 3], expected: [f64; 3], bound: f64, what: &str) {
    let apart = (0..3).map(|k| (found[k] - expected[k]).abs());
    let apart = apart.fold(0.0, f64::max);
    assert!(apart <= bound, "{what}: {found:?} for {expected:?}");
}

#[test]
fn pages_place_the_points_of_bodies_with_products_of_inertia() {
    for tensor in TENSORS {
        let page = serde_json::to_value(drawn(tensor)).expect("serialises");
        for (frame, turn) in TURNS.into_iter().enumerate() {
            let at = |p| turned(turn, p);
            let near = |point: &Value, p, what| {
                assert_near(placed(&page, point, frame), at(p), PAGE, what);
            };
            near(&page["markers"][0], TIP, "marker");
            near(&page["sites"][0]["place"], [0.0; 3], "first hinge");
            near(&page["sites"][1]["place"], HINGE, "second hinge");
            // The corners of the hull of the first body are its hinges and its centre of mass.
            let outline = page["bodies"][0]["outline"].as_array().expect("a list");
            assert_eq!(outline.len(), 3);
            for corner in [[0.0; 3], CENTRE, HINGE] {
                let distance = |p: &Value| {
                    let point = serde_json::json!({ "b": 0, "p": p });
                    let found = placed(&page, &point, frame);
                    let expected = at(corner);
                    (0..3).map(|k| (found[k] - expected[k]).abs()).sum::<f64>()
                };
                assert!(outline.iter().map(distance).any(|d| d <= 3.0 * PAGE));
            }
            // The origin of the frame, whose path is drawn.
            let origin = serde_json::json!({ "b": 0, "p": page["bodies"][0]["frame"] });
            near(&origin, [0.0; 3], "origin");
            let axis = &page["sites"][1]["axis"];
            let body = axis["b"].as_i64().expect("a body");
            assert!(body >= 0, "the first of its bodies carries it");
            let along = serde_json::json!({ "b": body, "p": axis["p"] });
            let zero = serde_json::json!({ "b": body, "p": [0, 0, 0] });
            let [tip, foot] = [along, zero].map(|p| placed(&page, &p, frame));
            let axis = [0, 1, 2].map(|k| tip[k] - foot[k]);
            assert_near(axis, [0.0, 1.0, 0.0], PAGE, "axis");
        }
    }
}

#[test]
fn figures_place_the_points_of_bodies_with_products_of_inertia() {
    let expected = drawn(DIAGONAL);
    for tensor in TENSORS {
        let found = drawn(tensor);
        let near = |a: [f64; 2], b: [f64; 2]| {
            assert_near([a[0], a[1], 0.0], [b[0], b[1], 0.0], ROUNDING, "figure");
        };
        for (a, b) in found.sites.iter().zip(&expected.sites) {
            near(found.at(&a.place), expected.at(&b.place));
            near(
                found.axis(a).expect("an axis"),
                expected.axis(b).expect("an axis"),
            );
        }
        for (a, b) in found.markers.iter().zip(&expected.markers) {
            near(found.held(a.b, a.p), expected.held(b.b, b.p));
        }
        for body in [0, 1] {
            let [a, b] = [&found, &expected].map(|model| model.silhouette(body).0);
            let reach = |hull: &[[f64; 2]], k: usize, sign: f64| {
                let along = hull.iter().map(|p| sign * p[k]);
                along.fold(f64::NEG_INFINITY, f64::max)
            };
            for k in [0, 1] {
                let ends = [1.0, -1.0].map(|sign| [reach(&a, k, sign), reach(&b, k, sign)]);
                for [a, b] in ends {
                    assert!((a - b).abs() <= ROUNDING, "{a} for {b}");
                }
            }
        }
    }
}
