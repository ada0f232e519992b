//! Expressions that vanish because of an identity, and expressions that are only small.

use super::is_zero;
use crate::Kind;
use crate::elaborate::Model;
use crate::testing::{KNIFE_EDGE, model};

fn edge() -> Model {
    model(Kind::Constraint, KNIFE_EDGE).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn the_identity_of_pythagoras_is_seen() {
    let mut m = edge();
    let [.., cos, sin] = m.inputs.slots[0].pose[..] else {
        panic!("a planar pose")
    };
    let one = m.g.number(1.0);
    let (cc, ss) = (m.g.mul(cos, cos), m.g.mul(sin, sin));
    let e = m.g.sum(&[(1.0, cc), (1.0, ss), (-1.0, one)]);
    assert!(!m.g.is_zero(e), "the graph has no trigonometry");
    assert!(is_zero(&mut m.g, &m.inputs, e));
    let doubled = m.g.sum(&[(1.0, cc), (2.0, ss), (-1.0, one)]);
    assert!(!is_zero(&mut m.g, &m.inputs, doubled));
}

#[test]
fn directions_have_length_one() {
    let mut m = edge();
    let (x, y) = (m.inputs.values("normal")[0], m.inputs.values("normal")[1]);
    let one = m.g.number(1.0);
    let (xx, yy) = (m.g.mul(x, x), m.g.mul(y, y));
    let e = m.g.sum(&[(1.0, xx), (1.0, yy), (-1.0, one)]);
    assert!(is_zero(&mut m.g, &m.inputs, e));
    // A point may have any length.
    let (x, y) = (m.inputs.values("s")[0], m.inputs.values("s")[1]);
    let (xx, yy) = (m.g.mul(x, x), m.g.mul(y, y));
    let e = m.g.sum(&[(1.0, xx), (1.0, yy), (-1.0, one)]);
    assert!(!is_zero(&mut m.g, &m.inputs, e));
}

#[test]
fn the_unit_of_length_does_not_decide() {
    let mut m = edge();
    let angle = m.inputs.slots[0].pose[2];
    let small = m.g.product(1e-30, &[(angle, 1)]);
    assert!(!is_zero(&mut m.g, &m.inputs, small), "small is not zero");
    // 1e30·(cos² + sin² − 1) is zero, but rounding gives a value far from zero.
    let [.., cos, sin] = m.inputs.slots[0].pose[..] else {
        panic!("a planar pose")
    };
    let one = m.g.number(1.0);
    let (cc, ss) = (m.g.mul(cos, cos), m.g.mul(sin, sin));
    let e = m.g.sum(&[(1e30, cc), (1e30, ss), (-1e30, one)]);
    assert!(is_zero(&mut m.g, &m.inputs, e));
}

#[test]
fn quotients_and_roots_cancel_too() {
    let mut m = edge();
    let [x, y, ..] = m.inputs.slots[0].pose[..] else {
        panic!("a planar pose")
    };
    let (xx, yy) = (m.g.mul(x, x), m.g.mul(y, y));
    let square = m.g.add(xx, yy);
    let length = m.g.call(symbolic::Function::Sqrt, square);
    let (ux, uy) = (m.g.div(x, length), m.g.div(y, length));
    let (a, b, one) = (m.g.mul(ux, ux), m.g.mul(uy, uy), m.g.number(1.0));
    let e = m.g.sum(&[(1.0, a), (1.0, b), (-1.0, one)]);
    assert!(is_zero(&mut m.g, &m.inputs, e));
    assert!(!is_zero(&mut m.g, &m.inputs, ux));
}
