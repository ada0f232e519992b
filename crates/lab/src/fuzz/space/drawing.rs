//! Bodies and joints of space at one configuration, in fractions. All points and directions are
//! given in the axes of the ground, at the configuration where every joint holds; what is fixed in
//! a body follows from its pose.

use super::ratio::Ratio;
use super::vector::{Motion, Rotation, Vector};

/// A body by its index, or the ground.
pub type Side = Option<usize>;

/// The ground.
pub const GROUND: Side = None;

/// A mechanism at one configuration.
#[derive(Clone, Debug, Default)]
pub struct Drawing {
    /// Bodies in the order of the file.
    pub bodies: Vec<Body>,
    /// Joints in the order of the file.
    pub joints: Vec<Joint>,
    /// Drives in the order of the file.
    pub drives: Vec<Drive>,
    /// The redundancy, if theory gives it without computation.
    pub redundancy: Option<usize>,
}

/// A body.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its name.
    pub name: String,
    /// The origin of its frame.
    pub position: Vector,
    /// From its frame to the ground.
    pub orientation: Rotation,
    /// The mass centre in its frame.
    pub centre: Vector,
    /// The mass.
    pub mass: Ratio,
    /// The tensor of inertia about the mass centre, in the axes of its frame.
    pub inertia: [[Ratio; 3]; 3],
}

/// A joint.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Its name.
    pub name: String,
    /// The first and the second body. Joints of one body have the ground as the second.
    pub bodies: [Side; 2],
    /// Its type and place.
    pub kind: Kind,
    /// The direction that chooses the basis of its rows, if it is not the default.
    pub cross: Option<Vector>,
    /// How it is written.
    pub style: Style,
}

/// How a joint is written. None of this changes the right answer.
#[derive(Clone, Debug, Default)]
pub struct Style {
    /// Whether points are given in the frames of the bodies, not in the ground.
    pub points_in_bodies: bool,
    /// The frame of directions.
    pub directions: Directions,
    /// The factor by which directions are multiplied; `None` if they are divided by their length.
    pub factor: Option<Ratio>,
}

/// The frame in which directions of a joint are given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Directions {
    /// In the frame of the first body.
    #[default]
    First,
    /// In the axes of the ground.
    Ground,
    /// In the frames of both bodies, if the joint has one axis that both carry.
    Both,
}

/// The type and place of a joint. `from` is on the first body and `at` on the second. Directions
/// have any length but 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Both bodies share a point.
    Spherical {
        /// The point.
        at: Vector,
    },
    /// Both bodies share a point and an axis.
    Revolute {
        /// The point.
        at: Vector,
        /// The axis.
        axis: Vector,
    },
    /// Both bodies share a point, and two of their axes are perpendicular.
    Universal {
        /// The point.
        at: Vector,
        /// The axis in the first body.
        first: Vector,
        /// The axis in the second body.
        second: Vector,
    },
    /// A slider of the second body on a line of the first; the orientation is kept.
    Translational {
        /// A point of the line on the first body.
        from: Vector,
        /// The slider.
        at: Vector,
        /// The line.
        axis: Vector,
    },
    /// The same, free to turn about the line.
    Cylindrical {
        /// A point of the line on the first body.
        from: Vector,
        /// The slider.
        at: Vector,
        /// The line.
        axis: Vector,
    },
    /// A plane of the first body that a point of the second does not leave; normals are parallel.
    Planar {
        /// A point of the plane on the first body.
        from: Vector,
        /// The point of the second body.
        at: Vector,
        /// The normal.
        normal: Vector,
    },
    /// A weld.
    Fixed {
        /// The reference point.
        at: Vector,
    },
    /// A point of the second body on a line of the first.
    PointOnLine {
        /// A point of the line.
        from: Vector,
        /// The point of the second body.
        at: Vector,
        /// The line.
        axis: Vector,
    },
    /// A point of the second body in a plane of the first.
    PointOnPlane {
        /// A point of the plane.
        from: Vector,
        /// The point of the second body.
        at: Vector,
        /// The normal.
        normal: Vector,
    },
    /// An axis that both bodies keep.
    Parallel {
        /// The axis.
        axis: Vector,
    },
    /// Two axes that stay perpendicular.
    Perpendicular {
        /// The axis in the first body.
        first: Vector,
        /// The axis in the second body.
        second: Vector,
    },
    /// The relative orientation is kept.
    Orientation,
    /// A massless rod with spherical ends.
    Distance {
        /// Its end on the first body.
        from: Vector,
        /// Its end on the second body.
        at: Vector,
    },
    /// A blade: no velocity of a point of the first body along a direction.
    KnifeEdge {
        /// The point.
        at: Vector,
        /// The direction.
        normal: Vector,
    },
    /// A wheel, the first body, that rolls without slip on a plane of the ground.
    Wheel {
        /// Its centre.
        centre: Vector,
        /// Its axis.
        axis: Vector,
        /// The point where it touches.
        contact: Vector,
        /// The normal of the plane, on the side of the wheel.
        normal: Vector,
    },
}

