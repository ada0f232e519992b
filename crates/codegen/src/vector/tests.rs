//! Tests of frames: operations that need no rotation contain no rotation.

use symbolic::{Expr, Graph};

use crate::defined::{Along, Defined};

use super::{Components, Frame, Turn, Vector};

/// Two bodies, and the symbols of a vector in each frame.
struct Bodies {
    g: Graph,
    turns: Vec<Turn>,
    a: Components,
    b: Components,
}

fn bodies() -> Bodies {
    let mut g = Graph::new();
    let turns = ["i", "j"]
        .map(|slot| Turn::Plane {
            cos: g.symbol(&format!("cos_{slot}")),
            sin: g.symbol(&format!("sin_{slot}")),
            omega: g.symbol(&format!("omega_{slot}")),
        })
        .into();
    let a = ["a_x", "a_y"].map(|name| g.symbol(name)).to_vec();
    let b = ["b_x", "b_y"].map(|name| g.symbol(name)).to_vec();
    Bodies { g, turns, a, b }
}

fn plain_dot(g: &mut Graph, a: &[Expr], b: &[Expr]) -> Expr {
    let (x, y) = (g.mul(a[0], b[0]), g.mul(a[1], b[1]));
    g.add(x, y)
}

#[test]
fn a_product_in_one_frame_needs_no_rotation() {
    let Bodies { mut g, turns, a, b } = bodies();
    let (u, v) = (
        Vector::new(Frame::Body(0), a.clone()),
        Vector::new(Frame::Body(0), b.clone()),
    );
    let product = u.dot(&mut g, &v, &turns);
    assert_eq!(product, plain_dot(&mut g, &a, &b));
}

#[test]
fn of_a_sum_only_the_foreign_part_is_turned() {
    let Bodies { mut g, turns, a, b } = bodies();
    let own = Vector::new(Frame::Body(0), a.clone());
    let foreign = Vector::new(Frame::Body(1), b.clone());
    let sum = own.combine(&mut g, 1.0, &foreign, 1.0);
    let product = own.dot(&mut g, &sum, &turns);
    // a·a + (R_i·a)·(R_j·b)
    let (turned_a, turned_b) = (
        own.to_ground(&mut g, &turns),
        foreign.to_ground(&mut g, &turns),
    );
    let (same, across) = (
        plain_dot(&mut g, &a, &a),
        plain_dot(&mut g, &turned_a, &turned_b),
    );
    assert_eq!(product, g.add(across, same));
}

#[test]
fn the_components_in_the_own_frame_are_the_components() {
    let Bodies {
        mut g, turns, a, ..
    } = bodies();
    let v = Vector::new(Frame::Body(1), a.clone());
    assert_eq!(v.in_body(&mut g, 1, &turns), a);
}

#[test]
fn a_vector_of_a_body_turns_with_it() {
    let Bodies {
        mut g, turns, a, ..
    } = bodies();
    let still = Along::new(&g, &Defined::default(), &[], Vec::new());
    let rate = Vector::new(Frame::Body(0), a.clone()).rate(&mut g, &turns, &still);
    // ω·Ω·a in the same frame, Ω·(x, y) = (−y, x)
    let omega = g.symbol("omega_i");
    let (y, x) = (g.mul(omega, a[1]), g.mul(omega, a[0]));
    let expected = [g.neg(y), x];
    assert_eq!(rate.in_body(&mut g, 0, &turns), expected);
}

#[test]
fn a_vector_of_the_ground_has_the_rate_of_its_components() {
    let Bodies { mut g, turns, a, b } = bodies();
    let images = [(a[0], b[0]), (a[1], b[1])];
    let time = Along::new(&g, &Defined::default(), &images, Vec::new());
    let rate = Vector::new(Frame::Ground, a.clone()).rate(&mut g, &turns, &time);
    assert_eq!(rate.to_ground(&mut g, &turns), b);
}

#[test]
fn two_right_angles_turn_back() {
    let Bodies {
        mut g, turns, a, ..
    } = bodies();
    let twice = Vector::new(Frame::Body(0), a.clone())
        .perp(&mut g)
        .perp(&mut g);
    let expected: Components = a.iter().map(|&e| g.neg(e)).collect();
    assert_eq!(twice.in_body(&mut g, 0, &turns), expected);
}

#[test]
fn the_empty_vector_is_zero() {
    let Bodies {
        mut g, turns, a, ..
    } = bodies();
    let product = Vector::default().dot(&mut g, &Vector::new(Frame::Ground, a.clone()), &turns);
    assert!(g.is_zero(product));
}
