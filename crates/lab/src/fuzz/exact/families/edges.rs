//! Wheels and blades: normals that meet in a point let the body turn about it, parallel ones let it
//! slide.

use super::super::drawing::{GROUND, Side, Tie, Vector, along};
use super::super::ratio::Ratio;
use super::Pen;

impl Pen<'_> {
    pub(super) fn edges(&mut self) {
        let n = match self.once_in(3) {
            true => 2,
            false => 1,
        };
        // Edges that turn with one body stay as they are to each other.
        self.drawing.has_constant_rank = n == 1;
        let mut before = GROUND;
        for k in 0..n {
            let body = self.body();
            if k > 0 {
                let at = self.point();
                self.hinge([before, body], at);
            }
            match self.numbers.below(4) {
                0 => self.at_angles_of_the_hexagon(body),
                1 => self.parallel_edges(body),
                _ => self.concurrent_edges(body),
            }
            before = body;
        }
    }

    /// A condition on the velocity of a point: along the first line, if it is a wheel then across
    /// its way of rolling.
    fn edge(&mut self, body: Side, at: Vector, u: Vector) {
        match self.numbers.below(4) {
            0 => self.link(&[body], Tie::Velocity { at, along: u }),
            _ => self.link(&[body], Tie::KnifeEdge { at, along: u }),
        };
    }

    /// Three wheels at 120°, or up to six at 60°, whose normals are radial: irrational where the
    /// drawing is stretched by √3.
    fn at_angles_of_the_hexagon(&mut self, body: Side) {
        if self.drawing.links.is_empty() {
            self.drawing.stretch = 3;
        }
        let centre = self.centre();
        self.often_at(body, centre);
        let half = Ratio::new(1, 2);
        let spokes = [
            [Ratio::ONE, Ratio::ZERO],
            [-half, half],
            [-half, -half],
            [half, half],
            [half, -half],
            [-Ratio::ONE, Ratio::ZERO],
        ];
        let radius = self.whole(1, 9) * self.step;
        let count = match self.once_in(3) {
            true => 6,
            false => 3,
        };
        let is_spoilt = self.once_in(4);
        for (k, spoke) in spokes.into_iter().take(count).enumerate() {
            let mut at = along(centre, radius, spoke);
            if is_spoilt && k == 0 {
                at = self.beside(at, spoke);
            }
            self.edge(body, at, spoke);
            if self.once_in(4) {
                self.spinner(body, at, self.drawing.across(spoke));
            }
        }
    }

    fn concurrent_edges(&mut self, body: Side) {
        let centre = self.centre();
        self.often_at(body, centre);
        let is_spoilt = self.once_in(3);
        for k in 0..2 + self.numbers.below(4) {
            let u = self.direction();
            let mut at = self.on_line(centre, u, 6);
            if is_spoilt && k == 0 {
                at = self.beside(at, u);
            }
            self.edge(body, at, u);
            if self.once_in(6) {
                self.spinner(body, at, self.drawing.across(u));
            }
        }
    }

    fn parallel_edges(&mut self, body: Side) {
        let u = self.direction();
        let is_spoilt = self.once_in(3);
        for k in 0..2 + self.numbers.below(3) {
            let at = self.point();
            let u = match is_spoilt && k == 0 {
                true => along(u, Ratio::new(1, 5), [-u[1], u[0]]),
                false => u,
            };
            self.edge(body, at, u);
        }
        if self.once_in(3) {
            // Two wheels on one axle, or on two: both tell how the body rolls.
            let way = self.drawing.across(u);
            let (first, second) = (self.point(), self.point());
            let axle = self.spinner(body, first, way);
            let other = match self.once_in(2) {
                true => axle,
                false => self.body(),
            };
            let radius = self.not_zero(4) * self.step;
            self.link(
                &[body, other],
                Tie::Rolling {
                    at: second,
                    along: way,
                    radius,
                },
            );
        }
    }

    /// A wheel that rolls as a point of the body moves along u, in a bearing there or in none.
    fn spinner(&mut self, body: Side, at: Vector, u: Vector) -> Side {
        let wheel = self.drawing.body_at(at);
        if self.once_in(2) {
            self.hinge([body, wheel], at);
        }
        let radius = self.not_zero(4) * self.step;
        let tie = Tie::Rolling {
            at,
            along: u,
            radius,
        };
        self.link(&[body, wheel], tie);
        wheel
    }
}
