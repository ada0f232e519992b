//! The bodies of the text, with their names and markers. Points are relative to the centres of
//! mass.

use joints::{Plane, Space3};
use model::{BodyRef, Marker, StartPose};

use crate::body::{BodyNames, SceneBody};
use crate::field::Field;
use crate::marker::{self, Markers};
use crate::mistake::Mistake;
use crate::space::SceneSpace;
use crate::table::Table;

/// The bodies of the text.
pub(crate) struct Bodies<S: SceneSpace> {
    pub(crate) list: Vec<S::Body>,
    /// Initial poses of bodies whose initial pose differs from the described pose.
    pub(crate) poses: Vec<StartPose>,
    pub(crate) names: BodyNames,
    /// Markers by name.
    pub(crate) markers: Markers,
}

impl<S: SceneSpace> Default for Bodies<S> {
    fn default() -> Self {
        Self {
            list: Vec::new(),
            poses: Vec::new(),
            names: BodyNames::default(),
            markers: Markers::default(),
        }
    }
}

impl<S: SceneSpace> Bodies<S> {
    /// Reads one body. Values that cannot be read are reported and replaced by zero.
    pub(crate) fn read(&mut self, mut table: Table, name: &str)
    where
        S: SceneBody,
    {
        let body = S::read_body(&mut table, name);
        let start = table
            .optional(&S::START)
            .and_then(|field| field.table(S::START.expected));
        if let Some(mut start) = start {
            self.poses.push(StartPose {
                body: self.list.len(),
                frame: S::read_start(&mut start, &body),
            });
            start.close();
        }
        self.list.push(body);
        self.names.add(name, &table);
        table.spaces(keys());
        table.close();
    }

    /// Converts a point of a body frame to a point relative to the centre of mass, as joints and
    /// forces require; points of the ground do not change.
    pub(crate) fn about_centre(&self, body: BodyRef, point: S::Vector<f64>) -> S::Vector<f64> {
        let described = body.moving().and_then(|at| self.list.get(at));
        described.map_or(point, |body| S::from_centre(body, point))
    }

    /// Converts a point in ground coordinates to a point relative to the centre of mass of a body,
    /// in the axes of this body.
    pub(crate) fn to_local(&self, body: BodyRef, point: S::Vector<f64>) -> S::Vector<f64> {
        let described = body.moving().and_then(|at| self.list.get(at));
        described.map_or(point, |body| S::to_local(body, point))
    }

    /// Ground coordinates of a marker in the described configuration.
    pub(crate) fn global(&self, marker: &Marker) -> S::Vector<f64> {
        let point = self.place_of(marker);
        match marker.body {
            BodyRef::Ground => point,
            BodyRef::Body(k) => S::to_global(&self.list[k], point),
        }
    }

    /// Returns the ground coordinates of a point at the start, before the start is corrected. The
    /// argument is relative to the centre of mass of the body.
    pub(crate) fn at_start(&self, body: BodyRef, point: S::Vector<f64>) -> S::Vector<f64> {
        let described = body.moving().and_then(|at| Some((at, self.list.get(at)?)));
        let Some((at, body)) = described else {
            return point;
        };
        match self.poses.binary_search_by_key(&at, |pose| pose.body) {
            Ok(k) => S::to_global(&S::moved(body, &self.poses[k].frame), point),
            Err(_) => S::to_global(body, point),
        }
    }

    /// Position of a marker relative to the centre of mass of its body.
    pub(crate) fn place_of(&self, marker: &Marker) -> S::Vector<f64> {
        self.about_centre(marker.body, S::vector(marker.point))
    }

    /// Reports that a marker belongs to a wrong body, if a point of the body `needed` is required.
    pub(crate) fn foreign(&self, marker: &Marker, needed: BodyRef, field: &Field) {
        let name = &marker.name;
        let advice = format!(
            "a point of `{}` is needed; `at = \"{name}\"` uses the position of the marker",
            self.names.name(needed)
        );
        self.not_of_body(marker, &advice, field);
    }

    /// Reports a marker that belongs to a wrong body.
    pub(crate) fn not_of_body(&self, marker: &Marker, needed: &str, field: &Field) {
        let (name, body) = (&marker.name, self.names.name(marker.body));
        let own = self.markers.list.iter().zip(&self.markers.entries);
        let found = own.clone().find(|(own, _)| own.name == marker.name);
        let place = found.map_or_else(|| field.span(), |(_, entry)| entry.span(marker::BODY.name));
        field.findings.collision(
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

/// Returns the keys of both spaces, each with the name of its space.
fn keys() -> impl Iterator<Item = (&'static str, &'static str)> {
    let plane = Plane::BODY_KEYS.iter().map(|key| (key.name, Plane::NAME));
    let space = Space3::BODY_KEYS.iter().map(|key| (key.name, Space3::NAME));
    plane.chain(space)
}
