//! A mechanism in double precision, created from a drawing, with Φ and C at any configuration and
//! for any data. The mechanism is not used for verdicts. The module `near` uses it to compute the
//! distance of the data from a lower rank, and other modules compute reactions under loads with it.
//!
//! This module uses no code of the crates under test. It is derived from the definitions of the
//! joints: positions of points, and the rate of the quantity that a joint keeps constant.

use pfaff::linalg::Matrix;

use super::drawing::{Side, Tie, Vector};
use super::pose::Posed;
use super::ratio::Ratio;

/// A group of data values that change together: a point, a direction or a single value.
#[derive(Clone, Debug)]
pub struct Block {
    /// Index of the first value of the block.
    pub first: usize,
    /// Number of values: two for a point or vector, one otherwise.
    pub count: usize,
    /// Whether a change of the block is an angle.
    pub is_angle: bool,
}

/// The quantity that a joint or drive keeps constant. The fields are indices of values in the data.
#[derive(Clone, Copy, Debug)]
enum Kept {
    /// Points coincide.
    Point {
        sides: [Side; 2],
        points: [usize; 2],
    },
    /// The condition is `normal·(p_j − p_i)`, with the normal rotated from an axis of the first
    /// body.
    Offset {
        sides: [Side; 2],
        points: [usize; 2],
        axis: usize,
    },
    /// The condition is `(|p_j − p_i|² − L²)/(2L)`.
    Length {
        sides: [Side; 2],
        points: [usize; 2],
        length: usize,
    },
    /// The condition is `φ_j − φ_i − kept`.
    Angle { sides: [Side; 2], kept: usize },
    /// The condition is `(φ_2 − φ_3) − ratio·(φ_1 − φ_3) − phase`.
    Mesh {
        sides: [Side; 3],
        ratio: usize,
        phase: usize,
    },
    /// The condition is `axis·(p_j − p_i) + radius·(φ_j − φ_i) − phase`, with the axis of the first
    /// body.
    Rack {
        sides: [Side; 2],
        points: [usize; 2],
        axis: usize,
        radius: usize,
        phase: usize,
    },
    /// Velocity of a point along a direction of its body, minus a radius times the angular velocity
    /// of another body.
    Edge {
        side: Side,
        point: usize,
        direction: usize,
        wheel: Option<(Side, usize)>,
    },
}

/// A mechanism in double precision. Angles are multiplied by the size of the mechanism, so that all
/// quantities are lengths.
pub struct Doubles {
    kept: Vec<Kept>,
    /// Points, directions and single values.
    pub blocks: Vec<Block>,
    /// All values.
    pub data: Vec<f64>,
    /// Coordinates, `x, y, φ` of each body.
    pub q: Vec<f64>,
    /// The largest distance between two points of the mechanism (m).
    pub size: f64,
    /// Joint or drive of each row.
    pub links: Vec<usize>,
    /// Number m of holonomic rows, which come first.
    pub holonomic: usize,
}

/// Position, angle, cosine and sine of a body.
#[derive(Clone, Copy)]
struct Place {
    at: [f64; 2],
    turn: [f64; 2],
    angle: f64,
}

