//! Joints whose definitions say `bearings`: teeth between two wheels that other joints bear on one
//! carrier. These joints give the bodies, the axes and the points on them.

mod line;

use joints::Argument;
use joints::space3::Axes;
use joints::spec::{ConstraintSpec, Shape, Spec};
use model::BodyRef;
use model::registry::ConstraintDefinition;
use serde_json::json;

use self::line::Axis;
use crate::active;
use crate::arguments::label;
use crate::bodies::Bodies;
use crate::dimension::Dimension;
use crate::direction::{FRAME, direction, is_global};
use crate::field::{Field, all};
use crate::findings::Findings;
use crate::joint::{JointNames, Known, Read, dimension, must_be_active, of_name};
use crate::key::{Interval, Key, TYPE, Takes};
use crate::mistake::Mistake;
use crate::place;
use crate::source_map::Entry;
use crate::space::SceneSpace;
use crate::table::Table;
use crate::tolerance;

const TWO_JOINTS: &str = "two joints [\"A\", \"B\"]";

/// The key of the bearings.
pub(crate) const BEARINGS: Key = Key::required("bearings", TWO_JOINTS, Takes::Texts(2)).doc(
    "The joints about which the wheels turn, each between a wheel and the same carrier, which may be the ground",
);
/// The key of the pressure angle.
pub(crate) const PRESSURE_ANGLE: Key =
    Key::optional("pressure_angle", "a number", Takes::Number(Interval::Any))
        .unit(Dimension::ANGLE)
        .doc("Angle by which the line of action is turned from the normal of the plane of both axes, about the line along which the wheels roll, towards the second wheel; not beside a line of action")
        .or(|| json!(0.0));

/// A joint that bears a wheel on a carrier: its bodies, and what it says of each of them.
struct Bearing<'a> {
    bodies: [BodyRef; 2],
    points: [&'a Argument; 2],
    axes: [&'a Argument; 2],
}

/// Reads one joint of such a definition.
pub(crate) fn read<'r, S: SceneSpace>(
    mut table: Table,
    name: String,
    definition: &'r ConstraintDefinition<S>,
    (bodies, joints): (&Bodies<S>, &JointNames<'_, 'r, S>),
    findings: &mut Findings,
) -> Read<'r, S> {
    let mut known = Known::named(&name, &table);
    known.definition = Some(definition);
    let _ = table.optional(TYPE);
    let field = table.required(&BEARINGS, findings);
    let named = field.as_ref().and_then(|f| named(f, joints, findings));
    known.tolerance = tolerance::read(&mut table, &tolerance::OF_JOINT, findings);
    known.is_active = active::read(&mut table, findings);
    if let (Some(field), Some(named), true) = (&field, &named, known.is_active) {
        for joint in named {
            let (subject, at) = (&table.subject, field.span());
            must_be_active(subject, "is between wheels of", at, Some(joint), findings);
        }
    }
    let borne = field.as_ref().zip(named);
    let borne = borne.and_then(|(field, named)| Borne::of(field, named, bodies, findings));
    let carrier = borne.as_ref().map(|borne| borne.carrier);
    let pitch = place::one(&mut table, carrier, bodies, findings).map(S::point);
    let line = written_line(&mut table, definition.spec, carrier, bodies, findings);
    let entry = Entry::switched(&name, &table, known.is_active);
    let (subject, header) = (table.subject.clone(), table.header.clone());
    table.close(findings);
    let (Some(borne), Some(pitch), Some(written)) = (borne, pitch, line) else {
        return (known, None);
    };
    let (line, at) = match written {
        Written::Along(line, at) => (line, at),
        Written::Across(angle) => {
            let key = line_of(&definition.spec.common).unwrap_or(BEARINGS.name);
            let at = field.map_or(header, |field| field.span());
            match borne.line(pitch, angle) {
                Ok(line) => (line, at),
                Err(why) => {
                    let message = format!("{subject} needs the key `{key}`: {why}");
                    let label = "the line of action does not follow from these";
                    findings.error(Mistake::Bearings, at, message, label);
                    return (known, None);
                }
            }
        }
    };
    if let Some(wheel) = borne.missed_by(line, pitch) {
        let message = format!(
            "{subject}: the line of action meets the axis of the {wheel} wheel, or is parallel to it"
        );
        findings.error(Mistake::Bearings, at, message, "turns nothing");
        return (known, None);
    }
    match (definition.build)(&borne.arguments(definition.spec, pitch, line)) {
        Ok(element) => {
            let joint = model::Joint {
                name,
                bodies: vec![borne.wheels[0], borne.wheels[1], borne.carrier],
                element,
                functions: Vec::new(),
                tolerance: known.tolerance,
            };
            (known, Some((joint, entry)))
        }
        Err(error) => {
            let message = format!("{subject}: {error}");
            findings.error(Mistake::from(&error), at, message, label(&error));
            (known, None)
        }
    }
}

