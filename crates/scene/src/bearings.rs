//! `bearings`: a gear mesh between two wheels that are supported by two joints on one carrier.
//! These joints define the bodies, the axes and the points on the axes.

mod line;

use std::ops::Range;

use joints::Argument;
use joints::space3::Axes;
use joints::spec::{Shape, Spec};
use model::BodyRef;
use model::registry::ConstraintDefinition;
use serde_json::json;

use self::line::Axis;
use crate::bodies::Bodies;
use crate::dimension::Dimension;
use crate::field::Field;
use crate::joint_measure::{Purpose, dimension};
use crate::joint_name::References;
use crate::joint_read::{JointKind, JointRead};
use crate::key::{Interval, Key, Takes};
use crate::mistake::Mistake;
use crate::space::SceneSpace;
use crate::table::Table;

const TWO_JOINTS: &str = "two joints [\"A\", \"B\"]";

/// The key of the bearings.
pub(crate) const BEARINGS: Key = Key::required("bearings", TWO_JOINTS, Takes::Texts(2)).doc(
    "The joints about which the wheels turn, each between a wheel and the same carrier, which may be the ground",
);
/// The key of the pressure angle.
pub(crate) const PRESSURE_ANGLE: Key =
    Key::optional("pressure_angle", "a number", Takes::Number(Interval::Any))
        .unit(Dimension::ANGLE)
        .doc("Angle by which the line of action is turned from the normal of the plane of both axes, about the line along which the wheels roll, towards the second wheel; not together with a line of action")
        .or(|| json!(0.0));

/// Index of the carrier in the list of bodies; it comes after the wheels.
pub(crate) const CARRIER: usize = 2;

/// The two joints that support the wheels of a gear mesh.
pub(crate) struct Bearings<'a> {
    /// Position of the two joint names in the text.
    pub(crate) span: Range<usize>,
    /// Two wheels on one carrier; `None` if the joints do not support such wheels, which has been
    /// reported.
    wheels: Option<Wheels<'a>>,
}

