//! `bearings;`: the definition takes its bodies from two joints, each of which supports one wheel
//! on a common carrier. The definition also takes all points and axes except the last point from
//! these joints.

use super::tree::{Definition, Param, ParamKind};
use crate::space::Space;

/// Requirements on such a definition before the word `bearings`.
pub(super) const NEEDED: &str = "`bearings` stands after the parameters of a `space` definition of two wheels and their \
     carrier: a `Point` in each wheel and three in the carrier, for the bearings of both wheels and for the place; \
     two `Axes` in the carrier, for these bearings, and one in each wheel `like` them; a `Direction` in the carrier, \
     the line of action; and nothing else";

/// Returns whether the definition has slots, points and axes for bearings.
pub(super) fn are_possible(d: &Definition) -> bool {
    let [first, second, carrier] = d.slots.as_slice() else {
        return false;
    };
    let points = |slot| {
        let is_here = |kind: &&ParamKind| matches!(kind, ParamKind::Point(s) if s == slot);
        d.params.iter().map(|p| &p.kind).filter(is_here).count()
    };
    // Names of the axes in a slot, and of the axes that they follow with `like`.
    let axes = |own| {
        let axes = d.params.iter().filter_map(move |p| match &p.kind {
            ParamKind::Axes { slot, like, .. } if slot == own => Some((&p.name, like.as_ref())),
            _ => None,
        });
        axes.collect::<Vec<_>>()
    };
    let [carried, of_first, of_second] = [carrier, first, second].map(axes);
    let [(axes_first, None), (axes_second, None)] = carried[..] else {
        return false;
    };
    let likes = |own: &[(_, Option<_>)]| own.iter().map(|(_, like)| *like).collect::<Vec<_>>();
    let is_line = |p: &Param| matches!(&p.kind, ParamKind::Direction(slot) if slot == carrier);
    d.space == Space::Space3
        && d.params.len() == 10
        && d.params.iter().any(is_line)
        && [first, second, carrier].map(points) == [1, 1, 3]
        && likes(&of_first) == [Some(axes_first)]
        && likes(&of_second) == [Some(axes_second)]
}
