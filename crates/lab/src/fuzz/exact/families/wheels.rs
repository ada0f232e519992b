//! Wheels pinned at their centres: the lever of the pin is exactly zero, and in doubles often a few
//! 1e-17 m. Castors on forks, pulleys on the ground and on vehicles.

use super::super::drawing::{GROUND, Side, Tie, along};
use super::Pen;

impl Pen<'_> {
    pub(super) fn wheels(&mut self) {
        self.drawing.is_careless = self.once_in(2);
        let chassis = self.body();
        match self.numbers.below(3) {
            0 => {
                let at = self.point();
                self.hinge([GROUND, chassis], at);
            }
            1 => {
                let u = self.direction();
                for _ in 0..1 + self.numbers.below(3) {
                    let at = self.point();
                    self.link(&[chassis], Tie::KnifeEdge { at, along: u });
                }
            }
            _ => {}
        }
        for _ in 0..1 + self.numbers.below(3) {
            match self.numbers.below(4) {
                0 => {
                    self.wheel(GROUND);
                }
                1 => self.castor(chassis),
                _ => {
                    self.wheel(chassis);
                }
            }
        }
    }

    /// A wheel in a bearing at its centre.
    fn wheel(&mut self, carrier: Side) -> Side {
        let centre = self.point();
        let wheel = self.drawing.body_at(centre);
        self.hinge([carrier, wheel], centre);
        match self.numbers.below(8) {
            // A second bearing at the centre, or a bar to it.
            0 => {
                self.hinge([carrier, wheel], centre);
            }
            1 => {
                let far = self.point();
                self.bar([GROUND, wheel], far, centre);
            }
            // A near relative: a bar to the rim.
            2 => {
                let (far, rim) = (self.point(), self.vector(3));
                let rim = along(centre, self.whole(1, 2), rim);
                self.bar([GROUND, wheel], far, rim);
            }
            // It slips in no direction: an edge at its centre.
            3 => {
                let u = self.direction();
                self.link(
                    &[wheel],
                    Tie::KnifeEdge {
                        at: centre,
                        along: u,
                    },
                );
            }
            4 => {
                let radius = self.not_zero(4) * self.step;
                let u = self.direction();
                let tie = Tie::Rolling {
                    at: centre,
                    along: u,
                    radius,
                };
                let carrier = match carrier {
                    GROUND => self.body(),
                    body => body,
                };
                self.link(&[carrier, wheel], tie);
            }
            _ => {}
        }
        wheel
    }

    /// A fork that turns about its pivot, and a wheel at its end, with an edge or none.
    fn castor(&mut self, chassis: Side) {
        let (pivot, arm) = (self.point(), self.vector(4));
        let fork = self.drawing.body_at(pivot);
        self.hinge([chassis, fork], pivot);
        let centre = along(pivot, self.whole(0, 1), arm);
        let wheel = self.drawing.body_at(centre);
        self.hinge([fork, wheel], centre);
        if self.once_in(2) {
            let u = self.drawing.across(arm);
            self.link(
                &[fork],
                Tie::KnifeEdge {
                    at: centre,
                    along: u,
                },
            );
        }
    }
}
