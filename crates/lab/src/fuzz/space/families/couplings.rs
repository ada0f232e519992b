//! Couplings of shafts in bearings: Oldham, Hooke, two universal joints in a row.

use super::super::catalogue::{cylindrical, revolute, translational};
use super::super::drawing::Kind;
use super::super::ratio::Ratio;
use super::super::vector::Vector;
use super::pen::Pen;

pub(super) fn couplings(pen: &mut Pen<'_>) {
    match pen.numbers.below(4) {
        0 => oldham(pen),
        1 => hooke(pen),
        2 => universal(pen),
        _ => cardan(pen),
    }
}

/// Draws an Oldham coupling, R P P R, with parallel shafts. The sliders are perpendicular to the
/// shafts, but not necessarily to each other: p = 3. With parallel sliders, the shafts can rotate
/// together or the middle body can slide: p = 4.
fn oldham(pen: &mut Pen<'_>) {
    let z = Vector::unit(2);
    let zero = Ratio::zero();
    let points = pen.points(2, &zero);
    let sliders = [0; 2].map(|_| {
        loop {
            let mut axis = pen.direction();
            axis.0[2] = Ratio::zero();
            if !axis.is_zero() {
                break axis;
            }
        }
    });
    let kinds = [
        revolute(&points[0], &z),
        translational(&points[0], &sliders[0]),
        translational(&points[1], &sliders[1]),
        revolute(&points[1], &z),
    ];
    let (_, first) = pen.chain(pen.base, pen.base, &kinds);
    if sliders[0].is_along(&sliders[1]) {
        pen.unknown();
    } else {
        pen.expects(3);
    }
    pen.drives(first);
}

/// Returns two shafts whose axes intersect, and the axes of a cross between them.
fn shafts(pen: &mut Pen<'_>) -> [Vector; 4] {
    loop {
        let (first, second) = (pen.direction(), pen.direction());
        let a = pen.across(&first);
        let b = a.cross(&second);
        if !first.is_along(&second) && !b.is_zero() && !a.is_along(&b) {
            return [first, a, b, second];
        }
    }
}

/// Adds a bearing of a shaft, at a distance of some steps from the centre.
fn bearing(pen: &mut Pen<'_>, centre: &Vector, axis: &Vector) -> Vector {
    let steps = &pen.not_zero(4) * &pen.step;
    centre.along(&steps, axis)
}

/// Draws the cross as a body: four axes through one point.
fn hooke(pen: &mut Pen<'_>) {
    let [first, a, b, second] = shafts(pen);
    let centre = pen.point();
    let (low, high) = (
        bearing(pen, &centre, &first),
        bearing(pen, &centre, &second),
    );
    let is_loose = pen.once_in(3);
    let end = if is_loose {
        cylindrical(&high, &second)
    } else {
        revolute(&high, &second)
    };
    let kinds = [
        revolute(&low, &first),
        revolute(&centre, &a),
        revolute(&centre, &b),
        end,
    ];
    let (_, first) = pen.chain(pen.base, pen.base, &kinds);
    if is_loose {
        pen.unknown();
    } else {
        pen.expects(3);
    }
    pen.drives(first);
}

/// Draws the cross as one universal joint: p = 3.
fn universal(pen: &mut Pen<'_>) {
    let [first, _, _, second] = shafts(pen);
    let centre = pen.point();
    let (low, high) = (
        bearing(pen, &centre, &first),
        bearing(pen, &centre, &second),
    );
    // The axes of the cross are perpendicular to each other, and each axis is perpendicular to its
    // shaft.
    let a = pen.across(&first);
    let b = second.cross(&a);
    let kinds = [
        revolute(&low, &first),
        Kind::Universal {
            at: centre,
            first: a,
            second: if b.is_zero() { first.clone() } else { b },
        },
        revolute(&high, &second),
    ];
    let (_, joint) = pen.chain(pen.base, pen.base, &kinds);
    pen.unknown();
    pen.drives(joint);
}

/// Draws a shaft between two universal joints, with or without a sliding joint.
fn cardan(pen: &mut Pen<'_>) {
    let [first, a, _, middle] = shafts(pen);
    let centre = pen.point();
    let far = bearing(pen, &centre, &middle);
    let last = pen.direction();
    let b = a.cross(&middle);
    let c = pen.across(&middle);
    let d = c.cross(&last);
    if d.is_zero() {
        return pen.unknown();
    }
    let (low, high) = (bearing(pen, &centre, &first), bearing(pen, &far, &last));
    let mut kinds = vec![
        revolute(&low, &first),
        Kind::Universal {
            at: centre.clone(),
            first: a,
            second: b,
        },
    ];
    if pen.once_in(2) {
        kinds.push(translational(
            &centre.along(&pen.step.clone(), &middle),
            &middle,
        ));
    }
    kinds.push(Kind::Universal {
        at: far,
        first: c,
        second: d,
    });
    kinds.push(revolute(&high, &last));
    let (_, joint) = pen.chain(pen.base, pen.base, &kinds);
    pen.unknown();
    pen.drives(joint);
}