/// A drive of a measure of a joint.
#[derive(Clone, Debug)]
pub struct Drive {
    /// Its name.
    pub name: String,
    /// The index of the joint.
    pub joint: usize,
    /// What it prescribes.
    pub measure: Measure,
}

/// A measure of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// The angle of a revolute or cylindrical joint.
    Angle,
    /// The displacement of a translational or cylindrical joint.
    Displacement,
    /// The length of a distance.
    Length,
}

impl Kind {
    /// The value of `type`.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Spherical { .. } => "spherical",
            Self::Revolute { .. } => "revolute",
            Self::Universal { .. } => "universal",
            Self::Translational { .. } => "translational",
            Self::Cylindrical { .. } => "cylindrical",
            Self::Planar { .. } => "planar",
            Self::Fixed { .. } => "fixed",
            Self::PointOnLine { .. } => "point-on-line",
            Self::PointOnPlane { .. } => "point-on-plane",
            Self::Parallel { .. } => "parallel",
            Self::Perpendicular { .. } => "perpendicular",
            Self::Orientation => "orientation",
            Self::Distance { .. } => "distance",
            Self::KnifeEdge { .. } => "knife-edge",
            Self::Wheel { .. } => "wheel",
        }
    }

    /// Whether it ties one body to the ground by nature, so that the key `body` is written.
    #[must_use]
    pub fn has_one_body(&self) -> bool {
        matches!(self, Self::KnifeEdge { .. } | Self::Wheel { .. })
    }

    /// The point of the first body for which its reaction is given; `None` if it carries couples
    /// only, which are the same about every point.
    #[must_use]
    pub fn place(&self) -> Option<&Vector> {
        match self {
            Self::Spherical { at }
            | Self::Revolute { at, .. }
            | Self::Universal { at, .. }
            | Self::Fixed { at }
            | Self::KnifeEdge { at, .. } => Some(at),
            Self::Translational { from, .. }
            | Self::Cylindrical { from, .. }
            | Self::Planar { from, .. }
            | Self::PointOnLine { from, .. }
            | Self::PointOnPlane { from, .. }
            | Self::Distance { from, .. } => Some(from),
            Self::Wheel { contact, .. } => Some(contact),
            Self::Parallel { .. } | Self::Perpendicular { .. } | Self::Orientation => None,
        }
    }

    /// The same joint after its points and directions are mapped.
    #[must_use]
    pub fn mapped(
        &self,
        point: &dyn Fn(&Vector) -> Vector,
        direction: &dyn Fn(&Vector) -> Vector,
    ) -> Self {
        let mut image = self.clone();
        let (points, directions): (Vec<&mut Vector>, Vec<&mut Vector>) = match &mut image {
            Self::Spherical { at } | Self::Fixed { at } => (vec![at], vec![]),
            Self::Revolute { at, axis } => (vec![at], vec![axis]),
            Self::Universal { at, first, second } => (vec![at], vec![first, second]),
            Self::Translational { from, at, axis }
            | Self::Cylindrical { from, at, axis }
            | Self::PointOnLine { from, at, axis } => (vec![from, at], vec![axis]),
            Self::Planar { from, at, normal } | Self::PointOnPlane { from, at, normal } => {
                (vec![from, at], vec![normal])
            }
            Self::Parallel { axis } => (vec![], vec![axis]),
            Self::Perpendicular { first, second } => (vec![], vec![first, second]),
            Self::Orientation => (vec![], vec![]),
            Self::Distance { from, at } => (vec![from, at], vec![]),
            Self::KnifeEdge { at, normal } => (vec![at], vec![normal]),
            Self::Wheel {
                centre,
                axis,
                contact,
                normal,
            } => (vec![centre, contact], vec![axis, normal]),
        };
        for p in points {
            *p = point(p);
        }
        for d in directions {
            *d = direction(d);
        }
        image
    }

    /// The same joint with its bodies exchanged. `None` if there is no such joint.
    #[must_use]
    pub fn swapped(&self) -> Option<Self> {
        let mut image = self.clone();
        match &mut image {
            Self::Spherical { .. }
            | Self::Revolute { .. }
            | Self::Fixed { .. }
            | Self::Parallel { .. }
            | Self::Orientation => {}
            Self::Translational { from, at, .. }
            | Self::Cylindrical { from, at, .. }
            | Self::Planar { from, at, .. }
            | Self::Distance { from, at } => std::mem::swap(from, at),
            Self::Universal { first, second, .. } | Self::Perpendicular { first, second } => {
                std::mem::swap(first, second);
            }
            Self::PointOnLine { .. }
            | Self::PointOnPlane { .. }
            | Self::KnifeEdge { .. }
            | Self::Wheel { .. } => return None,
        }
        Some(image)
    }

    /// Whether it holds where it is drawn, exactly.
    #[must_use]
    pub fn holds(&self) -> bool {
        match self {
            Self::Spherical { .. } | Self::Fixed { .. } | Self::Orientation => true,
            Self::Revolute { axis, .. } | Self::Parallel { axis } => !axis.is_zero(),
            Self::Universal { first, second, .. } | Self::Perpendicular { first, second } => {
                !first.is_zero() && !second.is_zero() && first.dot(second).is_zero()
            }
            Self::Translational { from, at, axis }
            | Self::Cylindrical { from, at, axis }
            | Self::PointOnLine { from, at, axis } => !axis.is_zero() && (at - from).is_along(axis),
            Self::Planar { from, at, normal } | Self::PointOnPlane { from, at, normal } => {
                !normal.is_zero() && (at - from).dot(normal).is_zero()
            }
            Self::Distance { from, at } => from != at,
            Self::KnifeEdge { normal, .. } => !normal.is_zero(),
            Self::Wheel {
                centre,
                axis,
                contact,
                normal,
            } => {
                // The lowest point of the circle: across the axis, and straight down in its plane.
                let spoke = contact - centre;
                let down = -&normal.across(axis);
                !down.is_zero()
                    && spoke.is_along(&down)
                    && Ratio::zero().is_below(&spoke.dot(&down))
            }
        }
    }
}

