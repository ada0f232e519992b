//! Errors in a description, with messages.

use joints::LARGEST;

use crate::codes::Code;
use crate::tolerance::ToleranceScope;

/// One error in a description.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BuildError {
    /// There is no body.
    #[error("a mechanism needs at least one body")]
    NoBodies,
    /// Two items have the same name.
    #[error("the name `{name}` is used twice")]
    DuplicateName {
        /// The name.
        name: String,
    },
    /// A body has the name of the ground, which is reserved.
    #[error("`ground` is the reserved name of the ground")]
    Ground,
    /// A property of a body is NaN or infinite.
    #[error("body `{body}`: {field} is {value:?}, need finite numbers up to {LARGEST:e}")]
    NotFinite {
        /// The body.
        body: String,
        /// Name of the property.
        field: &'static str,
        /// The value.
        value: f64,
    },
    /// A given velocity refers to a point other than the centre of mass. The angular velocity that
    /// is required in this case is not given.
    #[error(
        "body `{body}`: `velocity` is that of the origin of its frame, which is not its centre of mass, so `angular_velocity` is needed with it"
    )]
    VelocityAlone {
        /// The body.
        body: String,
    },
    /// A mass or an inertia is negative.
    #[error("body `{body}`: {field} is {value}, need a number ≥ 0")]
    Negative {
        /// The body.
        body: String,
        /// Name of the property.
        field: &'static str,
        /// The value.
        value: f64,
    },
    /// Gravity is NaN or infinite.
    #[error("gravity is {gravity:?}, need finite numbers up to {LARGEST:e}")]
    Gravity {
        /// Components of gravity (m/s²).
        gravity: Vec<f64>,
    },
    /// The length of a quaternion is zero.
    #[error("body `{body}`: the quaternion of its orientation is zero")]
    NoOrientation {
        /// The body.
        body: String,
    },
    /// A tensor of inertia is not symmetric.
    #[error("body `{body}`: the tensor of inertia is not symmetric")]
    NotSymmetric {
        /// The body.
        body: String,
    },
    /// A tensor of inertia is physically impossible.
    #[error(
        "body `{body}`: no body has the principal moments {moments:?}: the largest is above the sum of the others"
    )]
    NoSuchTensor {
        /// The body.
        body: String,
        /// The principal moments (kg·m²).
        moments: [f64; 3],
    },
    /// A tolerance is not a finite number > 0 up to [`LARGEST`].
    #[error("{of}: {field} is {value:?}, need a finite number > 0 up to {LARGEST:e}")]
    Tolerance {
        /// The item for which the tolerance is stated.
        of: ToleranceScope,
        /// Name of the tolerance.
        field: &'static str,
        /// The value.
        value: f64,
    },
    /// The number of bodies of a joint, drive or force differs from the number in its definition.
    #[error("`{name}` connects {found} bodies, `{definition}` needs {expected}")]
    BodyCount {
        /// The joint, drive or force.
        name: String,
        /// Definition of the joint, drive or force.
        definition: &'static str,
        /// Number of bodies in the definition.
        expected: usize,
        /// Number of given bodies.
        found: usize,
    },
    /// A body does not exist.
    #[error("`{name}` refers to body number {body}; there are {n_bodies}, counted from 0")]
    UnknownBody {
        /// The joint, drive or force.
        name: String,
        /// Index of the body.
        body: usize,
        /// Number of bodies.
        n_bodies: usize,
    },
    /// A joint connects a body with itself.
    #[error("`{name}` connects `{body}` with itself")]
    SameBody {
        /// The joint, drive or force.
        name: String,
        /// The body.
        body: String,
    },
    /// A joint or force has no moving body.
    #[error("`{name}` connects the ground with itself")]
    GroundOnly {
        /// The joint, drive or force.
        name: String,
    },
    /// A point of a joint, drive or force is NaN or infinite.
    #[error("`{name}`: a point is {point:?}, need finite numbers up to {LARGEST:e}")]
    Point {
        /// The joint, drive or force.
        name: String,
        /// Components of the point.
        point: Vec<f64>,
    },
    /// A property of a marker is NaN or infinite.
    #[error(
        "marker `{name}` is at {point:?}, turned by {angle:?}, need finite numbers up to {LARGEST:e}"
    )]
    Marker {
        /// The marker.
        name: String,
        /// Position of the marker.
        point: Vec<f64>,
        /// Angle of the marker.
        angle: f64,
    },
    /// A marker does not exist.
    #[error(
        "measure `{name}` refers to marker number {marker}; there are {n_markers}, counted from 0"
    )]
    UnknownMarker {
        /// The measure.
        name: String,
        /// Index of the marker.
        marker: usize,
        /// Number of markers.
        n_markers: usize,
    },
    /// Both markers of a measure are the same.
    #[error("measure `{name}` is between two identical points")]
    SameMarker {
        /// The measure.
        name: String,
    },
    /// The measure does not exist in this space, or one of its directions is invalid.
    #[error("measure `{name}`: {reason}")]
    Measure {
        /// The measure.
        name: String,
        /// Reason why the measure does not exist.
        reason: &'static str,
    },
    /// A drive is in the list of joints, or a joint is in the list of drives.
    #[error("`{name}` is in the list of {list}, but `{definition}` does not belong there")]
    Role {
        /// The joint or drive.
        name: String,
        /// Definition of the joint or drive.
        definition: &'static str,
        /// The list that contains the joint or drive.
        list: &'static str,
    },
    /// The number of functions of time differs from the number in the definition.
    #[error("`{name}` has {found} functions of time, `{definition}` needs {expected}")]
    FunctionCount {
        /// The joint or force.
        name: String,
        /// Definition of the element.
        definition: &'static str,
        /// Number of functions of the definition.
        expected: usize,
        /// Number of given functions.
        found: usize,
    },
    /// A joint cannot be one-sided, or its grip or its armature is not possible.
    #[error("`{name}`: {reason}")]
    Limits {
        /// The joint.
        name: String,
        /// The key: `one_sided`, `grip`, `load` or `armature`.
        key: &'static str,
        /// Reason why the value is not possible.
        reason: String,
    },
}

impl BuildError {
    /// Returns the code; see [`crate::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::NoBodies { .. } => const { Code::new(120) },
            Self::DuplicateName { .. } => const { Code::new(104) },
            Self::Ground { .. } => const { Code::new(121) },
            Self::NotFinite { .. } => const { Code::new(122) },
            Self::Negative { .. } => const { Code::new(123) },
            Self::Gravity { .. } => const { Code::new(124) },
            Self::Tolerance { .. } => const { Code::new(125) },
            Self::BodyCount { .. } => const { Code::new(126) },
            Self::UnknownBody { .. } => const { Code::new(127) },
            Self::SameBody { .. } => const { Code::new(128) },
            Self::GroundOnly { .. } => const { Code::new(129) },
            Self::Point { .. } => const { Code::new(130) },
            Self::Role { .. } => const { Code::new(131) },
            Self::FunctionCount { .. } => const { Code::new(132) },
            Self::VelocityAlone { .. } => const { Code::new(133) },
            Self::Marker { .. } => const { Code::new(134) },
            Self::UnknownMarker { .. } => const { Code::new(135) },
            Self::SameMarker { .. } => const { Code::new(136) },
            Self::Measure { .. } => const { Code::new(155) },
            Self::Limits { .. } => const { Code::new(156) },
            Self::NoOrientation { .. } => const { Code::new(152) },
            Self::NotSymmetric { .. } | Self::NoSuchTensor { .. } => const { Code::new(153) },
        }
    }
}
