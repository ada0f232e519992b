//! A mechanism as plain data. Nothing is checked here; [`crate::Mechanism::build`] checks everything once.

use joints::Pose;

use crate::function::Function;
use crate::registry::{PlaneConstraint, PlaneForce};

/// A mechanism before it is assembled.
#[derive(Clone, Default)]
pub struct Description {
    /// Its name.
    pub name: String,
    /// Acceleration of free fall (m/s²).
    pub gravity: [f64; 2],
    /// Bodies; their order is that of the coordinates.
    pub bodies: Vec<Body>,
    /// Joints; their order is that of the rows.
    pub joints: Vec<Joint>,
    /// Drives; their rows follow the holonomic rows of the joints.
    pub drives: Vec<Drive>,
    /// Forces.
    pub forces: Vec<Force>,
}

/// A rigid body with its state at the start. The origin of its frame is its centre of mass.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Body {
    /// Its name.
    pub name: String,
    /// Mass (kg), ≥ 0.
    pub mass: f64,
    /// Moment of inertia about the centre of mass (kg·m²), ≥ 0.
    pub inertia: f64,
    /// Position of the centre of mass (m).
    pub position: [f64; 2],
    /// Angle (rad).
    pub angle: f64,
    /// Velocity of the centre of mass (m/s).
    pub velocity: [f64; 2],
    /// Angular velocity (rad/s).
    pub angular_velocity: f64,
}

impl Body {
    /// Its pose at the start.
    #[must_use]
    pub fn pose(&self) -> Pose {
        Pose::new(self.position[0], self.position[1], self.angle)
    }
}

/// A body of the mechanism, by its place in the list, or the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum BodyRef {
    /// The ground.
    Ground,
    /// The body at this place.
    Body(usize),
}

impl BodyRef {
    /// Its place in the list; nothing for the ground.
    #[must_use]
    pub fn moving(self) -> Option<usize> {
        match self {
            Self::Ground => None,
            Self::Body(k) => Some(k),
        }
    }
}

/// A joint between bodies.
#[derive(Clone)]
pub struct Joint {
    /// Its name.
    pub name: String,
    /// One body for each slot of the definition.
    pub bodies: Vec<BodyRef>,
    /// Its definition with parameters.
    pub element: Box<dyn PlaneConstraint>,
    /// Its functions of time, in the order of the definition.
    pub functions: Vec<Function>,
}

impl Joint {
    /// A joint that does not depend on time.
    pub fn new(name: &str, bodies: &[BodyRef], element: impl PlaneConstraint + 'static) -> Self {
        Self {
            name: name.to_owned(),
            bodies: bodies.to_vec(),
            element: Box::new(element),
            functions: Vec::new(),
        }
    }
}

/// A prescribed relative motion: measure − initial measure − (f(t) − f(0)) = 0.
#[derive(Clone)]
pub struct Drive {
    /// Its name.
    pub name: String,
    /// One body for each slot of the joint's definition.
    pub bodies: Vec<BodyRef>,
    /// The drive of one measure of the joint, with the joint's parameters.
    pub element: Box<dyn PlaneConstraint>,
    /// f
    pub motion: Function,
}

/// An applied force.
#[derive(Clone)]
pub struct Force {
    /// Its name.
    pub name: String,
    /// One body for each slot of the definition.
    pub bodies: Vec<BodyRef>,
    /// Its definition with parameters.
    pub element: Box<dyn PlaneForce>,
    /// Its functions of time, in the order of the definition.
    pub functions: Vec<Function>,
}
