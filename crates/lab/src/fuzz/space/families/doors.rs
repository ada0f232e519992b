//! Draws a door on two to four coaxial hinges.

use super::super::catalogue::{cylindrical, revolute};
use super::super::drawing::{Kind, Measure};
use super::super::ratio::Ratio;
use super::pen::Pen;

pub(super) fn doors(pen: &mut Pen<'_>) {
    let (base, door) = (pen.base, pen.body());
    let (at, axis) = (pen.point(), pen.direction());
    let n = 2 + pen.numbers.below(3);
    let (mut rows, mut holds_along) = (0, false);
    let mut hinge = None;
    let mut heights: Vec<i32> = Vec::new();
    while heights.len() < n {
        let height = pen.numbers.between(-6, 6);
        if heights.contains(&height) {
            continue;
        }
        heights.push(height);
        let height = &Ratio::whole(height.into()) * &pen.step;
        let place = at.along(&height, &axis);
        let kind = match pen.numbers.below(5) {
            0 => cylindrical(&place, &axis),
            1 => Kind::Spherical { at: place },
            _ => revolute(&place, &axis),
        };
        let (count, along) = match &kind {
            Kind::Cylindrical { .. } => (4, false),
            Kind::Spherical { .. } => (3, true),
            _ => (5, true),
        };
        (rows, holds_along) = (rows + count, holds_along || along);
        let measure = (count > 3).then_some(Measure::Angle);
        let joint = pen.joint([base, door], kind);
        hinge = measure.map(|m| (joint, m)).or(hinge);
    }
    // Two or more hinges allow the rotation of the door. If no hinge constrains the door along the
    // axis, the door can also slide along the axis.
    pen.expects(rows - if holds_along { 5 } else { 4 });
    if let Some((joint, measure)) = hinge.filter(|_| pen.once_in(4)) {
        pen.drive(joint, measure);
    }
}
