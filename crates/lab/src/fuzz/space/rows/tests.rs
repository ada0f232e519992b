//! Tests that rows do no work in the motions that a joint allows, and that the rows exclude all
//! other motions. The motions are listed joint by joint, as twists of the second body while the
//! first body is at rest.

use super::super::drawing::GROUND;
use super::super::ratio::{Ratio, whole_multiples};
use super::super::vector::{Rotation, parts, whole};
use super::*;
use exact::Exact;

/// A twist of the second body: velocity of the body point at the origin of the ground, and angular
/// velocity.
struct Twist {
    velocity: Vector,
    rotation: Vector,
}

/// Returns a rotation about an axis through p.
fn turn(p: &Vector, axis: &Vector) -> Twist {
    Twist {
        velocity: p.cross(axis),
        rotation: axis.clone(),
    }
}

fn slide(along: &Vector) -> Twist {
    Twist {
        velocity: along.clone(),
        rotation: Vector::zero(),
    }
}

/// Returns rotations about all axes through a point.
fn ball(p: &Vector) -> Vec<Twist> {
    (0..3).map(|k| turn(p, &Vector::unit(k))).collect()
}

fn power(wrench: &Wrench, twist: &Twist) -> Ratio {
    &wrench.force.dot(&twist.velocity) + &wrench.moment.dot(&twist.rotation)
}

/// Compares the rows of a joint between a rotated body and a second body with the free motions of
/// the joint.
fn check(kind: Kind, free: &[Twist]) {
    let name = kind.name();
    assert!(kind.holds(), "{name}");
    let mut drawing = Drawing::default();
    let (first, second) = (drawing.body(), drawing.body());
    drawing.bodies[0].orientation = Rotation::whole([3, 1, -2, 4]);
    let pair = if kind.has_one_body() {
        [second, GROUND]
    } else {
        [first, second]
    };
    drawing.joint(pair, kind);
    let rows = Wrenches::from(&drawing).rows;
    // The wrenches act on the second body.
    let wrenches = || rows.iter().map(|row| &row.loads[1].1);
    for wrench in wrenches() {
        for twist in free {
            assert!(power(wrench, twist).is_zero(), "{name} {wrench:?}");
        }
    }
    let rank = |all: Vec<[Ratio; 6]>| {
        let whole = all.iter().map(|x| whole_multiples(x).0);
        Exact::of_whole(whole.collect()).rank()
    };
    let motions = free.iter().map(|t| {
        let twist = Wrench {
            force: t.velocity.clone(),
            moment: t.rotation.clone(),
        };
        twist.numbers()
    });
    let own = rank(wrenches().map(Wrench::numbers).collect());
    assert_eq!(own, rows.len(), "{name}");
    assert_eq!(own + rank(motions.collect()), 6, "{name}");
}

#[test]
fn joints_do_no_work_in_the_motions_that_they_allow() {
    let at = parts([1, -2, 5], 3);
    let (w, u, v) = (whole([1, 2, 2]), whole([2, 1, -2]), whole([2, -2, 1]));
    let from = at.along(&Ratio::new(3, 2), &w);
    let aside = at.along(&Ratio::new(3, 2), &u);
    let slides = || (0..3).map(|k| slide(&Vector::unit(k)));
    check(Kind::Spherical { at: at.clone() }, &ball(&at));
    check(
        Kind::Revolute {
            at: at.clone(),
            axis: w.clone(),
        },
        &[turn(&at, &w)],
    );
    check(
        Kind::Universal {
            at: at.clone(),
            first: w.clone(),
            second: u.clone(),
        },
        &[turn(&at, &w), turn(&at, &u)],
    );
    check(
        Kind::Translational {
            from: from.clone(),
            at: at.clone(),
            axis: w.clone(),
        },
        &[slide(&w)],
    );
    check(
        Kind::Cylindrical {
            from: from.clone(),
            at: at.clone(),
            axis: w.clone(),
        },
        &[slide(&w), turn(&at, &w)],
    );
    check(
        Kind::Planar {
            from: aside.clone(),
            at: at.clone(),
            normal: w.clone(),
        },
        &[slide(&u), slide(&v), turn(&at, &w)],
    );
    check(Kind::Fixed { at: at.clone() }, &[]);
    let mut free = ball(&at);
    free.push(slide(&w));
    check(
        Kind::PointOnLine {
            from,
            at: at.clone(),
            axis: w.clone(),
        },
        &free,
    );
    let mut free = ball(&at);
    free.extend([slide(&u), slide(&v)]);
    check(
        Kind::PointOnPlane {
            from: aside,
            at: at.clone(),
            normal: w.clone(),
        },
        &free,
    );
    let mut free: Vec<Twist> = slides().collect();
    check(Kind::Orientation, &free);
    free.push(turn(&at, &w));
    check(Kind::Parallel { axis: w.clone() }, &free);
    free.push(turn(&at, &u));
    check(
        Kind::Perpendicular {
            first: w.clone(),
            second: u.clone(),
        },
        &free,
    );
}

