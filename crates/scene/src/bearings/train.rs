//! Finds the bodies on which a wheel turns about the axis of its bearing. These bodies are the
//! other body of the bearing, and all bodies that joints with the same axis connect to this other
//! body.

use joints::space3::Axes;
use model::BodyRef;
use model::registry::ConstraintDefinition;

use super::line::{Axis, Offset};
use super::{CARRIER_KEY, slot_of};
use crate::bodies::Bodies;
use crate::dimension::Dimension;
use crate::joint_measure::dimension;
use crate::joint_name::References;
use crate::joint_read::{JointKind, JointRead};
use crate::limits::MEETING;
use crate::space::SceneSpace;

/// Point and axis of a bearing on one body of the bearing.
#[derive(Clone, Copy)]
pub(super) struct Seat {
    pub(super) body: BodyRef,
    pub(super) point: [f64; 3],
    pub(super) axes: Axes,
}

impl Seat {
    pub(super) fn axis(&self) -> Axis {
        let [.., along] = self.axes.uvw();
        Axis {
            point: self.point,
            along,
        }
    }

    /// Returns the seat with its axis in the opposite direction if `is_reversed`.
    fn turned(self, is_reversed: bool) -> Self {
        let [u, ..] = self.axes.uvw();
        let half_turn = |d: [f64; 3]| {
            let along = joints::space3::dot(u, d);
            [0, 1, 2].map(|k| 2.0 * along * u[k] - d[k])
        };
        Self {
            axes: if is_reversed {
                self.axes.map(half_turn)
            } else {
                self.axes
            },
            ..self
        }
    }
}

/// A joint with one axis and one angle.
pub(super) struct Bearing<'a> {
    pub(super) name: &'a str,
    pub(super) sides: [Seat; 2],
}

/// Reason why there are no two wheels on one carrier.
pub(super) struct Refusal {
    pub(super) what: String,
    pub(super) label: &'static str,
}

impl<'a> Bearing<'a> {
    /// Returns the bearing of a joint. Returns `None` if a value of the joint could not be read.
    pub(super) fn of<S: SceneSpace>(joint: &'a JointRead<S>) -> Result<Option<Self>, Refusal> {
        let parameters = match joint.kind {
            JointKind::Unknown => return Ok(None),
            JointKind::Coupling => None,
            JointKind::Defined(definition) => parameters(definition),
        };
        let parameters = parameters.ok_or_else(|| Refusal {
            what: format!(
                "`{}` bears no wheel: a joint with one axis and one angle is needed",
                joint.name
            ),
            label: "no bearing",
        })?;
        let side = |slot: usize| {
            let complete = joint.complete.as_ref()?;
            let [point, axes] = parameters[slot].map(|at| complete.arguments.get(at));
            Some(Seat {
                body: *complete.joint.bodies.get(slot)?,
                point: super::xyz(point?)?,
                axes: super::axes(axes?)?,
            })
        };
        let sides = side(0).zip(side(1));
        Ok(sides.map(|(first, second)| Self {
            name: &joint.name,
            sides: [first, second],
        }))
    }

