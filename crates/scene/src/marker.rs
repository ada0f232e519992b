//! `[[marker]]`: places of bodies by name, and their names elsewhere in the file.

use std::collections::HashMap;

use joints::{Plane, Space3};
use model::{BodyRef, Marker, SpaceKind};

use crate::body::{Bodies, read_orientation};
use crate::dimension::Dimension;
use crate::field::Field;
use crate::findings::Findings;
use crate::key::{Interval, Key, Takes};
use crate::mistake::Mistake;
use crate::nearest::all;
use crate::source_map::Entry;
use crate::space::SceneSpace;
use crate::table::Table;
use crate::tolerance;
use crate::units;

const BODY: Key = Key::required("body", "the name of a body", Takes::Text)
    .doc("The body that carries the marker, or `ground`");
const POINT: Key = Key::pair("point")
    .expecting("a point [x, y]")
    .needed()
    .unit(Dimension::LENGTH)
    .doc("Its place [x, y] in the frame of the body");
const SPATIAL_POINT: Key = Key::triple("point")
    .expecting("a point [x, y, z]")
    .needed()
    .unit(Dimension::LENGTH)
    .doc("Its place [x, y, z] in the frame of the body");
const ANGLE: Key = Key::optional("angle", "a number", Takes::Number(Interval::Any))
    .unit(Dimension::ANGLE)
    .doc("Angle of its axes in the frame of the body; where it is given, the angle of the marker is written, too");
const ORIENTATION: Key = Key::optional(
    "orientation",
    "a table { quaternion | axis, angle | rpy | matrix }",
    Takes::Orientation,
)
.doc("Orientation of its axes in the frame of the body, written as that of a body: { quaternion }, { axis, angle }, { rpy } or { matrix }; z is the axis of a joint between markers, x lies across it");
const TOLERANCE: Key = tolerance::length(
    "What its point is known to, wherever it is used; that of its body, or of the scene, where it is not given",
);

/// Keys of a marker in addition to its name.
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

/// What is said of a marker where another thing is expected.
const NAME: &str = "the name of a marker";

/// The markers that were read, with their places.
#[derive(Default)]
pub(crate) struct Markers {
    pub(crate) list: Vec<Marker>,
    pub(crate) entries: Vec<Entry>,
    /// Indices by name, `None` if a marker could not be read; if a name is used twice, the first.
    by_name: HashMap<String, Option<usize>>,
}

impl Markers {
    /// Reads one marker of the bodies.
    pub(crate) fn read<S: SceneSpace>(
        bodies: &mut Bodies<S>,
        mut table: Table,
        name: &str,
        findings: &mut Findings,
    ) {
        let body = table.required(&BODY, findings);
        let body = body.and_then(|field| bodies.names.find(&field, findings));
        let point = table.needed(POINT.name, S::POINT, findings);
        let point = point.and_then(|field| field.vector::<S>(S::POINT, POINT.unit, findings));
        let (mut angle, mut orientation) = (None, None);
        if S::KIND == SpaceKind::Space3 {
            let field = table.optional(&ORIENTATION);
            orientation = field.map(|field| read_orientation(&field, findings));
        } else {
            let field = table.optional(&ANGLE);
            angle = field.map(|field| field.number(ANGLE.unit, findings));
        }
        let tolerance = tolerance::read(&mut table, &TOLERANCE, findings);
        let entry = Entry::of(name, &table);
        table.spaces(all_keys());
        table.close(findings);
        let Self {
            list,
            entries,
            by_name,
        } = &mut bodies.markers;
        let at = list.len();
        let is_turned = angle != Some(None) && orientation != Some(None);
        let read = body.zip(point).filter(|_| is_turned);
        by_name.entry(name.to_owned()).or_insert(read.map(|_| at));
        if let Some((body, point)) = read {
            list.push(Marker {
                name: name.to_owned(),
                body,
                point: S::point(point),
                angle: angle.flatten(),
                orientation: orientation.flatten(),
                tolerance,
            });
            entries.push(entry);
        }
    }

    /// Whether a field that takes a place says the name of a marker: it has a text, which is not a
    /// number with a unit where there are no markers.
    pub(crate) fn may_be(&self, field: &Field) -> bool {
        let text = field.value.get_ref().as_str();
        text.is_some_and(|text| {
            self.by_name.contains_key(text)
                || !self.by_name.is_empty() && units::advice(text).is_none()
        })
    }

    /// The index of the marker with the name in this field. Returns `None` if it is unknown, which
    /// is reported, or could not be read, which has been.
    pub(crate) fn index(&self, field: &Field, findings: &mut Findings) -> Option<usize> {
        let name = field.text(NAME, findings)?;
        if let Some(found) = self.by_name.get(name) {
            return *found;
        }
        let names = || self.by_name.keys().map(String::as_str);
        let mut sorted: Vec<&str> = names().collect();
        sorted.sort_unstable();
        let near = findings.suggest(name, sorted.iter().copied());
        findings.error_with_help(
            Mistake::UnknownMarker,
            field.span(),
            format!("{} refers to the unknown marker `{name}`", field.subject),
            "no such marker",
            match near {
                Some(near) => Some(format!("did you mean `{near}`?")),
                None => all("markers", sorted),
            },
        );
        None
    }

    /// Like [`Self::index`], the marker itself.
    pub(crate) fn find(&self, field: &Field, findings: &mut Findings) -> Option<&Marker> {
        self.index(field, findings).map(|at| &self.list[at])
    }
}

impl<S: SceneSpace> Bodies<S> {
    /// Global coordinates of a marker in the described configuration.
    pub(crate) fn global(&self, marker: &Marker) -> S::Vector<f64> {
        let point = self.place_of(marker);
        match marker.body {
            BodyRef::Ground => point,
            BodyRef::Body(k) => S::to_global(&self.list[k], point),
        }
    }

    /// Place of a marker relative to the centre of mass of its body.
    pub(crate) fn place_of(&self, marker: &Marker) -> S::Vector<f64> {
        self.about_centre(marker.body, S::vector(marker.point))
    }

    /// Reports a marker where a point of another body is needed.
    pub(crate) fn foreign(
        &self,
        marker: &Marker,
        needed: BodyRef,
        field: &Field,
        findings: &mut Findings,
    ) {
        let name = &marker.name;
        let advice = format!(
            "a point of `{}` is needed; `at = \"{name}\"` takes the place where it is",
            self.names.name(needed)
        );
        self.not_of_body(marker, &advice, field, findings);
    }

    /// Reports a marker that belongs to another body than the one that is needed.
    pub(crate) fn not_of_body(
        &self,
        marker: &Marker,
        needed: &str,
        field: &Field,
        findings: &mut Findings,
    ) {
        let (name, body) = (&marker.name, self.names.name(marker.body));
        let own = self.markers.list.iter().zip(&self.markers.entries);
        let found = own.clone().find(|(own, _)| own.name == marker.name);
        let place = found.map_or_else(|| field.span(), |(_, entry)| entry.span(BODY.name));
        findings.collision(
            Mistake::ForeignMarker,
            field.span(),
            format!(
                "{}: marker `{name}` belongs to `{body}`, and {needed}",
                field.subject
            ),
            "not a marker of this body",
            place,
            "its body is given here",
        );
    }
}