/// The two joints that are named.
fn named<'j, 'r, S: SceneSpace>(
    field: &Field,
    joints: &JointNames<'j, 'r, S>,
    findings: &mut Findings,
) -> Option<[&'j Known<'r, S>; 2]> {
    let items = field.items(TWO_JOINTS, findings)?;
    if items.len() != 2 {
        field.miscount(TWO_JOINTS, items.len(), 2, findings);
        return None;
    }
    let found = all(&items, |item| {
        let name = item.text(TWO_JOINTS, findings)?;
        of_name(name, item, joints, findings)
    });
    found?.try_into().ok()
}

/// The name of the parameter that is the line of action.
pub(crate) fn line_of(spec: &Spec) -> Option<&'static str> {
    let mut parameters = spec.parameters.iter();
    let line = parameters.find(|p| matches!(p.shape, Shape::Direction { .. }));
    line.map(|line| line.name)
}

/// What is said of the line of action.
enum Written {
    /// A direction in the frame of the carrier, and its place in the text.
    Along([f64; 3], std::ops::Range<usize>),
    /// The pressure angle.
    Across(f64),
}

/// Reads the line of action, which is written in the frame of the carrier or in ground axes, or the
/// pressure angle.
fn written_line<S: SceneSpace>(
    table: &mut Table,
    spec: &ConstraintSpec,
    carrier: Option<BodyRef>,
    bodies: &Bodies<S>,
    findings: &mut Findings,
) -> Option<Written> {
    let key = line_of(&spec.common)?;
    let (line, frame) = (table.optional(key), table.optional(FRAME));
    let is_global = frame.is_some_and(|frame| is_global(&frame, findings));
    match (line, table.optional(&PRESSURE_ANGLE)) {
        (Some(line), Some(angle)) => {
            let message = format!(
                "{} takes `{key}` or `{}`, not both",
                table.subject, PRESSURE_ANGLE.name
            );
            let (label, other) = ("and here by an angle", "the line of action is given here");
            findings.collision(
                Mistake::Exclusive,
                angle.span(),
                message,
                label,
                line.span(),
                other,
            );
            None
        }
        (Some(line), None) => {
            let along = direction::<S>(&line, findings)?;
            let of = carrier?.moving().and_then(|at| bodies.list.get(at));
            let along = S::carried(along, if is_global { None } else { of }, of);
            Some(Written::Along(S::point(along), line.span()))
        }
        (None, Some(angle)) => angle
            .number(PRESSURE_ANGLE.unit, findings)
            .map(Written::Across),
        (None, None) => Some(Written::Across(0.0)),
    }
}