    fn bodies(&self) -> [BodyRef; 2] {
        self.sides.map(|side| side.body)
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

/// A body on which a wheel turns, with the axis of the bearing on this body.
struct Carrier {
    seat: Seat,
    /// The side of the bearing that is the wheel. The wheel is the body of the bearing with more
    /// joints between it and this carrier. `None` if both bodies are equally far away.
    wheel: Option<usize>,
}

/// The joints that connect two bearings to the bodies on which the wheels turn.
pub(super) struct Train<'a, 'j, 'r, S: SceneSpace> {
    references: &'a References<'a, 'j, 'r, S>,
    bearings: [Bearing<'j>; 2],
    /// The size of the wheels (m). Distances between axes are compared with this size.
    size: f64,
}

impl<'a, 'j, 'r, S: SceneSpace> Train<'a, 'j, 'r, S> {
    pub(super) fn new(
        references: &'a References<'a, 'j, 'r, S>,
        bearings: [Bearing<'j>; 2],
    ) -> Self {
        let size = size(&bearings, references.bodies);
        Self {
            references,
            bearings,
            size,
        }
    }

    /// Returns the carrier: `given`, the body that both bearings connect, or the only body on which
    /// both wheels turn.
    pub(super) fn carrier(&self, given: Option<BodyRef>) -> Result<BodyRef, Refusal> {
        if let Some(given) = given {
            return Ok(given);
        }
        let [own, other] = self.bearings.each_ref().map(Bearing::bodies);
        let mut shared = own.to_vec();
        shared.retain(|body| other.contains(body));
        match shared[..] {
            [carrier] => return Ok(carrier),
            [] => {}
            _ => return Err(self.one_wheel(&shared)),
        }
        let [own, other] = [0, 1].map(|k| self.carriers(k, None));
        let turns_there = |body| other.iter().any(|there| there.seat.body == body);
        let own = own.iter().map(|here| here.seat.body);
        let common: Vec<_> = own.filter(|body| turns_there(*body)).collect();
        let [first, second] = self.names();
        match common[..] {
            [carrier] => Ok(carrier),
            [] => Err(Refusal {
                what: format!(
                    "{first} and {second} connect no common body, and there is no body on which both wheels turn{}",
                    self.miss(&[0, 1], |k| self.bearings[1 - k].bodies().to_vec())
                ),
                label: "both wheels turn on one carrier",
            }),
            _ => Err(Refusal {
                what: format!(
                    "both wheels turn on {}: write which one is the `{}`",
                    self.quoted(&common),
                    CARRIER_KEY.name
                ),
                label: "the carrier is not determined",
            }),
        }
    }

    /// Returns the wheel of bearing `k` and its axis on the carrier.
    pub(super) fn wheel(&self, k: usize, carrier: BodyRef) -> Result<[Seat; 2], Refusal> {
        let bearing = &self.bearings[k];
        let (name, bodies) = (bearing.name, self.quoted(&bearing.bodies()));
        let on = self.quoted(&[carrier]);
        let mut found = self.carriers(k, Some(carrier)).into_iter();
        match found.find(|there| there.seat.body == carrier) {
            Some(Carrier {
                seat,
                wheel: Some(wheel),
            }) => Ok([bearing.sides[wheel], seat]),
            Some(_) => Err(Refusal {
                what: format!(
                    "`{name}` connects {bodies}, which both turn on {on}: name the joint that connects the wheel with {on}"
                ),
                label: "the wheel is not determined",
            }),
            None => Err(Refusal {
                what: format!(
                    "no joints about the axis of `{name}` connect {bodies} with the carrier {on}{}",
                    self.miss(&[k], |_| vec![carrier])
                ),
                label: "both wheels turn on one carrier",
            }),
        }
    }

    /// The train has only one wheel, because both bearings connect these bodies.
    pub(super) fn one_wheel(&self, shared: &[BodyRef]) -> Refusal {
        let [first, second] = self.names();
        Refusal {
            what: format!(
                "{first} and {second} both connect {}: there is one wheel only",
                self.quoted(shared)
            ),
            label: "two wheels and a carrier are three bodies",
        }
    }

    fn names(&self) -> [String; 2] {
        self.bearings
            .each_ref()
            .map(|bearing| format!("`{}`", bearing.name))
    }

    /// The names of bodies, in words.
    fn quoted(&self, bodies: &[BodyRef]) -> String {
        let names = bodies
            .iter()
            .map(|body| self.references.bodies.names.name(*body));
        let names: Vec<_> = names.map(|name| format!("`{name}`")).collect();
        names.join(" and ")
    }

    /// Returns the bodies on which the wheel of bearing `k` turns, from the nearest to the
    /// farthest. The search ends at `last`.
    fn carriers(&self, k: usize, last: Option<BodyRef>) -> Vec<Carrier> {
        let own = &self.bearings[k];
        let mut found: Vec<_> = [0, 1]
            .map(|side| Carrier {
                seat: own.sides[side],
                wheel: Some(1 - side),
            })
            .into();
        let mut nearer = 0..found.len();
        while !nearer.is_empty()
            && found[nearer.clone()]
                .iter()
                .all(|c| Some(c.seat.body) != last)
        {
            let next = nearer.end..;
            for at in nearer {
                let Carrier { seat, wheel } = found[at];
                for (_, [here, there]) in self.joints(seat.body) {
                    let offset = seat.axis().offset(&here.axis());
                    if !self.coincide(&offset) {
                        continue;
                    }
                    let known = found.iter().position(|c| c.seat.body == there.body);
                    match known {
                        None => found.push(Carrier {
                            seat: there.turned(offset.is_reversed),
                            wheel,
                        }),
                        Some(same) if next.contains(&same) && found[same].wheel != wheel => {
                            found[same].wheel = None;
                        }
                        Some(_) => {}
                    }
                }
            }
            nearer = next.start..found.len();
        }
        found
    }

    fn coincide(&self, offset: &Offset) -> bool {
        offset.sine < MEETING && offset.distance <= MEETING * self.size
    }

    /// Returns the bearings of a body. Each bearing has a name, a seat on this body and a seat on
    /// the other body. An active mesh uses only active joints.
    fn joints(&self, body: BodyRef) -> impl Iterator<Item = (&'j str, [Seat; 2])> {
        let is_active = self.references.is_active;
        let all = self.references.joints.of_body(body).iter();
        let active = all.filter(move |joint| joint.is_active || !is_active);
        active.filter_map(move |joint| {
            let Bearing { name, sides } = Bearing::of(joint).ok().flatten()?;
            let [first, second] = sides;
            Some((
                name,
                if first.body == body {
                    [first, second]
                } else {
                    [second, first]
                },
            ))
        })
    }

    /// Whether a joint could not be read completely. That joint may be the missing joint.
    pub(super) fn is_incomplete(&self) -> bool {
        let is_unread = |joint: &JointRead<S>| matches!(Bearing::of(joint), Ok(None));
        self.references.joints.all().iter().any(is_unread)
    }

    /// Returns a text that names the joint with the axis nearest to the axis of one of the bearings
    /// `of`. The function considers only joints that would connect the wheel to one of the bodies
    /// `ends` if the joints had the axis of the bearing. The text is empty if there is no such
    /// joint.
    fn miss(&self, of: &[usize], ends: impl Fn(usize) -> Vec<BodyRef>) -> String {
        let mut misses = Vec::new();
        for &k in of {
            let ends = ends(k);
            for here in self.carriers(k, None) {
                let joints = self.joints(here.seat.body);
                for (name, [own, there]) in joints {
                    let offset = here.seat.axis().offset(&own.axis());
                    if ends.contains(&there.body) && !self.coincide(&offset) {
                        misses.push((self.share(&offset), k, name, offset));
                    }
                }
            }
        }
        let nearest = misses.iter().min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.map_or_else(String::new, |(_, k, name, offset)| {
            let own = self.bearings[*k].name;
            format!("; the axis of `{name}` {offset} the axis of `{own}`")
        })
    }

    /// The offset of an axis as a share of the size of the wheels.
    fn share(&self, offset: &Offset) -> f64 {
        offset.sine + offset.distance / self.size.max(f64::MIN_POSITIVE)
    }
}

/// Returns the largest of the following distances: between the points of the two bearings, and
/// between these points and the centres of mass of their bodies.
fn size<S: SceneSpace>(bearings: &[Bearing; 2], bodies: &Bodies<S>) -> f64 {
    let [first, second] = bearings.each_ref().map(|bearing| {
        let [Seat { body, point, .. }, _] = bearing.sides;
        S::point(bodies.at_start(body, S::vector(point)))
    });
    let sides = bearings.iter().flat_map(|bearing| &bearing.sides);
    let moving = sides.filter(|side| side.body.moving().is_some());
    let arms = moving.map(|side| super::line::length(side.point));
    arms.fold(
        super::line::length(super::line::minus(first, second)),
        f64::max,
    )
}