/// Velocity of the origin, and angular velocity.
type Twist = [f64; 3];

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Returns the vector rotated by +90°.
fn quarter([x, y]: [f64; 2]) -> [f64; 2] {
    [-y, x]
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

impl Place {
    fn of(side: Side, q: &[f64]) -> Self {
        let [x, y, angle] = side.map_or([0.0; 3], |k| [q[3 * k], q[3 * k + 1], q[3 * k + 2]]);
        let (s, c) = angle.sin_cos();
        Self {
            at: [x, y],
            turn: [c, s],
            angle,
        }
    }

    /// Returns the vector from the origin of the body to a point, in ground components.
    fn arm(&self, d: &[f64], first: usize) -> [f64; 2] {
        let ([c, s], [x, y]) = (self.turn, [d[first], d[first + 1]]);
        [c * x - s * y, s * x + c * y]
    }

    fn point(&self, d: &[f64], first: usize) -> [f64; 2] {
        let arm = self.arm(d, first);
        [self.at[0] + arm[0], self.at[1] + arm[1]]
    }

    /// Returns a unit vector at a given angle in the body.
    fn direction(&self, d: &[f64], first: usize) -> [f64; 2] {
        let (s, c) = (self.angle + d[first]).sin_cos();
        [c, s]
    }
}

fn twist(side: Side, v: &[f64]) -> Twist {
    side.map_or([0.0; 3], |k| [v[3 * k], v[3 * k + 1], v[3 * k + 2]])
}

fn velocity([x, y, w]: Twist, arm: [f64; 2]) -> [f64; 2] {
    [x - w * arm[1], y + w * arm[0]]
}

impl Kept {
    fn is_holonomic(&self) -> bool {
        !matches!(self, Self::Edge { .. })
    }

    fn rows(&self) -> usize {
        match self {
            Self::Point { .. } => 2,
            _ => 1,
        }
    }

    /// Whether the row of the quantity is an equation between angles.
    fn is_angular(&self) -> bool {
        matches!(self, Self::Angle { .. } | Self::Mesh { .. })
    }

    /// Appends the values that must be zero.
    fn phi(&self, q: &[f64], d: &[f64], out: &mut Vec<f64>) {
        let of = |side: Side| Place::of(side, q);
        let apart = |sides: [Side; 2], points: [usize; 2]| {
            minus(
                of(sides[1]).point(d, points[1]),
                of(sides[0]).point(d, points[0]),
            )
        };
        match *self {
            Self::Point { sides, points } => out.extend(apart(sides, points)),
            Self::Offset {
                sides,
                points,
                axis,
            } => {
                let normal = quarter(of(sides[0]).direction(d, axis));
                out.push(dot(normal, apart(sides, points)));
            }
            Self::Length {
                sides,
                points,
                length,
            } => {
                let (v, length) = (apart(sides, points), d[length]);
                out.push((dot(v, v) - length * length) / (2.0 * length));
            }
            Self::Angle { sides, kept } => {
                out.push(of(sides[1]).angle - of(sides[0]).angle - d[kept]);
            }
            Self::Mesh {
                sides,
                ratio,
                phase,
            } => {
                let [a, b, c] = sides.map(|side| of(side).angle);
                out.push((b - c) - d[ratio] * (a - c) - d[phase]);
            }
            Self::Rack {
                sides,
                points,
                axis,
                radius,
                phase,
            } => {
                let along = dot(of(sides[0]).direction(d, axis), apart(sides, points));
                let turned = of(sides[1]).angle - of(sides[0]).angle;
                out.push(along + d[radius] * turned - d[phase]);
            }
            Self::Edge { .. } => {}
        }
    }

    /// Appends the rates of these values for velocities v, `C·v`.
    fn rate(&self, q: &[f64], d: &[f64], v: &[f64], out: &mut Vec<f64>) {
        let of = |side: Side| Place::of(side, q);
        let moving = |side: Side, point: usize| velocity(twist(side, v), of(side).arm(d, point));
        let apart = |sides: [Side; 2], points: [usize; 2]| {
            (
                minus(
                    of(sides[1]).point(d, points[1]),
                    of(sides[0]).point(d, points[0]),
                ),
                minus(moving(sides[1], points[1]), moving(sides[0], points[0])),
            )
        };
        let turning = |side: Side| twist(side, v)[2];
        match *self {
            Self::Point { sides, points } => out.extend(apart(sides, points).1),
            Self::Offset {
                sides,
                points,
                axis,
            } => {
                let normal = quarter(of(sides[0]).direction(d, axis));
                let (p, fast) = apart(sides, points);
                let turned = turning(sides[0]) * dot(quarter(normal), p);
                out.push(dot(normal, fast) + turned);
            }
            Self::Length {
                sides,
                points,
                length,
            } => {
                let (p, fast) = apart(sides, points);
                out.push(dot(p, fast) / d[length]);
            }
            Self::Angle { sides, .. } => out.push(turning(sides[1]) - turning(sides[0])),
            Self::Mesh { sides, ratio, .. } => {
                let [a, b, c] = sides.map(turning);
                out.push((b - c) - d[ratio] * (a - c));
            }
            Self::Rack {
                sides,
                points,
                axis,
                radius,
                ..
            } => {
                let axis = of(sides[0]).direction(d, axis);
                let (p, fast) = apart(sides, points);
                let turned = turning(sides[0]) * dot(quarter(axis), p);
                let rolled = d[radius] * (turning(sides[1]) - turning(sides[0]));
                out.push(dot(axis, fast) + turned + rolled);
            }
            Self::Edge {
                side,
                point,
                direction,
                wheel,
            } => {
                let along = dot(of(side).direction(d, direction), moving(side, point));
                let rolled = wheel.map_or(0.0, |(wheel, radius)| d[radius] * turning(wheel));
                out.push(along - rolled);
            }
        }
    }
}

/// Collects the data of the drawing.
struct Pen<'a> {
    posed: &'a Posed,
    blocks: Vec<Block>,
    data: Vec<f64>,
}

