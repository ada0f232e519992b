//! Bodies held by bars whose lines meet in a point or are parallel: a rotation about the point, or
//! a shift across the bars, is free.

use super::super::drawing::{GROUND, Side, along};
use super::super::ratio::Ratio;
use super::Pen;

impl Pen<'_> {
    pub(super) fn bars(&mut self) {
        let n = 1 + self.numbers.below(2);
        let mut held: Vec<Side> = Vec::new();
        for k in 0..n {
            let body = self.body();
            // To the ground, or to the body before.
            let base = match k > 0 && self.once_in(2) {
                true => held[k - 1],
                false => GROUND,
            };
            let count = match self.numbers.below(4) {
                0 => 4 + self.numbers.below(2),
                _ => 3,
            };
            match self.once_in(3) {
                true => self.parallel([base, body], count),
                false => self.concurrent([base, body], count),
            }
            if k > 0 && self.once_in(3) {
                let at = self.point();
                self.hinge([held[k - 1], body], at);
            }
            held.push(body);
        }
    }

    fn concurrent(&mut self, pair: [Side; 2], count: usize) {
        let centre = self.centre();
        self.often_at(pair[1], centre);
        let is_spoilt = self.once_in(3);
        for k in 0..count {
            let d = self.direction();
            let (near, far) = (self.whole(-3, 3) * self.step, self.whole(4, 8) * self.step);
            let mut ends = [along(centre, near, d), along(centre, far, d)];
            if is_spoilt && k == 0 {
                ends[1] = self.beside(ends[1], d);
            }
            if self.once_in(2) {
                ends.reverse();
            }
            self.bar(pair, ends[0], ends[1]);
        }
    }

    fn parallel(&mut self, pair: [Side; 2], count: usize) {
        let d = self.direction();
        let is_spoilt = self.once_in(3);
        for k in 0..count {
            let from = self.point();
            let mut end = along(from, self.not_zero(6) * self.step, d);
            if is_spoilt && k == 0 {
                end = along(end, self.step * Ratio::new(1, 2), [-d[1], d[0]]);
            }
            self.bar(pair, from, end);
        }
    }
}
