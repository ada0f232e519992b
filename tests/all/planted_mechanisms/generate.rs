//! Random mechanisms on a grid of points, so that parallel or equal elements are exactly parallel
//! or equal.

use model::BodyRef;
use tests::numbers::Numbers;
use tests::sketch::{Sketch, Tie, Vector};

/// How a mechanism is constructed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Three to five parallel cranks under one coupler, some of them driven.
    Cranks,
    /// A tree with loops closed by random joints.
    Loops,
    /// A tree in which joints have parallel twins.
    Twins,
    /// Bodies on knife edges, many of them parallel.
    Edges,
    /// Two gear trains between the same two wheels.
    Gears,
    /// A four-bar with one to four drives.
    FourBar,
    /// Several of these mechanisms in one scene, connected or not.
    Several,
    /// Several of these mechanisms in one scene, with sizes from 1e-4 to 1e4.
    Sizes,
}

/// A mechanism, and its redundancy if it is known without computation.
pub(crate) struct Drawn {
    pub(crate) sketch: Sketch,
    pub(crate) redundancy: Option<usize>,
}

impl Kind {
    pub(crate) const ALL: [Self; 8] = [
        Self::Cranks,
        Self::Loops,
        Self::Twins,
        Self::Edges,
        Self::Gears,
        Self::FourBar,
        Self::Several,
        Self::Sizes,
    ];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Cranks => "parallel cranks",
            Self::Loops => "loops",
            Self::Twins => "joints with twins",
            Self::Edges => "knife edges",
            Self::Gears => "gear trains",
            Self::FourBar => "four-bars with drives",
            Self::Several => "several in one scene",
            Self::Sizes => "sizes 1e-4 to 1e4 in one scene",
        }
    }
}

/// Draws a random mechanism.
pub(crate) fn draw(kind: Kind, numbers: &mut Numbers) -> Drawn {
    let mut pen = Pen {
        sketch: Sketch::default(),
        numbers,
        size: 1.0,
    };
    let redundancy = pen.draw(kind);
    let sketch = pen.sketch;
    Drawn { sketch, redundancy }
}

/// Draws random elements on a grid.
struct Pen<'a> {
    sketch: Sketch,
    numbers: &'a mut Numbers,
    /// The step of the grid times 8.
    size: f64,
}

const GROUND: BodyRef = BodyRef::Ground;

