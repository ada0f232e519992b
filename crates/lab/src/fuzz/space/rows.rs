//! Constraint rows as screws, by virtual work: a unit multiplier of a row does no work in any
//! motion that the joint allows, and it acts with opposite wrenches on the two bodies. The wrench
//! on the second body, force and moment about the origin of the ground, is the row; nothing is
//! differentiated. Rows have any scale: directions are used as they are, not divided by their
//! length.
//!
//! | element | wrenches on the second body; (F; M) with M about the origin |
//! | --- | --- |
//! | point | (e; P × e) for e along the axes of the ground |
//! | offset | (u; P₂ × u): a smooth guide pushes the second body at its own point |
//! | directions u, v of an axis w | couples along w × u and w × v: those that keep w from leaving u, v |
//! | orientation of u, v, w | those of the axis w, and a couple along w: no turn of u towards v |
//! | perpendicular a, b | couple along b × a |
//! | distance | force along the rod |
//! | contact, slip, edge | force at the point, along normal, longitudinal, lateral |
//! | drive | couple along the axis, or force along the line of displacement |
//!
//! Verdicts of joints, forces, moments and components do not depend on the basis of the rows.
//! Verdicts of single rows do; [`Meaning`] says what each row is taken to be. The order inside a
//! joint is that of the table of joints: points, then offsets, then directions u and v, then the
//! turn about w. Joints that keep an orientation without an axis use the axes of the frame of the
//! first body.

#[cfg(test)]
mod tests;

use super::drawing::{Drawing, Joint, Kind, Measure};
use super::ratio::Ratio;
use super::vector::Vector;

/// Force, and moment about the origin of the ground.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wrench {
    /// The force.
    pub force: Vector,
    /// The moment.
    pub moment: Vector,
}

impl Wrench {
    /// A force along a line through p.
    #[must_use]
    pub fn line(p: &Vector, force: &Vector) -> Self {
        Self {
            force: force.clone(),
            moment: p.cross(force),
        }
    }

    /// A couple.
    #[must_use]
    pub fn couple(moment: Vector) -> Self {
        Self {
            force: Vector::zero(),
            moment,
        }
    }

    /// Its six numbers.
    #[must_use]
    pub fn numbers(&self) -> [Ratio; 6] {
        let ([a, b, c], [d, e, f]) = (&self.force.0, &self.moment.0);
        [a, b, c, d, e, f].map(Clone::clone)
    }
}

/// The element that a row belongs to, by its index in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Owner {
    /// A joint.
    Joint(usize),
    /// A drive.
    Drive(usize),
}

/// What a row says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// Points coincide along an axis of the ground.
    Point(usize),
    /// A point stays on a line or plane: the offset along u (0), v (1) or the normal (2).
    Offset(usize),
    /// The second axis does not leave the first one towards u (0) or v (1).
    Direction(usize),
    /// The second u does not turn towards the first v: no relative rotation about w.
    Turn,
    /// Two axes stay perpendicular.
    Perpendicular,
    /// A length.
    Length,
    /// No velocity along the normal of an edge.
    Edge,
    /// A wheel touches its plane.
    Contact,
    /// A wheel does not slip along its heading.
    Longitudinal,
    /// A wheel does not slip across its heading.
    Lateral,
    /// A driven measure.
    Driven,
}

impl Meaning {
    /// Whether it restricts velocities only.
    #[must_use]
    pub fn is_nonholonomic(self) -> bool {
        matches!(self, Self::Edge | Self::Longitudinal | Self::Lateral)
    }
}

/// One row.
#[derive(Clone, Debug)]
pub struct Row {
    /// Its joint or drive.
    pub owner: Owner,
    /// What it says.
    pub meaning: Meaning,
    /// The wrench of a unit multiplier on the second body; the first gets the opposite.
    pub wrench: Wrench,
}

/// All rows in the order of a file: holonomic ones of joints, those of drives, then nonholonomic
/// ones; each in the order of the file.
#[must_use]
pub fn rows(drawing: &Drawing) -> Vec<Row> {
    let of_joint = |(k, joint): (usize, &Joint)| {
        let rows = of(drawing, joint).into_iter();
        rows.map(move |(meaning, wrench)| Row {
            owner: Owner::Joint(k),
            meaning,
            wrench,
        })
    };
    let joints = drawing.joints.iter().enumerate().flat_map(of_joint);
    let (late, early): (Vec<Row>, Vec<Row>) = joints.partition(|r| r.meaning.is_nonholonomic());
    let drives = drawing.drives.iter().enumerate().map(|(k, drive)| Row {
        owner: Owner::Drive(k),
        meaning: Meaning::Driven,
        wrench: driven(&drawing.joints[drive.joint].kind, drive.measure),
    });
    early.into_iter().chain(drives).chain(late).collect()
}

/// The directions u, v across the axis w of a joint: u from the key `cross` if it is there, else
/// from the first body's coordinate axis that lies least along w (the first of several); v = w × u.
#[must_use]
pub fn basis(drawing: &Drawing, joint: &Joint, w: &Vector) -> [Vector; 2] {
    let u = match &joint.cross {
        Some(cross) => cross.across(w),
        None => {
            let [x, y, z] = drawing.frame(joint.bodies[0]).turn.axes();
            let mut least = x;
            for axis in [y, z] {
                if axis.dot(w).abs().is_below(&least.dot(w).abs()) {
                    least = axis;
                }
            }
            least.across(w)
        }
    };
    let v = w.cross(&u);
    [u, v]
}

