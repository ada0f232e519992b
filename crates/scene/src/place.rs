//! The reference point of a joint or force. It is given by `at`, which is a point in ground
//! coordinates in the described configuration, or by points in the frames of the bodies. Markers
//! may replace these points. Points are stored relative to the centres of mass.

use std::ops::Range;

use joints::spec::Spec;
use joints::{LARGEST, is_usable};
use model::{BodyRef, Marker};

use crate::bodies::Bodies;
use crate::connection::listed;
use crate::dimension::Dimension;
use crate::field::Field;
use crate::marker::Markers;
use crate::mistake::Mistake;
use crate::nearest::list;
use crate::space::SceneSpace;
use crate::table::Table;

/// Points in the frames of their bodies, in the order of the point parameters, with their positions
/// in the text. A point is `None` if it could not be read.
pub(crate) struct Place<S: SceneSpace> {
    pub(crate) points: Vec<Option<S::Vector<f64>>>,
    pub(crate) span: Range<usize>,
}

/// The key of the reference point in ground coordinates.
pub(crate) const AT: &str = "at";

/// The key of the reference point in the frame of one body.
pub(crate) const POINT: &str = "point";

/// The key of the reference point in the frames of the bodies.
pub(crate) fn local_key(spec: &Spec) -> &'static str {
    if listed(spec) == 1 || spec.bearings {
        POINT
    } else {
        "points"
    }
}

/// Returns the frames of the points of a key, in words for messages.
fn frames(local_key: &str) -> &'static str {
    match local_key {
        POINT => "in the frame of the body",
        _ => "in the frames of the bodies",
    }
}

/// Returns the indices of the bodies whose points a table contains. These are all bodies of a
/// definition. If bearings define the points, it is only the last body.
pub(crate) fn slots_of_points(spec: &Spec) -> Vec<usize> {
    let mut slots: Vec<usize> = spec.slots_of_points().collect();
    if spec.bearings {
        slots.drain(..slots.len().saturating_sub(1));
    }
    slots
}

/// Reads the reference point of a definition with the bodies `slots`. The result contains the
/// points of the bodies with the indices `of`.
pub(crate) fn read<S: SceneSpace>(
    table: &mut Table,
    spec: &'static Spec,
    (of, slots): (&[usize], &[Option<BodyRef>]),
    bodies: &Bodies<S>,
) -> Place<S> {
    let missing = |span| Place {
        points: vec![None; of.len()],
        span,
    };
    if of.is_empty() {
        return missing(table.header.clone());
    }
    let local_key = local_key(spec);
    let (at, local) = (table.optional(AT), table.optional(local_key));
    match (at, local) {
        (Some(at), Some(local)) => {
            let label = format!("and here {}", frames(local_key));
            let values = [
                (at.span(), "the place is given here"),
                (local.span(), &label),
            ];
            table.exclusive(format!("`at` or `{local_key}`"), values);
            missing(local.span())
        }
        (Some(at), None) => Place {
            points: global(&at, spec, of, slots, bodies),
            span: at.span(),
        },
        (None, Some(local)) => Place {
            points: match local_key {
                POINT => {
                    let body = slots.get(of[0]).copied().flatten();
                    of_body(&local, of.len(), body, bodies)
                }
                _ => by_body(&local, of, slots, bodies),
            },
            span: local.span(),
        },
        (None, None) => {
            let mut form = S::VECTOR.to_owned();
            if spec.points_apart {
                form = format!("[{form}, …]");
            }
            table.missing(
                format!(
                    " needs a place: `at = {form}` in global coordinates, or `{local_key}` {}",
                    frames(local_key)
                ),
                "the place is missing here",
            );
            missing(table.header.clone())
        }
    }
}

/// Reads `at`. The value is one common point, or one point for each parameter.
fn global<S: SceneSpace>(
    at: &Field,
    spec: &Spec,
    of: &[usize],
    slots: &[Option<BodyRef>],
    bodies: &Bodies<S>,
) -> Vec<Option<S::Vector<f64>>> {
    let fields = if spec.points_apart {
        let expected = format!("{} global points [{}, …]", of.len(), S::VECTOR);
        several(at, of.len(), &expected, &bodies.markers)
    } else {
        Some(vec![at.clone()])
    };
    let fields = fields.unwrap_or_default();
    let read = |field: &Field| point(field, S::GLOBAL_POINT, bodies);
    let read: Vec<_> = fields.iter().map(read).collect();
    let local = |(k, &slot): (usize, &usize)| {
        let body = slots.get(slot).copied().flatten()?;
        local(at, read.get(k).or(read.first())?.as_ref()?, body, bodies)
    };
    of.iter().enumerate().map(local).collect()
}

