//! `[[marker]]`: named points of bodies, and references to these names in the rest of the file.

use std::collections::HashMap;

use joints::{Plane, Space3};
use model::{Marker, SpaceKind};

use crate::body::{BodyNames, read_orientation};
use crate::dimension::Dimension;
use crate::field::Field;
use crate::key::{Interval, Key, Takes};
use crate::mistake::Mistake;
use crate::nearest::all;
use crate::source_map::Entry;
use crate::space::SceneSpace;
use crate::table::Table;
use crate::tolerance;
use crate::units;

pub(crate) const BODY: Key = Key::required("body", "the name of a body", Takes::Text)
    .doc("The body that carries the marker, or `ground`");
const POINT: Key = Key::pair("point")
    .expecting("a point [x, y]")
    .needed()
    .unit(Dimension::LENGTH)
    .doc("Position [x, y] of the marker in the frame of the body");
const SPATIAL_POINT: Key = Key::triple("point")
    .expecting("a point [x, y, z]")
    .needed()
    .unit(Dimension::LENGTH)
    .doc("Position [x, y, z] of the marker in the frame of the body");
const ANGLE: Key = Key::optional("angle", "a number", Takes::Number(Interval::Any))
    .unit(Dimension::ANGLE)
    .doc("Angle of its axes in the frame of the body; if it is given, the angle of the marker is written, too");
const ORIENTATION: Key = Key::optional(
    "orientation",
    "a table { quaternion | axis, angle | rpy | matrix }",
    Takes::Orientation,
)
.doc("Orientation of its axes in the frame of the body, written as that of a body: { quaternion }, { axis, angle }, { rpy } or { matrix }; z is the axis of a joint between markers, x lies across it");
const TOLERANCE: Key =
    tolerance::length("Tolerance of its point [default: tolerance of its body or of the scene]");

/// Keys of a marker, except its name.
pub(crate) fn keys(space: SpaceKind) -> &'static [Key] {
    match space {
        SpaceKind::Space3 => &[BODY, SPATIAL_POINT, ORIENTATION, TOLERANCE],
        _ => &[BODY, POINT, ANGLE, TOLERANCE],
    }
}

/// The keys of both spaces, each with the name of its space.
fn all_keys() -> impl Iterator<Item = (&'static str, &'static str)> {
    fn of<S: SceneSpace>() -> impl Iterator<Item = (&'static str, &'static str)> {
        keys(S::KIND).iter().map(|key| (key.name, S::NAME))
    }
    of::<Plane>().chain(of::<Space3>())
}

/// The expected value in messages, if it may be a marker.
const NAME: &str = "the name of a marker";

/// The markers of the text, with their indices.
#[derive(Default)]
pub(crate) struct Markers {
    pub(crate) list: Vec<Marker>,
    pub(crate) entries: Vec<Entry>,
    /// Indices by name; `None` if a marker could not be read. If a name is used twice, the index of
    /// the first marker.
    by_name: HashMap<String, Option<usize>>,
}

impl Markers {
    /// Reads one marker; its body must have one of these names.
    pub(crate) fn read<S: SceneSpace>(&mut self, mut table: Table, name: &str, bodies: &BodyNames) {
        let body = table.of_key(&BODY).and_then(|field| bodies.find(&field));
        let point = table.needed(POINT.name, S::POINT);
        let point = point.and_then(|field| field.vector::<S>(S::POINT, POINT.unit));
        let (mut angle, mut orientation) = (None, None);
        if S::KIND == SpaceKind::Space3 {
            let field = table.optional(&ORIENTATION);
            orientation = field.map(|field| read_orientation(&field));
        } else {
            let field = table.optional(&ANGLE);
            angle = field.map(|field| field.number(ANGLE.unit));
        }
        let tolerance = tolerance::read(&mut table, &TOLERANCE);
        let entry = Entry::of(name, &table);
        table.spaces(all_keys());
        table.close();
        let at = self.list.len();
        let is_turned = angle != Some(None) && orientation != Some(None);
        let read = body.zip(point).filter(|_| is_turned);
        let index = read.map(|_| at);
        self.by_name.entry(name.to_owned()).or_insert(index);
        if let Some((body, point)) = read {
            self.list.push(Marker {
                name: name.to_owned(),
                body,
                point: S::point(point),
                angle: angle.flatten(),
                orientation: orientation.flatten(),
                tolerance,
            });
            self.entries.push(entry);
        }
    }

    /// Returns whether a field for a point contains the name of a marker. This is true for the name
    /// of a known marker. In a scene with markers, it is also true for a text that is not a number
    /// with a unit.
    pub(crate) fn may_be(&self, field: &Field) -> bool {
        let text = field.value.get_ref().as_str();
        text.is_some_and(|text| {
            self.by_name.contains_key(text)
                || !self.by_name.is_empty() && units::advice(text).is_none()
        })
    }

    /// Returns the index of the marker with the name in this field. Returns `None` if the name is
    /// unknown, which this function reports, or if the marker could not be read, which was reported
    /// earlier.
    pub(crate) fn index(&self, field: &Field) -> Option<usize> {
        let name = field.text(NAME)?;
        if let Some(found) = self.by_name.get(name) {
            return *found;
        }
        let names = || self.by_name.keys().map(String::as_str);
        let mut sorted: Vec<&str> = names().collect();
        sorted.sort_unstable();
        let near = field.findings.suggest(name, sorted.iter().copied());
        field.error_with_help(
            Mistake::UnknownMarker,
            format!(" refers to the unknown marker `{name}`"),
            "no such marker",
            match near {
                Some(near) => Some(format!("did you mean `{near}`?")),
                None => all("markers", sorted),
            },
        );
        None
    }

    /// Works like [`Self::index`], but returns the marker itself.
    pub(crate) fn find(&self, field: &Field) -> Option<&Marker> {
        self.index(field).map(|at| &self.list[at])
    }
}
