//! Directions and axes of joints and forces. In space, directions are given in the axes of the
//! first body, or of the ground (`frame = "global"`), in the described configuration. The
//! directions on the other body are computed from this configuration, like a reference point.

mod key;

pub(crate) use key::{AXES, CROSS, FRAME, FRAMES, keys};

use std::ops::Range;

use joints::space3::{Axes, dot};
use joints::spec::{Shape, Spec};
use joints::{Argument, Space3};
use model::BodyRef;

use crate::argument_source::ArgumentSource;
use crate::bearings::{self, CARRIER};
use crate::between::MARKERS;
use crate::bodies::Bodies;
use crate::dimension::Dimension;
use crate::field::Field;
use crate::mistake::Mistake;
use crate::nearest::did_you_mean;
use crate::space::SceneSpace;
use crate::table::Table;

/// The directions of one element.
pub(crate) struct Directions<'b, S: SceneSpace> {
    bodies: &'b Bodies<S>,
    slots: &'b [Option<BodyRef>],
    is_global: bool,
    /// The direction perpendicular to the axis, in the form given in the text.
    across: Option<S::Vector<f64>>,
    /// Whether the axis is given for both bodies.
    is_paired: bool,
    /// The axis in the frames of the first two bodies, if it could be read.
    own: Option<[S::Vector<f64>; 2]>,
    /// Source of the directions.
    pub(crate) source: ArgumentSource<'b>,
}

impl<'b, S: SceneSpace> Directions<'b, S> {
    /// Reads the keys of directions that are not parameters.
    pub(crate) fn read(
        table: &mut Table,
        spec: &'static Spec,
        slots: &'b [Option<BodyRef>],
        (bodies, source): (&'b Bodies<S>, ArgumentSource<'b>),
    ) -> Self {
        let mut directions = Self {
            bodies,
            slots,
            is_global: false,
            across: None,
            is_paired: false,
            own: None,
            source,
        };
        // Other keys were rejected earlier.
        if let ArgumentSource::Markers(_) = directions.source {
            return directions;
        }
        if !S::CARRIES {
            // `axes` is not in this list, because in the plane it is more likely a misspelling of
            // `axis`.
            table.spaces(
                [FRAME, CROSS, MARKERS]
                    .map(|key| (key, Space3::NAME))
                    .into_iter(),
            );
            return directions;
        }
        for key in keys(spec) {
            let Some(field) = table.optional(key) else {
                continue;
            };
            match key {
                FRAME => directions.is_global = is_global(&field),
                CROSS => directions.across = direction::<S>(&field),
                _ => {
                    directions.is_paired = true;
                    directions.own = directions.both(&field);
                }
            }
        }
        directions
    }

    /// Reads `axes`: one direction for each body, in the frame of this body.
    fn both(&self, field: &Field) -> Option<[S::Vector<f64>; 2]> {
        let table = field.table(S::BY_BODY)?;
        let [Some(first), Some(second)] = self.slots.first_chunk()? else {
            return None;
        };
        let all = table.all();
        let names = [first, second].map(|body| self.bodies.names.name(*body));
        let read = names.map(|name| {
            let own = all.iter().find(|(_, field)| field.key == name);
            let Some((_, field)) = own else {
                let message = format!("{} needs the direction of `{name}`", table.subject);
                let label = format!("`{name} = {}` is missing here", S::VECTOR);
                field
                    .findings
                    .error(Mistake::Missing, table.header.clone(), message, label);
                return None;
            };
            direction::<S>(field)
        });
        for (key, field) in all
            .iter()
            .filter(|(_, field)| !names.contains(&&*field.key))
        {
            let message = format!(
                "{} names `{}`, which is not connected",
                table.subject, field.key
            );
            field.findings.error(
                Mistake::UnknownKey,
                key.clone(),
                message,
                "not a body of this joint",
            );
        }
        match read {
            [Some(a), Some(b)] => Some([a, b]),
            _ => None,
        }
    }

