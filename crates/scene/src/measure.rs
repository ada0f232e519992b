//! `[[measure]]`: quantities between markers.

use model::{Measure, MeasureKind, SpaceKind};

use crate::body::GROUND;
use crate::key::{Key, TYPE, Takes};
use crate::marker::Markers;
use crate::mistake::Mistake;
use crate::nearest::{did_you_mean, list};
use crate::plausible;
use crate::source_map::Entry;
use crate::table::Table;

const KIND: Key = Key::required(TYPE, "what is measured", Takes::OneOf(in_plane))
    .doc("What is measured, of the second marker relative to the first: `distance` (m); `angle` between their axes, not reduced to one revolution (rad); `x` and `y` in the axes of the first (m); `speed` as seen from the first (m/s); `angular-velocity` (rad/s)");
const SPATIAL_KIND: Key = Key::required(TYPE, "what is measured", Takes::OneOf(in_space))
    .doc("What is measured, of the second marker relative to the first: `distance` (m); `x`, `y` and `z` in the axes of the first body (m); `speed` as seen from it (m/s); `angular-velocity`, its size (rad/s)");
const MARKERS: Key = Key::required(
    "markers",
    "one or two markers [\"a\", \"b\"]",
    Takes::Texts(1),
)
.doc("Two markers, or one and `ground`; one alone is measured from the ground");

/// Keys of a measure, except its name.
pub(crate) fn keys(space: SpaceKind) -> [Key; 2] {
    let kind = match space {
        SpaceKind::Space3 => SPATIAL_KIND,
        _ => KIND,
    };
    [kind, MARKERS]
}

fn kinds(space: SpaceKind) -> Vec<&'static str> {
    let mut kinds = MeasureKind::ALL.to_vec();
    kinds.retain(|kind| kind.exists_in(space));
    kinds.into_iter().map(MeasureKind::name).collect()
}

fn in_plane() -> Vec<&'static str> {
    kinds(SpaceKind::Plane)
}

fn in_space() -> Vec<&'static str> {
    kinds(SpaceKind::Space3)
}

/// Reads one measure with its position in the text; `None` if it could not be read.
pub(crate) fn read(
    mut table: Table,
    name: &str,
    space: SpaceKind,
    markers: &Markers,
) -> Option<(Measure, Entry)> {
    let kind = kind(&mut table, space);
    let between = between(&mut table, markers);
    let entry = Entry::of(name, &table);
    table.close();
    let measure = Measure {
        name: name.to_owned(),
        kind: kind?,
        between: between?,
    };
    Some((measure, entry))
}

fn kind(table: &mut Table, space: SpaceKind) -> Option<MeasureKind> {
    let field = table.required(&KIND)?;
    let name = field.text(KIND.expected)?;
    let mut known = MeasureKind::ALL.into_iter();
    let found = known.find(|kind| kind.name() == name && kind.exists_in(space));
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

/// Reads the indices of the two markers; `None` stands for the ground.
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