impl Pen<'_> {
    fn add(&mut self, numbers: &[f64], is_angle: bool) -> usize {
        let first = self.data.len();
        self.data.extend(numbers);
        self.blocks.push(Block {
            first,
            count: numbers.len(),
            is_angle,
        });
        first
    }

    fn point(&mut self, side: Side, p: Vector) -> usize {
        let p = self.posed.point_in(side, p);
        self.add(&p.map(|x| x.rounded(self.posed.stretch)), false)
    }

    fn points(&mut self, sides: [Side; 2], p: [Vector; 2]) -> [usize; 2] {
        [0, 1].map(|k| self.point(sides[k], p[k]))
    }

    /// Stores a direction as an angle in the frame of a side.
    fn direction(&mut self, side: Side, v: Vector) -> usize {
        let [x, y] = self.posed.vector_in(side, v);
        let k = self.posed.stretch;
        self.add(&[y.rounded(k).atan2(x.rounded(k))], true)
    }

    /// Stores the axis that is perpendicular to this line of force.
    fn axis(&mut self, side: Side, along: Vector) -> usize {
        let [x, y] = self.posed.vector_in(side, along);
        let k = self.posed.stretch;
        self.add(&[(-x.rounded(k)).atan2(y.rounded(k))], true)
    }

    fn tie(&mut self, sides: &[Side], tie: &Tie, q: &[f64]) -> Vec<Kept> {
        let angle = |side: Side| Place::of(side, q).angle;
        let pair = || [sides[0], sides[1]];
        let turned = || angle(sides[1]) - angle(sides[0]);
        match *tie {
            Tie::Revolute { at } => {
                let points = self.points(pair(), [at, at]);
                vec![Kept::Point {
                    sides: pair(),
                    points,
                }]
            }
            Tie::Fixed { at } => {
                let points = self.points(pair(), [at, at]);
                let kept = self.add(&[turned()], true);
                let sides = pair();
                vec![Kept::Point { sides, points }, Kept::Angle { sides, kept }]
            }
            Tie::Translational { from, at, along } | Tie::PinInSlot { from, at, along } => {
                let (sides, points) = (pair(), self.points(pair(), [from, at]));
                let axis = self.axis(sides[0], along);
                let mut all = vec![Kept::Offset {
                    sides,
                    points,
                    axis,
                }];
                if matches!(tie, Tie::Translational { .. }) {
                    let kept = self.add(&[turned()], true);
                    all.push(Kept::Angle { sides, kept });
                }
                all
            }
            Tie::PointOnLine { at, along } => {
                let sides = [None, sides[0]];
                let points = self.points(sides, [at, at]);
                let axis = self.axis(None, along);
                vec![Kept::Offset {
                    sides,
                    points,
                    axis,
                }]
            }
            Tie::Distance { from, at } => {
                let (sides, points) = (pair(), self.points(pair(), [from, at]));
                let [x, y] = self
                    .posed
                    .vector([at[0] - from[0], at[1] - from[1]])
                    .map(|x| x.rounded(self.posed.stretch));
                let length = self.add(&[x.hypot(y)], false);
                vec![Kept::Length {
                    sides,
                    points,
                    length,
                }]
            }
            Tie::Angle | Tie::AngleDrive { .. } => {
                let kept = self.add(&[turned()], true);
                vec![Kept::Angle {
                    sides: pair(),
                    kept,
                }]
            }
            Tie::Gear { ratio } => {
                let sides = [sides[0], sides[1], sides[2]];
                let [a, b, c] = sides.map(angle);
                let factor = ratio.rounded();
                let ratio = self.add(&[factor], true);
                let phase = self.add(&[(b - c) - factor * (a - c)], true);
                vec![Kept::Mesh {
                    sides,
                    ratio,
                    phase,
                }]
            }
            Tie::Rack { at, along, radius } => {
                let (sides, points) = (pair(), self.points(pair(), [at, at]));
                let axis = self.direction(sides[0], along);
                let length = self.posed.lever(along, radius);
                let radius = self.add(&[length], false);
                let phase = self.add(&[length * turned()], false);
                vec![Kept::Rack {
                    sides,
                    points,
                    axis,
                    radius,
                    phase,
                }]
            }
            Tie::KnifeEdge { at, along } | Tie::Velocity { at, along } => {
                let (point, direction) =
                    (self.point(sides[0], at), self.direction(sides[0], along));
                vec![Kept::Edge {
                    side: sides[0],
                    point,
                    direction,
                    wheel: None,
                }]
            }
            Tie::Rolling { at, along, radius } => {
                let (point, direction) =
                    (self.point(sides[0], at), self.direction(sides[0], along));
                let length = self.posed.lever(along, radius);
                let radius = self.add(&[length], false);
                vec![Kept::Edge {
                    side: sides[0],
                    point,
                    direction,
                    wheel: Some((sides[1], radius)),
                }]
            }
        }
    }
}

