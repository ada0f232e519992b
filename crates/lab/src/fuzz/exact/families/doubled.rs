//! Two or three joints between the same two bodies: the second bearing, the second slider on a
//! parallel line, the second weld.

use super::super::drawing::{GROUND, Side, Tie, Vector};
use super::Pen;

impl Pen<'_> {
    pub(super) fn doubled(&mut self) {
        let mut bodies: Vec<Side> = vec![GROUND];
        for _ in 0..1 + self.numbers.below(3) {
            let base = bodies[self.numbers.below(bodies.len())];
            let body = self.body();
            bodies.push(body);
            let (at, u) = (self.point(), self.direction());
            let first = self.numbers.below(7);
            self.one_of(first, [base, body], at, u);
            for _ in 0..self.numbers.below(3) {
                // Mostly the same again, at the same place or elsewhere, rarely along another line.
                let kind = match self.once_in(4) {
                    true => self.numbers.below(7),
                    false => first,
                };
                let at = match self.once_in(2) {
                    true => at,
                    false => self.point(),
                };
                let u = match self.once_in(5) {
                    true => self.direction(),
                    false => u,
                };
                self.one_of(kind, [base, body], at, u);
            }
        }
    }

    fn one_of(&mut self, kind: usize, pair: [Side; 2], at: Vector, u: Vector) {
        match kind {
            0 | 1 => {
                self.hinge(pair, at);
            }
            2 | 3 => {
                self.slider(pair, at, u);
            }
            4 => {
                self.link(&pair, Tie::Fixed { at });
            }
            5 => {
                let axis = self.drawing.across(u);
                let from = self.on_line(at, axis, 2);
                self.link(&pair, Tie::PinInSlot { from, at, along: u });
            }
            _ => match pair[0] {
                GROUND => {
                    self.link(&[pair[1]], Tie::PointOnLine { at, along: u });
                }
                _ => {
                    self.link(&pair, Tie::Angle);
                }
            },
        }
    }
}
