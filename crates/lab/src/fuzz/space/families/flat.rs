//! Planar linkages in space. Each loop that constrains its bodies to a plane has three redundant
//! rows.

use super::super::catalogue::{Flat, flat as joint, revolute};
use super::super::drawing::{Kind, Side};
use super::super::ratio::Ratio;
use super::super::vector::Vector;
use super::pen::Pen;

pub(super) fn flat(pen: &mut Pen<'_>) {
    match pen.numbers.below(5) {
        0 | 1 => ring(pen),
        2 => revolute_ring(pen),
        3 => cranks(pen),
        _ => parallelograms(pen),
    }
}

/// Draws three to five joints of any kind at points of a plane.
fn ring(pen: &mut Pen<'_>) {
    const KINDS: [Flat; 9] = [
        Flat::R,
        Flat::R,
        Flat::R,
        Flat::R,
        Flat::P,
        Flat::C,
        Flat::S,
        Flat::S,
        Flat::U,
    ];
    let n = 3 + pen.numbers.below(3);
    let zero = Ratio::zero();
    let points = pen.points(n, &zero);
    let kinds = points.iter().map(|p| {
        let kind = KINDS[pen.numbers.below(KINDS.len())];
        let turn = pen.turn_about(2);
        match (kind, pen.numbers.below(8)) {
            (Flat::R, 0) => Kind::Planar {
                from: p.clone(),
                at: p.clone(),
                normal: Vector::unit(2),
            },
            // Sliders have any direction in the plane, and universal joints any axes.
            (kind, _) => joint(kind, p).mapped(&Vector::clone, &|d| turn.of(d)),
        }
    });
    let kinds: Vec<Kind> = kinds.collect();
    let (_, first) = pen.chain(pen.base, pen.base, &kinds);
    pen.unknown();
    pen.drives(first);
}

/// Draws a loop of parallel revolute axes at points of different heights. The redundancy is p = 3,
/// and p = 4 if all axes are in one plane.
fn revolute_ring(pen: &mut Pen<'_>) {
    let n = 4 + pen.numbers.below(2);
    let zero = Ratio::zero();
    let points = pen.points(n, &zero);
    let side = &points[1] - &points[0];
    let is_collinear = points.iter().all(|p| (p - &points[0]).is_along(&side));
    let kinds = points.iter().map(|p| {
        let height = &pen.whole(-2, 2) * &pen.step;
        revolute(&p.along(&height, &Vector::unit(2)), &Vector::unit(2))
    });
    let kinds: Vec<Kind> = kinds.collect();
    let (_, first) = pen.chain(pen.base, pen.base, &kinds);
    pen.expects(if is_collinear { 4 } else { 3 });
    pen.drives(first);
}

/// Draws a coupler on two to four parallel cranks of equal length.
fn cranks(pen: &mut Pen<'_>) {
    let n = 2 + pen.numbers.below(3);
    let (base, coupler) = (pen.base, pen.body());
    let zero = Ratio::zero();
    let feet = pen.points(n, &zero);
    let crank = loop {
        let crank = pen.point_at(&zero);
        if !crank.is_zero() {
            break crank;
        }
    };
    let z = Vector::unit(2);
    let mut first = usize::MAX;
    for foot in &feet {
        let joints = [revolute(foot, &z), revolute(&(foot + &crank), &z)];
        let (_, joint) = pen.chain(base, coupler, &joints);
        first = first.min(joint);
    }
    // In the plane, each further crank repeats the constraint on the angle of the coupler. If the
    // cranks are parallel to a line through all ground pivots, the configuration is singular.
    let is_flat = feet.iter().all(|f| (f - &feet[0]).is_along(&crank));
    let in_plane = if is_flat { n - 1 } else { n - 2 };
    pen.expects(in_plane + 3 * (n - 1));
    pen.drives(first);
}

/// Draws parallelograms side by side.
fn parallelograms(pen: &mut Pen<'_>) {
    let n = 1 + pen.numbers.below(3);
    let zero = Ratio::zero();
    let foot = pen.point_at(&zero);
    let steps = [0; 3].map(|_| pen.not_zero(5));
    let crank = Vector([steps[0].clone(), steps[1].clone(), zero.clone()]).times(&pen.step);
    let is_flat = pen.once_in(3);
    let side = if is_flat {
        crank.times(&steps[2])
    } else {
        pen.points(1, &zero).remove(0)
    };
    if side.is_zero() {
        return pen.unknown();
    }
    let z = Vector::unit(2);
    let mut before: Side = pen.base;
    for k in 0..=n {
        let low = foot.along(&Ratio::whole(k as i64), &side);
        let high = &low + &crank;
        let bar = pen.body();
        pen.joint([pen.base, bar], revolute(&low, &z));
        if k > 0 {
            let joints = [revolute(&(&high - &side), &z), revolute(&high, &z)];
            pen.chain(before, bar, &joints);
        }
        before = bar;
    }
    pen.expects(if side.is_along(&crank) { 4 * n } else { 3 * n });
}
