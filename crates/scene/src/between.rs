//! `markers`: a joint between two oriented markers. The z direction of a marker is the axis of the
//! joint, and x is perpendicular to it. The markers define the points and directions on both
//! bodies.

use std::ops::Range;

use joints::Argument;
use joints::space3::Axes;
use joints::spec::{Parameter, Shape, Spec};
use model::{BodyRef, Marker};

use crate::bodies::Bodies;
use crate::connection::listed;
use crate::direction;
use crate::field::Field;
use crate::place::{self, AT};
use crate::space::SceneSpace;
use crate::table::Table;

/// The key of the markers of both bodies.
pub(crate) const MARKERS: &str = "markers";

/// The expected value of the key `markers`.
const EXPECTED: &str = "two markers [first, second]";

/// Returns whether a definition connects two bodies at points or along axes, so that markers can
/// define it.
pub(crate) fn takes_markers<S: SceneSpace>(spec: &Spec) -> bool {
    let is_given = |shape: Shape| {
        matches!(
            shape,
            Shape::Point { .. } | Shape::Direction { .. } | Shape::Axes { .. }
        )
    };
    S::CARRIES
        && !spec.bearings
        && listed(spec) == 2
        && spec.parameters.iter().any(|p| is_given(p.shape))
}

/// The keys that `markers` replaces: the reference point, and parameters and keys for directions.
fn replaced(spec: &'static Spec) -> Vec<&'static str> {
    let mut keys = Vec::new();
    if spec.slots_of_points().next().is_some() {
        keys.extend([AT, place::local_key(spec)]);
    }
    keys.extend(directions(spec));
    keys.extend(direction::keys(spec));
    keys
}

/// The parameters of a definition that are directions.
fn directions(spec: &'static Spec) -> impl Iterator<Item = &'static str> {
    let is_written = |shape: Shape| {
        matches!(
            shape,
            Shape::Direction { .. } | Shape::Axes { like: None, .. }
        )
    };
    let parameters = spec.parameters.iter();
    parameters
        .filter(move |p| is_written(p.shape) && !p.optional)
        .map(|p| p.name)
}

/// The markers of a joint, and their position in the text.
pub(crate) struct JointMarkers<'b> {
    markers: [Option<&'b Marker>; 2],
    pub(crate) span: Range<usize>,
}

impl<'b> JointMarkers<'b> {
    /// Reads `markers` of a definition with these bodies. Returns `None` if the text does not
    /// contain the key.
    pub(crate) fn read<S: SceneSpace>(
        table: &mut Table,
        spec: &'static Spec,
        slots: &[Option<BodyRef>],
        bodies: &'b Bodies<S>,
    ) -> Option<Self> {
        if !takes_markers::<S>(spec) {
            return None;
        }
        let field = table.optional(MARKERS)?;
        let between = Self {
            markers: of_bodies(&field, slots, bodies).unwrap_or_default(),
            span: field.span(),
        };
        for key in replaced(spec) {
            if let Some(other) = table.optional(key) {
                let first = (field.span(), "position and axes follow from the markers");
                let second = (other.span(), "and here once more");
                table.exclusive(format!("`{MARKERS}` or `{key}`"), [first, second]);
            }
        }
        Some(between)
    }

    /// Returns the argument of a point or a direction. A direction along the axis is the z
    /// direction of the marker; the direction `cross` is the x direction of the marker.
    pub(crate) fn argument<S: SceneSpace>(
        &self,
        parameter: &Parameter,
        bodies: &Bodies<S>,
    ) -> Option<Argument> {
        match parameter.shape {
            Shape::Point { slot } => Some(S::argument(bodies.place_of(self.of(slot)?))),
            Shape::Axes { slot, .. } => {
                let [x, y, z] = self.of(slot)?.axes();
                Some(Argument::Axes(Axes::FRAME.map(|d| {
                    [0, 1, 2].map(|k| d[0] * x[k] + d[1] * y[k] + d[2] * z[k])
                })))
            }
            Shape::Direction { slot } => {
                let [x, _, z] = self.of(slot)?.axes();
                let is_across = parameter.name == direction::CROSS;
                Some(S::argument(S::vector(if is_across { x } else { z })))
            }
            _ => None,
        }
    }

    fn of(&self, slot: usize) -> Option<&'b Marker> {
        self.markers.get(slot).copied().flatten()
    }
}

/// One marker of each of the two bodies.
fn of_bodies<'b, S: SceneSpace>(
    field: &Field,
    slots: &[Option<BodyRef>],
    bodies: &'b Bodies<S>,
) -> Option<[Option<&'b Marker>; 2]> {
    let items = field.items(EXPECTED)?;
    let [first, second] = items.as_slice() else {
        field.miscount(EXPECTED, items.len(), 2);
        return None;
    };
    let of_slot = |slot: usize, field: &Field| {
        let marker = bodies.markers.find(field)?;
        let body = slots.get(slot).copied().flatten()?;
        if marker.body != body {
            let needed = format!("one of `{}` is needed here", bodies.names.name(body));
            bodies.not_of_body(marker, &needed, field);
            return None;
        }
        Some(marker)
    };
    Some([of_slot(0, first), of_slot(1, second)])
}