/// Whether another coordinate axis of the first body lies nearly as little along w as the least
/// one, so that rounding may choose the basis of rows.
#[must_use]
pub fn basis_is_doubtful(drawing: &Drawing, joint: &Joint, w: &Vector) -> bool {
    let axes = drawing.frame(joint.bodies[0]).turn.axes();
    let mut shares = axes.map(|axis| axis.dot(w).abs().rounded() / w.square().root());
    shares.sort_by(f64::total_cmp);
    shares[1] - shares[0] < DOUBTFUL
}

/// Difference of two cosines below which rounding to few digits may exchange them.
const DOUBTFUL: f64 = 0.05;

/// The axis or normal across which the basis of rows of a joint is chosen.
#[must_use]
pub fn basis_axis(kind: &Kind) -> Option<&Vector> {
    match kind {
        Kind::Revolute { axis, .. }
        | Kind::Translational { axis, .. }
        | Kind::Cylindrical { axis, .. }
        | Kind::PointOnLine { axis, .. }
        | Kind::Parallel { axis } => Some(axis),
        Kind::Planar { normal, .. } => Some(normal),
        _ => None,
    }
}

fn points(at: &Vector) -> Vec<(Meaning, Wrench)> {
    let row = |k: usize| (Meaning::Point(k), Wrench::line(at, &Vector::unit(k)));
    [0, 1, 2].map(row).to_vec()
}

/// The couples that keep the second axis w from moving along u and v: `(ω × w)·u = ω·(w × u)`.
fn directions(w: &Vector, basis: &[Vector; 2]) -> Vec<(Meaning, Wrench)> {
    let row = |k: usize| {
        let couple = Wrench::couple(w.cross(&basis[k]));
        (Meaning::Direction(k), couple)
    };
    [0, 1].map(row).to_vec()
}

fn offsets(at: &Vector, basis: &[Vector; 2]) -> Vec<(Meaning, Wrench)> {
    let row = |k: usize| (Meaning::Offset(k), Wrench::line(at, &basis[k]));
    [0, 1].map(row).to_vec()
}

/// The couples that keep axes u, v, w of both bodies parallel: w leaves neither u nor v, and u does
/// not turn towards v.
fn orientation(w: &Vector, basis: &[Vector; 2]) -> Vec<(Meaning, Wrench)> {
    let mut rows = directions(w, basis);
    rows.push((Meaning::Turn, Wrench::couple(basis[0].cross(&basis[1]))));
    rows
}

/// The rows of a joint.
fn of(drawing: &Drawing, joint: &Joint) -> Vec<(Meaning, Wrench)> {
    let across = |w: &Vector| basis(drawing, joint, w);
    let frame = || {
        let [u, v, w] = drawing.frame(joint.bodies[0]).turn.axes();
        orientation(&w, &[u, v])
    };
    match &joint.kind {
        Kind::Spherical { at } => points(at),
        Kind::Revolute { at, axis } => [points(at), directions(axis, &across(axis))].concat(),
        Kind::Universal { at, first, second } => {
            let mut rows = points(at);
            rows.push(perpendicular(first, second));
            rows
        }
        Kind::Translational { at, axis, .. } => {
            let across = across(axis);
            [offsets(at, &across), orientation(axis, &across)].concat()
        }
        Kind::Cylindrical { at, axis, .. } => {
            let across = across(axis);
            [offsets(at, &across), directions(axis, &across)].concat()
        }
        Kind::Planar { at, normal, .. } => {
            let mut rows = vec![(Meaning::Offset(2), Wrench::line(at, normal))];
            rows.extend(directions(normal, &across(normal)));
            rows
        }
        Kind::Fixed { at } => [points(at), frame()].concat(),
        Kind::PointOnLine { at, axis, .. } => offsets(at, &across(axis)),
        Kind::PointOnPlane { at, normal, .. } => {
            vec![(Meaning::Offset(2), Wrench::line(at, normal))]
        }
        Kind::Parallel { axis } => directions(axis, &across(axis)),
        Kind::Perpendicular { first, second } => vec![perpendicular(first, second)],
        Kind::Orientation => frame(),
        Kind::Distance { from, at } => vec![(Meaning::Length, Wrench::line(at, &(at - from)))],
        Kind::KnifeEdge { at, normal } => vec![(Meaning::Edge, Wrench::line(at, normal))],
        Kind::Wheel {
            axis,
            contact,
            normal,
            ..
        } => {
            // The material point that touches has no velocity: along the normal since the circle
            // stays above the plane, along the others since it does not slip.
            let longitudinal = axis.cross(normal);
            let lateral = normal.cross(&longitudinal);
            vec![
                (Meaning::Contact, Wrench::line(contact, normal)),
                (Meaning::Longitudinal, Wrench::line(contact, &longitudinal)),
                (Meaning::Lateral, Wrench::line(contact, &lateral)),
            ]
        }
    }
}

/// `a·b = 0`: no power of the couple along b × a in a turn about a or about b.
fn perpendicular(a: &Vector, b: &Vector) -> (Meaning, Wrench) {
    (Meaning::Perpendicular, Wrench::couple(b.cross(a)))
}

/// The wrench of a drive: it works on its own measure.
///
/// # Panics
/// If the joint has no such measure.
pub(super) fn driven(kind: &Kind, measure: Measure) -> Wrench {
    match (measure, kind) {
        (Measure::Angle, Kind::Revolute { axis, .. } | Kind::Cylindrical { axis, .. }) => {
            Wrench::couple(axis.clone())
        }
        (
            Measure::Displacement,
            Kind::Translational { at, axis, .. } | Kind::Cylindrical { at, axis, .. },
        ) => Wrench::line(at, axis),
        (Measure::Length, Kind::Distance { from, at }) => Wrench::line(at, &(at - from)),
        (_, kind) => panic!("{} has no {measure:?}", kind.name()),
    }
}
