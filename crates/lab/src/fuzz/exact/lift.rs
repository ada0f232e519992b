//! Planar drawings as wrenches in space. A unit multiplier of a row causes, on each body of the
//! row, a force along a line of the drawing or a couple about the normal of the plane. The lines of
//! the drawing before stretching and motion are used, because stretching, motion and other frames
//! of bodies only change the basis. Therefore ranks and dependencies equal the ranks and
//! dependencies of C, up to one factor for each row. All values are rational.

use num_bigint::BigInt;

use super::drawing::{Link, Tie, Vector};
use super::expected::{Elsewhere, Expected};
use super::pose::{Placed, Posed};
use super::ratio::Ratio;
use super::truth::Truth;
use super::wrench::{Component, Element, Meaning, Owner, Row, Wrench, Wrenches};
use crate::fuzz::space::ratio::Ratio as BigRatio;
use crate::fuzz::space::vector::Vector as BigVector;

/// The velocities in the plane: along x and y, and about z.
const VELOCITIES: [usize; 3] = [0, 1, 5];

impl From<&Posed> for Wrenches {
    fn from(posed: &Posed) -> Self {
        let links = || posed.links.iter().enumerate();
        let element = |(k, placed): (usize, &Placed)| Element {
            owner: owner(k, &placed.link.tie),
            name: placed.link.name.clone(),
            sides: placed.link.sides.clone(),
            place: place(&placed.link.tie).map(vector),
        };
        Self {
            bodies: posed.frames.len(),
            velocities: VELOCITIES.to_vec(),
            components: components(posed),
            stretch: posed.stretch,
            elements: links().map(element).collect(),
            rows: links()
                .flat_map(|(k, placed)| rows(posed, k, &placed.link))
                .collect(),
            distance: posed.distance(),
            theory: posed.redundancy,
        }
        .in_order()
    }
}

impl Posed {
    /// Returns the results of exact arithmetic.
    #[must_use]
    pub fn right(&self) -> (Truth, Expected) {
        let truth = Truth::of(self);
        let elsewhere = if self.has_constant_rank {
            Elsewhere::Same
        } else {
            Elsewhere::Unknown
        };
        let right = Expected::from_truth(&truth).with(elsewhere);
        (truth, right)
    }
}

fn owner(k: usize, tie: &Tie) -> Owner {
    if tie.is_drive() {
        Owner::Drive(k)
    } else {
        Owner::Joint(k)
    }
}

fn number(x: Ratio) -> BigRatio {
    BigRatio::new(x.numerator(), x.denominator())
}

/// Converts a point or vector of the plane to space.
fn vector([x, y]: Vector) -> BigVector {
    BigVector([number(x), number(y), BigRatio::zero()])
}

/// Returns the couple that rotates the first axis to the second.
fn couple(m: Ratio) -> Wrench {
    Wrench::couple(BigVector([BigRatio::zero(), BigRatio::zero(), number(m)]))
}

fn line(p: Vector, u: Vector) -> Wrench {
    Wrench::line(&vector(p), &vector(u))
}

/// Returns the components in the axes of the world, after the drawing is stretched by √k along its
/// second axis and rotated.
fn components(posed: &Posed) -> Vec<Component> {
    let [c, s] = posed.turn;
    let unit = c.denominator() * s.denominator();
    let whole = |x: Ratio| BigInt::from(x.numerator() * (unit / x.denominator()));
    let zero = BigInt::default;
    let along = |x: Ratio| (0, [whole(x), zero()]);
    let stretched = |place: usize, x: Ratio| match posed.stretch {
        1 => (place, [whole(x), zero()]),
        _ => (place, [zero(), whole(x)]),
    };
    let component = |name, terms| Component {
        name,
        terms,
        unit: unit.into(),
    };
    vec![
        component("Fx", vec![along(c), stretched(1, -s)]),
        component("Fy", vec![along(s), stretched(1, c)]),
        component("T", vec![stretched(5, Ratio::ONE)]),
    ]
}

