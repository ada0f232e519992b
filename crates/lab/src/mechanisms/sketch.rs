//! Mechanisms drawn at one configuration, at which joints are given by global points and
//! directions. From the same drawing, the module creates a mechanism of the `model` and, by an
//! independent method, its constraint matrix in exact arithmetic. It also creates the same
//! mechanism in other units, translated, rotated, or in another order.

mod change;
mod rows;

pub use rows::ExactRows;

use joints::{
    Angle, Direction, Distance, Fixed, Gear, KnifeEdge, PinInSlot, Pose, RackAndPinion, Revolute,
    RevoluteAngleDrive, Rolling, Translational, TranslationalDisplacementDrive,
};
use model::{Body, BodyRef, ConstraintKernels, ContactLimits, Description, Drive, Function, Joint};

/// A point or vector in global coordinates.
pub type Vector = [f64; 2];

/// A mechanism at one configuration.
#[derive(Clone, Debug, Default)]
pub struct Sketch {
    /// Bodies at this configuration.
    pub bodies: Vec<Body>,
    /// Joints and drives.
    pub links: Vec<Link>,
}

/// A joint or drive.
#[derive(Clone, Debug)]
pub struct Link {
    /// Name of the joint or drive.
    pub name: String,
    /// Bodies in the order of the arguments of the joint or drive.
    pub bodies: Vec<BodyRef>,
    /// Kind and position of the joint or drive.
    pub tie: Tie,
}

/// The kind of a joint or drive, with global points `at` (on the first body `from`) and global
/// directions of any length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tie {
    /// Both bodies share a point.
    Revolute {
        /// The point.
        at: Vector,
    },
    /// A slider of the second body on a line of the first.
    Translational {
        /// A point of the line.
        from: Vector,
        /// The slider.
        at: Vector,
        /// The line.
        axis: Vector,
    },
    /// A rigid connection.
    Fixed {
        /// The reference point.
        at: Vector,
    },
    /// A pin of the second body in a slot of the first.
    PinInSlot {
        /// A point of the slot.
        from: Vector,
        /// The pin.
        at: Vector,
        /// The slot.
        axis: Vector,
    },
    /// A massless rod.
    Distance {
        /// The end on the first body.
        from: Vector,
        /// The end on the second body.
        at: Vector,
    },
    /// Equal rotations.
    Angle,
    /// Rotations in a ratio, relative to the third body.
    Gear {
        /// The ratio.
        ratio: f64,
    },
    /// A pinion, the second body, on a rack.
    RackAndPinion {
        /// Centre of the pinion.
        at: Vector,
        /// The rack.
        axis: Vector,
        /// Radius of the pinion.
        radius: f64,
    },
    /// The velocity along the normal is zero.
    KnifeEdge {
        /// The point of contact.
        at: Vector,
        /// The normal.
        normal: Vector,
    },
    /// A wheel, the second body, that rolls and rotates in a bearing of the first body.
    Rolling {
        /// The centre, on the carrier.
        at: Vector,
        /// Direction of rolling, a unit vector.
        direction: Vector,
        /// Radius of the wheel.
        radius: f64,
    },
    /// A drive of the relative angle.
    AngleDrive,
    /// A drive along the line of a slider.
    DisplacementDrive {
        /// A point of the line.
        from: Vector,
        /// The slider.
        at: Vector,
        /// The line.
        axis: Vector,
    },
}

impl Sketch {
    /// Adds a body with unit mass and unit inertia, and returns a reference to it.
    pub fn body(&mut self, position: Vector, angle: f64) -> BodyRef {
        self.bodies.push(Body {
            name: format!("body {}", self.bodies.len()),
            mass: 1.0,
            inertia: 1.0,
            position,
            angle,
            ..Body::default()
        });
        BodyRef::Body(self.bodies.len() - 1)
    }

    /// Adds a joint or drive.
    pub fn link(&mut self, bodies: &[BodyRef], tie: Tie) {
        self.links.push(Link {
            name: format!("link {}", self.links.len()),
            bodies: bodies.to_vec(),
            tie,
        });
    }

