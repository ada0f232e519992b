//! Bodies on points of planes and in grooves: kinematic couplings and tables.

use super::super::drawing::{Kind, Side};
use super::super::ratio::Ratio;
use super::super::vector::{Vector, parts};
use super::pen::Pen;

pub(super) fn supports(pen: &mut Pen<'_>) {
    match pen.numbers.below(4) {
        0 => table(pen),
        1 => grooves(pen),
        2 => cone_groove_plane(pen),
        _ => box_on_planes(pen),
    }
}

fn rests(pen: &mut Pen<'_>, pair: [Side; 2], at: Vector, normal: Vector) {
    let across = pen.across(&normal);
    let aside = &pen.whole(-2, 2) * &pen.step;
    let kind = Kind::PointOnPlane {
        from: at.along(&aside, &across),
        at,
        normal,
    };
    pen.joint(pair, kind);
}

/// Draws a table. Three to five points of the table are on a plane. Three of the constraints are
/// independent, or two if all points are on a line.
fn table(pen: &mut Pen<'_>) {
    let (base, table) = (pen.base, pen.body());
    let zero = Ratio::zero();
    let n = 3 + pen.numbers.below(3);
    let mut points = pen.points(n, &zero);
    if pen.once_in(4) {
        let side = &points[1] - &points[0];
        for (k, point) in points.iter_mut().enumerate().skip(2) {
            *point = point_on(&side, k);
        }
        points[0] = point_on(&side, 0);
        points[1] = point_on(&side, 1);
    }
    let side = &points[1] - &points[0];
    let is_line = points.iter().all(|p| (p - &points[0]).is_along(&side));
    for at in points {
        rests(pen, [base, table], at, Vector::unit(2));
    }
    pen.expects(if is_line { n - 2 } else { n - 3 });
}

fn point_on(side: &Vector, k: usize) -> Vector {
    side.times(&Ratio::whole(k as i64 * 2 - 3))
}

/// Draws three to five balls in grooves that meet in a point, are parallel, or are arbitrary.
fn grooves(pen: &mut Pen<'_>) {
    let (base, body) = (pen.base, pen.body());
    let zero = Ratio::zero();
    let way = pen.numbers.below(4);
    let common = pen.direction();
    let n = 3 + pen.numbers.below(3);
    for at in pen.points(n, &zero) {
        let axis = match way {
            0 => common.clone(),
            1 => &at - &parts([1, 2, 1], 7),
            2 if !at.is_zero() => at.clone(),
            _ => pen.direction(),
        };
        let along = &pen.whole(-2, 2) * &pen.step;
        let kind = Kind::PointOnLine {
            from: at.along(&along, &axis),
            at,
            axis,
        };
        pen.joint([base, body], kind);
    }
    pen.unknown();
}

/// Draws a body with a ball in a cone, a ball in a groove and a ball on a plane. The six rows are
/// independent unless the groove is perpendicular to the line from the groove to the cone.
fn cone_groove_plane(pen: &mut Pen<'_>) {
    let (base, body) = (pen.base, pen.body());
    let zero = Ratio::zero();
    let points = pen.points(3, &zero);
    let axis = match pen.numbers.below(3) {
        0 => &points[1] - &points[0],
        1 => Vector::unit(2).cross(&(&points[1] - &points[0])),
        _ => pen.direction(),
    };
    let at = points[0].clone();
    pen.joint([base, body], Kind::Spherical { at });
    let at = points[1].clone();
    let from = at.clone();
    pen.joint([base, body], Kind::PointOnLine { from, at, axis });
    rests(pen, [base, body], points[2].clone(), Vector::unit(2));
    pen.unknown();
}

/// Draws a body with up to eight points on three planes. The planes are perpendicular or oblique.
fn box_on_planes(pen: &mut Pen<'_>) {
    let (base, body) = (pen.base, pen.body());
    let is_square = pen.once_in(2);
    for _ in 0..4 + pen.numbers.below(5) {
        let normal = if is_square {
            Vector::unit(pen.numbers.below(3))
        } else {
            pen.direction()
        };
        let at = pen.point();
        rests(pen, [base, body], at, normal);
    }
    pen.unknown();
}
