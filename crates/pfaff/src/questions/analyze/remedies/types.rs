//! Types of joints that may replace a joint. No type is known by name: its description states its
//! rows and parameters.

use joints::spec::{ConstraintSpec, Role, Shape};
use model::reaction::ConstraintGroup;
use model::{ConstraintId, Frame, Registry, SpaceKind};

use crate::configuration::ConfigurationAnalysis;
use crate::error::StudyError;
use scene::RetypedJoint;

/// Another type for a joint.
#[derive(Clone, Debug)]
pub(super) struct OtherType {
    pub(super) id: ConstraintId,
    pub(super) spec: &'static ConstraintSpec,
    pub(super) retyped: RetypedJoint,
}

/// Returns the types with fewer rows that need no other data than the points of a joint and
/// directions along its axes.
pub(super) fn other_types(
    of: &ConfigurationAnalysis<'_>,
    registry: &Registry,
    (id, group): (ConstraintId, &ConstraintGroup),
) -> Result<Vec<OtherType>, StudyError> {
    if group.is_drive() || !has_only_directions(group.spec) {
        return Ok(Vec::new());
    }
    let from = &group.spec.common;
    let axes = axes(of, id, group.space)?;
    let all = registry.constraints_in(group.space).into_iter();
    let fitting = all.filter(|to| {
        let points = |spec: &'static ConstraintSpec| spec.common.slots_of_points();
        to.rows.len() < group.spec.rows.len()
            && has_only_directions(to)
            && to.common.slots.len() == from.slots.len()
            && points(to).eq(points(group.spec))
    });
    let mut out = Vec::new();
    for to in fitting {
        let retyped = |directions| OtherType {
            id,
            spec: to,
            retyped: RetypedJoint {
                joint: group.name.clone(),
                from,
                to: &to.common,
                directions,
            },
        };
        let needed: Vec<(&'static str, usize)> = directions(to).collect();
        let is_given = |(name, _): &(&str, usize)| directions(group.spec).any(|(x, _)| x == *name);
        let is_kept = needed.iter().all(is_given);
        if is_kept {
            out.push(retyped(Vec::new()));
        }
        if let [(key, 0)] = needed[..] {
            // The last axis is the direction in the text.
            let new = axes.len() - usize::from(is_kept && axes.len() == 3);
            let new = axes[..new].iter();
            out.extend(new.map(|axis| retyped(vec![(key, axis.clone())])));
        }
    }
    Ok(out)
}

/// Whether a joint has no other parameters than points and directions, and at least one point.
fn has_only_directions(spec: &ConstraintSpec) -> bool {
    let common = &spec.common;
    let is_simple = |shape| {
        matches!(
            shape,
            Shape::Point { .. } | Shape::Direction { .. } | Shape::Axes { .. }
        )
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

/// Returns the axes of a joint in the frame of its first body; those of the body if the joint has
/// no axes.
fn axes(
    of: &ConfigurationAnalysis<'_>,
    id: ConstraintId,
    space: SpaceKind,
) -> Result<Vec<Vec<f64>>, StudyError> {
    let frames = of.frames(id)?;
    let axes = |frame: Frame| {
        let found = frames.iter().find(|found| found.frame == frame);
        found.map(|found| found.axes.to_vec())
    };
    let global = axes(Frame::Global).unwrap_or_default();
    let body = axes(Frame::FirstBody).unwrap_or(global);
    let joint = axes(Frame::Joint).filter(|_| space == SpaceKind::Space3);
    let joint = joint.unwrap_or_else(|| body.clone());
    let component = |axis: &[f64; 3], along: &[f64; 3]| {
        let x: f64 = axis.iter().zip(along).map(|(a, b)| a * b).sum();
        // Rounding is not part of a direction.
        if (x - x.round()).abs() < ROUNDING { x.round() + 0.0 } else { x }
    };
    let in_body = |axis| {
        let vector: Vec<f64> = body.iter().map(|along| component(axis, along)).collect();
        // Both signs describe the same line or plane.
        let is_negative = vector.iter().find(|x| **x != 0.0).is_some_and(|x| *x < 0.0);
        let sign = if is_negative { -1.0 } else { 1.0 };
        vector.iter().map(|x| sign * x + 0.0).collect()
    };
    Ok(joint.iter().map(in_body).collect())
}

/// Largest rounding of a component of a unit vector.
const ROUNDING: f64 = 1e-12;
