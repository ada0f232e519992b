//! Gears and racks. A closed train has a self-stress if the product of the ratios around the train
//! is one; otherwise the train is locked.

use super::super::drawing::{GROUND, Side, Tie, Vector, along};
use super::super::ratio::Ratio;
use super::pen::Pen;

/// Ratios that cannot be represented exactly as doubles; their products cannot either.
const RATIOS: [(i128, i128); 10] = [
    (1, 3),
    (-1, 3),
    (-1, 10),
    (-3, 7),
    (10, 1),
    (-2, 1),
    (-1, 1),
    (-7, 5),
    (-9, 11),
    (3, 10),
];

pub(super) fn gears(pen: &mut Pen<'_>) {
    let kind = pen.numbers.below(7);
    // Each wheel has one rotation in its bearing, and ratios are constant.
    pen.drawing.has_constant_rank = kind < 5;
    match kind {
        0 | 1 => closed_train(pen),
        2 | 3 => planets(pen),
        4 => held(pen),
        _ => racks(pen),
    }
}

fn ratio(pen: &mut Pen<'_>) -> Ratio {
    let (n, d) = RATIOS[pen.numbers.below(RATIOS.len())];
    Ratio::new(n, d)
}

/// Adds a wheel in a bearing of the carrier, usually at its centre.
fn geared(pen: &mut Pen<'_>, carrier: Side) -> Side {
    let centre = pen.point();
    let wheel = if pen.once_in(4) {
        pen.body()
    } else {
        pen.drawing.body_at(centre)
    };
    if !pen.once_in(8) {
        pen.hinge([carrier, wheel], centre);
    }
    wheel
}

fn mesh(pen: &mut Pen<'_>, first: Side, second: Side, carrier: Side, ratio: Ratio) {
    pen.link(&[first, second, carrier], Tie::Gear { ratio });
}

/// Adds a wheel with two meshes with the ground. The two meshes are dependent for any ratios.
fn held(pen: &mut Pen<'_>) {
    let wheel = geared(pen, GROUND);
    for _ in 0..2 {
        let ratio = ratio(pen);
        if pen.once_in(2) {
            mesh(pen, GROUND, wheel, GROUND, ratio);
        } else {
            mesh(pen, wheel, GROUND, GROUND, ratio);
        }
    }
    pen.drawing.redundancy = Some(1);
}

/// Adds wheels in a ring.
fn closed_train(pen: &mut Pen<'_>) {
    let carrier = if pen.once_in(2) {
        GROUND
    } else {
        let (carrier, at) = (pen.body(), pen.point());
        if pen.once_in(2) {
            pen.hinge([GROUND, carrier], at);
        }
        carrier
    };
    let n = 2 + pen.numbers.below(3);
    let wheels: Vec<Side> = (0..n).map(|_| geared(pen, carrier)).collect();
    let mut product = Ratio::ONE;
    for pair in wheels.windows(2) {
        let ratio = ratio(pen);
        mesh(pen, pair[0], pair[1], carrier, ratio);
        product = product * ratio;
    }
    let is_locked = pen.once_in(3);
    pen.drawing.redundancy = Some(usize::from(!is_locked));
    let closing = if is_locked {
        product * Ratio::new(51, 50)
    } else {
        product
    };
    if pen.once_in(2) {
        mesh(pen, wheels[0], wheels[n - 1], carrier, closing);
    } else {
        mesh(pen, wheels[n - 1], wheels[0], carrier, closing.inverse());
    }
}

/// Adds a sun wheel, a ring that is fixed to the ground or free, and planets on a carrier.
fn planets(pen: &mut Pen<'_>) {
    let centre = pen.point();
    let (sun, carrier) = (pen.drawing.body_at(centre), pen.drawing.body_at(centre));
    pen.hinge([GROUND, sun], centre);
    pen.hinge([GROUND, carrier], centre);
    let ring = if pen.once_in(3) {
        let ring = pen.drawing.body_at(centre);
        pen.hinge([GROUND, ring], centre);
        ring
    } else {
        GROUND
    };
    let (inner, outer) = (Ratio::new(-2, 1), Ratio::new(1, 4));
    let shrink = ratio(pen);
    let (count, mut is_locked) = (1 + pen.numbers.below(3), false);
    for k in 0..count {
        let at = pen.point();
        let planet = pen.drawing.body_at(at);
        pen.hinge([carrier, planet], at);
        let is_spoilt = k > 0 && pen.once_in(4);
        is_locked |= is_spoilt;
        let spoil = if is_spoilt {
            Ratio::new(9, 10)
        } else {
            Ratio::ONE
        };
        // The planets have different sizes, but the product of the ratios of both meshes is the
        // same for all planets.
        let shrink = if k == 0 { Ratio::ONE } else { shrink };
        mesh(pen, sun, planet, carrier, inner * shrink);
        mesh(pen, planet, ring, carrier, outer * shrink.inverse() * spoil);
    }
    // Each further planet gives the same condition on sun and ring as the first planet. One
    // different ratio locks sun and ring.
    pen.drawing.redundancy = Some(count - 1 - usize::from(is_locked));
}

/// Adds a rack that is free or on a slider, and pinions on both sides that mesh with each other.
fn racks(pen: &mut Pen<'_>) {
    let rack = pen.body();
    let way = pen.direction();
    // Line of force that is perpendicular to the direction of the rack after the plane is
    // stretched, so that the slider moves along the rack.
    let (k, at) = (Ratio::whole(i64::from(pen.drawing.stretch)), pen.point());
    let normal = [-(k * way[1]), way[0]];
    if !pen.once_in(4) {
        pen.slider([GROUND, rack], at, normal);
    }
    let mut pinions: Vec<(Side, Ratio)> = Vec::new();
    for _ in 0..1 + pen.numbers.below(3) {
        let centre = pen.point();
        let radius = pen.not_zero(5) * pen.step;
        let pinion = pen.drawing.body_at(centre);
        pen.hinge([GROUND, pinion], centre);
        rolls_on(pen, rack, pinion, centre, way, radius);
        pinions.push((pinion, radius));
    }
    for pair in pinions.windows(2) {
        let ([first, second], [r, s]) = ([pair[0].0, pair[1].0], [pair[0].1, pair[1].1]);
        // The condition is −v = r·ω_1 = s·ω_2.
        let ratio = if pen.once_in(3) {
            r * s.inverse() * Ratio::new(5, 4)
        } else {
            r * s.inverse()
        };
        if pen.once_in(2) {
            mesh(pen, first, second, GROUND, ratio);
        }
    }
    if pen.once_in(4) {
        // Adds a second mesh of the same rack with the same pinion.
        let (pinion, radius) = pinions[0];
        let centre = pinion.and_then(|p| pen.drawing.origins[p]);
        if let Some(centre) = centre {
            let beside = along(centre, Ratio::ONE, way);
            rolls_on(pen, rack, pinion, beside, way, radius);
        }
    }
}

fn rolls_on(pen: &mut Pen<'_>, rack: Side, pinion: Side, at: Vector, along: Vector, radius: Ratio) {
    pen.link(&[rack, pinion], Tie::Rack { at, along, radius });
}
