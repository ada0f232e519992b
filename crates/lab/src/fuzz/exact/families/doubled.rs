//! Two or three joints between the same two bodies: a second bearing, a second slider on a parallel
//! line, a second rigid connection.

use super::super::drawing::{GROUND, Side, Tie, Vector};
use super::pen::Pen;

pub(super) fn doubled(pen: &mut Pen<'_>) {
    let mut bodies: Vec<Side> = vec![GROUND];
    for _ in 0..1 + pen.numbers.below(3) {
        let base = bodies[pen.numbers.below(bodies.len())];
        let body = pen.body();
        bodies.push(body);
        let (at, u) = (pen.point(), pen.direction());
        let first = pen.numbers.below(7);
        one_of(pen, first, [base, body], at, u);
        for _ in 0..pen.numbers.below(3) {
            // The second joint usually has the same kind. The second joint is at the same point or
            // at another point, and rarely has another direction.
            let kind = if pen.once_in(4) {
                pen.numbers.below(7)
            } else {
                first
            };
            let at = if pen.once_in(2) { at } else { pen.point() };
            let u = if pen.once_in(5) { pen.direction() } else { u };
            one_of(pen, kind, [base, body], at, u);
        }
    }
}

fn one_of(pen: &mut Pen<'_>, kind: usize, pair: [Side; 2], at: Vector, u: Vector) {
    match kind {
        0 | 1 => {
            pen.hinge(pair, at);
        }
        2 | 3 => {
            pen.slider(pair, at, u);
        }
        4 => {
            pen.link(&pair, Tie::Fixed { at });
        }
        5 => {
            let axis = pen.drawing.across(u);
            let from = pen.on_line(at, axis, 2);
            pen.link(&pair, Tie::PinInSlot { from, at, along: u });
        }
        _ => match pair[0] {
            GROUND => {
                pen.link(&[pair[1]], Tie::PointOnLine { at, along: u });
            }
            _ => {
                pen.link(&pair, Tie::Angle);
            }
        },
    }
}
