//! Draws random points, directions and joints on a grid, for the families.

use super::super::drawing::{Drawing, Kind, Measure, Side};
use super::super::pose::{any_turn, quarter};
use super::super::ratio::Ratio;
use super::super::relatives::{any, any_across};
use super::super::vector::{Motion, Rotation, Vector};
use suite::numbers::Numbers;

/// Step sizes of the grid.
const STEPS: [(i64, i64); 6] = [(1, 1), (1, 2), (1, 3), (1, 10), (3, 10), (1, 7)];

/// Sides of right triangles with integer lengths.
const TRIPLES: [[i64; 3]; 6] = [
    [3, 4, 5],
    [5, 12, 13],
    [8, 15, 17],
    [7, 24, 25],
    [20, 21, 29],
    [12, 35, 37],
];

/// Draws a submechanism in separate coordinates.
pub(super) struct Pen<'a> {
    drawing: &'a mut Drawing,
    pub(super) numbers: &'a mut Numbers,
    /// Base of the submechanism.
    pub(super) base: Side,
    /// The step of the grid.
    pub(super) step: Ratio,
    /// Transformation from the coordinates of the submechanism to the drawing.
    placement: Motion,
}

impl<'a> Pen<'a> {
    pub(super) fn new(drawing: &'a mut Drawing, base: Side, numbers: &'a mut Numbers) -> Self {
        let (n, d) = STEPS[numbers.below(STEPS.len())];
        let turn = match numbers.below(3) {
            0 => Rotation::none(),
            1 => quarter(numbers),
            _ => any_turn(numbers),
        };
        let shift = match numbers.below(2) {
            0 => [0; 3],
            _ => [0; 3].map(|_| numbers.between(-4, 4)),
        };
        let shift = Vector(shift.map(|x| Ratio::new(x, 2)));
        Self {
            drawing,
            numbers,
            base,
            step: Ratio::new(n, d),
            placement: Motion::rigid(turn, shift),
        }
    }

    /// Sets the base to the ground, without a transformation, for a submechanism that needs the
    /// ground.
    pub(super) fn stand_on_ground(&mut self) {
        self.base = None;
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
        let whole = [0; 3].map(|_| self.whole(-8, 8));
        Vector(whole).times(&self.step)
    }

    /// Returns a point of the grid with this third coordinate.
    pub(super) fn point_at(&mut self, z: &Ratio) -> Vector {
        let mut p = self.point();
        p.0[2] = z.clone();
        p
    }

    /// Returns points that are pairwise different.
    pub(super) fn points(&mut self, n: usize, z: &Ratio) -> Vec<Vector> {
        let mut points: Vec<Vector> = Vec::new();
        while points.len() < n {
            let p = self.point_at(z);
            if !points.contains(&p) {
                points.push(p);
            }
        }
        points
    }

    /// Returns a direction, often along a coordinate axis.
    pub(super) fn direction(&mut self) -> Vector {
        match self.numbers.below(3) {
            0 => Vector::unit(self.numbers.below(3)),
            _ => any(self.numbers),
        }
    }

    /// Returns a direction perpendicular to a given direction.
    pub(super) fn across(&mut self, w: &Vector) -> Vector {
        any_across(w, self.numbers)
    }

    /// Returns cosine and sine of an angle, both rational.
    pub(super) fn angle(&mut self) -> [Ratio; 2] {
        let [a, b, c] = TRIPLES[self.numbers.below(TRIPLES.len())];
        let (a, b) = if self.once_in(2) { (a, b) } else { (b, a) };
        [a, b].map(|x| Ratio::new(x, c))
    }

    /// Returns the tangent of a half angle that is neither 0 nor ±1.
    pub(super) fn half_tangent(&mut self) -> Ratio {
        let (n, d) = (self.numbers.between(1, 4), self.numbers.between(1, 4));
        let n = if n == d { n + 1 } else { n };
        if self.once_in(2) {
            Ratio::new(n, d)
        } else {
            Ratio::new(-n, d)
        }
    }

    /// Returns a rotation about one of the three coordinate axes of the submechanism.
    pub(super) fn turn_about(&mut self, axis: usize) -> Rotation {
        Rotation::about(&Vector::unit(axis), &self.half_tangent())
    }