impl Drawing {
    /// The frame of a side: position and orientation.
    #[must_use]
    pub fn frame(&self, side: Side) -> Motion {
        match side {
            None => Motion::none(),
            Some(k) => {
                let body = &self.bodies[k];
                Motion::rigid(body.orientation.clone(), body.position.clone())
            }
        }
    }

    /// Adds a body with its frame at the origin of the ground.
    pub fn body(&mut self) -> Side {
        let k = self.bodies.len();
        let diagonal = [3, 4, 5].map(|x| Ratio::new(x, 10));
        let entry = |i: usize, j: usize| {
            if i == j {
                diagonal[i].clone()
            } else {
                Ratio::zero()
            }
        };
        self.bodies.push(Body {
            name: format!("b{k}"),
            position: Vector::zero(),
            orientation: Rotation::none(),
            centre: Vector::zero(),
            mass: Ratio::one(),
            inertia: [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j))),
        });
        Some(k)
    }

    /// Adds a joint and returns its index.
    pub fn joint(&mut self, bodies: [Side; 2], kind: Kind) -> usize {
        let k = self.joints.len();
        self.joints.push(Joint {
            name: format!("j{k}"),
            bodies,
            kind,
            cross: None,
            style: Style::default(),
        });
        k
    }

    /// Adds a drive of a joint.
    pub fn drive(&mut self, joint: usize, measure: Measure) {
        let name = format!("d{}", self.drives.len());
        self.drives.push(Drive {
            name,
            joint,
            measure,
        });
    }

    /// Moves, turns and scales everything as one.
    pub fn moved(&mut self, motion: &Motion) {
        for body in &mut self.bodies {
            body.position = motion.point(&body.position);
            body.orientation = motion.turn.after(&body.orientation);
            body.centre = body.centre.times(&motion.scale);
        }
        for joint in &mut self.joints {
            let kind = &joint.kind;
            joint.kind = kind.mapped(&|p| motion.point(p), &|d| motion.direction(d));
            joint.cross = joint.cross.as_ref().map(|d| motion.direction(d));
        }
    }

    /// The joints that do not hold where they are drawn, by name.
    #[must_use]
    pub fn broken(&self) -> Vec<&str> {
        let broken = self.joints.iter().filter(|j| !j.kind.holds());
        broken.map(|j| j.name.as_str()).collect()
    }
}
