//! Wheels pinned at their centres. The lever arm of the pin is exactly zero, but in double
//! precision it is often a few 1e-17 m. The wheels are castors on forks, and pulleys on the ground
//! and on vehicles.

use super::super::drawing::{GROUND, Side, Tie, along};
use super::pen::Pen;

pub(super) fn wheels(pen: &mut Pen<'_>) {
    pen.drawing.is_careless = pen.once_in(2);
    let chassis = pen.body();
    match pen.numbers.below(3) {
        0 => {
            let at = pen.point();
            pen.hinge([GROUND, chassis], at);
        }
        1 => {
            let u = pen.direction();
            for _ in 0..1 + pen.numbers.below(3) {
                let at = pen.point();
                pen.link(&[chassis], Tie::KnifeEdge { at, along: u });
            }
        }
        _ => {}
    }
    for _ in 0..1 + pen.numbers.below(3) {
        match pen.numbers.below(4) {
            0 => {
                wheel(pen, GROUND);
            }
            1 => castor(pen, chassis),
            _ => {
                wheel(pen, chassis);
            }
        }
    }
}

/// Adds a wheel in a bearing at its centre.
fn wheel(pen: &mut Pen<'_>, carrier: Side) -> Side {
    let centre = pen.point();
    let wheel = pen.drawing.body_at(centre);
    pen.hinge([carrier, wheel], centre);
    match pen.numbers.below(8) {
        // Adds a second bearing at the centre, or a bar that ends at the centre.
        0 => {
            pen.hinge([carrier, wheel], centre);
        }
        1 => {
            let far = pen.point();
            pen.bar([GROUND, wheel], far, centre);
        }
        // A similar drawing that is not degenerate: a bar to the rim.
        2 => {
            let (far, rim) = (pen.point(), pen.vector(3));
            let rim = along(centre, pen.whole(1, 2), rim);
            pen.bar([GROUND, wheel], far, rim);
        }
        // A knife edge at the centre of the wheel prevents slip along its normal.
        3 => {
            let u = pen.direction();
            pen.link(
                &[wheel],
                Tie::KnifeEdge {
                    at: centre,
                    along: u,
                },
            );
        }
        4 => {
            let radius = pen.not_zero(4) * pen.step;
            let u = pen.direction();
            let tie = Tie::Rolling {
                at: centre,
                along: u,
                radius,
            };
            let carrier = match carrier {
                GROUND => pen.body(),
                body => body,
            };
            pen.link(&[carrier, wheel], tie);
        }
        _ => {}
    }
    wheel
}

/// Adds a fork that rotates about its pivot, and a wheel at its end, with or without an edge.
fn castor(pen: &mut Pen<'_>, chassis: Side) {
    let (pivot, arm) = (pen.point(), pen.vector(4));
    let fork = pen.drawing.body_at(pivot);
    pen.hinge([chassis, fork], pivot);
    let centre = along(pivot, pen.whole(0, 1), arm);
    let wheel = pen.drawing.body_at(centre);
    pen.hinge([fork, wheel], centre);
    if pen.once_in(2) {
        let u = pen.drawing.across(arm);
        pen.link(
            &[fork],
            Tie::KnifeEdge {
                at: centre,
                along: u,
            },
        );
    }
}
