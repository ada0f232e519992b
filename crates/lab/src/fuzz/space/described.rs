//! A drawing as the description of a mechanism, with the numbers of its text: every number is a
//! fraction rounded once, and what the text leaves out follows from them as in a scene.

use joints::space3::{
    Axes, Cylindrical, CylindricalAngleDrive, CylindricalDisplacementDrive, Direction, Distance,
    DistanceLengthDrive, Fixed, GroundPlane, KnifeEdge, Orientation, Parallel, Perpendicular,
    Planar, PointOnLine, PointOnPlane, Pose, Revolute, RevoluteAngleDrive, Spherical,
    Translational, TranslationalDisplacementDrive, Universal, WheelContact, WheelSlip,
};
use model::{BodyRef, Function, SpatialBody, SpatialDescription};

use super::drawing::{Drawing, Joint, Kind, Measure, Side};
use super::ratio::Ratio;
use super::text::{Precision, direction_in};
use super::vector::Vector;

/// What follows the name of a wheel in the name of its rows against slip, which are a joint of
/// their own.
pub const SLIP: &str = " slip";

/// The description of a drawing.
///
/// # Errors
/// The name of a joint with a direction that rounding left without a length, or of a drive whose
/// joint has no such measure.
pub fn description(drawing: &Drawing, precision: &Precision) -> Result<SpatialDescription, String> {
    let mut pen = Pen {
        drawing,
        precision,
        d: SpatialDescription {
            gravity: precision.gravity,
            ..SpatialDescription::new("exact")
        },
    };
    pen.d.tolerance.length = precision.tolerance;
    pen.bodies();
    for joint in &drawing.joints {
        let placed = pen.joint(joint);
        placed.ok_or_else(|| format!("`{}` has no direction", joint.name))?;
    }
    for drive in &drawing.drives {
        let driven = pen.drive(&drive.name, &drawing.joints[drive.joint], drive.measure);
        driven.ok_or_else(|| format!("`{}` has no measure", drive.name))?;
    }
    Ok(pen.d)
}

struct Pen<'a> {
    drawing: &'a Drawing,
    precision: &'a Precision,
    d: SpatialDescription,
}

