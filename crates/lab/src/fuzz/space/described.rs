//! A drawing as a description for the `model`, without a file. Every number is a fraction rounded
//! once; only the row basis of a joint is carried to its second body in `f64`.

use joints::space3::{
    Axes, Cylindrical, Direction, Distance, Fixed, GroundPlane, KnifeEdge, Orientation, Parallel,
    Perpendicular, Planar, PointOnLine, PointOnPlane, Pose, Revolute, Spherical, Translational,
    Universal, WheelContact, WheelSlip,
};
use model::{BodyRef, Function, FunctionError, SpatialBody, SpatialDescription};

use super::drawing::{Body, Drawing, Drive, Joint, Kind, Measure, Side};
use super::ratio::Ratio;
use super::vector::Vector;

/// Why a drawing is not a mechanism.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DescribeError {
    /// A direction is zero.
    #[error("`{joint}` has a direction that is zero")]
    Direction {
        /// The joint.
        joint: String,
    },
    /// The joint has no such measure.
    #[error("`{joint}` does not have the measure of `{drive}`")]
    Measure {
        /// The joint.
        joint: String,
        /// The drive.
        drive: String,
    },
    /// The function of a drive is not finite.
    #[error(transparent)]
    Function(#[from] FunctionError),
}

/// What a wheel that does not slip adds to its name: its contact is a joint of its own.
pub const SLIP: &str = " slip";

/// The mechanism of a drawing, with the diagonals of its tensors. The slip rows of a wheel are a
/// second joint, named with [`SLIP`]. Drives have a rate of one.
///
/// # Errors
/// - [`DescribeError::Direction`]: a joint has a direction that is zero.
/// - [`DescribeError::Measure`]: a drive prescribes what its joint does not measure.
pub fn described(drawing: &Drawing) -> Result<SpatialDescription, DescribeError> {
    let mut d = SpatialDescription::new("drawing");
    for body in &drawing.bodies {
        d.body(SpatialBody {
            centre: rounded(&body.centre),
            position: rounded(&body.position),
            orientation: body.orientation.rounded(),
            ..SpatialBody::new(&body.name, body.mass.rounded(), inertia(body))
        });
    }
    for joint in &drawing.joints {
        let on = Place { drawing, joint };
        add_joint(&mut d, &on).ok_or_else(|| DescribeError::Direction {
            joint: joint.name.clone(),
        })?;
    }
    for drive in &drawing.drives {
        let joint = &drawing.joints[drive.joint];
        let motion = Function::constant_rate(1.0)?;
        let on = Place { drawing, joint };
        add_drive(&mut d, &on, drive, motion).ok_or_else(|| DescribeError::Measure {
            joint: joint.name.clone(),
            drive: drive.name.clone(),
        })?;
    }
    Ok(d)
}

fn rounded(v: &Vector) -> [f64; 3] {
    v.0.each_ref().map(Ratio::rounded)
}

/// The diagonal of the tensor, which is that of a body, too.
// FIXME: the model takes tensors without products only (P0154); then the whole tensor.
fn inertia(body: &Body) -> [[f64; 3]; 3] {
    let entry = |i: usize, j: usize| {
        if i == j {
            body.inertia[i][j].rounded()
        } else {
            0.0
        }
    };
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)))
}

/// A joint and the bodies on which it is placed.
struct Place<'a> {
    drawing: &'a Drawing,
    joint: &'a Joint,
}

impl Place<'_> {
    fn bodies(&self) -> [BodyRef; 2] {
        let side = |side: Side| side.map_or(BodyRef::Ground, BodyRef::Body);
        self.joint.bodies.map(side)
    }

    /// A point relative to the mass centre of a body.
    fn point(&self, slot: usize, p: &Vector) -> [f64; 3] {
        let side = self.joint.bodies[slot];
        let local = self.drawing.frame(side).inverse().point(p);
        rounded(&match side {
            Some(k) => &local - &self.drawing.bodies[k].centre,
            None => local,
        })
    }

    fn vector(&self, slot: usize, v: &Vector) -> [f64; 3] {
        rounded(
            &self
                .drawing
                .frame(self.joint.bodies[slot])
                .turn
                .inverse()
                .of(v),
        )
    }

    fn direction(&self, slot: usize, v: &Vector) -> Option<Direction> {
        Direction::new(self.vector(slot, v))
    }

    /// Axes on both bodies.
    fn axes(&self, w: &Vector) -> Option<[Axes; 2]> {
        let cross = self.joint.cross.as_ref().map(|cross| self.vector(0, cross));
        Axes::new(self.vector(0, w), cross).map(|axes| self.both(axes))
    }

    /// Axes of the first body, and the same on the second one.
    fn both(&self, axes: Axes) -> [Axes; 2] {
        let [one, other] = self.joint.bodies.map(|side| {
            let turn = self.drawing.frame(side).turn.rounded();
            Pose::new([0.0; 3], turn)
        });
        let carried = axes.map(|v| other.direction_to_local(one.direction_to_global(v)));
        [axes, carried]
    }
}

