//! `bearings`: a gear mesh between two wheels that turn on one carrier about the axes of two
//! joints. These joints define the wheels, the axes and the points on the axes.

mod line;
mod train;

use std::ops::Range;

use joints::Argument;
use joints::space3::Axes;
use joints::spec::{Shape, Spec};
use model::BodyRef;
use serde_json::json;

use self::line::Axis;
use self::train::{Bearing, Refusal, Seat, Train};
use crate::dimension::Dimension;
use crate::field::Field;
use crate::joint_measure::Purpose;
use crate::joint_name::References;
use crate::joint_read::JointRead;
use crate::key::{Interval, Key, Takes};
use crate::mistake::Mistake;
use crate::space::SceneSpace;
use crate::table::Table;

const TWO_JOINTS: &str = "two joints [\"A\", \"B\"]";

/// The key of the bearings.
pub(crate) const BEARINGS: Key = Key::required("bearings", TWO_JOINTS, Takes::Texts(2)).doc(
    "The joints about whose axes the wheels turn, each between a wheel and the carrier, or between a wheel and a body on which the carrier turns about the same axis",
);
/// The key of the body on which both wheels turn.
pub(crate) const CARRIER_KEY: Key = Key::optional("carrier", "the name of a body", Takes::Name)
    .doc("The body on which both wheels turn, which may be the ground [default: the common body of the bearings, or the only body on which both wheels turn about the axes of their bearings]");
/// The key of the pressure angle.
pub(crate) const PRESSURE_ANGLE: Key =
    Key::optional("pressure_angle", "a number", Takes::Number(Interval::Any))
        .unit(Dimension::ANGLE)
        .doc("Angle by which the line of action is turned from the normal of the plane of both axes, about the line along which the wheels roll, towards the second wheel; not together with a line of action")
        .or(|| json!(0.0));

/// Index of the carrier in the list of bodies; it comes after the wheels.
pub(crate) const CARRIER: usize = 2;

/// The two joints about whose axes the wheels of a gear mesh turn.
pub(crate) struct Bearings {
    /// Position of the two joint names in the text.
    pub(crate) span: Range<usize>,
    /// Two wheels on one carrier. `None` if there are no such wheels; this has been reported.
    wheels: Option<Box<Wheels>>,
}

/// Two wheels and their carrier.
struct Wheels {
    /// The point and the axis of the bearing on each wheel.
    wheels: [Seat; 2],
    /// The points and axes of both bearings on the carrier.
    carrier: [Seat; 2],
}

impl Bearings {
    pub(crate) fn read<S: SceneSpace>(
        table: &mut Table,
        references: &References<'_, '_, '_, S>,
    ) -> Self {
        let usage = (Purpose::Bear, references.is_active);
        let field = table.required(&BEARINGS);
        let written = table.optional(&CARRIER_KEY);
        let carrier = written
            .as_ref()
            .map(|field| references.bodies.names.find(field));
        let wheels = field.as_ref().and_then(|field| {
            let named = references.joints.two(field, TWO_JOINTS, usage)?;
            let carrier = match carrier {
                // An unknown body has been reported.
                Some(known) => Some(known?),
                None => None,
            };
            Wheels::of(field, named, carrier, references).map(Box::new)
        });
        Self {
            span: table.span_of(BEARINGS.name),
            wheels,
        }
    }

    /// The bodies in the order of the definition.
    pub(crate) fn slots(&self) -> Vec<Option<BodyRef>> {
        let Some(own) = &self.wheels else {
            return vec![None; 3];
        };
        let [[i, j], [carrier, _]] =
            [&own.wheels, &own.carrier].map(|of| of.each_ref().map(|seat| seat.body));
        [i, j, carrier].map(Some).to_vec()
    }

    /// The argument of a parameter that is a point or an axis of a bearing.
    pub(crate) fn argument(&self, spec: &Spec, parameter: usize) -> Option<Argument> {
        let own = self.wheels.as_ref()?;
        let (is_axes, slot) = slot_of(spec.parameters[parameter].shape)?;
        let earlier = spec.parameters[..parameter].iter();
        let earlier = earlier.filter(|p| slot_of(p.shape) == Some((is_axes, slot)));
        let seat = match slot {
            CARRIER => own.carrier.get(earlier.count())?,
            wheel => own.wheels.get(wheel)?,
        };
        Some(if is_axes {
            Argument::Axes(seat.axes)
        } else {
            Argument::Triple(seat.point)
        })
    }

