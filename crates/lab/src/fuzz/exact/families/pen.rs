//! Draws random points, directions and links on a grid, for the families.

use super::super::drawing::{Drawing, Side, Tie, Vector, along};
use super::super::ratio::Ratio;
use suite::numbers::Numbers;

/// Step sizes of the grid.
const STEPS: [(i128, i128); 6] = [(1, 1), (1, 2), (1, 3), (1, 10), (3, 10), (1, 7)];

/// Squares of the stretch factors.
const STRETCHES: [u32; 3] = [2, 3, 5];

/// Draws random elements on a grid.
pub(super) struct Pen<'a> {
    pub(super) drawing: Drawing,
    pub(super) numbers: &'a mut Numbers,
    /// The step of the grid.
    pub(super) step: Ratio,
}

impl<'a> Pen<'a> {
    pub(super) fn new(numbers: &'a mut Numbers) -> Self {
        let (n, d) = STEPS[numbers.below(STEPS.len())];
        let mut drawing = Drawing::new();
        if numbers.once_in(4) {
            drawing.stretch = STRETCHES[numbers.below(STRETCHES.len())];
        }
        Self {
            drawing,
            numbers,
            step: Ratio::new(n, d),
        }
    }

    /// Returns true in one of n cases.
    pub(super) fn once_in(&mut self, n: usize) -> bool {
        self.numbers.once_in(n)
    }

    /// Returns an integer in low..=high.
    pub(super) fn whole(&mut self, low: i32, high: i32) -> Ratio {
        Ratio::whole(self.numbers.between(low, high).into())
    }

    /// Returns an integer between −most and most, but not 0.
    pub(super) fn not_zero(&mut self, most: i32) -> Ratio {
        loop {
            let x = self.whole(-most, most);
            if !x.is_zero() {
                return x;
            }
        }
    }

    /// Returns a point of the grid.
    pub(super) fn point(&mut self) -> Vector {
        [0; 2].map(|_| self.step * self.whole(-10, 10))
    }

    /// Returns a vector of the grid that is not zero.
    pub(super) fn vector(&mut self, most: i32) -> Vector {
        loop {
            let v = [0; 2].map(|_| self.step * self.whole(-most, most));
            if !(v[0].is_zero() && v[1].is_zero()) {
                return v;
            }
        }
    }

    /// Returns a direction, often one of the axes.
    pub(super) fn direction(&mut self) -> Vector {
        match self.numbers.below(6) {
            0 => [Ratio::ONE, Ratio::ZERO],
            1 => [Ratio::ZERO, Ratio::ONE],
            _ => {
                let v = self.vector(5);
                let shrink = self.step.inverse();
                v.map(|x| x * shrink)
            }
        }
    }

    /// Returns a point at a distance of one step from a given point, perpendicular to a direction.
    pub(super) fn beside(&mut self, p: Vector, [x, y]: Vector) -> Vector {
        let sign = self.not_zero(1);
        along(p, sign * self.step, [-y, x])
    }

    /// Returns a point on the line through p along d, some steps away.
    pub(super) fn on_line(&mut self, p: Vector, d: Vector, most: i32) -> Vector {
        let steps = self.whole(-most, most);
        along(p, steps * self.step, d)
    }

    /// Returns distinct points on a line.
    pub(super) fn places(&mut self, p: Vector, d: Vector, n: usize) -> Vec<Vector> {
        let mut steps: Vec<i32> = Vec::new();
        while steps.len() < n {
            let next = self.numbers.between(-7, 7);
            if !steps.contains(&next) {
                steps.push(next);
            }
        }
        let place = |k: i32| along(p, Ratio::whole(k.into()) * self.step, d);
        steps.into_iter().map(place).collect()
    }

    pub(super) fn body(&mut self) -> Side {
        self.drawing.body()
    }

    /// Returns the point in which the lines of a drawing meet.
    pub(super) fn centre(&mut self) -> Vector {
        if self.once_in(2) {
            [Ratio::ZERO; 2]
        } else {
            self.point()
        }
    }

    /// Often puts the origin of a body at the point in which lines meet, so that the lever arms of
    /// these lines are zero.
    pub(super) fn often_at(&mut self, body: Side, centre: Vector) {
        if let Some(k) = body.filter(|_| self.numbers.once_in(2)) {
            self.drawing.origins[k] = Some(centre);
        }
    }

    pub(super) fn link(&mut self, sides: &[Side], tie: Tie) -> usize {
        self.drawing.link(sides, tie)
    }

    pub(super) fn hinge(&mut self, pair: [Side; 2], at: Vector) -> usize {
        self.link(&pair, Tie::Revolute { at })
    }

    /// Adds a bar, unless its ends coincide.
    pub(super) fn bar(&mut self, pair: [Side; 2], from: Vector, at: Vector) {
        if from != at {
            self.link(&pair, Tie::Distance { from, at });
        }
    }

    /// Adds a slider whose line is perpendicular to the force along `u`.
    pub(super) fn slider(&mut self, pair: [Side; 2], at: Vector, u: Vector) -> usize {
        let axis = self.drawing.across(u);
        let from = if self.once_in(2) {
            at
        } else {
            self.on_line(at, axis, 3)
        };
        self.link(&pair, Tie::Translational { from, at, along: u })
    }
}