    pub(super) fn body(&mut self) -> Side {
        self.drawing.body()
    }

    /// Adds a joint that is given in the coordinates of the submechanism; returns its index.
    pub(super) fn joint(&mut self, bodies: [Side; 2], kind: Kind) -> usize {
        let placement = &self.placement;
        let placed = kind.mapped(&|p| placement.point(p), &|d| placement.direction(d));
        self.drawing.joint(bodies, placed)
    }

    /// Joins two sides by a chain of joints with new bodies between them; returns the bodies and
    /// the index of the first joint.
    pub(super) fn chain(&mut self, from: Side, to: Side, kinds: &[Kind]) -> (Vec<Side>, usize) {
        let first = self.drawing.joints.len();
        let mut bodies = Vec::new();
        let mut last = from;
        for (k, kind) in kinds.iter().enumerate() {
            let next = if k + 1 == kinds.len() {
                to
            } else {
                let body = self.body();
                bodies.push(body);
                body
            };
            self.joint([last, next], kind.clone());
            last = next;
        }
        (bodies, first)
    }

    /// Adds the redundancy of this submechanism according to theory.
    pub(super) fn expects(&mut self, redundancy: usize) {
        self.drawing.redundancy = self.drawing.redundancy.map(|p| p + redundancy);
    }

    /// Records that theory gives no result for this submechanism.
    pub(super) fn unknown(&mut self) {
        self.drawing.redundancy = None;
    }

    /// In one of three cases, drives one or two joints of the submechanism, starting at the joint
    /// `first`.
    pub(super) fn drives(&mut self, first: usize) {
        if !self.once_in(3) {
            return;
        }
        let count = self.drawing.joints.len() - first;
        let mut driven = Vec::new();
        for _ in 0..1 + self.numbers.below(2) {
            let place = first + self.numbers.below(count);
            let measure = match self.drawing.joints[place].kind {
                Kind::Revolute { .. } => Measure::Angle,
                Kind::Translational { .. } => Measure::Displacement,
                Kind::Cylindrical { .. } if self.numbers.once_in(2) => Measure::Angle,
                Kind::Cylindrical { .. } => Measure::Displacement,
                _ => continue,
            };
            if !driven.contains(&(place, measure)) {
                self.drive(place, measure);
                driven.push((place, measure));
            }
        }
    }

    /// Drives a joint. The redundancy according to theory is no longer valid.
    pub(super) fn drive(&mut self, joint: usize, measure: Measure) {
        self.drawing.drive(joint, measure);
        self.unknown();
    }

    /// Returns any joint of two bodies, at a random position.
    pub(super) fn any_joint(&mut self) -> Kind {
        let (at, axis) = (self.point(), self.direction());
        self.any_joint_at(at, axis)
    }

    /// Returns any joint of two bodies, at a point and about an axis.
    pub(super) fn any_joint_at(&mut self, at: Vector, axis: Vector) -> Kind {
        let across = self.across(&axis);
        let (steps, aside) = (self.whole(-3, 3), self.whole(-3, 3));
        let on_line = at.along(&(&steps * &self.step), &axis);
        let in_plane = at.along(&(&aside * &self.step), &across);
        match self.numbers.below(18) {
            0..=3 => Kind::Revolute { at, axis },
            4 | 5 => Kind::Spherical { at },
            6 | 7 => Kind::Universal {
                at,
                first: axis,
                second: across,
            },
            8 => Kind::Translational {
                from: on_line,
                at,
                axis,
            },
            9 | 10 => Kind::Cylindrical {
                from: on_line,
                at,
                axis,
            },
            11 => Kind::Planar {
                from: in_plane,
                at,
                normal: axis,
            },
            12 => Kind::Fixed { at },
            13 => Kind::PointOnLine {
                from: on_line,
                at,
                axis,
            },
            14 => Kind::PointOnPlane {
                from: in_plane,
                at,
                normal: axis,
            },
            15 => match self.numbers.below(3) {
                0 => Kind::Orientation,
                1 => Kind::Perpendicular {
                    first: axis,
                    second: across,
                },
                _ => Kind::Parallel { axis },
            },
            _ => Kind::Distance {
                from: &at + &across,
                at,
            },
        }
    }
}
