//! `[[measure]]`: quantities between markers.

use joints::Space3;
use model::{Measure, MeasureKind, SpaceKind};

use crate::body::GROUND;
use crate::dimension::Dimension;
use crate::field::{Field, all};
use crate::key::{Key, TYPE, Takes};
use crate::marker::Markers;
use crate::mistake::Mistake;
use crate::nearest::{did_you_mean, list};
use crate::plausible;
use crate::source_map::Entry;
use crate::space::SceneSpace;
use crate::table::Table;

const KIND: Key = Key::required(TYPE, "what is measured", Takes::OneOf(in_plane))
    .doc("What is measured, of the second marker relative to the first: `distance` (m); `angle` between their axes, not reduced to one revolution (rad); `x` and `y` in the axes of the first, and the `component` along an axis (m); `speed` as seen from the first (m/s); `angular-velocity` (rad/s)");
const SPATIAL_KIND: Key = Key::required(TYPE, "what is measured", Takes::OneOf(in_space))
    .doc("What is measured, of the second marker relative to the first: `distance` (m); `angle` between directions, `inclination` of a direction to a plane (rad); `x`, `y` and `z` in the axes of the first, and the `component` along an axis (m); `speed` as seen from the first (m/s); `angular-velocity`, its size (rad/s)");
const MARKERS: Key = Key::required(
    "markers",
    "one or two markers [\"a\", \"b\"]",
    Takes::Texts(1),
)
.doc("Two markers, or one and `ground`; one alone is measured from the ground");
const AXIS: &str = "axis";
const AXES: &str = "axes";
const ABOUT: Key = Key::optional("about", DIRECTION, Takes::Direction(3))
    .doc("Direction in the axes of the first marker about which an `angle` has its sign: it is the angle between the projections perpendicular to this direction; without it, the angle is from 0 to π");
const DIRECTION: &str = "an axis \"x\" or a vector";
const DIRECTIONS: &str = "two directions [\"x\", \"y\"], each an axis or a vector";

/// Keys of a measure, except its name.
pub(crate) fn keys(space: SpaceKind) -> Vec<Key> {
    let n = space.n_translations();
    let axis = Key::optional(AXIS, DIRECTION, Takes::Direction(n))
        .doc("Direction of a `component`, in the axes of the first marker");
    let axes = Key::optional(AXES, DIRECTIONS, Takes::Directions(n));
    match space {
        SpaceKind::Space3 => vec![
            SPATIAL_KIND,
            MARKERS,
            axis,
            axes.doc("An `angle` is from the first direction, in the axes of the first marker, to the second direction, in those of the second marker; an `inclination` is that of the second direction to the plane perpendicular to the first"),
            ABOUT,
        ],
        _ => vec![
            KIND,
            MARKERS,
            axis,
            axes.doc("An `angle` is from the first direction, in the axes of the first marker, to the second direction, in those of the second marker; if a direction is omitted, it is the x axis of its marker"),
        ],
    }
}

fn kinds(space: SpaceKind) -> Vec<&'static str> {
    let mut kinds = MeasureKind::ALL.to_vec();
    kinds.retain(|kind| kind.fault(space).is_none());
    kinds.into_iter().map(MeasureKind::name).collect()
}

fn in_plane() -> Vec<&'static str> {
    kinds(SpaceKind::Plane)
}

fn in_space() -> Vec<&'static str> {
    kinds(SpaceKind::Space3)
}

/// Reads one measure with its position in the text; `None` if it could not be read.
pub(crate) fn read<S: SceneSpace>(
    mut table: Table,
    name: &str,
    markers: &Markers,
) -> Option<(Measure, Entry)> {
    let kind = kind(&mut table, S::KIND);
    let between = between(&mut table, markers);
    let entry = Entry::of(name, &table);
    let is_known = kind.is_some();
    let kind = kind.and_then(|kind| directed::<S>(&mut table, kind));
    if S::KIND != SpaceKind::Space3 {
        table.spaces([(ABOUT.name, Space3::NAME)].into_iter());
    }
    if is_known {
        table.close();
    }
    let measure = Measure {
        name: name.to_owned(),
        kind: kind?,
        between: between?,
    };
    Some((measure, entry))
}