impl Doubles {
    /// Converts the current variant of the drawing.
    #[must_use]
    pub fn of(posed: &Posed) -> Self {
        let k = posed.stretch;
        let frames = posed.frames.iter();
        let q: Vec<f64> = frames
            .flat_map(|frame| {
                let [x, y] = posed.point(frame.origin).map(|x| x.rounded(k));
                let [c, s] = frame.turn.map(Ratio::rounded);
                [x, y, s.atan2(c)]
            })
            .collect();
        let mut pen = Pen {
            posed,
            blocks: Vec::new(),
            data: Vec::new(),
        };
        let (mut kept, mut owners) = (Vec::new(), Vec::new());
        let links = || posed.links.iter().enumerate();
        let is_wanted = |tie: &Tie, turn: usize| match turn {
            0 => !tie.is_drive() && !tie.is_nonholonomic(),
            1 => tie.is_drive(),
            _ => tie.is_nonholonomic(),
        };
        for turn in 0..3 {
            for (place, placed) in links().filter(|(_, p)| is_wanted(&p.link.tie, turn)) {
                let own = pen.tie(&placed.link.sides, &placed.link.tie, &q);
                owners.extend(own.iter().flat_map(|k| vec![place; k.rows()]));
                kept.extend(own);
            }
        }
        let holonomic = kept.iter().filter(|k| k.is_holonomic());
        let holonomic = holonomic.map(Kept::rows).sum();
        let (blocks, data) = (pen.blocks, pen.data);
        Self {
            kept,
            blocks,
            data,
            q,
            size: extent(posed),
            links: owners,
            holonomic,
        }
    }

    /// Returns the number of rows of C.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.links.len()
    }

    /// Returns Φ, whose components are all lengths.
    #[must_use]
    pub fn phi(&self, q: &[f64], d: &[f64]) -> Vec<f64> {
        let mut out = Vec::with_capacity(self.holonomic);
        for kept in self.kept.iter().filter(|k| k.is_holonomic()) {
            let first = out.len();
            kept.phi(q, d, &mut out);
            if kept.is_angular() {
                out[first..].iter_mut().for_each(|x| *x *= self.size);
            }
        }
        out
    }

    /// Returns C for velocities in which rotations are multiplied by the size, so that all have the
    /// same unit.
    #[must_use]
    pub fn c(&self, q: &[f64], d: &[f64]) -> Matrix {
        let n = q.len();
        let mut columns = Vec::with_capacity(n);
        for j in 0..n {
            let mut v = vec![0.0; n];
            v[j] = match j % 3 {
                2 => 1.0 / self.size,
                _ => 1.0,
            };
            columns.push(self.rate(q, d, &v));
        }
        Matrix::from_fn(self.rows(), n, |i, j| columns[j][i])
    }

    /// Returns `C·v` with lengths in all rows.
    fn rate(&self, q: &[f64], d: &[f64], v: &[f64]) -> Vec<f64> {
        let mut out = Vec::with_capacity(self.rows());
        for kept in &self.kept {
            let first = out.len();
            kept.rate(q, d, v, &mut out);
            if kept.is_angular() {
                out[first..].iter_mut().for_each(|x| *x *= self.size);
            }
        }
        out
    }

    /// Returns `C·v` for velocities whose rotations are lengths.
    #[must_use]
    pub fn power(&self, q: &[f64], d: &[f64], v: &[f64]) -> Vec<f64> {
        let mut v = v.to_vec();
        v.iter_mut()
            .skip(2)
            .step_by(3)
            .for_each(|x| *x /= self.size);
        self.rate(q, d, &v)
    }

    /// Changes coordinates by a step whose rotations are lengths.
    pub fn step(&self, q: &mut [f64], step: &[f64]) {
        for (j, (q, step)) in q.iter_mut().zip(step).enumerate() {
            *q += match j % 3 {
                2 => step / self.size,
                _ => *step,
            };
        }
    }

    /// Returns the change of a value in the block that corresponds to a change of one metre.
    #[must_use]
    pub fn unit(&self, block: &Block) -> f64 {
        if block.is_angle { 1.0 / self.size } else { 1.0 }
    }
}

/// Returns the largest distance of two points or origins of a drawing (m).
#[must_use]
pub fn extent(posed: &Posed) -> f64 {
    let ties = posed.links.iter().flat_map(|p| p.link.tie.points());
    let points = ties.chain(posed.frames.iter().map(|f| f.origin));
    let points: Vec<[f64; 2]> = points
        .map(|p| posed.point(p).map(|x| x.rounded(posed.stretch)))
        .collect();
    let apart = points
        .iter()
        .flat_map(|p| points.iter().map(move |o| (p[0] - o[0]).hypot(p[1] - o[1])));
    match apart.fold(0.0, f64::max) {
        0.0 => 1.0,
        size => size,
    }
}
