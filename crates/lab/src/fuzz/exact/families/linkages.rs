//! Linkages at configurations where they are flat, stretched or aligned, and parallel cranks, which
//! are redundant everywhere.

use super::super::drawing::{GROUND, Side, Vector, along};
use super::super::ratio::Ratio;
use super::Pen;

impl Pen<'_> {
    pub(super) fn linkage(&mut self) {
        match self.numbers.below(5) {
            0 | 1 => self.cranks(),
            2 => self.chain(),
            3 => self.four_bar(),
            _ => self.slider_crank(),
        }
    }

    /// Two to five cranks under one coupler, all alike, or one that is not; some are driven.
    fn cranks(&mut self) {
        let count = 2 + self.numbers.below(4);
        let arm = self.vector(6);
        let (coupler, is_spoilt) = (self.body(), self.once_in(3));
        let is_on_line = self.once_in(4);
        let (origin, line) = (self.point(), self.direction());
        let pivots: Vec<Vector> = match is_on_line {
            true => self.places(origin, line, count),
            false => (0..count).map(|_| self.point()).collect(),
        };
        let drives = match self.once_in(2) {
            true => 0,
            false => self.numbers.below(count + 1),
        };
        let [x, y] = [0, 1].map(|axis| pivots[1][axis] - pivots[0][axis]);
        if !is_spoilt && !(x * arm[1] - y * arm[0]).is_zero() {
            // Two cranks carry the coupler, and it moves in one way.
            self.drawing.redundancy = Some(count - 2 + drives.saturating_sub(1));
        }
        for (k, pivot) in pivots.into_iter().enumerate() {
            let crank = self.body();
            let mut tip = along(pivot, Ratio::ONE, arm);
            if is_spoilt && k == 0 {
                tip = along(tip, self.step, [Ratio::ONE, Ratio::ZERO]);
            }
            let bearing = self.hinge([GROUND, crank], pivot);
            self.hinge([crank, coupler], tip);
            if k < drives {
                self.drawing.drive(bearing);
            }
        }
    }

    /// Hinges on a line between two pivots of the ground, or on a line and back; a driven end.
    fn chain(&mut self) {
        let n = 2 + self.numbers.below(4);
        let (origin, line) = (self.point(), self.direction());
        let mut places = self.places(origin, line, n + 1);
        if self.once_in(3) {
            let k = self.numbers.below(n + 1);
            places[k] = self.beside(places[k], line);
        }
        let mut before: Side = GROUND;
        let mut first = None;
        for place in &places[..n] {
            let next = self.body();
            let joint = self.hinge([before, next], *place);
            first = first.or(Some(joint));
            before = next;
        }
        if !self.once_in(4) {
            self.hinge([before, GROUND], places[n]);
        }
        if let Some(joint) = first.filter(|_| self.once_in(3)) {
            self.drawing.drive(joint);
        }
        if self.once_in(3) {
            let (far, near) = (self.point(), places[n / 2]);
            self.bar([GROUND, Some(self.drawing.origins.len() - 1)], far, near);
        }
    }

    /// Crank and coupler aligned, or nothing; the rocker or the crank held.
    fn four_bar(&mut self) {
        let [a, d] = [self.point(), self.point()];
        let arm = self.vector(4);
        let b = along(a, Ratio::ONE, arm);
        let c = match self.numbers.below(3) {
            0 => self.point(),
            1 => along(a, self.whole(2, 3), arm),
            _ => along(a, -self.whole(1, 2), arm),
        };
        let bars = [0; 3].map(|_| self.body());
        let joints = [
            self.hinge([GROUND, bars[0]], a),
            self.hinge([bars[0], bars[1]], b),
            self.hinge([bars[1], bars[2]], c),
            self.hinge([bars[2], GROUND], d),
        ];
        for joint in joints {
            if self.once_in(4) {
                self.drawing.drive(joint);
            }
        }
    }

    /// A slider-crank at a dead centre, or one step beside it.
    fn slider_crank(&mut self) {
        let (pivot, way) = (self.point(), self.direction());
        let tip = along(pivot, self.not_zero(3) * self.step, way);
        let mut end: Vector = along(tip, self.not_zero(5) * self.step, way);
        if self.once_in(3) {
            end = self.beside(end, way);
        }
        let [crank, rod, slider] = [0; 3].map(|_| self.body());
        let bearing = self.hinge([GROUND, crank], pivot);
        self.hinge([crank, rod], tip);
        self.hinge([rod, slider], end);
        let k = Ratio::whole(i64::from(self.drawing.stretch));
        let normal = [-(k * way[1]), way[0]];
        self.slider([GROUND, slider], end, normal);
        match self.numbers.below(3) {
            0 => self.drawing.drive(bearing),
            // Held at the slider: the crank is where it cannot be turned.
            1 => {
                let anchor = along(end, Ratio::whole(2), way);
                self.bar([GROUND, slider], anchor, end);
            }
            _ => {}
        }
    }
}
