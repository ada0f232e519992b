//! Constraint rows as lines of force. A unit multiplier of a row causes a wrench on each of its
//! bodies: a force along a line of the drawing, or a couple. Expressed about the origin of the
//! drawing as (fx, fy, m), these wrenches are the row of C in special coordinates: stretching,
//! moving and other body frames only change the basis. So they have the rank of C and its
//! dependencies, up to one factor for each row.

use super::drawing::{Link, Side, Tie, Vector};
use super::pose::Posed;
use super::ratio::Ratio;

/// Force and moment about the origin, in the drawing.
pub type Wrench = [Ratio; 3];

/// One row.
#[derive(Clone, Debug)]
pub struct Row {
    /// The index of its joint or drive in the file.
    pub link: usize,
    /// The wrench of a unit multiplier on each slot.
    pub wrenches: Vec<(usize, Wrench)>,
    /// The row of the program is this one times `scale`, in the coordinates of the program.
    pub scale: f64,
}

/// All rows in the order of the program: holonomic ones of joints, those of drives, then
/// nonholonomic ones; each in the order of the file.
#[must_use]
pub fn rows(posed: &Posed) -> Vec<Row> {
    let links = || posed.links.iter().enumerate();
    let of = |(place, placed): (usize, &super::pose::Placed)| rows_of(posed, place, &placed.link);
    let joints = links().filter(|(_, p)| !p.link.tie.is_drive() && !p.link.tie.is_nonholonomic());
    let drives = links().filter(|(_, p)| p.link.tie.is_drive());
    let nonholonomic = links().filter(|(_, p)| p.link.tie.is_nonholonomic());
    joints
        .chain(drives)
        .chain(nonholonomic)
        .flat_map(of)
        .collect()
}

/// A force along a line through p.
fn line(p: Vector, u: Vector) -> Wrench {
    [u[0], u[1], p[0] * u[1] - p[1] * u[0]]
}

/// A couple.
fn couple(m: Ratio) -> Wrench {
    [Ratio::ZERO, Ratio::ZERO, m]
}

fn minus(w: Wrench) -> Wrench {
    w.map(|x| -x)
}

/// The point for which the wrench of a joint on its first body is given. `None` if the wrench is
/// only a couple, or if the force acts at a point that is not in the drawing.
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

fn rows_of(posed: &Posed, place: usize, link: &Link) -> Vec<Row> {
    let k = posed.stretch;
    let row = |wrenches: Vec<(usize, Wrench)>, scale: f64| Row {
        link: place,
        wrenches,
        scale,
    };
    // A force along u of the drawing counts as a force of one newton.
    let unit = |u: Vector| {
        let k = Ratio::whole(i64::from(k));
        (u[0] * u[0] + k * u[1] * u[1]).inverse().rounded().sqrt()
    };
    let pushes = |at: Vector, u: Vector, signs: [Ratio; 2]| {
        let wrenches = signs.iter().enumerate().map(|(slot, sign)| {
            let wrench = line(at, u).map(|x| *sign * x);
            (slot, wrench)
        });
        row(wrenches.collect(), unit(u))
    };
    let turns = || {
        let wrenches = vec![(0, couple(-Ratio::ONE)), (1, couple(Ratio::ONE))];
        row(wrenches, f64::from(k).sqrt().recip())
    };
    let (plus, less) = (Ratio::ONE, -Ratio::ONE);
    // The axes of the world, in the coordinates of the drawing.
    let [c, s] = posed.turn;
    let (x, y) = ([c, -s], [s, c]);
    match link.tie {
        Tie::Revolute { at } => [x, y].map(|u| pushes(at, u, [plus, less])).to_vec(),
        Tie::Fixed { at } => {
            let [x, y] = [x, y].map(|u| pushes(at, u, [plus, less]));
            vec![x, y, turns()]
        }
        Tie::Translational { at, along, .. } => vec![pushes(at, along, [less, plus]), turns()],
        Tie::PinInSlot { at, along, .. } => vec![pushes(at, along, [less, plus])],
        Tie::Distance { from, at } => {
            let d = [at[0] - from[0], at[1] - from[1]];
            vec![pushes(at, d, [less, plus])]
        }
        Tie::Angle | Tie::AngleDrive { .. } => vec![turns()],
        Tie::Gear { ratio } => {
            let factors = [-ratio, Ratio::ONE, ratio - Ratio::ONE];
            let wrenches = factors.map(couple).into_iter().enumerate().collect();
            vec![row(wrenches, f64::from(k).sqrt().recip())]
        }
        Tie::Rack { at, along, radius } => {
            let on_pinion = line(at, along);
            let on_pinion = [on_pinion[0], on_pinion[1], on_pinion[2] + radius];
            vec![row(
                vec![(0, minus(on_pinion)), (1, on_pinion)],
                unit(along),
            )]
        }
        Tie::PointOnLine { at, along }
        | Tie::KnifeEdge { at, along }
        | Tie::Velocity { at, along } => {
            vec![row(vec![(0, line(at, along))], unit(along))]
        }
        Tie::Rolling { at, along, radius } => {
            let wrenches = vec![(0, line(at, along)), (1, couple(-radius))];
            vec![row(wrenches, unit(along))]
        }
    }
}

/// The sides with the wrenches of a row; one body may occupy several slots.
pub fn on_sides<'a>(
    row: &'a Row,
    link: &'a Link,
) -> impl Iterator<Item = (Side, Wrench)> + use<'a> {
    let wrenches = row.wrenches.iter();
    wrenches.map(|&(slot, wrench)| (link.sides[slot], wrench))
}