/// Converts a point given by `at` to a point relative to the centre of mass, in the body frame.
fn local<S: SceneSpace>(
    at: &Field,
    point: &PointText<S>,
    body: BodyRef,
    bodies: &Bodies<S>,
) -> Option<S::Vector<f64>> {
    let local = match *point {
        PointText::Of(marker) if marker.body == body => bodies.place_of(marker),
        PointText::Of(marker) => bodies.to_local(body, bodies.global(marker)),
        PointText::At(point) => bodies.to_local(body, point),
    };
    if !S::point(local).iter().all(|x| is_usable(*x)) {
        at.error(Mistake::NotFinite, format!(": `at` and the position of `{}` are too far apart: their difference is not a finite number up to {LARGEST:e}", bodies.names.name(body)), "too far away");
        return None;
    }
    Some(local)
}

/// A point in the form given in the text.
enum PointText<'b, S: SceneSpace> {
    At(S::Vector<f64>),
    Of(&'b Marker),
}

/// Reads a vector, or the name of a marker. If the value is neither, the function reports this and
/// returns `None`.
fn point<'b, S: SceneSpace>(
    field: &Field,
    expected: &str,
    bodies: &'b Bodies<S>,
) -> Option<PointText<'b, S>> {
    if bodies.markers.may_be(field) {
        return bodies.markers.find(field).map(PointText::Of);
    }
    let point = field.vector::<S>(expected, Dimension::LENGTH);
    point.map(PointText::At)
}

/// Returns the fields of `n` points. If the number of points is not `n`, the function reports this
/// and returns `None`.
fn several<'t>(
    field: &Field<'t>,
    n: usize,
    expected: &str,
    markers: &Markers,
) -> Option<Vec<Field<'t>>> {
    let items = field.items(expected)?;
    let is_point = |item: &Field| item.value.get_ref().is_array() || markers.may_be(item);
    if items.len() == n && items.iter().all(is_point) {
        return Some(items);
    }
    field.miscount(expected, items.len(), n);
    None
}

/// Reads points in the frame of one body and converts them to points relative to the centre of
/// mass. Several points are written as a list.
fn of_body<S: SceneSpace>(
    field: &Field,
    n: usize,
    body: Option<BodyRef>,
    bodies: &Bodies<S>,
) -> Vec<Option<S::Vector<f64>>> {
    let fields = match n {
        1 => Some(vec![field.clone()]),
        _ => several(
            field,
            n,
            &format!("{n} points [{}, …]", S::VECTOR),
            &bodies.markers,
        ),
    };
    let Some(fields) = fields else {
        return vec![None; n];
    };
    let mut local = |field: &Field| {
        let read = point(field, S::POINT, bodies)?;
        let body = body?;
        match read {
            PointText::At(point) => Some(bodies.about_centre(body, point)),
            PointText::Of(marker) if marker.body == body => Some(bodies.place_of(marker)),
            PointText::Of(marker) => {
                bodies.foreign(marker, body, field);
                None
            }
        }
    };
    fields.iter().map(&mut local).collect()
}

/// Reads `points`, a table whose keys are the names of the bodies with points.
fn by_body<S: SceneSpace>(
    field: &Field,
    of: &[usize],
    slots: &[Option<BodyRef>],
    bodies: &Bodies<S>,
) -> Vec<Option<S::Vector<f64>>> {
    let mut points = vec![None; of.len()];
    let Some(table) = field.table(S::BY_BODY) else {
        return points;
    };
    // If a body has no name, it is not possible to decide which keys are correct.
    let Some(owners) = of
        .iter()
        .map(|&slot| slots.get(slot).copied().flatten())
        .collect::<Option<Vec<_>>>()
    else {
        return points;
    };
    let mut names: Vec<&str> = owners.iter().map(|&body| bodies.names.name(body)).collect();
    names.dedup();
    let given = table.all();
    let mut missing = names.clone();
    missing.retain(|name| !given.iter().any(|(_, value)| value.key == *name));
    let foreign = given
        .iter()
        .filter(|(_, value)| !names.contains(&&*value.key));
    // If one point has a wrong name, this is only one mistake.
    let meant = match (missing.len(), foreign.count()) {
        (1, 1) => missing.pop(),
        _ => None,
    };
    for (key, value) in &given {
        let mine: Vec<usize> = (0..of.len())
            .filter(|&k| bodies.names.name(owners[k]) == value.key)
            .collect();
        if mine.is_empty() {
            field.findings.error_with_help(
                Mistake::UnknownKey,
                key.clone(),
                format!(
                    "{} names `{}`, which has no point here",
                    table.subject, value.key
                ),
                match meant {
                    Some(name) => format!("the point of `{name}` is expected here"),
                    None => "not a body with a point here".to_owned(),
                },
                Some(format!("its keys are {}", list(names.iter().copied()))),
            );
            continue;
        }
        let body = mine.first().map(|k| owners[*k]);
        let read = of_body(value, mine.len(), body, bodies);
        for (k, point) in mine.iter().zip(read) {
            points[*k] = point;
        }
    }
    for name in missing {
        table.missing(
            format!(" needs the point of `{name}`"),
            format!("`{name} = {}` is missing here", S::VECTOR),
        );
    }
    points
}