/// Two wheels and their carrier.
struct Borne<'a> {
    wheels: [BodyRef; 2],
    carrier: BodyRef,
    /// Points and axes of both bearings, on the wheel and on the carrier.
    points: [[&'a Argument; 2]; 2],
    axes: [[&'a Argument; 2]; 2],
}

impl<'a> Borne<'a> {
    /// The wheels that two joints bear on the only body that both connect. Returns `None` and
    /// reports if there are none.
    fn of<S: SceneSpace>(
        field: &Field,
        named: [&'a Known<S>; 2],
        bodies: &Bodies<S>,
        findings: &mut Findings,
    ) -> Option<Self> {
        let mut report = |what: String, label: &str| {
            let message = format!("{}: {what}", field.subject);
            findings.error(Mistake::Bearings, field.span(), message, label);
        };
        let mut read = Vec::new();
        for joint in named {
            if joint.is_coupling || joint.definition.is_some_and(|d| !bears(joint, d.spec)) {
                report(
                    format!(
                        "`{}` bears no wheel: a joint with one axis and one angle is needed",
                        joint.name
                    ),
                    "no bearing",
                );
                return None;
            }
            read.push(bearing(joint)?);
        }
        let [first, second] = &read[..] else {
            return None;
        };
        let is_shared = |body: &BodyRef| second.bodies.contains(body);
        let shared: Vec<BodyRef> = first.bodies.into_iter().filter(is_shared).collect();
        let [first_name, second_name] = named.map(|joint| &joint.name);
        let carrier = match shared[..] {
            [carrier] => carrier,
            [] => {
                report(
                    format!("`{first_name}` and `{second_name}` connect no common body"),
                    "both wheels turn on one carrier",
                );
                return None;
            }
            _ => {
                let names = shared.iter().map(|body| bodies.names.name(*body));
                let names: Vec<_> = names.map(|name| format!("`{name}`")).collect();
                report(
                    format!(
                        "`{first_name}` and `{second_name}` both connect {}: there is one wheel only",
                        names.join(" and ")
                    ),
                    "two wheels and a carrier are three bodies",
                );
                return None;
            }
        };
        // The slot of the wheel in each bearing.
        let slots = [first, second].map(|bearing| usize::from(bearing.bodies[0] == carrier));
        let ordered = |k: usize, both: [&'a Argument; 2]| [both[slots[k]], both[1 - slots[k]]];
        Some(Self {
            wheels: [0, 1].map(|k| read[k].bodies[slots[k]]),
            carrier,
            points: [0, 1].map(|k| ordered(k, read[k].points)),
            axes: [0, 1].map(|k| ordered(k, read[k].axes)),
        })
    }

    /// The axis of bearing `k` on the carrier.
    fn axis(&self, k: usize) -> Option<Axis> {
        let Argument::Triple(point) = *self.points[k][1] else {
            return None;
        };
        let axes = match *self.axes[k][1] {
            Argument::Axes(axes) => Some(axes),
            Argument::Axis(axis, across) => Axes::new(axis, across),
            _ => None,
        };
        let [.., along] = axes?.uvw();
        Some(Axis { point, along })
    }

    /// The wheel on whose axis a force along this line through the pitch point has no lever.
    fn missed_by(&self, line: [f64; 3], pitch: [f64; 3]) -> Option<&'static str> {
        let names = ["first", "second"].into_iter().enumerate();
        let mut axes = names.filter_map(|(k, name)| Some((name, self.axis(k)?)));
        axes.find_map(|(name, axis)| (!axis.has_lever(line, pitch)).then_some(name))
    }

    /// The line of action of wheels that meet at a pitch point of the carrier, if none is written.
    fn line(&self, pitch: [f64; 3], pressure_angle: f64) -> Result<[f64; 3], &'static str> {
        match [0, 1].map(|k| self.axis(k)) {
            [Some(first), Some(second)] => line::of_action([first, second], pitch, pressure_angle),
            _ => Err("an axis has no direction"),
        }
    }

    /// The arguments of the definition, in the order of its parameters.
    fn arguments(&self, spec: &ConstraintSpec, pitch: [f64; 3], line: [f64; 3]) -> Vec<Argument> {
        let pitch = Argument::Triple(pitch);
        let [first, second] = self.points;
        let mut on_carrier = [first[1], second[1], &pitch].into_iter();
        let mut axes_on_carrier = self.axes.iter().map(|axes| axes[1]);
        let arguments = spec.common.parameters.iter().map(|p| match p.shape {
            Shape::Point { slot } => match self.points.get(slot) {
                Some(points) => Some(points[0]),
                None => on_carrier.next(),
            },
            Shape::Axes { slot, .. } => match self.axes.get(slot) {
                Some(axes) => Some(axes[0]),
                None => axes_on_carrier.next(),
            },
            _ => None,
        });
        // The one parameter that is neither a point nor axes.
        let arguments = arguments.map(|a| a.cloned().unwrap_or(Argument::Triple(line)));
        arguments.collect()
    }
}

/// Whether joints of this definition have a point and an axis on each of two bodies, and one angle.
fn bears<S: SceneSpace>(joint: &Known<S>, spec: &ConstraintSpec) -> bool {
    let parameters = spec.common.parameters;
    let points = [0, 1].map(|own| {
        let is_here = |shape| matches!(shape, Shape::Point { slot } if slot == own);
        parameters.iter().filter(|p| is_here(p.shape)).count()
    });
    let axes = [0, 1].map(|own| {
        let is_here = |shape| matches!(shape, Shape::Axes { slot, .. } if slot == own);
        parameters.iter().filter(|p| is_here(p.shape)).count()
    });
    let is_angle = |measure: &&str| dimension(joint, measure) == Some(Dimension::ANGLE);
    let angles = spec.measures.iter().map(|m| m.name).filter(is_angle);
    (spec.common.slots.len(), points, axes, angles.count()) == (2, [1, 1], [1, 1], 1)
}

/// What such a joint says of its bodies, if it could be read.
fn bearing<'a, S: SceneSpace>(joint: &'a Known<S>) -> Option<Bearing<'a>> {
    let spec = &joint.definition?.spec;
    let (bodies, arguments) = joint.complete()?;
    let find = |is: &dyn Fn(Shape) -> bool| {
        let at = spec.common.parameters.iter().position(|p| is(p.shape))?;
        arguments.get(at)
    };
    let point = |own| find(&|shape| matches!(shape, Shape::Point { slot } if slot == own));
    let axes = |own| find(&|shape| matches!(shape, Shape::Axes { slot, .. } if slot == own));
    Some(Bearing {
        bodies: bodies.try_into().ok()?,
        points: [point(0)?, point(1)?],
        axes: [axes(0)?, axes(1)?],
    })
}
