//! Variants of a drawing, which describe the same mechanism in different ways. The drawing is moved
//! as a whole, bodies have other frames, or bodies and joints are in another order. First and
//! second body may be exchanged, and positions may be given in the world or in the frames of
//! bodies. The correct answer is the same for all variants.

use suite::numbers::Numbers;

use super::drawing::{Drawing, Link, Side, Tie, Vector};
use super::ratio::{Ratio, Surd};

/// A variant of a drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Writing {
    /// The original drawing.
    AsDrawn,
    /// The elements are in another order, the drawing is rotated by a multiple of 90°, and the
    /// bodies have other frames.
    Reordered,
    /// Like `Reordered`, and also rotated by any angle and translated by about the size of the
    /// drawing.
    Moved,
    /// Like `Reordered`, and also rotated and translated by 1e3 m to 1e6 m.
    Far,
}

impl Writing {
    /// All variants.
    pub const ALL: [Self; 4] = [Self::AsDrawn, Self::Reordered, Self::Moved, Self::Far];

    /// Returns the name of the variant.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::AsDrawn => "as drawn",
            Self::Reordered => "reordered",
            Self::Moved => "moved",
            Self::Far => "far",
        }
    }
}

/// Sides of right triangles, for angles whose sine and cosine are rational.
const TRIPLES: [[i64; 3]; 7] = [
    [3, 4, 5],
    [5, 12, 13],
    [8, 15, 17],
    [7, 24, 25],
    [20, 21, 29],
    [12, 35, 37],
    [336, 527, 625],
];

/// Cosine and sine of an angle.
type Turn = [Ratio; 2];

const NO_TURN: Turn = [Ratio::ONE, Ratio::ZERO];

/// The frame of a body.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Origin of the frame, in the drawing.
    pub origin: Vector,
    /// Angle of the frame in the world.
    pub turn: Turn,
}

/// A joint or drive, and the form in which the scene states the points and the direction.
#[derive(Clone, Debug)]
pub struct Placed {
    /// The joint.
    pub link: Link,
    /// Whether the points are written in the frames of the bodies.
    pub is_local: bool,
    /// The factor by which a direction is multiplied; `None` if it is divided by its length.
    pub factor: Option<Ratio>,
}

/// A drawing in the world.
#[derive(Clone, Debug)]
pub struct Posed {
    /// The stretch of the drawing, before it is rotated.
    pub stretch: u32,
    /// The rotation of the drawing.
    pub turn: Turn,
    /// The translation after the rotation.
    pub shift: Vector,
    /// Frames of the bodies.
    pub frames: Vec<Frame>,
    /// The bodies in the order of the file.
    pub order: Vec<usize>,
    /// Joints and drives in the order of the file.
    pub links: Vec<Placed>,
    /// See the field of [`Drawing`].
    pub redundancy: Option<usize>,
    /// See the field of [`Drawing`].
    pub has_constant_rank: bool,
    /// The seed of the position errors, if positions have errors (see `is_careless` of
    /// [`Drawing`]).
    pub careless: Option<u64>,
}

impl Posed {
    /// Creates a random variant of a drawing.
    #[must_use]
    pub fn new(drawing: &Drawing, writing: Writing, numbers: &mut Numbers) -> Self {
        let n = drawing.origins.len();
        let is_as_drawn = writing == Writing::AsDrawn;
        let by_quarters = writing == Writing::Reordered
            || drawing.stretch != 1 && drawing.links.iter().any(|l| l.tie.has_axes());
        let turn = match (is_as_drawn, by_quarters) {
            (true, _) => NO_TURN,
            (false, true) => quarter(numbers),
            (false, false) => any_turn(numbers),
        };
        let shift = match writing {
            Writing::AsDrawn => [Ratio::ZERO; 2],
            Writing::Reordered => [0; 2].map(|_| thirds(numbers, 3)),
            Writing::Moved => [0; 2].map(|_| thirds(numbers, 30)),
            Writing::Far => {
                let size = 10_i32.pow(3 + numbers.below(4) as u32);
                [0; 2].map(|_| thirds(numbers, 3 * size))
            }
        };
        let frame = |(body, origin): (usize, &Option<Vector>)| Frame {
            origin: origin.unwrap_or_else(|| origin_of(drawing, body, is_as_drawn, numbers)),
            turn: match (is_as_drawn, numbers.below(4)) {
                (true, _) | (false, 0) => NO_TURN,
                (false, 1) => quarter(numbers),
                (false, _) => any_turn(numbers),
            },
        };
        let frames = drawing.origins.iter().enumerate().map(frame).collect();
        let (order, links) = if is_as_drawn {
            ((0..n).collect(), (0..drawing.links.len()).collect())
        } else {
            (numbers.order(n), numbers.order(drawing.links.len()))
        };
        Self {
            stretch: drawing.stretch,
            turn,
            shift,
            frames,
            order,
            links: placed(drawing, &links, is_as_drawn, numbers),
            redundancy: drawing.redundancy,
            has_constant_rank: drawing.has_constant_rank,
            careless: drawing.is_careless.then(|| numbers.bits()),
        }
    }