/// Two wheels and their carrier.
struct Wheels<'a> {
    /// The two wheels, followed by the carrier.
    bodies: [BodyRef; 3],
    /// Point and axis of both bearings, each on the wheel and on the carrier.
    points: [[&'a Argument; 2]; 2],
    axes: [[&'a Argument; 2]; 2],
}

impl<'a> Bearings<'a> {
    pub(crate) fn read<S: SceneSpace>(
        table: &mut Table,
        references: &References<'_, 'a, '_, S>,
    ) -> Self {
        let usage = (Purpose::Bear, references.is_active);
        let field = table.required(&BEARINGS);
        let wheels = field.as_ref().and_then(|field| {
            let named = references.joints.two(field, TWO_JOINTS, usage)?;
            Wheels::of(field, named, references.bodies)
        });
        Self {
            span: table.span_of(BEARINGS.name),
            wheels,
        }
    }

    /// The bodies in the order of the definition.
    pub(crate) fn slots(&self) -> Vec<Option<BodyRef>> {
        let wheels = self.wheels.as_ref();
        wheels.map_or_else(|| vec![None; 3], |own| own.bodies.map(Some).to_vec())
    }

    /// The argument of a parameter that is a point or an axis of a bearing.
    pub(crate) fn argument(&self, spec: &Spec, parameter: usize) -> Option<Argument> {
        let wheels = self.wheels.as_ref()?;
        let (is_axes, slot) = slot_of(spec.parameters[parameter].shape)?;
        let of = if is_axes { wheels.axes } else { wheels.points };
        let earlier = spec.parameters[..parameter].iter();
        let earlier = earlier.filter(|p| slot_of(p.shape) == Some((is_axes, slot)));
        let argument = match slot {
            CARRIER => of.get(earlier.count())?[1],
            wheel => of[wheel][0],
        };
        Some(argument.clone())
    }

    /// Returns the line of action and its position in the text. The line is given in the text and
    /// read with `direction`, or it is computed from the pressure angle.
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
                    let line = wheels.line(xyz(pitch)?, angle).map_err(refuse);
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

/// The components of a point or a direction.
fn xyz(argument: &Argument) -> Option<[f64; 3]> {
    match *argument {
        Argument::Triple(xyz) => Some(xyz),
        _ => None,
    }
}

impl<'a> Wheels<'a> {
    /// Finds the two wheels. Their joints connect each wheel to the carrier, the only body that
    /// both joints have in common. If there are no such wheels, the function reports this and
    /// returns `None`.
    fn of<S: SceneSpace>(
        field: &Field,
        named: [&'a JointRead<S>; 2],
        bodies: &Bodies<S>,
    ) -> Option<Self> {
        let report = |what: String, label: &str| {
            let message = format!("{}: {what}", field.subject);
            field
                .findings
                .error(Mistake::Bearings, field.span(), message, label);
        };
        let read = named.map(|joint| {
            let bearing = match joint.kind {
                JointKind::Unknown => return None,
                JointKind::Coupling => None,
                JointKind::Defined(definition) => parameters(definition),
            };
            if bearing.is_none() {
                let name = &joint.name;
                report(
                    format!(
                        "`{name}` bears no wheel: a joint with one axis and one angle is needed"
                    ),
                    "no bearing",
                );
            }
            joint.complete.as_ref().zip(bearing)
        });
        let [Some(first), Some(second)] = read else {
            return None;
        };
        let [own, other] = [first.0, second.0].map(|bearing| &bearing.joint.bodies);
        let shared: Vec<BodyRef> = own
            .iter()
            .filter(|body| other.contains(body))
            .copied()
            .collect();
        let [first_name, second_name] = named.map(|joint| &joint.name);
        let &[carrier] = shared.as_slice() else {
            let names = shared.iter().map(|body| bodies.names.name(*body));
            let names: Vec<_> = names.map(|name| format!("`{name}`")).collect();
            if names.is_empty() {
                report(
                    format!("`{first_name}` and `{second_name}` connect no common body"),
                    "both wheels turn on one carrier",
                );
            } else {
                report(
                    format!(
                        "`{first_name}` and `{second_name}` both connect {}: there is one wheel only",
                        names.join(" and ")
                    ),
                    "two wheels and a carrier are three bodies",
                );
            }
            return None;
        };
        let read = [first, second];
        // For each bearing, the index of the wheel in the list of bodies of the joint.
        let wheels = read.map(|(bearing, _)| usize::from(bearing.joint.bodies[0] == carrier));
        let arguments = |which: usize| {
            [0, 1].map(|k| {
                let (bearing, parameters) = read[k];
                let of = |slot: usize| &bearing.arguments[parameters[slot][which]];
                [of(wheels[k]), of(1 - wheels[k])]
            })
        };
        let [i, j] = [0, 1].map(|k| read[k].0.joint.bodies[wheels[k]]);
        Some(Self {
            bodies: [i, j, carrier],
            points: arguments(0),
            axes: arguments(1),
        })
    }

    /// The axis of bearing `k` on the carrier.
    fn axis(&self, k: usize) -> Option<Axis> {
        let point = xyz(self.points[k][1])?;
        let axes = match *self.axes[k][1] {
            Argument::Axes(axes) => Some(axes),
            Argument::Axis(axis, across) => Axes::new(axis, across),
            _ => None,
        };
        let [.., along] = axes?.uvw();
        Some(Axis { point, along })
    }

    /// Returns the wheel for which a force along this line through the pitch point has no lever arm
    /// about the axis of the wheel.
    fn missed_by(&self, line: &Argument, pitch: &Argument) -> Option<&'static str> {
        let (line, pitch) = (xyz(line)?, xyz(pitch)?);
        let names = ["first", "second"].into_iter().enumerate();
        let mut axes = names.filter_map(|(k, name)| Some((name, self.axis(k)?)));
        axes.find_map(|(name, axis)| (!axis.has_lever(line, pitch)).then_some(name))
    }

    /// Returns the line of action if the text does not give it; the wheels are in contact at a
    /// pitch point of the carrier.
    fn line(&self, pitch: [f64; 3], pressure_angle: f64) -> Result<[f64; 3], &'static str> {
        match [0, 1].map(|k| self.axis(k)) {
            [Some(first), Some(second)] => line::of_action([first, second], pitch, pressure_angle),
            _ => Err("an axis has no direction"),
        }
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

/// Returns the parameters for point and axis of each of two bodies, if the definition has exactly
/// one of each and one angle.
fn parameters<S: SceneSpace>(definition: &ConstraintDefinition<S>) -> Option<[[usize; 2]; 2]> {
    let spec = definition.spec;
    let only = |is_axes: bool, slot: usize| {
        let all = spec.common.parameters.iter().enumerate();
        let mut found = all.filter(|(_, p)| slot_of(p.shape) == Some((is_axes, slot)));
        let (at, _) = found.next()?;
        found.next().is_none().then_some(at)
    };
    let measures = 0..spec.measures.len();
    let angles = measures.filter(|k| dimension(definition, *k) == Some(Dimension::ANGLE));
    if spec.common.slots.len() != 2 || angles.count() != 1 {
        return None;
    }
    let of = |slot| Some([only(false, slot)?, only(true, slot)?]);
    Some([of(0)?, of(1)?])
}
