//! Kinds of drawings. Each draws degenerate members and near relatives that are not: what is off
//! its line is off by a step of the grid, at least a hundredth of the size, so that a judge that
//! calls everything redundant is wrong as often as one that calls nothing redundant.

mod bars;
mod doubled;
mod edges;
mod gears;
mod linkages;
pub mod slender;
mod trusses;
mod wheels;

use crate::numbers::Numbers;

use super::drawing::{Drawing, GROUND, Side, Tie, Vector, along};
use super::ratio::Ratio;

/// A kind of drawings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Family {
    /// Nodes on a line joined by distances, with oblique bars.
    Trusses,
    /// Bodies held by bars that meet in a point or are parallel.
    Bars,
    /// Knife edges, prescribed velocities and rolling wheels whose lines meet in a point or are
    /// parallel.
    Edges,
    /// Castors and pulleys pinned at their centres.
    Wheels,
    /// Gears and racks, with closed trains.
    Gears,
    /// Cranks, chains and dead centres.
    Linkages,
    /// Two joints between the same bodies.
    Doubled,
    /// Two of these in one scene, joined by a hinge or not.
    Several,
}

impl Family {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Trusses,
        Self::Bars,
        Self::Edges,
        Self::Wheels,
        Self::Gears,
        Self::Linkages,
        Self::Doubled,
        Self::Several,
    ];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Trusses => "collinear trusses",
            Self::Bars => "concurrent bars",
            Self::Edges => "edges and rolling wheels",
            Self::Wheels => "castors and pulleys",
            Self::Gears => "gears and racks",
            Self::Linkages => "flat linkages",
            Self::Doubled => "doubled joints",
            Self::Several => "two in one scene",
        }
    }

    /// A drawing.
    #[must_use]
    pub fn draw(self, numbers: &mut Numbers) -> Drawing {
        let mut pen = Pen::new(numbers);
        pen.draw(self);
        pen.drawing
    }
}

/// Steps of the grid.
const STEPS: [(i128, i128); 6] = [(1, 1), (1, 2), (1, 3), (1, 10), (3, 10), (1, 7)];

/// Squares of stretches.
const STRETCHES: [u32; 3] = [2, 3, 5];

/// What draws on a grid.
struct Pen<'a> {
    drawing: Drawing,
    numbers: &'a mut Numbers,
    /// The grid's step.
    step: Ratio,
}

impl<'a> Pen<'a> {
    fn new(numbers: &'a mut Numbers) -> Self {
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

    fn draw(&mut self, family: Family) {
        match family {
            Family::Trusses => trusses::truss(self),
            Family::Bars => bars::bars(self),
            Family::Edges => edges::edges(self),
            Family::Wheels => wheels::wheels(self),
            Family::Gears => gears::gears(self),
            Family::Linkages => linkages::linkage(self),
            Family::Doubled => doubled::doubled(self),
            Family::Several => self.several(),
        }
    }

    fn several(&mut self) {
        let mut firsts = vec![GROUND];
        for _ in 0..2 {
            let family = Family::ALL[self.numbers.below(Family::ALL.len() - 1)];
            firsts.push(Some(self.drawing.origins.len()));
            self.draw(family);
        }
        if self.numbers.once_in(2) {
            let at = self.point();
            let pair = [firsts[1], firsts[2]];
            self.drawing.link(&pair, Tie::Revolute { at });
        }
        self.drawing.redundancy = None;
        self.drawing.has_constant_rank = false;
    }

    /// True in one of n cases.
    fn once_in(&mut self, n: usize) -> bool {
        self.numbers.once_in(n)
    }

    /// A whole number in low..=high.
    fn whole(&mut self, low: i32, high: i32) -> Ratio {
        Ratio::whole(self.numbers.between(low, high).into())
    }

    /// The same without 0.
    fn not_zero(&mut self, most: i32) -> Ratio {
        loop {
            let x = self.whole(-most, most);
            if !x.is_zero() {
                return x;
            }
        }
    }

    /// A point of the grid.
    fn point(&mut self) -> Vector {
        [0; 2].map(|_| self.step * self.whole(-10, 10))
    }

    /// A vector of the grid that is not zero.
    fn vector(&mut self, most: i32) -> Vector {
        loop {
            let v = [0; 2].map(|_| self.step * self.whole(-most, most));
            if !(v[0].is_zero() && v[1].is_zero()) {
                return v;
            }
        }
    }

    /// A direction, often one of the axes.
    fn direction(&mut self) -> Vector {
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

    /// One step off a point, across a direction.
    fn beside(&mut self, p: Vector, [x, y]: Vector) -> Vector {
        let sign = self.not_zero(1);
        along(p, sign * self.step, [-y, x])
    }

    /// A place on the line through p along d, some steps away.
    fn on_line(&mut self, p: Vector, d: Vector, most: i32) -> Vector {
        let steps = self.whole(-most, most);
        along(p, steps * self.step, d)
    }

    /// Different places on a line.
    fn places(&mut self, p: Vector, d: Vector, n: usize) -> Vec<Vector> {
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

    fn body(&mut self) -> Side {
        self.drawing.body()
    }

    /// Where lines meet.
    fn centre(&mut self) -> Vector {
        if self.once_in(2) {
            [Ratio::ZERO; 2]
        } else {
            self.point()
        }
    }

    /// Where lines meet is often the origin of a body: their levers vanish there.
    fn often_at(&mut self, body: Side, centre: Vector) {
        if let Some(k) = body.filter(|_| self.numbers.once_in(2)) {
            self.drawing.origins[k] = Some(centre);
        }
    }

    fn link(&mut self, sides: &[Side], tie: Tie) -> usize {
        self.drawing.link(sides, tie)
    }

    fn hinge(&mut self, pair: [Side; 2], at: Vector) -> usize {
        self.link(&pair, Tie::Revolute { at })
    }

    /// A bar, unless its ends meet.
    fn bar(&mut self, pair: [Side; 2], from: Vector, at: Vector) {
        if from != at {
            self.link(&pair, Tie::Distance { from, at });
        }
    }

    /// A slider that a force along `u` holds on its line.
    fn slider(&mut self, pair: [Side; 2], at: Vector, u: Vector) -> usize {
        let axis = self.drawing.across(u);
        let from = if self.once_in(2) {
            at
        } else {
            self.on_line(at, axis, 3)
        };
        self.link(&pair, Tie::Translational { from, at, along: u })
    }
}
