//! Wheels and knife edges. If the normals meet in a point, the body can rotate about this point; if
//! the normals are parallel, the body can slide.

use super::super::drawing::{GROUND, Side, Tie, Vector, along};
use super::super::ratio::Ratio;
use super::pen::Pen;

pub(super) fn edges(pen: &mut Pen<'_>) {
    let n = if pen.once_in(3) { 2 } else { 1 };
    // Knife edges on a single body have constant relative positions.
    pen.drawing.has_constant_rank = n == 1;
    let mut before = GROUND;
    for k in 0..n {
        let body = pen.body();
        if k > 0 {
            let at = pen.point();
            pen.hinge([before, body], at);
        }
        match pen.numbers.below(4) {
            0 => at_angles_of_the_hexagon(pen, body),
            1 => parallel_edges(pen, body),
            _ => concurrent_edges(pen, body),
        }
        before = body;
    }
}

/// Adds a condition on the velocity of a point along the given direction, which for a wheel is
/// perpendicular to the direction of rolling.
fn edge(pen: &mut Pen<'_>, body: Side, at: Vector, u: Vector) {
    match pen.numbers.below(4) {
        0 => pen.link(&[body], Tie::Velocity { at, along: u }),
        _ => pen.link(&[body], Tie::KnifeEdge { at, along: u }),
    };
}

/// Adds three wheels at 120°, or up to six at 60°, with radial normals. These angles are obtained
/// from rational coordinates by stretching the drawing by √3.
fn at_angles_of_the_hexagon(pen: &mut Pen<'_>, body: Side) {
    if pen.drawing.links.is_empty() {
        pen.drawing.stretch = 3;
    }
    let centre = pen.centre();
    pen.often_at(body, centre);
    let half = Ratio::new(1, 2);
    let spokes = [
        [Ratio::ONE, Ratio::ZERO],
        [-half, half],
        [-half, -half],
        [half, half],
        [half, -half],
        [-Ratio::ONE, Ratio::ZERO],
    ];
    let radius = pen.whole(1, 9) * pen.step;
    let count = if pen.once_in(3) { 6 } else { 3 };
    let is_spoilt = pen.once_in(4);
    for (k, spoke) in spokes.into_iter().take(count).enumerate() {
        let mut at = along(centre, radius, spoke);
        if is_spoilt && k == 0 {
            at = pen.beside(at, spoke);
        }
        edge(pen, body, at, spoke);
        if pen.once_in(4) {
            spinner(pen, body, at, pen.drawing.across(spoke));
        }
    }
}

fn concurrent_edges(pen: &mut Pen<'_>, body: Side) {
    let centre = pen.centre();
    pen.often_at(body, centre);
    let is_spoilt = pen.once_in(3);
    for k in 0..2 + pen.numbers.below(4) {
        let u = pen.direction();
        let mut at = pen.on_line(centre, u, 6);
        if is_spoilt && k == 0 {
            at = pen.beside(at, u);
        }
        edge(pen, body, at, u);
        if pen.once_in(6) {
            spinner(pen, body, at, pen.drawing.across(u));
        }
    }
}

fn parallel_edges(pen: &mut Pen<'_>, body: Side) {
    let u = pen.direction();
    let is_spoilt = pen.once_in(3);
    for k in 0..2 + pen.numbers.below(3) {
        let at = pen.point();
        let u = if is_spoilt && k == 0 {
            along(u, Ratio::new(1, 5), [-u[1], u[0]])
        } else {
            u
        };
        edge(pen, body, at, u);
    }
    if pen.once_in(3) {
        // Two wheels are on one axle or on two axles; both wheels constrain the rolling motion of
        // the body.
        let way = pen.drawing.across(u);
        let (first, second) = (pen.point(), pen.point());
        let axle = spinner(pen, body, first, way);
        let other = if pen.once_in(2) { axle } else { pen.body() };
        let radius = pen.not_zero(4) * pen.step;
        pen.link(
            &[body, other],
            Tie::Rolling {
                at: second,
                along: way,
                radius,
            },
        );
    }
}

/// Adds a wheel that rolls while a point of the body moves along u, with or without a bearing at
/// this point.
fn spinner(pen: &mut Pen<'_>, body: Side, at: Vector, u: Vector) -> Side {
    let wheel = pen.drawing.body_at(at);
    if pen.once_in(2) {
        pen.hinge([body, wheel], at);
    }
    let radius = pen.not_zero(4) * pen.step;
    let tie = Tie::Rolling {
        at,
        along: u,
        radius,
    };
    pen.link(&[body, wheel], tie);
    wheel
}
