//! Descriptions of bodies in the plane and in space, and the references by which joints select
//! bodies.

use crate::principal::Principal;

/// A rigid body with its initial state. The origin of the body frame is the centre of mass, unless
/// `centre` specifies another point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Body {
    /// Name of the body.
    pub name: String,
    /// Mass (kg), ≥ 0.
    pub mass: f64,
    /// Moment of inertia about the centre of mass (kg·m²), ≥ 0.
    pub inertia: f64,
    /// The centre of mass in the body frame (m). Points of joints and forces are relative to the
    /// centre of mass: see [`Body::from_centre`] and [`crate::Description::local`].
    pub centre: [f64; 2],
    /// Position of the origin of the body frame (m).
    pub position: [f64; 2],
    /// Angle of the body frame (rad).
    pub angle: f64,
    /// Velocity of the origin of the body frame (m/s). `None` means that the velocity follows from
    /// the given velocities and the prescribed motions, with the smallest kinetic energy.
    pub velocity: Option<[f64; 2]>,
    /// Angular velocity (rad/s). `None` means that it is computed like the velocity.
    pub angular_velocity: Option<f64>,
    /// Tolerance of points and directions in the body frame (m). For directions, the tolerance is
    /// divided by the size of the mechanism. This tolerance takes precedence over the tolerance of
    /// the scene.
    pub tolerance: Option<f64>,
}

impl Body {
    /// Returns a body with this mass (kg) and moment of inertia about the centre of mass (kg·m²).
    /// The body is at the origin, and its velocities are not specified.
    #[must_use]
    pub fn new(name: &str, mass: f64, inertia: f64) -> Self {
        Self {
            name: name.to_owned(),
            mass,
            inertia,
            ..Self::default()
        }
    }
}

/// A rigid body in space with its initial state. The origin of the body frame is the centre of
/// mass, unless `centre` specifies another point.
#[derive(Clone, Debug, PartialEq)]
pub struct SpatialBody {
    /// Name of the body.
    pub name: String,
    /// Mass (kg), ≥ 0.
    pub mass: f64,
    /// Inertia about the centre of mass in the axes of the body frame (kg·m²), symmetric. The
    /// off-diagonal entries are the entries of the matrix, for example −∫xy dm.
    pub inertia: [[f64; 3]; 3],
    /// The centre of mass in the body frame (m). Points of joints and forces are relative to the
    /// centre of mass.
    pub centre: [f64; 3],
    /// Position of the origin of the body frame (m).
    pub position: [f64; 3],
    /// Orientation of the body frame, from body to ground: a quaternion (w, x, y, z) of any nonzero
    /// length.
    pub orientation: [f64; 4],
    /// Velocity of the origin of the body frame (m/s), in ground axes. `None` means that the
    /// velocity follows from the given velocities and the prescribed motions, with the smallest
    /// kinetic energy.
    pub velocity: Option<[f64; 3]>,
    /// Angular velocity (rad/s), in ground axes. `None` means that it is computed like the
    /// velocity.
    pub angular_velocity: Option<[f64; 3]>,
    /// Tolerance of points and directions in the body frame (m). For directions, the tolerance is
    /// divided by the size of the mechanism. This tolerance takes precedence over the tolerance of
    /// the scene.
    pub tolerance: Option<f64>,
}

impl SpatialBody {
    /// Returns a body with this mass (kg) and inertia about the centre of mass (kg·m²). The body is
    /// at the origin, not rotated, and its velocities are not specified.
    #[must_use]
    pub fn new(name: &str, mass: f64, inertia: impl Into<[[f64; 3]; 3]>) -> Self {
        Self {
            name: name.to_owned(),
            mass,
            inertia: inertia.into(),
            centre: [0.0; 3],
            position: [0.0; 3],
            orientation: [1.0, 0.0, 0.0, 0.0],
            velocity: None,
            angular_velocity: None,
            tolerance: None,
        }
    }
}

/// A body of a mechanism, as described.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyRecord {
    /// Name of the body.
    pub name: String,
    /// Mass (kg).
    pub mass: f64,
    /// Tolerance of points and directions in the body frame (m), if stated.
    pub tolerance: Option<f64>,
    /// Properties that differ between plane and space.
    pub described: DescribedBody,
    /// Principal axes of the body, if they differ from the axes of its frame.
    pub principal: Option<Principal>,
}

/// Description of a body in the plane or in space.
#[derive(Clone, Debug, PartialEq)]
pub enum DescribedBody {
    /// A body in the plane.
    Plane(Body),
    /// A body in space.
    Space3(SpatialBody),
}

/// Position and orientation of the frame of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FramePose {
    /// Pose in the plane.
    Plane {
        /// Origin of the frame (m).
        position: [f64; 2],
        /// Angle of the body (rad).
        angle: f64,
    },
    /// Pose in space.
    Space3 {
        /// Origin of the frame (m).
        position: [f64; 3],
        /// Orientation from body to ground: a quaternion (w, x, y, z) of any nonzero length.
        orientation: [f64; 4],
    },
}

impl From<Body> for DescribedBody {
    fn from(body: Body) -> Self {
        Self::Plane(body)
    }
}