/// Returns the point for which the wrench of a joint on its first body is given. Returns `None` if
/// the force acts at a point that is not in the drawing.
#[must_use]
pub fn place(tie: &Tie) -> Option<Vector> {
    match *tie {
        Tie::Revolute { at }
        | Tie::Fixed { at }
        | Tie::PointOnLine { at, .. }
        | Tie::KnifeEdge { at, .. }
        | Tie::Velocity { at, .. }
        | Tie::Rolling { at, .. } => Some(at),
        Tie::Translational { from, .. }
        | Tie::PinInSlot { from, .. }
        | Tie::Distance { from, .. } => Some(from),
        Tie::Angle | Tie::Gear { .. } | Tie::AngleDrive { .. } => Some([Ratio::ZERO; 2]),
        Tie::Rack { .. } => None,
    }
}

fn rows(posed: &Posed, place: usize, link: &Link) -> Vec<Row> {
    let owner = owner(place, &link.tie);
    let k = Ratio::whole(i64::from(posed.stretch));
    let (root, length) = (f64::from(posed.stretch).sqrt(), |u: Vector| {
        (u[0] * u[0] + k * u[1] * u[1]).rounded().sqrt()
    });
    let row = |meaning, length, wrenches: Vec<Wrench>| Row {
        owner,
        meaning,
        loads: link.sides.iter().copied().zip(wrenches).collect(),
        length,
    };
    let pair = |meaning, length, wrench: Wrench| {
        let opposite = wrench.opposite();
        row(meaning, length, vec![opposite, wrench])
    };
    let pushes = |meaning, at, u| pair(meaning, length(u), line(at, u));
    // The program subtracts the point of the second body from the point of the first body.
    let meets = |meaning, at, u| pair(meaning, length(u), line(at, u).opposite());
    let turns = |meaning| pair(meaning, root, couple(Ratio::ONE));
    // Axes of the world, in the coordinates of the drawing.
    let [c, s] = posed.turn;
    let points = |at| {
        let axes = [[c, -s], [s, c]].into_iter().enumerate();
        axes.map(move |(axis, u)| meets(Meaning::Point(axis), at, u))
    };
    match link.tie {
        Tie::Revolute { at } => points(at).collect(),
        Tie::Fixed { at } => points(at).chain([turns(Meaning::Turn)]).collect(),
        Tie::Translational { at, along, .. } => {
            vec![pushes(Meaning::Offset(2), at, along), turns(Meaning::Turn)]
        }
        Tie::PinInSlot { at, along, .. } => vec![pushes(Meaning::Offset(2), at, along)],
        Tie::Distance { from, at } => {
            let along = [at[0] - from[0], at[1] - from[1]];
            vec![pushes(Meaning::Length, at, along)]
        }
        Tie::Angle => vec![turns(Meaning::Turn)],
        Tie::AngleDrive { .. } => vec![turns(Meaning::Driven)],
        Tie::Gear { ratio } => {
            let factors = [-ratio, Ratio::ONE, ratio - Ratio::ONE];
            vec![row(Meaning::Mesh, root, factors.map(couple).to_vec())]
        }
        Tie::Rack { at, along, radius } => {
            let mut on_pinion = line(at, along);
            on_pinion.moment = &on_pinion.moment + &couple(radius).moment;
            vec![pair(Meaning::Mesh, length(along), on_pinion)]
        }
        Tie::PointOnLine { at, along } => {
            vec![row(
                Meaning::Offset(2),
                length(along),
                vec![line(at, along)],
            )]
        }
        Tie::KnifeEdge { at, along } | Tie::Velocity { at, along } => {
            vec![row(Meaning::Edge, length(along), vec![line(at, along)])]
        }
        Tie::Rolling { at, along, radius } => {
            let wrenches = vec![line(at, along), couple(-radius)];
            vec![row(Meaning::Longitudinal, length(along), wrenches)]
        }
    }
}
