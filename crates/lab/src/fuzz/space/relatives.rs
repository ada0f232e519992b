//! Drawings that are similar to a given drawing: one joint has fewer rows, or one axis is slightly
//! rotated. All joints of the changed drawing are satisfied as drawn. The changed drawing often has
//! full rank, although it is similar to the redundant drawing.

use suite::numbers::Numbers;

use super::drawing::{Drawing, Kind};
use super::ratio::Ratio;
use super::vector::{Rotation, Vector};

/// Changes one of the joints from `first` on; returns whether a joint was changed. After a change,
/// the redundancy according to theory is no longer valid.
pub fn change_one(drawing: &mut Drawing, first: usize, numbers: &mut Numbers) -> bool {
    let count = drawing.joints.len().saturating_sub(first);
    if count == 0 {
        return false;
    }
    let place = first + numbers.below(count);
    // A driven joint is not changed, because the drive needs the joint coordinate.
    if drawing.drives.iter().any(|d| d.joint == place) {
        return false;
    }
    let kind = &drawing.joints[place].kind;
    let changed = if numbers.once_in(2) {
        weaker(kind, numbers)
    } else {
        turned(kind, numbers)
    };
    let Some(changed) = changed else { return false };
    drawing.joints[place].kind = changed;
    drawing.redundancy = None;
    true
}

/// Returns a joint of a type with fewer rows that is satisfied at the same configuration.
#[must_use]
pub fn weaker(kind: &Kind, numbers: &mut Numbers) -> Option<Kind> {
    let choice = numbers.below(3);
    Some(match kind.clone() {
        Kind::Revolute { at, axis } => match choice {
            0 => Kind::Spherical { at },
            1 => Kind::Cylindrical {
                from: at.clone(),
                at,
                axis,
            },
            _ => {
                let (first, second) = (axis.clone(), any_across(&axis, numbers));
                Kind::Universal { at, first, second }
            }
        },
        Kind::Universal { at, .. } => Kind::Spherical { at },
        Kind::Translational { from, at, axis } => match choice {
            0 => Kind::PointOnLine { from, at, axis },
            _ => Kind::Cylindrical { from, at, axis },
        },
        Kind::Cylindrical { from, at, axis } => match choice {
            0 => Kind::Parallel { axis },
            _ => Kind::PointOnLine { from, at, axis },
        },
        Kind::Fixed { at } => match choice {
            0 => Kind::Orientation,
            1 => Kind::Spherical { at },
            _ => {
                let axis = Vector::unit(numbers.below(3));
                Kind::Revolute { at, axis }
            }
        },
        Kind::Planar { from, at, normal } => match choice {
            0 => Kind::Parallel { axis: normal },
            _ => Kind::PointOnPlane { from, at, normal },
        },
        Kind::PointOnLine { from, at, axis } => {
            let normal = any_across(&axis, numbers);
            Kind::PointOnPlane { from, at, normal }
        }
        Kind::Spherical { at } => {
            let normal = any(numbers);
            let from = at.clone();
            Kind::PointOnPlane { from, at, normal }
        }
        Kind::Orientation => Kind::Parallel { axis: any(numbers) },
        Kind::Parallel { axis } => {
            let (first, second) = (axis.clone(), any_across(&axis, numbers));
            Kind::Perpendicular { first, second }
        }
        _ => return None,
    })
}

/// Returns a copy of the joint whose axis or normal is rotated by a random angle of at most 0.7
/// rad.
#[must_use]
pub fn turned(kind: &Kind, numbers: &mut Numbers) -> Option<Kind> {
    let turn = small_turn(numbers);
    let mut image = kind.clone();
    match &mut image {
        Kind::Revolute { axis, .. } | Kind::Parallel { axis } => *axis = turn.of(axis),
        Kind::Translational { from, at, axis }
        | Kind::Cylindrical { from, at, axis }
        | Kind::PointOnLine { from, at, axis } => {
            *axis = turn.of(axis);
            *from = at.clone();
        }
        Kind::Planar { from, at, normal } | Kind::PointOnPlane { from, at, normal } => {
            *normal = turn.of(normal);
            *from = at.clone();
        }
        Kind::Universal { first, second, .. } | Kind::Perpendicular { first, second } => {
            *first = turn.of(first);
            *second = turn.of(second);
        }
        Kind::KnifeEdge { normal, .. } => *normal = turn.of(normal),
        _ => return None,
    }
    (image != *kind).then_some(image)
}

fn small_turn(numbers: &mut Numbers) -> Rotation {
    let q = [0; 3].map(|_| i64::from(numbers.between(-2, 2)));
    let w = i64::from(numbers.between(10, 60));
    Rotation::whole([w, q[0], q[1], q[2]])
}

/// Returns any direction of small integers.
#[must_use]
pub fn any(numbers: &mut Numbers) -> Vector {
    loop {
        let v = Vector([0; 3].map(|_| Ratio::whole(numbers.between(-3, 3).into())));
        if !v.is_zero() {
            return v;
        }
    }
}

/// Returns any direction perpendicular to a given direction.
#[must_use]
pub fn any_across(w: &Vector, numbers: &mut Numbers) -> Vector {
    loop {
        let v = w.cross(&any(numbers));
        if !v.is_zero() {
            return v;
        }
    }
}
