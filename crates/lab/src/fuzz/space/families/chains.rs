//! Open chains, closed loops of any joints, and loops of axes through one point.

use super::super::catalogue::revolute;
use super::super::drawing::{GROUND, Kind, Side};
use super::super::ratio::Ratio;
use super::super::vector::Vector;
use super::pen::Pen;

pub(super) fn chains(pen: &mut Pen<'_>) {
    if pen.once_in(3) {
        tree(pen);
    } else {
        ring(pen);
    }
}

/// Draws a tree. The joint rows of a tree are independent, because no joint closes a loop. A knife
/// edge on the last body is also independent, if this body can move along the normal of the edge;
/// this condition is not checked.
fn tree(pen: &mut Pen<'_>) {
    let mut bodies: Vec<Side> = vec![pen.base];
    for _ in 0..1 + pen.numbers.below(4) {
        let from = bodies[pen.numbers.below(bodies.len())];
        let to = pen.body();
        let kind = pen.any_joint();
        pen.joint([from, to], kind);
        bodies.push(to);
    }
    pen.expects(0);
    if pen.once_in(4) {
        let (at, normal) = (pen.point(), pen.direction());
        let last = bodies[bodies.len() - 1];
        pen.joint([last, GROUND], Kind::KnifeEdge { at, normal });
        pen.unknown();
    }
}

/// Draws a loop of joints. In two of three loops, most axes are parallel.
fn ring(pen: &mut Pen<'_>) {
    let n = 3 + pen.numbers.below(4);
    let (common, centre) = (pen.direction(), pen.point());
    let is_mixed = pen.once_in(3);
    let mut kinds = Vec::new();
    for _ in 0..n {
        let is_own = pen.once_in(if is_mixed { 2 } else { 6 });
        let axis = if is_own {
            pen.direction()
        } else {
            common.clone()
        };
        let at = match pen.numbers.below(3) {
            0 => centre.along(&pen.step.clone(), &axis),
            _ => pen.point(),
        };
        let kind = pen.any_joint_at(at, axis);
        kinds.push(kind);
    }
    let (_, first) = pen.chain(pen.base, pen.base, &kinds);
    pen.unknown();
    pen.drives(first);
}

/// Draws a loop of axes through one point. If the axes span space, all self-stresses are forces
/// through this point.
pub(super) fn spherical(pen: &mut Pen<'_>) {
    let n = 3 + pen.numbers.below(4);
    let centre = pen.point();
    let mut axes: Vec<Vector> = Vec::new();
    while axes.len() < n {
        let axis = pen.direction();
        if !axes.iter().any(|other| other.is_along(&axis)) {
            axes.push(axis);
        }
    }
    let kinds = axes.iter().map(|axis| {
        let steps = Ratio::whole(pen.numbers.between(0, 3).into());
        revolute(&centre.along(&steps, axis), axis)
    });
    let kinds: Vec<Kind> = kinds.collect();
    let normal = axes[0].cross(&axes[1]);
    let spans_space = axes.iter().any(|axis| !axis.dot(&normal).is_zero());
    let (_, first) = pen.chain(pen.base, pen.base, &kinds);
    pen.expects(if spans_space { 3 } else { 4 });
    pen.drives(first);
}