    /// Returns the description for the `model`. Drives come after the joints; the order in each
    /// group is unchanged.
    ///
    /// # Panics
    /// Panics if a direction is zero or not finite.
    #[must_use]
    pub fn description(&self) -> Description {
        let joints = self.links.iter().filter(|l| !l.tie.is_drive());
        let drives = self.links.iter().filter(|l| l.tie.is_drive());
        Description {
            name: "sketch".into(),
            bodies: self.bodies.clone(),
            joints: joints.map(|l| self.joint(l)).collect(),
            drives: drives.map(|l| self.drive(l)).collect(),
            ..Description::default()
        }
    }

    fn joint(&self, link: &Link) -> Joint {
        Joint {
            name: link.name.clone(),
            bodies: link.bodies.clone(),
            element: self.element(link),
            functions: Vec::new(),
            tolerance: None,
            limits: ContactLimits::default(),
        }
    }

    fn drive(&self, link: &Link) -> Drive {
        Drive {
            name: link.name.clone(),
            bodies: link.bodies.clone(),
            element: self.element(link),
            motion: Function::constant_rate(1.0).expect("finite"),
            tolerance: None,
        }
    }

    fn element(&self, link: &Link) -> Box<dyn ConstraintKernels> {
        let pose = |slot: usize| match link.bodies[slot] {
            BodyRef::Ground => Pose::GROUND,
            BodyRef::Body(k) => self.bodies[k].pose(),
        };
        let point = |slot: usize, p: Vector| pose(slot).to_local(p);
        let direction = |slot: usize, v: Vector| {
            let turned = Pose {
                x: 0.0,
                y: 0.0,
                ..pose(slot)
            };
            Direction::new(turned.to_local(v)).expect("a direction")
        };
        // The mechanism computes initial values such as lengths and angles, so they are not given
        // here.
        match link.tie {
            Tie::Revolute { at } => Box::new(Revolute {
                s_i: point(0, at),
                s_j: point(1, at),
            }),
            Tie::Translational { from, at, axis } => Box::new(Translational::new(
                point(0, from),
                point(1, at),
                direction(0, axis),
            )),
            Tie::Fixed { at } => Box::new(Fixed::new(point(0, at), point(1, at))),
            Tie::PinInSlot { from, at, axis } => Box::new(PinInSlot {
                s_i: point(0, from),
                s_j: point(1, at),
                axis: direction(0, axis),
            }),
            Tie::Distance { from, at } => Box::new(Distance::new(point(0, from), point(1, at))),
            Tie::Angle => Box::new(Angle::new()),
            Tie::Gear { ratio } => Box::new(Gear::new(ratio)),
            Tie::RackAndPinion { at, axis, radius } => {
                Box::new(RackAndPinion::new(point(1, at), direction(0, axis), radius))
            }
            Tie::KnifeEdge { at, normal } => Box::new(KnifeEdge {
                s: point(0, at),
                normal: direction(0, normal),
            }),
            Tie::Rolling {
                at,
                direction: along,
                radius,
            } => Box::new(Rolling {
                s: point(0, at),
                direction: direction(0, along),
                radius,
            }),
            Tie::AngleDrive => Box::new(RevoluteAngleDrive::new([0.0; 2], [0.0; 2])),
            Tie::DisplacementDrive { from, at, axis } => {
                Box::new(TranslationalDisplacementDrive::new(
                    point(0, from),
                    point(1, at),
                    direction(0, axis),
                ))
            }
        }
    }
}

impl Tie {
    /// Whether the element prescribes a motion.
    #[must_use]
    pub fn is_drive(self) -> bool {
        matches!(self, Self::AngleDrive | Self::DisplacementDrive { .. })
    }

    /// Whether the element restricts only velocities.
    #[must_use]
    pub fn is_nonholonomic(self) -> bool {
        matches!(self, Self::KnifeEdge { .. } | Self::Rolling { .. })
    }
}