impl Pen<'_> {
    fn number(&self, x: &Ratio) -> f64 {
        self.precision.rounded(x.rounded())
    }

    fn vector(&self, v: &Vector) -> [f64; 3] {
        v.0.each_ref().map(|x| self.number(x))
    }

    fn bodies(&mut self) {
        for body in &self.drawing.bodies {
            // Mechanisms refuse products of inertia so far; no verdict depends on them.
            let moment = |i: usize, j: usize| {
                if i == j {
                    self.number(&body.inertia[i][i])
                } else {
                    0.0
                }
            };
            let inertia = [0, 1, 2].map(|i| [0, 1, 2].map(|j| moment(i, j)));
            let orientation = body.orientation.rounded();
            let described = SpatialBody {
                position: self.vector(&body.position),
                centre: self.vector(&body.centre),
                orientation: orientation.map(|x| self.precision.rounded(x)),
                ..SpatialBody::new(&body.name, self.number(&body.mass), inertia)
            };
            self.d.body(described);
        }
    }

    /// A point relative to the centre of mass of a body.
    fn point(&self, joint: &Joint, side: Side, p: &Vector) -> [f64; 3] {
        if joint.is_placed_in_ground() {
            return self.d.local(reference(side), self.vector(p));
        }
        let local = self.drawing.frame(side).inverse().point(p);
        let (local, centre) = (self.vector(&local), self.centre(side));
        std::array::from_fn(|k| local[k] - centre[k])
    }

    fn centre(&self, side: Side) -> [f64; 3] {
        side.map_or([0.0; 3], |k| self.d.bodies[k].centre)
    }

    fn pose(&self, side: Side) -> Pose {
        side.map_or(Pose::GROUND, |k| {
            Pose::new([0.0; 3], self.d.bodies[k].orientation)
        })
    }

    /// A direction as it is written, in the frame in which it is written.
    fn written(&self, joint: &Joint, side: Side, d: &Vector) -> [f64; 3] {
        direction_in(self.drawing, joint, side, d).map(|x| self.precision.rounded(x))
    }

    /// A direction that is written in the frame of the directions of a joint, in a body.
    fn direction(&self, joint: &Joint, side: Side, d: &Vector) -> [f64; 3] {
        let frame = joint.frame_of_directions();
        let written = self.written(joint, frame, d);
        self.carried([frame, side], written)
    }

    /// A direction of one frame in another, at the described start.
    fn carried(&self, [from, to]: [Side; 2], d: [f64; 3]) -> [f64; 3] {
        if from == to {
            return d;
        }
        let ground = self.pose(from).direction_to_global(d);
        self.pose(to).direction_to_local(ground)
    }

    fn ends(&self, joint: &Joint, from: &Vector, at: &Vector) -> [[f64; 3]; 2] {
        let [first, second] = joint.bodies;
        [(first, from), (second, at)].map(|(side, p)| self.point(joint, side, p))
    }

    /// The axes about w in both bodies.
    fn axes(&self, joint: &Joint, w: &Vector) -> Option<[Axes; 2]> {
        let [first, second] = joint.bodies;
        let across = joint.cross.as_ref();
        let across = across.map(|d| self.direction(joint, first, d));
        let own = Axes::new(self.direction(joint, first, w), across)?;
        let carried = own.map(|d| self.carried([first, second], d));
        let other = if joint.gives_both_axes() {
            Axes::new(self.written(joint, second, w), Some(carried.uvw()[0]))?
        } else {
            carried
        };
        Some([own, other])
    }

    fn axial(&self, joint: &Joint, from: &Vector, at: &Vector, w: &Vector) -> Option<Axial> {
        let [s_i, s_j] = self.ends(joint, from, at);
        let [own, other] = self.axes(joint, w)?;
        Some((s_i, s_j, own, other))
    }

    /// A direction of the first body and one of the second.
    fn two(&self, joint: &Joint, a: &Vector, b: &Vector) -> Option<[Direction; 2]> {
        let [first, second] = joint.bodies;
        let a = Direction::new(self.direction(joint, first, a))?;
        Some([a, Direction::new(self.direction(joint, second, b))?])
    }

    fn joint(&mut self, joint: &Joint) -> Option<()> {
        let bodies = joint.bodies.map(reference);
        let first = joint.bodies[0];
        let name = joint.name.as_str();
        match &joint.kind {
            Kind::Spherical { at } => {
                let [s_i, s_j] = self.ends(joint, at, at);
                self.d.joint(name, &bodies, Spherical { s_i, s_j });
            }
            Kind::Fixed { at } => {
                let [s_i, s_j] = self.ends(joint, at, at);
                let [axes, axes_j] = self.frames(joint);
                let element = Fixed {
                    s_i,
                    s_j,
                    axes,
                    axes_j,
                };
                self.d.joint(name, &bodies, element);
            }
            Kind::Orientation => {
                let [axes, axes_j] = self.frames(joint);
                self.d.joint(name, &bodies, Orientation { axes, axes_j });
            }
            Kind::Revolute { at, axis } => {
                let (s_i, s_j, axis, axis_j) = self.axial(joint, at, at, axis)?;
                let element = Revolute {
                    s_i,
                    s_j,
                    axis,
                    axis_j,
                };
                self.d.joint(name, &bodies, element);
            }
            Kind::Universal {
                at,
                first: a,
                second: b,
            } => {
                let [s_i, s_j] = self.ends(joint, at, at);
                let [axis, cross] = self.two(joint, a, b)?;
                let element = Universal {
                    s_i,
                    s_j,
                    axis,
                    cross,
                };
                self.d.joint(name, &bodies, element);
            }
            Kind::Perpendicular {
                first: a,
                second: b,
            } => {
                let [axis, cross] = self.two(joint, a, b)?;
                self.d.joint(name, &bodies, Perpendicular { axis, cross });
            }
            Kind::Translational { from, at, axis } => {
                let (s_i, s_j, axis, axis_j) = self.axial(joint, from, at, axis)?;
                let element = Translational {
                    s_i,
                    s_j,
                    axis,
                    axis_j,
                };
                self.d.joint(name, &bodies, element);
            }
            Kind::Cylindrical { from, at, axis } => {
                let (s_i, s_j, axis, axis_j) = self.axial(joint, from, at, axis)?;
                let element = Cylindrical {
                    s_i,
                    s_j,
                    axis,
                    axis_j,
                };
                self.d.joint(name, &bodies, element);
            }
            Kind::Planar { from, at, normal } => {
                let (s_i, s_j, normal, normal_j) = self.axial(joint, from, at, normal)?;
                let element = Planar {
                    s_i,
                    s_j,
                    normal,
                    normal_j,
                };
                self.d.joint(name, &bodies, element);
            }
            Kind::PointOnLine { from, at, axis } => {
                let (s_i, s_j, axis, _) = self.axial(joint, from, at, axis)?;
                self.d.joint(name, &bodies, PointOnLine { s_i, s_j, axis });
            }
            Kind::PointOnPlane { from, at, normal } => {
                let [s_i, s_j] = self.ends(joint, from, at);
                let normal = Direction::new(self.direction(joint, first, normal))?;
                let element = PointOnPlane { s_i, s_j, normal };
                self.d.joint(name, &bodies, element);
            }
            Kind::Parallel { axis } => {
                let [axis, axis_j] = self.axes(joint, axis)?;
                self.d.joint(name, &bodies, Parallel { axis, axis_j });
            }
            Kind::Distance { from, at } => {
                let [s_i, s_j] = self.ends(joint, from, at);
                let element = Distance {
                    s_i,
                    s_j,
                    length: 0.0,
                    half_inverse: 0.0,
                };
                self.d.joint(name, &bodies, element);
            }
            Kind::KnifeEdge { at, normal } => {
                let s = self.point(joint, first, at);
                let normal = Direction::new(self.direction(joint, first, normal))?;
                self.d.joint(name, &bodies[..1], KnifeEdge { s, normal });
            }
            Kind::Wheel { .. } => self.wheel(joint)?,
        }
        Some(())
    }

    /// The axes of the first body, also as they lie in the second.
    fn frames(&self, joint: &Joint) -> [Axes; 2] {
        let carried = |d| self.carried(joint.bodies, d);
        [Axes::FRAME, Axes::FRAME.map(carried)]
    }

    fn wheel(&mut self, joint: &Joint) -> Option<()> {
        let Kind::Wheel {
            centre,
            axis,
            contact,
            normal,
        } = &joint.kind
        else {
            return None;
        };
        let body = joint.bodies[0];
        let local = self.drawing.frame(body).inverse().point(centre);
        let (local, own) = (self.vector(&local), self.centre(body));
        let s = std::array::from_fn(|k| local[k] - own[k]);
        let axis = Direction::new(self.written(joint, body, axis))?;
        let radius = (contact - centre).square().root();
        let radius = self.precision.rounded(radius);
        let plane = GroundPlane::new(self.vector(contact), self.written(joint, None, normal))?;
        let contact = WheelContact {
            s,
            axis,
            radius,
            plane,
            half_inverse: 0.0,
        };
        let slip = WheelSlip {
            s,
            axis,
            radius,
            plane,
            inverse: 0.0,
        };
        let bodies = [reference(body)];
        self.d.joint(&joint.name, &bodies, contact);
        let name = format!("{}{SLIP}", joint.name);
        self.d.joint(&name, &bodies, slip);
        Some(())
    }

    fn drive(&mut self, name: &str, joint: &Joint, measure: Measure) -> Option<()> {
        let bodies = joint.bodies.map(reference);
        let motion = Function::constant(0.0).ok()?;
        match (measure, &joint.kind) {
            (Measure::Angle, Kind::Revolute { at, axis }) => {
                let (s_i, s_j, axis, axis_j) = self.axial(joint, at, at, axis)?;
                let element = RevoluteAngleDrive {
                    s_i,
                    s_j,
                    axis,
                    axis_j,
                    measure_0: [1.0, 0.0],
                };
                self.d.drive(name, &bodies, element, motion);
            }
            (Measure::Angle, Kind::Cylindrical { from, at, axis }) => {
                let (s_i, s_j, axis, axis_j) = self.axial(joint, from, at, axis)?;
                let element = CylindricalAngleDrive {
                    s_i,
                    s_j,
                    axis,
                    axis_j,
                    measure_0: [1.0, 0.0],
                };
                self.d.drive(name, &bodies, element, motion);
            }
            (Measure::Displacement, Kind::Cylindrical { from, at, axis }) => {
                let (s_i, s_j, axis, axis_j) = self.axial(joint, from, at, axis)?;
                let element = CylindricalDisplacementDrive {
                    s_i,
                    s_j,
                    axis,
                    axis_j,
                    measure_0: 0.0,
                };
                self.d.drive(name, &bodies, element, motion);
            }
            (Measure::Displacement, Kind::Translational { from, at, axis }) => {
                let (s_i, s_j, axis, axis_j) = self.axial(joint, from, at, axis)?;
                let element = TranslationalDisplacementDrive {
                    s_i,
                    s_j,
                    axis,
                    axis_j,
                    measure_0: 0.0,
                };
                self.d.drive(name, &bodies, element, motion);
            }
            (Measure::Length, Kind::Distance { from, at }) => {
                let [s_i, s_j] = self.ends(joint, from, at);
                let element = DistanceLengthDrive {
                    s_i,
                    s_j,
                    length: 0.0,
                    half_inverse: 0.0,
                };
                self.d.drive(name, &bodies, element, motion);
            }
            _ => return None,
        }
        Some(())
    }
}

/// Points and axes of a joint with one axis, in its first and its second body.
type Axial = ([f64; 3], [f64; 3], Axes, Axes);

fn reference(side: Side) -> BodyRef {
    side.map_or(BodyRef::Ground, BodyRef::Body)
}