    /// Converts a vector of the drawing to the world.
    #[must_use]
    pub fn vector(&self, [x, y]: Vector) -> [Surd; 2] {
        let [c, s] = self.turn;
        // The rotation follows the stretch; √1 is rational.
        let surd = |x: Ratio, y: Ratio| match self.stretch {
            1 => Surd {
                a: x + y,
                b: Ratio::ZERO,
            },
            _ => Surd { a: x, b: y },
        };
        [surd(c * x, -s * y), surd(s * x, c * y)]
    }

    /// Converts a point of the drawing to the world.
    #[must_use]
    pub fn point(&self, p: Vector) -> [Surd; 2] {
        let shift = self.shift.map(|a| Surd { a, b: Ratio::ZERO });
        let [x, y] = self.vector(p);
        [x + shift[0], y + shift[1]]
    }

    /// Converts a vector of the drawing to the frame of a side.
    #[must_use]
    pub fn vector_in(&self, side: Side, v: Vector) -> [Surd; 2] {
        let [c, s] = side.map_or(NO_TURN, |k| self.frames[k].turn);
        let [x, y] = self.vector(v);
        [x.times(c) + y.times(s), x.times(-s) + y.times(c)]
    }

    /// Converts a point of the drawing to the frame of a side.
    #[must_use]
    pub fn point_in(&self, side: Side, p: Vector) -> [Surd; 2] {
        let Some(k) = side else { return self.point(p) };
        let o = self.frames[k].origin;
        self.vector_in(side, [p[0] - o[0], p[1] - o[1]])
    }

    /// Returns the origin of a side, in the drawing. Returns `None` for the ground of a drawing
    /// that was moved, because it has no rational coordinates in the drawing.
    #[must_use]
    pub fn origin(&self, side: Side) -> Option<Vector> {
        side.map(|k| self.frames[k].origin)
    }

    /// Returns the radius of a wheel from the torque of a unit force along `along`: the torque
    /// divided by the length of `along`.
    #[must_use]
    pub fn lever(&self, along: Vector, radius: Ratio) -> f64 {
        let ([x, y], k) = (along, Ratio::whole(i64::from(self.stretch)));
        let square = radius * radius * k * (x * x + k * y * y).inverse();
        square.rounded().sqrt().copysign(radius.rounded())
    }

    /// Returns the distance by which the drawing was moved (m).
    #[must_use]
    pub fn distance(&self) -> f64 {
        self.shift[0].rounded().hypot(self.shift[1].rounded())
    }
}

/// Returns an origin for a body: one of its joint points, so that lever arms are zero, or any
/// point.
fn origin_of(drawing: &Drawing, body: usize, is_as_drawn: bool, numbers: &mut Numbers) -> Vector {
    let links = drawing
        .links
        .iter()
        .filter(|l| l.sides.contains(&Some(body)));
    let points: Vec<Vector> = links.flat_map(|l| l.tie.points()).collect();
    match (numbers.below(3), is_as_drawn) {
        (0, _) if !points.is_empty() => points[numbers.below(points.len())],
        (1, true) => [Ratio::ZERO; 2],
        _ => [0; 2].map(|_| tenths(numbers, 20)),
    }
}

/// Returns the joints and drives in a random order. Three properties of each element are random:
/// whether the bodies are exchanged, the frames of the points, and the length of the direction
/// vector.
fn placed(
    drawing: &Drawing,
    order: &[usize],
    is_as_drawn: bool,
    numbers: &mut Numbers,
) -> Vec<Placed> {
    let swaps: Vec<bool> = (drawing.links.iter())
        .map(|_| !is_as_drawn && numbers.once_in(2))
        .collect();
    let place = |&k: &usize| {
        let link = &drawing.links[k];
        // A drive has the bodies of its joint, in the same order.
        let is_swapped = match link.tie {
            Tie::AngleDrive { joint } => swaps[joint],
            _ => swaps[k],
        };
        let link = match (is_swapped, link.tie) {
            (true, Tie::AngleDrive { .. }) => Link {
                sides: link.sides.iter().rev().copied().collect(),
                ..link.clone()
            },
            (true, _) => link.swapped().unwrap_or_else(|| link.clone()),
            (false, _) => link.clone(),
        };
        Placed {
            link,
            is_local: numbers.once_in(2),
            factor: match numbers.below(4) {
                0 => Some(Ratio::ONE),
                1 => Some(Ratio::new(1, 7)),
                2 => Some(Ratio::new(11, 10)),
                _ => None,
            },
        }
    };
    order.iter().map(place).collect()
}

/// Returns an integer number of thirds.
fn thirds(numbers: &mut Numbers, most: i32) -> Ratio {
    Ratio::new(numbers.between(-most, most).into(), 3)
}

fn tenths(numbers: &mut Numbers, most: i32) -> Ratio {
    Ratio::new(numbers.between(-most, most).into(), 10)
}

fn quarter(numbers: &mut Numbers) -> Turn {
    let one = Ratio::whole(1 - 2 * numbers.below(2) as i64);
    if numbers.once_in(2) {
        [one, Ratio::ZERO]
    } else {
        [Ratio::ZERO, one]
    }
}

fn any_turn(numbers: &mut Numbers) -> Turn {
    let [mut a, mut b, c] = TRIPLES[numbers.below(TRIPLES.len())];
    if numbers.once_in(2) {
        (a, b) = (b, a);
    }
    let mut leg = |a: i64| Ratio::new((a * (1 - 2 * numbers.below(2) as i64)).into(), c.into());
    [leg(a), leg(b)]
}