#[test]
fn rods_edges_and_wheels_do_no_work_in_the_motions_that_they_allow() {
    let at = parts([1, -2, 5], 3);
    let (w, u, v) = (whole([1, 2, 2]), whole([2, 1, -2]), whole([2, -2, 1]));
    let mut free = ball(&at);
    free.extend([slide(&u), slide(&v)]);
    check(
        Kind::Distance {
            from: at.along(&Ratio::new(3, 2), &w),
            at: at.clone(),
        },
        &free,
    );
    check(
        Kind::KnifeEdge {
            at: at.clone(),
            normal: w.clone(),
        },
        &free,
    );
    // A wheel rotates about every axis through the point of contact.
    let contact = parts([1, 1, 0], 2);
    check(
        Kind::Wheel {
            centre: &contact + &parts([0, 3, 4], 5),
            axis: parts([0, 4, -3], 5),
            contact: contact.clone(),
            normal: Vector::unit(2),
        },
        &ball(&contact),
    );
}

#[test]
fn drives_work_on_their_measure_only() {
    let (at, axis) = (parts([1, -2, 5], 3), whole([1, 2, 2]));
    let from = at.along(&Ratio::new(3, 2), &axis);
    let kind = Kind::Cylindrical { from, at, axis };
    let Kind::Cylindrical { at, axis, .. } = &kind else {
        return;
    };
    let (spin, slip) = (turn(at, axis), slide(axis));
    let angle = driven(&kind, Measure::Angle);
    let displacement = driven(&kind, Measure::Displacement);
    assert!(power(&angle, &slip).is_zero());
    assert!(power(&displacement, &spin).is_zero());
    assert!(!power(&angle, &spin).is_zero());
    assert!(!power(&displacement, &slip).is_zero());
}

#[test]
fn the_basis_follows_the_least_axis_of_the_first_body() {
    let mut drawing = Drawing::default();
    let body = drawing.body();
    let axis = whole([2, 1, 2]);
    let kind = Kind::Revolute {
        at: Vector::zero(),
        axis: axis.clone(),
    };
    drawing.joint([body, GROUND], kind);
    // The y-axis has the smallest component along the axis: u = 9·y − (2, 1, 2).
    let [u, v] = basis(&drawing, &drawing.joints[0], &axis);
    assert_eq!(u, whole([-2, 8, -2]));
    assert_eq!(v, axis.cross(&u));
    assert!(!basis_is_doubtful(&drawing, &drawing.joints[0], &axis));
    assert!(basis_is_doubtful(
        &drawing,
        &drawing.joints[0],
        &Vector::unit(2)
    ));
    // After half a turn about the diagonal of x and z the same axis of the body still has the
    // smallest component.
    drawing.bodies[0].orientation = Rotation::whole([0, 1, 0, 1]);
    let [turned, _] = basis(&drawing, &drawing.joints[0], &axis);
    assert_eq!(turned, whole([2, -8, 2]));
}
