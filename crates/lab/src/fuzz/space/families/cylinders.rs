//! Draws a lid that parallel hydraulic cylinders lift.

use super::super::catalogue::{cylindrical, revolute, translational};
use super::super::drawing::{Kind, Measure};
use super::super::ratio::Ratio;
use super::super::vector::Vector;
use super::pen::Pen;

pub(super) fn cylinders(pen: &mut Pen<'_>) {
    let (base, lid) = (pen.base, pen.body());
    let (z, zero) = (Vector::unit(2), Ratio::zero());
    let points = loop {
        let points = pen.points(3, &zero);
        let (foot, pin) = (&points[1] - &points[0], &points[2] - &points[0]);
        if !foot.is_along(&pin) && points[1] != points[2] {
            break points;
        }
    };
    pen.joint([base, lid], revolute(&points[0], &z));
    let n = 1 + pen.numbers.below(2);
    let with_guides = pen.once_in(2);
    let mut redundancy = 3 * n;
    for k in 0..n {
        let height = &pen.whole(-3, 3) * &pen.step;
        let [foot, pin] = [1, 2].map(|i| points[i].along(&height, &z));
        let rod = &pin - &foot;
        let middle = foot.along(&Ratio::new(1, 3), &rod);
        // If a cylindrical joint replaces the translational joint, the tube can spin.
        let slides = if with_guides {
            translational(&middle, &rod)
        } else {
            redundancy -= 1;
            cylindrical(&middle, &rod)
        };
        let kinds: [Kind; 3] = [revolute(&foot, &z), slides, revolute(&pin, &z)];
        let (_, first) = pen.chain(base, lid, &kinds);
        if pen.once_in(3 + k) {
            pen.drive(first + 1, Measure::Displacement);
        }
    }
    pen.expects(redundancy);
}