fn add_joint(d: &mut SpatialDescription, on: &Place<'_>) -> Option<()> {
    let (name, bodies) = (on.joint.name.as_str(), &on.bodies());
    let points = |from, at| [on.point(0, from), on.point(1, at)];
    match &on.joint.kind {
        Kind::Spherical { at } => {
            let [s_i, s_j] = points(at, at);
            d.joint(name, bodies, Spherical { s_i, s_j });
        }
        Kind::Revolute { at, axis } => {
            d.joint(name, bodies, revolute(on, at, axis)?);
        }
        Kind::Universal { at, first, second } => {
            let [s_i, s_j] = points(at, at);
            let universal = Universal {
                s_i,
                s_j,
                axis: on.direction(0, first)?,
                cross: on.direction(1, second)?,
            };
            d.joint(name, bodies, universal);
        }
        Kind::Translational { from, at, axis } => {
            d.joint(name, bodies, translational(on, [from, at], axis)?);
        }
        Kind::Cylindrical { from, at, axis } => {
            d.joint(name, bodies, cylindrical(on, [from, at], axis)?);
        }
        Kind::Planar { from, at, normal } => {
            let ([s_i, s_j], [normal, normal_j]) = (points(from, at), on.axes(normal)?);
            let planar = Planar {
                s_i,
                s_j,
                normal,
                normal_j,
            };
            d.joint(name, bodies, planar);
        }
        Kind::Fixed { at } => {
            let ([s_i, s_j], [axes, axes_j]) = (points(at, at), on.both(Axes::FRAME));
            let fixed = Fixed {
                s_i,
                s_j,
                axes,
                axes_j,
            };
            d.joint(name, bodies, fixed);
        }
        Kind::PointOnLine { from, at, axis } => {
            let ([s_i, s_j], [axis, _]) = (points(from, at), on.axes(axis)?);
            d.joint(name, bodies, PointOnLine { s_i, s_j, axis });
        }
        Kind::PointOnPlane { from, at, normal } => {
            let ([s_i, s_j], normal) = (points(from, at), on.direction(0, normal)?);
            d.joint(name, bodies, PointOnPlane { s_i, s_j, normal });
        }
        Kind::Parallel { axis } => {
            let [axis, axis_j] = on.axes(axis)?;
            d.joint(name, bodies, Parallel { axis, axis_j });
        }
        Kind::Perpendicular { first, second } => {
            let (axis, cross) = (on.direction(0, first)?, on.direction(1, second)?);
            d.joint(name, bodies, Perpendicular { axis, cross });
        }
        Kind::Orientation => {
            let [axes, axes_j] = on.both(Axes::FRAME);
            d.joint(name, bodies, Orientation { axes, axes_j });
        }
        Kind::Distance { from, at } => {
            d.joint(name, bodies, distance(on, [from, at]));
        }
        Kind::KnifeEdge { at, normal } => {
            let (s, normal) = (on.point(0, at), on.direction(0, normal)?);
            d.joint(name, &bodies[..1], KnifeEdge { s, normal });
        }
        Kind::Wheel {
            centre,
            axis,
            contact,
            normal,
        } => {
            let (s, axis) = (on.point(0, centre), on.direction(0, axis)?);
            let radius = (contact - centre).square().root();
            let plane = GroundPlane::new(rounded(contact), rounded(normal))?;
            let touching = WheelContact {
                s,
                axis,
                radius,
                plane,
                half_inverse: 0.0,
            };
            let rolling = WheelSlip {
                s,
                axis,
                radius,
                plane,
                inverse: 0.0,
            };
            d.joint(name, &bodies[..1], touching);
            d.joint(&format!("{name}{SLIP}"), &bodies[..1], rolling);
        }
    }
    Some(())
}

fn add_drive(
    d: &mut SpatialDescription,
    on: &Place<'_>,
    drive: &Drive,
    motion: Function,
) -> Option<()> {
    let (name, bodies) = (drive.name.as_str(), &on.bodies());
    match (&on.joint.kind, drive.measure) {
        (Kind::Revolute { at, axis }, Measure::Angle) => {
            d.drive(name, bodies, revolute(on, at, axis)?.angle_drive(), motion);
        }
        (Kind::Translational { from, at, axis }, Measure::Displacement) => {
            let joint = translational(on, [from, at], axis)?;
            d.drive(name, bodies, joint.displacement_drive(), motion);
        }
        (Kind::Cylindrical { from, at, axis }, Measure::Displacement) => {
            let joint = cylindrical(on, [from, at], axis)?;
            d.drive(name, bodies, joint.displacement_drive(), motion);
        }
        (Kind::Cylindrical { from, at, axis }, Measure::Angle) => {
            let joint = cylindrical(on, [from, at], axis)?;
            d.drive(name, bodies, joint.angle_drive(), motion);
        }
        (Kind::Distance { from, at }, Measure::Length) => {
            d.drive(
                name,
                bodies,
                distance(on, [from, at]).length_drive(),
                motion,
            );
        }
        _ => return None,
    }
    Some(())
}

fn revolute(on: &Place<'_>, at: &Vector, axis: &Vector) -> Option<Revolute> {
    let [axis, axis_j] = on.axes(axis)?;
    Some(Revolute {
        s_i: on.point(0, at),
        s_j: on.point(1, at),
        axis,
        axis_j,
    })
}

fn translational(on: &Place<'_>, [from, at]: [&Vector; 2], axis: &Vector) -> Option<Translational> {
    let [axis, axis_j] = on.axes(axis)?;
    Some(Translational {
        s_i: on.point(0, from),
        s_j: on.point(1, at),
        axis,
        axis_j,
    })
}

fn cylindrical(on: &Place<'_>, [from, at]: [&Vector; 2], axis: &Vector) -> Option<Cylindrical> {
    let [axis, axis_j] = on.axes(axis)?;
    Some(Cylindrical {
        s_i: on.point(0, from),
        s_j: on.point(1, at),
        axis,
        axis_j,
    })
}

fn distance(on: &Place<'_>, [from, at]: [&Vector; 2]) -> Distance {
    Distance {
        s_i: on.point(0, from),
        s_j: on.point(1, at),
        length: 0.0,
        half_inverse: 0.0,
    }
}
