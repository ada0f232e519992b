//! Bodies and joints in space at one configuration, with rational coordinates. All points and
//! directions are given in the axes of the ground, at a configuration at which every joint is
//! satisfied. The coordinates in a body follow from the pose of the body.

pub use super::kind::Kind;
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
    /// Name of the body.
    pub name: String,
    /// The origin of the body frame.
    pub position: Vector,
    /// Rotation from the body frame to the ground.
    pub orientation: Rotation,
    /// The mass centre in the body frame.
    pub centre: Vector,
    /// The mass.
    pub mass: Ratio,
    /// The tensor of inertia about the mass centre, in the axes of the body frame.
    pub inertia: [[Ratio; 3]; 3],
}

/// A joint.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Name of the joint.
    pub name: String,
    /// The first and the second body. Joints of one body have the ground as the second body.
    pub bodies: [Side; 2],
    /// Type and position of the joint.
    pub kind: Kind,
    /// The direction that selects the basis of the rows of the joint, if it is not the default.
    pub cross: Option<Vector>,
    /// Written form of the joint.
    pub style: Style,
}

impl Joint {
    /// Whether the axis is written for both bodies.
    #[must_use]
    pub fn gives_both_axes(&self) -> bool {
        self.style.directions == Directions::Both
            && matches!(
                self.kind,
                Kind::Revolute { .. } | Kind::Cylindrical { .. } | Kind::Parallel { .. }
            )
    }

    /// Whether the points are written in the axes of the ground.
    #[must_use]
    pub fn is_placed_in_ground(&self) -> bool {
        let is_one_point = match &self.kind {
            Kind::Translational { from, at, .. }
            | Kind::Cylindrical { from, at, .. }
            | Kind::Planar { from, at, .. }
            | Kind::PointOnLine { from, at, .. }
            | Kind::PointOnPlane { from, at, .. } => from == at,
            _ => true,
        };
        is_one_point && !self.style.points_in_bodies
    }

    /// Returns the frame in which directions are written, if they are not written for both bodies.
    #[must_use]
    pub fn frame_of_directions(&self) -> Side {
        match self.style.directions {
            Directions::Ground => GROUND,
            Directions::First | Directions::Both => self.bodies[0],
        }
    }
}

/// Written form of a joint. The correct result does not depend on this form.
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
    /// In the frames of both bodies, if the joint has one axis that belongs to both bodies.
    Both,
}

/// A drive of a joint coordinate.
#[derive(Clone, Debug)]
pub struct Drive {
    /// Name of the drive.
    pub name: String,
    /// The index of the joint.
    pub joint: usize,
    /// The driven joint coordinate.
    pub measure: Measure,
}

/// A joint coordinate (measure).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// The angle of a revolute or cylindrical joint.
    Angle,
    /// The displacement of a translational or cylindrical joint.
    Displacement,
    /// The length of a distance joint.
    Length,
}

impl Drawing {
    /// Returns position and orientation of the frame of the body on one side of a joint; `None` is
    /// the ground.
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

    /// Translates, rotates and scales the whole drawing.
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

    /// Returns the names of the joints that are not satisfied as drawn.
    #[must_use]
    pub fn broken(&self) -> Vec<&str> {
        let broken = self.joints.iter().filter(|j| !j.kind.holds());
        broken.map(|j| j.name.as_str()).collect()
    }
}
