//! The keys of directions that are not parameters of a definition.

use joints::spec::{Parameter, Shape, Spec};

/// The key for the axes in which directions are given.
pub(crate) const FRAME: &str = "frame";
/// The key for a direction perpendicular to an axis.
pub(crate) const CROSS: &str = "cross";
/// The key for the axis in the frames of both bodies.
pub(crate) const AXES: &str = "axes";

/// Values of `frame`; the first one is the default.
pub(crate) const FRAMES: [&str; 2] = ["body", "global"];

/// Whether a definition has a parameter of this kind.
fn has(spec: &Spec, is: impl Fn(&Parameter) -> bool) -> bool {
    spec.parameters.iter().any(is)
}

/// The keys of directions that are not parameters of a definition, in a space that transforms
/// directions between bodies.
pub(crate) fn keys(spec: &Spec) -> impl Iterator<Item = &'static str> {
    let is_written = |p: &Parameter| {
        matches!(
            p.shape,
            Shape::Direction { .. } | Shape::Axes { like: None, .. }
        ) && !p.optional
    };
    let has_axes = has(spec, |p| {
        matches!(p.shape, Shape::Axes { .. }) && is_written(p)
    });
    let is_paired = has(spec, |p| {
        matches!(p.shape, Shape::Axes { like: Some(_), .. })
    });
    let takes_cross = has_axes && !has(spec, |p| p.name == CROSS);
    // The axes of wheels are taken from the bearings, not from the table.
    let keys = [
        (FRAME, has(spec, is_written)),
        (CROSS, takes_cross && !spec.bearings),
        (AXES, has_axes && is_paired && !spec.bearings),
    ];
    keys.into_iter()
        .filter(|(_, takes)| *takes)
        .map(|(key, _)| key)
}