impl From<SpatialBody> for DescribedBody {
    fn from(body: SpatialBody) -> Self {
        Self::Space3(body)
    }
}

impl From<DescribedBody> for BodyRecord {
    fn from(described: DescribedBody) -> Self {
        let (name, mass, tolerance, principal) = match &described {
            DescribedBody::Plane(b) => (b.name.clone(), b.mass, b.tolerance, None),
            DescribedBody::Space3(b) => (
                b.name.clone(),
                b.mass,
                b.tolerance,
                Principal::of(&b.inertia),
            ),
        };
        Self {
            name,
            mass,
            tolerance,
            described,
            principal,
        }
    }
}

impl BodyRecord {
    /// Returns whether the origin of the body frame is the centre of mass.
    #[must_use]
    pub fn is_centred(&self) -> bool {
        self.centre() == [0.0; 3]
    }

    /// Returns the centre of mass in the body frame (m).
    #[must_use]
    pub fn centre(&self) -> [f64; 3] {
        match &self.described {
            DescribedBody::Plane(b) => [b.centre[0], b.centre[1], 0.0],
            DescribedBody::Space3(b) => b.centre,
        }
    }

    /// Converts a point of the body frame to a point relative to the centre of mass (m), in the
    /// axes of the coordinates of the body. These axes are the axes of the body frame, or the
    /// principal axes if the two differ.
    #[must_use]
    pub fn from_centre(&self, point: [f64; 3]) -> [f64; 3] {
        let centre = self.centre();
        let arm = std::array::from_fn(|k| point[k] - centre[k]);
        self.principal.as_ref().map_or(arm, |own| own.own(arm))
    }

    /// Returns the components of the field with this name. Error messages use the same names.
    #[must_use]
    pub fn numbers(&self, field: &str) -> Vec<f64> {
        match (field, &self.described) {
            ("mass", _) => vec![self.mass],
            ("tolerance", _) => self.tolerance.into_iter().collect(),
            ("inertia", DescribedBody::Plane(b)) => vec![b.inertia],
            ("inertia", DescribedBody::Space3(b)) => b.inertia.concat(),
            ("position", DescribedBody::Plane(b)) => b.position.to_vec(),
            ("position", DescribedBody::Space3(b)) => b.position.to_vec(),
            ("centre", DescribedBody::Plane(b)) => b.centre.to_vec(),
            ("centre", DescribedBody::Space3(b)) => b.centre.to_vec(),
            ("angle", DescribedBody::Plane(b)) => vec![b.angle],
            ("orientation", DescribedBody::Space3(b)) => b.orientation.to_vec(),
            ("velocity", DescribedBody::Plane(b)) => b.velocity.into_iter().flatten().collect(),
            ("velocity", DescribedBody::Space3(b)) => b.velocity.into_iter().flatten().collect(),
            (_, DescribedBody::Plane(b)) => b.angular_velocity.into_iter().collect(),
            (_, DescribedBody::Space3(b)) => b.angular_velocity.into_iter().flatten().collect(),
        }
    }

    /// Returns the body with its frame at another pose, or `None` if the pose belongs to another
    /// space.
    #[must_use]
    pub fn at(&self, frame: &FramePose) -> Option<Self> {
        let described = match (&self.described, *frame) {
            (DescribedBody::Plane(body), FramePose::Plane { position, angle }) => Body {
                position,
                angle,
                ..body.clone()
            }
            .into(),
            (
                DescribedBody::Space3(body),
                FramePose::Space3 {
                    position,
                    orientation,
                },
            ) => SpatialBody {
                position,
                orientation,
                ..body.clone()
            }
            .into(),
            _ => return None,
        };
        Some(Self {
            described,
            ..self.clone()
        })
    }

    /// Returns whether the description gives a velocity for the body.
    #[must_use]
    pub fn has_velocity(&self) -> bool {
        match &self.described {
            DescribedBody::Plane(b) => b.velocity.is_some(),
            DescribedBody::Space3(b) => b.velocity.is_some(),
        }
    }
}

/// A reference to the ground, or to a body by its index in the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum BodyRef {
    /// The ground.
    Ground,
    /// The body with this index.
    Body(usize),
}

impl BodyRef {
    /// Returns the index of the body in the list, or `None` for the ground.
    #[must_use]
    pub fn moving(self) -> Option<usize> {
        match self {
            Self::Ground => None,
            Self::Body(k) => Some(k),
        }
    }
}

impl Body {
    /// Returns whether the origin of the body frame is the centre of mass.
    #[must_use]
    pub fn is_centred(&self) -> bool {
        self.centre == [0.0; 2]
    }

    /// Converts a point of the body frame to a point relative to the centre of mass (m), as joints
    /// and forces require.
    ///
    /// ```
    /// let rod = pfaff_model::Body { centre: [0.5, 0.0], ..pfaff_model::Body::new("rod", 1.0, 0.1) };
    /// assert_eq!(rod.from_centre([1.0, 0.0]), [0.5, 0.0]);
    /// assert_eq!((rod.pose().x, rod.pose().y), (0.5, 0.0));
    /// ```
    #[must_use]
    pub fn from_centre(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [cx, cy] = self.centre;
        [x - cx, y - cy]
    }
}