impl Pen<'_> {
    /// Adds a mechanism of the kind; returns its redundancy if it is known from theory.
    fn draw(&mut self, kind: Kind) -> Option<usize> {
        match kind {
            Kind::Cranks => Some(self.cranks()),
            Kind::Loops => {
                let bodies = self.tree();
                for _ in 0..1 + self.numbers.below(3) {
                    let pair = self.pair(&bodies);
                    let tie = self.tie();
                    self.sketch.link(&pair, tie);
                }
                None
            }
            Kind::Twins => {
                self.twins();
                None
            }
            Kind::Edges => {
                self.edges();
                None
            }
            Kind::Gears => Some(self.gears()),
            Kind::FourBar => Some(self.four_bar()),
            Kind::Several => {
                self.several(|_| 1.0);
                None
            }
            Kind::Sizes => {
                self.several(|numbers| 2_f64.powi(numbers.between(-13, 13)));
                None
            }
        }
    }

    fn whole(&mut self, low: i32, high: i32) -> f64 {
        f64::from(self.numbers.between(low, high))
    }

    /// Returns a point of the grid.
    fn point(&mut self) -> Vector {
        [0, 1].map(|_| self.size * self.whole(-40, 40) / 8.0)
    }

    /// Returns a direction of any length.
    fn direction(&mut self) -> Vector {
        [self.whole(-4, 4), self.whole(1, 4)]
    }

    /// Adds a body at a random position and angle.
    fn body(&mut self) -> BodyRef {
        let (at, angle) = (self.point(), 3.0 * self.numbers.unit());
        self.sketch.body(at, angle)
    }

    /// Returns two bodies, or a body and the ground.
    fn pair(&mut self, bodies: &[BodyRef]) -> [BodyRef; 2] {
        let j = self.numbers.below(bodies.len());
        match self.numbers.below(bodies.len()) {
            i if i == j => [GROUND, bodies[j]],
            i => [bodies[i], bodies[j]],
        }
    }

    /// Returns a point on the line through `at`.
    fn on_line(&mut self, at: Vector, axis: Vector) -> Vector {
        let along = self.size * self.whole(-8, 8) / 8.0;
        [at[0] + along * axis[0], at[1] + along * axis[1]]
    }

    /// Returns a random joint between two bodies.
    fn tie(&mut self) -> Tie {
        let (at, axis) = (self.point(), self.direction());
        let from = self.on_line(at, axis);
        match self.numbers.below(8) {
            0..3 => Tie::Revolute { at },
            3 => Tie::Translational { from, at, axis },
            4 => Tie::Fixed { at },
            5 => Tie::PinInSlot { from, at, axis },
            6 => Tie::Angle,
            _ => {
                let from = self.point();
                if from == at {
                    Tie::Revolute { at }
                } else {
                    Tie::Distance { from, at }
                }
            }
        }
    }

    /// Adds two to six bodies, each with one joint to the ground or to an earlier body.
    fn tree(&mut self) -> Vec<BodyRef> {
        let mut bodies = Vec::new();
        for k in 0..2 + self.numbers.below(5) {
            let parent = match self.numbers.below(k + 1) {
                0 => GROUND,
                p => bodies[p - 1],
            };
            let body = self.body();
            let tie = self.tie();
            self.sketch.link(&[parent, body], tie);
            bodies.push(body);
        }
        bodies
    }

    /// Adds cranks `a` from their pivots to their tips: n − 2 are redundant, and so is each drive
    /// except the first.
    fn cranks(&mut self) -> usize {
        let count = 3 + self.numbers.below(3);
        let (pivots, a) = loop {
            let pivots: Vec<Vector> = (0..count).map(|_| self.point()).collect();
            let a = self.direction().map(|x| self.size * x);
            let d = [pivots[1][0] - pivots[0][0], pivots[1][1] - pivots[0][1]];
            // Otherwise the first two cranks are in the singular configuration.
            if d[0] * a[1] != d[1] * a[0] {
                break (pivots, a);
            }
        };
        let coupler = self.body();
        let drives = self.numbers.below(count + 1);
        for (k, pivot) in pivots.into_iter().enumerate() {
            let crank = self.body();
            let tip = [pivot[0] + a[0], pivot[1] + a[1]];
            self.sketch
                .link(&[GROUND, crank], Tie::Revolute { at: pivot });
            self.sketch
                .link(&[crank, coupler], Tie::Revolute { at: tip });
            if k < drives {
                self.sketch.link(&[GROUND, crank], Tie::AngleDrive);
            }
        }
        count - 2 + drives.saturating_sub(1)
    }

    fn twins(&mut self) {
        self.tree();
        let originals = self.sketch.links.clone();
        for _ in 0..1 + self.numbers.below(2) {
            let original = &originals[self.numbers.below(originals.len())];
            let other = self.point();
            let twin = match original.tie {
                _ if self.numbers.once_in(3) => original.tie,
                // The joint is two bearings, or two sliders on parallel lines.
                Tie::Revolute { .. } => Tie::Revolute { at: other },
                Tie::Translational { axis, .. } => {
                    let from = self.on_line(other, axis);
                    Tie::Translational {
                        from,
                        at: other,
                        axis,
                    }
                }
                tie => tie,
            };
            self.sketch.link(&original.bodies, twin);
        }
    }

    /// Adds a car of one to three bodies; its edges have few different normals.
    fn edges(&mut self) {
        let bodies: Vec<BodyRef> = (0..1 + self.numbers.below(3))
            .map(|_| self.body())
            .collect();
        for pair in bodies.windows(2) {
            let at = self.point();
            self.sketch.link(pair, Tie::Revolute { at });
        }
        let normals = [self.direction(), self.direction()];
        for _ in 0..2 + self.numbers.below(5) {
            let body = bodies[self.numbers.below(bodies.len())];
            let (at, normal) = (self.point(), normals[self.numbers.below(2)]);
            self.sketch.link(&[body], Tie::KnifeEdge { at, normal });
        }
        if self.numbers.once_in(2) {
            let (wheel, at) = (self.body(), self.point());
            self.sketch.link(&[bodies[0], wheel], Tie::Revolute { at });
            let (direction, radius) = ([0.0, 1.0], self.size);
            self.sketch.link(
                &[bodies[0], wheel],
                Tie::Rolling {
                    at,
                    direction,
                    radius,
                },
            );
        }
    }

    /// Adds wheels on a carrier; two trains have the same ratio between the first and the last
    /// wheel, so one mesh is redundant.
    fn gears(&mut self) -> usize {
        let carrier = if self.numbers.once_in(2) {
            GROUND
        } else {
            let (carrier, at) = (self.body(), self.point());
            self.sketch.link(&[GROUND, carrier], Tie::Revolute { at });
            carrier
        };
        let wheel = |pen: &mut Self| {
            let (body, at) = (pen.body(), pen.point());
            pen.sketch.link(&[carrier, body], Tie::Revolute { at });
            body
        };
        let (first, last) = (wheel(self), wheel(self));
        // Each mesh has a ratio −2^e; the last mesh of a train makes the product 1.
        for between in [1, 1 + 2 * self.numbers.below(2)] {
            let (mut before, mut product) = (first, 1.0);
            for _ in 0..between {
                let (next, e) = (wheel(self), self.numbers.between(-2, 2));
                let ratio = -2_f64.powi(e);
                self.sketch
                    .link(&[before, next, carrier], Tie::Gear { ratio });
                (before, product) = (next, product * ratio);
            }
            let ratio = 1.0 / product;
            self.sketch
                .link(&[before, last, carrier], Tie::Gear { ratio });
        }
        1
    }

    /// No three points of the four-bar are collinear. It has one degree of freedom, so all drives
    /// except one are redundant.
    fn four_bar(&mut self) -> usize {
        let points = loop {
            let p = [0; 4].map(|_| self.point());
            let line = |i: usize, j: usize, k: usize| {
                (p[j][0] - p[i][0]) * (p[k][1] - p[i][1])
                    == (p[j][1] - p[i][1]) * (p[k][0] - p[i][0])
            };
            if !(line(0, 1, 2) || line(0, 1, 3) || line(0, 2, 3) || line(1, 2, 3)) {
                break p;
            }
        };
        let bars = [0; 3].map(|_| self.body());
        let pairs = [
            [GROUND, bars[0]],
            [bars[0], bars[1]],
            [bars[1], bars[2]],
            [bars[2], GROUND],
        ];
        for (pair, at) in pairs.iter().zip(points) {
            self.sketch.link(pair, Tie::Revolute { at });
        }
        let drives = 1 + self.numbers.below(4);
        for pair in &pairs[..drives] {
            self.sketch.link(pair, Tie::AngleDrive);
        }
        drives - 1
    }

    fn several(&mut self, size: impl Fn(&mut Numbers) -> f64) {
        let kinds = [
            Kind::Cranks,
            Kind::Twins,
            Kind::Edges,
            Kind::Gears,
            Kind::FourBar,
        ];
        for _ in 0..2 {
            self.size = size(self.numbers);
            let (kind, before) = (
                kinds[self.numbers.below(kinds.len())],
                self.sketch.bodies.len(),
            );
            self.draw(kind);
            if before > 0 && self.numbers.once_in(2) {
                let (i, j) = (self.numbers.below(before), before);
                let tie = self.tie();
                self.sketch.link(&[BodyRef::Body(i), BodyRef::Body(j)], tie);
            }
        }
    }
}
