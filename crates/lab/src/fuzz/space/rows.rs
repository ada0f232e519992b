//! Constraint rows as screws, derived by virtual work. A unit multiplier of a row acts with
//! opposite wrenches on the two bodies. These wrenches do no work in any motion that the joint
//! allows. The row is the wrench on the second body: force, and moment about the origin of the
//! ground. No derivatives are used. Rows have any scale, because directions are not divided by
//! their length.
//!
//! | element | wrenches on the second body; (F; M) with M about the origin |
//! | --- | --- |
//! | point | (e; P × e) for e along the axes of the ground |
//! | offset | (u; P₂ × u): a smooth guide acts on the second body at the point of this body |
//! | directions u, v of an axis w | couples along w × u and w × v: they prevent w from moving along u, v |
//! | orientation of u, v, w | couples of the axis w, and a couple along w: no rotation of u towards v |
//! | perpendicular a, b | couple along b × a |
//! | distance | force along the rod |
//! | contact, slip, edge | force at the point, along normal, longitudinal, lateral |
//! | drive | couple along the axis, or force along the line of displacement |
//!
//! Verdicts on joints, forces, moments and components do not depend on the basis of the rows.
//! Verdicts on single rows depend on the basis; [`Meaning`] describes the meaning of each row. The
//! order of rows in a joint is the order in the table of joints: points, then offsets, then
//! directions u and v, then the rotation about w. Joints without an axis that fix the orientation
//! use the axes of the frame of the first body.

#[cfg(test)]
mod tests;

use num_bigint::BigInt;

use super::drawing::{Drawing, Drive, Joint, Kind, Measure};
use super::pose::extent;
use super::vector::Vector;
use crate::fuzz::exact::wrench::{AXES, Component, Element, Meaning, Owner, Row, Wrench, Wrenches};

impl From<&Drawing> for Wrenches {
    fn from(drawing: &Drawing) -> Self {
        let joints = || drawing.joints.iter().enumerate();
        let place = |joint: &Joint| joint.kind.place().cloned().unwrap_or_else(Vector::zero);
        let element = |owner, name: &String, joint: &Joint| Element {
            owner,
            name: name.clone(),
            sides: joint.bodies.to_vec(),
            place: Some(place(joint)),
        };
        let of_joints = joints().map(|(k, joint)| element(Owner::Joint(k), &joint.name, joint));
        let drives = || drawing.drives.iter().enumerate();
        let of_drives = drives().map(|(k, drive)| {
            let joint = &drawing.joints[drive.joint];
            element(Owner::Drive(k), &drive.name, joint)
        });
        let elements = of_joints.chain(of_drives).collect();
        let of_joint = |(k, joint): (usize, &Joint)| {
            let rows = of(drawing, joint).into_iter();
            let sides = joint.bodies;
            rows.map(move |(meaning, wrench)| Row::between(Owner::Joint(k), meaning, sides, wrench))
        };
        let of_drive = |(k, drive): (usize, &Drive)| {
            let joint = &drawing.joints[drive.joint];
            let wrench = driven(&joint.kind, drive.measure);
            Row::between(Owner::Drive(k), Meaning::Driven, joint.bodies, wrench)
        };
        let component = |(k, name)| Component {
            name,
            terms: vec![(k, [1, 0].map(BigInt::from))],
            unit: BigInt::from(1),
        };
        Self {
            bodies: drawing.bodies.len(),
            velocities: (0..6).collect(),
            components: AXES.into_iter().enumerate().map(component).collect(),
            stretch: 1,
            elements,
            rows: joints()
                .flat_map(of_joint)
                .chain(drives().map(of_drive))
                .collect(),
            distance: extent(drawing),
            theory: drawing.redundancy,
        }
        .in_order()
    }
}

/// Returns the directions u, v perpendicular to the axis w of a joint. The direction u comes from
/// the key `cross` if this key exists. Otherwise u comes from the coordinate axis of the first body
/// with the smallest component along w. If several components are equal, the first of these axes is
/// used. The direction v is w × u.
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

/// Whether the two smallest components of w along coordinate axes of the first body are nearly
/// equal, so that rounding may change the basis of rows.
#[must_use]
pub fn basis_is_doubtful(drawing: &Drawing, joint: &Joint, w: &Vector) -> bool {
    let axes = drawing.frame(joint.bodies[0]).turn.axes();
    let mut shares = axes.map(|axis| axis.dot(w).abs().rounded() / w.square().root());
    shares.sort_by(f64::total_cmp);
    shares[1] - shares[0] < DOUBTFUL
}

/// Difference of two cosines below which rounding to few digits may change their order.
const DOUBTFUL: f64 = 0.05;

/// Returns the axis or normal that determines the basis of rows of a joint.
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

/// Returns the couples that prevent the second axis w from moving along u and v:
/// `(ω × w)·u = ω·(w × u)`.
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

/// Returns the couples that keep the axes u, v, w of both bodies parallel: w does not rotate
/// towards u or v, and u does not rotate towards v.
fn orientation(w: &Vector, basis: &[Vector; 2]) -> Vec<(Meaning, Wrench)> {
    let mut rows = directions(w, basis);
    rows.push((Meaning::Turn, Wrench::couple(basis[0].cross(&basis[1]))));
    rows
}

/// Returns the rows of a joint.
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
            // The velocity of the material point at the contact is zero: along the normal because
            // the circle remains above the plane, and along the other directions because the wheel
            // does not slip.
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

/// Returns the couple along b × a, whose power is zero in rotations about a and about b, for
/// `a·b = 0`.
fn perpendicular(a: &Vector, b: &Vector) -> (Meaning, Wrench) {
    (Meaning::Perpendicular, Wrench::couple(b.cross(a)))
}

/// Returns the wrench of a drive, which does work only in motions of the driven joint coordinate.
///
/// # Panics
/// Panics if the joint does not have this joint coordinate.
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
