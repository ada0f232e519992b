//! Types of joints that may replace a joint. This module contains no names of types. The
//! description of a type states its rows and parameters.

use joints::spec::{ConstraintSpec, Role, Shape};
use model::reaction::ConstraintGroup;
use model::words::rounded;
use model::{ConstraintId, Frame, Reactions, Registry, SpaceKind};
use scene::RetypedJoint;

/// Cost of a joint of another type.
const CHANGED: usize = 1;
/// Cost of a force component that a joint no longer transmits. Two components of one joint cost
/// four times as much, because a joint should still transmit a force along its main direction. A
/// released moment has no cost.
const FORCE: usize = 4;
/// Cost of a direction that the scene does not state.
const DIRECTION: usize = 6;

/// Largest rounding of a component of a unit vector.
const ROUNDING: f64 = 1e-12;

/// Another type for a joint.
pub(super) struct OtherType {
    pub(super) id: ConstraintId,
    pub(super) retyped: RetypedJoint,
    /// Numbers of force components and of moment components.
    loads: [usize; 2],
    /// Cost of the replacement.
    pub(super) cost: usize,
}

impl OtherType {
    /// Describes the new joint. Its kind follows from its loads.
    pub(super) fn words(&self, space: SpaceKind) -> String {
        let kind = match (space, self.loads) {
            (SpaceKind::Space3, [3, 0]) => "a ball joint",
            (SpaceKind::Space3, [2, 0]) => "a ball on a line",
            (SpaceKind::Space3, [1, 0]) => "a ball on a plane",
            (SpaceKind::Space3, [2, 2]) => "a joint that turns and slides",
            (SpaceKind::Plane, [2, 0]) => "a hinge",
            (SpaceKind::Plane, [1, 0]) => "a pin on a line",
            _ => "a joint",
        };
        let directions = self.retyped.directions.iter().map(|(key, vector)| {
            let vector: Vec<String> = vector.iter().map(|x| rounded(*x)).collect();
            format!(", {key} = [{}]", vector.join(", "))
        });
        let directions: String = directions.collect();
        format!("{kind} (`{}`{directions})", self.retyped.to.scene_type)
    }
}

/// Returns types that can replace a joint. Such a type needs no other data than the points of the
/// joint and directions along its axes. It still transmits a force, and it has fewer rows; the
/// difference is at most `released`. The cheapest types come first.
pub(super) fn other_types(
    of: Reactions<'_>,
    registry: &Registry,
    (id, group): (ConstraintId, &ConstraintGroup),
    released: usize,
) -> Vec<OtherType> {
    if group.is_drive() || !has_only_directions(group.spec) {
        return Vec::new();
    }
    let axes = axes(of, id, group.space);
    let forces = |spec: &ConstraintSpec| {
        let is_force =
            |row| move |[c, r]: &[usize; 2]| *r == row && group.space.forces().contains(c);
        let rows = 0..spec.rows.len();
        rows.filter(|row| spec.wrench.iter().any(is_force(*row)))
            .count()
    };
    let points = |spec: &'static ConstraintSpec| spec.common.slots_of_points();
    let mut out = Vec::new();
    for to in registry.constraints_in(group.space) {
        let fewer = group.spec.rows.len().saturating_sub(to.rows.len());
        let is_fitting = (1..=released).contains(&fewer)
            && has_only_directions(to)
            && to.common.slots.len() == group.spec.common.slots.len()
            && points(to).eq(points(group.spec))
            && forces(to) > 0;
        if !is_fitting {
            continue;
        }
        let mut add = |directions: Vec<(&'static str, Vec<f64>)>| {
            let released = forces(group.spec).saturating_sub(forces(to));
            out.push(OtherType {
                id,
                loads: [forces(to), to.rows.len() - forces(to)],
                cost: CHANGED + FORCE * released * released + DIRECTION * directions.len(),
                retyped: RetypedJoint {
                    joint: group.name.clone(),
                    from: &group.spec.common,
                    to: &to.common,
                    directions,
                },
            });
        };
        let needed: Vec<(&'static str, usize)> = directions(to).collect();
        let is_given = |(name, _): &(&str, usize)| directions(group.spec).any(|(x, _)| x == *name);
        let is_kept = needed.iter().all(is_given);
        if is_kept {
            add(Vec::new());
        }
        if let [(key, 0)] = needed[..] {
            // The last axis of a joint is the direction in the text.
            let new = axes.len() - usize::from(is_kept && axes.len() == 3);
            axes[..new]
                .iter()
                .for_each(|axis| add(vec![(key, axis.clone())]));
        }
    }
    out.sort_by_key(|other: &OtherType| other.cost);
    out
}

/// Whether a joint has no other parameters than points and directions, and at least one point.
fn has_only_directions(spec: &ConstraintSpec) -> bool {
    let common = &spec.common;
    let is_simple = |shape| {
        let is_point = matches!(shape, Shape::Point { .. });
        is_point || matches!(shape, Shape::Direction { .. } | Shape::Axes { .. })
    };
    spec.role == Role::Joint
        && spec.nonholonomic() == 0
        && !spec.rheonomic
        && spec.turns == 0
        && common.variant.is_none()
        && !common.points_apart
        && !common.bearings
        && common.slots_of_points().next().is_some()
        && common.parameters.iter().all(|p| is_simple(p.shape))
}

/// Returns the directions that a scene has to state, with the indices of their bodies.
fn directions(spec: &'static ConstraintSpec) -> impl Iterator<Item = (&'static str, usize)> {
    let all = spec.common.parameters.iter().filter(|p| !p.optional);
    all.filter_map(|p| match p.shape {
        Shape::Direction { slot } | Shape::Axes { slot, like: None } => Some((p.name, slot)),
        _ => None,
    })
}

/// Returns the axes of a joint in the frame of its first body. If the joint has no axes, returns
/// the axes of the body.
fn axes(of: Reactions<'_>, id: ConstraintId, space: SpaceKind) -> Vec<Vec<f64>> {
    let axes = |frame: Frame| of.axes(id, frame).map(|axes| axes.to_vec());
    let body = axes(Frame::FirstBody).or_else(|| axes(Frame::Global));
    let body = body.unwrap_or_default();
    let joint = axes(Frame::Joint).filter(|_| space == SpaceKind::Space3);
    let in_body = |axis: &[f64; 3]| {
        let along = |other: &[f64; 3]| {
            let x = linalg::kernels::dot(axis, other);
            // Rounding errors are removed from a direction.
            if (x - x.round()).abs() < ROUNDING {
                x.round()
            } else {
                x
            }
        };
        let vector: Vec<f64> = body.iter().map(along).collect();
        // Both signs describe the same line or plane.
        let is_negative = vector.iter().find(|x| **x != 0.0).is_some_and(|x| *x < 0.0);
        let sign = if is_negative { -1.0 } else { 1.0 };
        vector.iter().map(|x| sign * x + 0.0).collect()
    };
    joint
        .as_ref()
        .unwrap_or(&body)
        .iter()
        .map(in_body)
        .collect()
}