/// Reads the directions of a measure of this kind.
fn directed<S: SceneSpace>(table: &mut Table, kind: MeasureKind) -> Option<MeasureKind> {
    let component = MeasureKind::Along([1.0; 3]).name();
    match kind {
        MeasureKind::Along(_) if kind.name() == component => {
            let axis = table.needed(AXIS, DIRECTION)?;
            direction::<S>(&axis).map(MeasureKind::Along)
        }
        MeasureKind::Angle { directions, about } => {
            let is_spatial = S::KIND == SpaceKind::Space3;
            let axes = if is_spatial {
                Some(table.needed(AXES, DIRECTIONS))
            } else {
                table.optional(AXES).map(Some)
            };
            let about = match table.optional(&ABOUT).filter(|_| is_spatial) {
                Some(field) => Some(direction::<S>(&field)),
                None => about.map(Some),
            };
            let directions = match axes {
                Some(field) => pair::<S>(&field?)?,
                None => directions,
            };
            let about = match about {
                Some(about) => Some(about?),
                None => None,
            };
            Some(MeasureKind::Angle { directions, about })
        }
        MeasureKind::Inclination(_) => {
            let axes = table.needed(AXES, DIRECTIONS)?;
            pair::<S>(&axes).map(MeasureKind::Inclination)
        }
        other => Some(other),
    }
}

/// Reads two directions.
fn pair<S: SceneSpace>(field: &Field) -> Option<[[f64; 3]; 2]> {
    let items = field.items(DIRECTIONS)?;
    if items.len() != 2 {
        field.miscount(DIRECTIONS, items.len(), 2);
        return None;
    }
    all(&items, direction::<S>)?.try_into().ok()
}

/// Reads a direction: the name of an axis, or a vector.
fn direction<S: SceneSpace>(field: &Field) -> Option<[f64; 3]> {
    let Some(name) = field.value.get_ref().as_str() else {
        let vector = field.vector::<S>(DIRECTION, Dimension::NONE)?;
        return Some(S::point(vector));
    };
    let known = &AXIS_NAMES[..S::DIM];
    let Some(axis) = known.iter().position(|known| *known == name) else {
        let names = known.iter().copied();
        field.error_with_help(
            Mistake::UnknownChoice,
            format!(": `{}` names the unknown axis `{name}`", field.key),
            "no such axis",
            format!("the axes are {}; a vector is a direction, too", list(names)),
        );
        return None;
    };
    let mut direction = [0.0; 3];
    direction[axis] = 1.0;
    Some(direction)
}

/// Names of the axes of a marker.
pub(crate) const AXIS_NAMES: [&str; 3] = ["x", "y", "z"];

fn kind(table: &mut Table, space: SpaceKind) -> Option<MeasureKind> {
    let field = table.required(&KIND)?;
    let name = field.text(KIND.expected)?;
    let mut known = MeasureKind::ALL.into_iter();
    let found = known.find(|kind| kind.name() == name && kind.fault(space).is_none());
    if found.is_none() {
        field.error_with_help(
            Mistake::UnknownType,
            format!(" has the unknown type `{name}`"),
            "unknown type",
            did_you_mean(name, kinds(space)).or(Some(format!(
                "the types of a measure are {}",
                list(kinds(space))
            ))),
        );
    }
    found
}

/// Reads the indices of the two markers. `None` means the ground.
fn between(table: &mut Table, markers: &Markers) -> Option<[Option<usize>; 2]> {
    let field = table.required(&MARKERS)?;
    let items = field.items(MARKERS.expected)?;
    if !(1..=2).contains(&items.len()) {
        field.miscount(MARKERS.expected, items.len(), 2);
        return None;
    }
    let read = items
        .iter()
        .map(|item| match item.value.get_ref().as_str() {
            Some(GROUND) => Some(None),
            _ => markers.index(item).map(Some),
        });
    let read: Vec<Option<Option<usize>>> = read.collect();
    let between = match read[..] {
        [only] => [None, only?],
        [first, second] => [first?, second?],
        _ => return None,
    };
    plausible::measure(&field, between, &markers.list);
    Some(between)
}