    /// Returns the line of action and its position in the text. If the text contains the line,
    /// `direction` reads it. Otherwise, the line is computed from the pressure angle.
    pub(crate) fn line(
        &self,
        table: &mut Table,
        key: &'static str,
        direction: impl Fn(&Field) -> Option<Argument>,
        pitch: Option<&Argument>,
    ) -> (Option<Argument>, Range<usize>) {
        let (written, angle) = (table.optional(key), table.optional(&PRESSURE_ANGLE));
        let at = written.as_ref().map_or(self.span.clone(), Field::span);
        let subject = &table.subject;
        let line = match (written, angle) {
            (Some(_), Some(angle)) => {
                let first = (at.clone(), "the line of action is given here");
                let second = (angle.span(), "and here by an angle");
                let ways = format!("`{key}` or `{}`", PRESSURE_ANGLE.name);
                table.exclusive(ways, [first, second]);
                None
            }
            (Some(line), None) => direction(&line),
            (None, angle) => {
                let angle = match angle {
                    Some(angle) => angle.number(PRESSURE_ANGLE.unit),
                    None => Some(0.0),
                };
                let wheels = self.wheels.as_ref().zip(pitch).zip(angle);
                wheels.and_then(|((wheels, pitch), angle)| {
                    let refuse = |why| {
                        let message = format!("{subject} needs the key `{key}`: {why}");
                        let label = "the line of action does not follow from these";
                        table
                            .findings
                            .error(Mistake::Bearings, at.clone(), message, label);
                    };
                    let line = line::of_action(wheels.axes(), xyz(pitch)?, angle).map_err(refuse);
                    line.ok().map(Argument::Triple)
                })
            }
        };
        let missed = self.wheels.as_ref().zip(pitch).zip(line.as_ref());
        if let Some(wheel) = missed.and_then(|((own, pitch), line)| own.missed_by(line, pitch)) {
            let message = format!(
                "{subject}: the line of action meets the axis of the {wheel} wheel, or is parallel to it"
            );
            table
                .findings
                .error(Mistake::Bearings, at.clone(), message, "turns nothing");
            return (None, at);
        }
        (line, at)
    }
}

/// The axes of an argument.
pub(crate) fn axes(argument: &Argument) -> Option<Axes> {
    match *argument {
        Argument::Axes(axes) => Some(axes),
        Argument::Axis(axis, across) => Axes::new(axis, across),
        _ => None,
    }
}

/// The components of a point or a direction.
fn xyz(argument: &Argument) -> Option<[f64; 3]> {
    match *argument {
        Argument::Triple(xyz) => Some(xyz),
        _ => None,
    }
}

impl Wheels {
    /// Finds the two wheels and the body on which both wheels turn. If there are no such wheels,
    /// the function reports this and returns `None`.
    fn of<'j, 'r, S: SceneSpace>(
        field: &Field,
        named: [&'j JointRead<'r, S>; 2],
        carrier: Option<BodyRef>,
        references: &References<'_, 'j, 'r, S>,
    ) -> Option<Self> {
        let report = |Refusal { what, label }: Refusal| {
            let message = format!("{}: {what}", field.subject);
            field
                .findings
                .error(Mistake::Bearings, field.span(), message, label);
        };
        let read = named.map(|joint| match Bearing::of(joint) {
            Ok(bearing) => bearing,
            Err(refusal) => {
                report(refusal);
                None
            }
        });
        let [Some(first), Some(second)] = read else {
            return None;
        };
        let train = Train::new(references, [first, second]);
        let found = train.carrier(carrier).and_then(|carrier| {
            let [[i, on_i], [j, on_j]] = [train.wheel(0, carrier)?, train.wheel(1, carrier)?];
            if i.body == j.body {
                return Err(train.one_wheel(&[i.body]));
            }
            Ok(Self {
                wheels: [i, j],
                carrier: [on_i, on_j],
            })
        });
        match found {
            Ok(wheels) => Some(wheels),
            // A joint that could not be read may be the missing joint.
            Err(_) if train.is_incomplete() => None,
            Err(refusal) => {
                report(refusal);
                None
            }
        }
    }

    /// The axes of both wheels on the carrier.
    fn axes(&self) -> [Axis; 2] {
        self.carrier.each_ref().map(Seat::axis)
    }

    /// Returns the name of a wheel about whose axis a force along this line through the pitch point
    /// has no moment.
    fn missed_by(&self, line: &Argument, pitch: &Argument) -> Option<&'static str> {
        let (line, pitch) = (xyz(line)?, xyz(pitch)?);
        let mut axes = ["first", "second"].into_iter().zip(self.axes());
        axes.find_map(|(name, axis)| (!axis.has_lever(line, pitch)).then_some(name))
    }
}

/// For a point or an axis, returns whether the parameter is an axis, and the index of its body.
fn slot_of(shape: Shape) -> Option<(bool, usize)> {
    match shape {
        Shape::Point { slot } => Some((false, slot)),
        Shape::Axes { slot, .. } => Some((true, slot)),
        _ => None,
    }
}
