//! Bodies supported by bars whose lines meet in a point or are parallel. The body can rotate about
//! the point, or translate perpendicular to the bars.

use super::super::drawing::{GROUND, Side, along};
use super::super::ratio::Ratio;
use super::pen::Pen;

pub(super) fn bars(pen: &mut Pen<'_>) {
    let n = 1 + pen.numbers.below(2);
    let mut held: Vec<Side> = Vec::new();
    for k in 0..n {
        let body = pen.body();
        // The other end of the bar is on the ground or on the previous body.
        let base = if k > 0 && pen.once_in(2) {
            held[k - 1]
        } else {
            GROUND
        };
        let count = match pen.numbers.below(4) {
            0 => 4 + pen.numbers.below(2),
            _ => 3,
        };
        if pen.once_in(3) {
            parallel(pen, [base, body], count);
        } else {
            concurrent(pen, [base, body], count);
        }
        if k > 0 && pen.once_in(3) {
            let at = pen.point();
            pen.hinge([held[k - 1], body], at);
        }
        held.push(body);
    }
}

fn concurrent(pen: &mut Pen<'_>, pair: [Side; 2], count: usize) {
    let centre = pen.centre();
    pen.often_at(pair[1], centre);
    let is_spoilt = pen.once_in(3);
    for k in 0..count {
        let d = pen.direction();
        let (near, far) = (pen.whole(-3, 3) * pen.step, pen.whole(4, 8) * pen.step);
        let mut ends = [along(centre, near, d), along(centre, far, d)];
        if is_spoilt && k == 0 {
            ends[1] = pen.beside(ends[1], d);
        }
        if pen.once_in(2) {
            ends.reverse();
        }
        pen.bar(pair, ends[0], ends[1]);
    }
}

fn parallel(pen: &mut Pen<'_>, pair: [Side; 2], count: usize) {
    let d = pen.direction();
    let is_spoilt = pen.once_in(3);
    for k in 0..count {
        let from = pen.point();
        let mut end = along(from, pen.not_zero(6) * pen.step, d);
        if is_spoilt && k == 0 {
            end = along(end, pen.step * Ratio::new(1, 2), [-d[1], d[0]]);
        }
        pen.bar(pair, from, end);
    }
}