    /// Returns the argument of a parameter that the table of the element does not contain, and the
    /// position of the source of this argument in the text.
    pub(crate) fn given(
        &self,
        spec: &Spec,
        parameter: usize,
    ) -> Option<(Option<Argument>, Range<usize>)> {
        self.source.argument(spec, parameter, self.bodies)
    }

    /// Returns whether `axes` already gives the axis.
    pub(crate) fn has_own_axes(&self) -> bool {
        self.is_paired
    }

    /// Returns the body with this index. Returns `None` for the ground and for an unknown body; an
    /// unknown body has been reported.
    fn body(&self, slot: usize) -> Option<&'b S::Body> {
        let at = self.slots.get(slot).copied().flatten()?.moving()?;
        self.bodies.list.get(at)
    }

    /// Converts a direction of the text to the axes of the body with the index `slot`.
    fn placed(&self, direction: S::Vector<f64>, slot: usize) -> S::Vector<f64> {
        let home = match self.source {
            ArgumentSource::Bearings(_) => CARRIER,
            ArgumentSource::Text | ArgumentSource::Markers(_) => 0,
        };
        let written = if self.is_global {
            None
        } else {
            self.body(home)
        };
        S::carried(direction, written, self.body(slot))
    }

    /// Reads the direction of a parameter.
    pub(crate) fn direction(&self, field: &Field, slot: usize) -> Option<Argument> {
        let direction = direction::<S>(field)?;
        Some(S::argument(self.placed(direction, slot)))
    }

    /// Returns the axis of a parameter. Without a field, the result is the axis in `axes`, or the
    /// axes of the body frame.
    pub(crate) fn axis(&self, field: Option<&Field>, slot: usize) -> Option<Argument> {
        let axis = match (field, self.own) {
            (Some(field), _) => self.placed(direction::<S>(field)?, slot),
            (None, Some(own)) => *own.get(slot)?,
            (None, None) if self.is_paired => return None,
            (None, None) => return Some(Argument::Axes(Axes::FRAME)),
        };
        let across = self.across.map(|across| self.placed(across, slot));
        Some(S::axis(axis, across))
    }

    /// Converts axes of one body to axes of the body with the index `slot`. In the described
    /// configuration, both are parallel.
    pub(crate) fn like(&self, axes: &Argument, [from, slot]: [usize; 2]) -> Argument {
        // An invalid axis is reported for the key in which it is given.
        let axes = bearings::axes(axes).unwrap_or(Axes::FRAME);
        let [from, to] = [from, slot].map(|slot| self.body(slot));
        let carried = axes.map(|d| S::point(S::carried(S::vector(d), from, to)));
        let [u, v, _] = carried.uvw();
        let own = self.own.and_then(|own| own.get(slot).copied());
        let given = own.map(|axis| {
            let axis = S::point(axis);
            // One of these directions may be parallel to the given axis.
            let [of_u, of_v] = [u, v].map(|across| dot(across, axis).abs());
            Argument::Axis(axis, Some(if of_u <= of_v { u } else { v }))
        });
        given.unwrap_or(Argument::Axes(carried))
    }
}

/// Components of a direction.
fn direction<S: SceneSpace>(field: &Field) -> Option<S::Vector<f64>> {
    let expected = Shape::Direction { slot: 0 }.words(S::DIM).to_string();
    field.vector::<S>(&expected, Dimension::NONE)
}

/// Returns whether `frame` specifies that directions are given in ground axes.
fn is_global(field: &Field) -> bool {
    let [own, global] = FRAMES;
    let expected = format!("\"{own}\" or \"{global}\"");
    let Some(text) = field.text(&expected) else {
        return false;
    };
    if !FRAMES.contains(&text) {
        field.error_with_help(
            Mistake::UnknownChoice,
            format!(": `{}` must be {expected}, found `{text}`", field.key),
            "no such choice",
            did_you_mean(text, FRAMES),
        );
    }
    text == global
}
