//! Chassis on wheels that roll without slip, and bodies on knife edges.

use super::super::catalogue::{cylindrical, revolute};
use super::super::drawing::{GROUND, Kind, Side};
use super::super::ratio::Ratio;
use super::super::vector::{Rotation, Vector};
use super::pen::Pen;

pub(super) fn vehicles(pen: &mut Pen<'_>) {
    pen.stand_on_ground();
    match pen.numbers.below(5) {
        0 => car(pen, &Ratio::zero()),
        1 => {
            let half = Ratio::new(pen.numbers.between(1, 20), 60);
            car(pen, &half);
        }
        2 => tilted(pen),
        3 => edges(pen),
        _ => turned(pen),
    }
}

/// Adds a wheel in a hub of the chassis, with the contact at z = 0 and the axis rotated about z.
fn wheel(pen: &mut Pen<'_>, chassis: Side, [x, y]: [&Ratio; 2], radius: &Ratio, turn: &Rotation) {
    let axis = turn.of(&Vector::unit(1));
    let contact = Vector([x.clone(), y.clone(), Ratio::zero()]);
    let centre = contact.along(radius, &Vector::unit(2));
    let hub = match pen.numbers.below(12) {
        0 => cylindrical(&centre, &axis),
        1 => Kind::Spherical { at: centre.clone() },
        _ => revolute(&centre, &axis),
    };
    if !matches!(hub, Kind::Revolute { .. }) {
        pen.unknown();
    }
    let wheel = pen.body();
    pen.joint([chassis, wheel], hub);
    let kind = Kind::Wheel {
        centre,
        axis,
        contact,
        normal: Vector::unit(2),
    };
    pen.joint([wheel, GROUND], kind);
}

/// Draws four wheels at the corners of a rectangle; the front wheels are steered in parallel. In
/// the straight position, one self-stress consists of normal forces, and each axle has one
/// self-stress of side forces. In the steered position with separate axles, the two side forces of
/// each axle act on two separate lines, and all motion is blocked.
fn car(pen: &mut Pen<'_>, half_tangent: &Ratio) {
    let chassis = pen.body();
    let (length, width) = (&pen.whole(1, 6) * &pen.step, &pen.whole(1, 4) * &pen.step);
    let radius = &pen.whole(1, 3) * &pen.step;
    let steering = Rotation::about(&Vector::unit(2), half_tangent);
    pen.expects(if half_tangent.is_zero() { 3 } else { 2 });
    for (front, left) in [(true, true), (true, false), (false, true), (false, false)] {
        let (x, turn) = if front {
            (length.clone(), steering.clone())
        } else {
            (-&length, Rotation::none())
        };
        let y = if left { width.clone() } else { -&width };
        wheel(pen, chassis, [&x, &y], &radius, &turn);
    }
}

/// Draws three to five wheels at random positions, The wheels are rotated independently or all by
/// the same angle.
fn turned(pen: &mut Pen<'_>) {
    let chassis = pen.body();
    let n = 2 + pen.numbers.below(4);
    let zero = Ratio::zero();
    let common = pen.turn_about(2);
    pen.unknown();
    for contact in pen.points(n, &zero) {
        let turn = match pen.numbers.below(3) {
            0 => pen.turn_about(2),
            _ => common.clone(),
        };
        let radius = &pen.whole(1, 3) * &pen.step;
        let [x, y, _] = &contact.0;
        wheel(pen, chassis, [x, y], &radius, &turn);
    }
}

/// Draws tilted free disks. Some disks have a joint with another body at the centre or about the
/// axis.
fn tilted(pen: &mut Pen<'_>) {
    let body = pen.body();
    pen.unknown();
    let zero = Ratio::zero();
    let n = 1 + pen.numbers.below(3);
    for contact in pen.points(n, &zero) {
        let [cosine, sine] = pen.angle();
        let turn = pen.turn_about(2);
        let radius = &pen.whole(1, 4) * &pen.step;
        // Before the rotation, the vector from the centre to the lowest point is along (0, −sine,
        // −cosine), which is perpendicular to the axis.
        let axis = Vector([zero.clone(), cosine.clone(), -&sine]);
        let spoke = Vector([zero.clone(), -&sine, -&cosine]);
        let (axis, spoke) = (turn.of(&axis), turn.of(&spoke));
        let centre = contact.along(&-&radius, &spoke);
        let disk = pen.body();
        let at = centre.clone();
        match pen.numbers.below(3) {
            0 => pen.joint([body, disk], Kind::Spherical { at }),
            _ => pen.joint([body, disk], revolute(&at, &axis)),
        };
        let kind = Kind::Wheel {
            centre,
            axis,
            contact,
            normal: Vector::unit(2),
        };
        pen.joint([disk, GROUND], kind);
    }
}

/// Draws a sledge on a plane, or a free sledge, with knife edges whose normals are parallel,
/// intersect, or neither.
fn edges(pen: &mut Pen<'_>) {
    let sledge = pen.body();
    let zero = Ratio::zero();
    pen.unknown();
    if pen.once_in(2) {
        let at = Vector::zero();
        let kind = Kind::Planar {
            from: at.clone(),
            at,
            normal: Vector::unit(2),
        };
        pen.joint([GROUND, sledge], kind);
    }
    let (way, common) = (pen.numbers.below(3), pen.direction());
    let n = 2 + pen.numbers.below(4);
    for at in pen.points(n, &zero) {
        let normal = match way {
            0 => common.clone(),
            1 if !at.is_zero() => at.clone(),
            _ => pen.direction(),
        };
        pen.joint([sledge, GROUND], Kind::KnifeEdge { at, normal });
    }
}
