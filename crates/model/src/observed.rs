//! Markers (named points) and measures (quantities between markers) for the output of a motion.
//! Markers and measures do not constrain the mechanism; [`crate::frame`] evaluates them on request.

use crate::body::{BodyRecord, BodyRef};
use crate::space::{SpaceKind, cross, norm};

/// A named point of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Marker {
    /// Name of the marker.
    pub name: String,
    /// Body of the marker.
    pub body: BodyRef,
    /// Position in the body frame (m); in the plane z = 0.
    pub point: [f64; 3],
    /// In the plane, the angle of the marker axes in the body frame (rad). `None` means that the
    /// marker has the axes of the body, and that its angle is not used.
    pub angle: Option<f64>,
    /// In space, the orientation of the marker axes in the body frame: a quaternion (w, x, y, z) of
    /// any nonzero length. `None` means that the marker has the axes of the body.
    pub orientation: Option<[f64; 4]>,
    /// Tolerance of the point (m). The tolerance also applies to joints at this point. This
    /// tolerance takes precedence over the tolerances of the body and of the scene.
    pub tolerance: Option<f64>,
}

impl Marker {
    /// Returns the marker axes x, y and z in the body frame.
    ///
    /// ```
    /// use pfaff_model::{BodyRef, Marker};
    /// let mut pin = Marker::new("pin", BodyRef::Ground, [0.0; 3]);
    /// // A quarter turn about x.
    /// pin.orientation = Some([1.0, 1.0, 0.0, 0.0]);
    /// assert_eq!(pin.axes(), [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]);
    /// ```
    #[must_use]
    pub fn axes(&self) -> [[f64; 3]; 3] {
        let e = self.orientation.unwrap_or([1.0, 0.0, 0.0, 0.0]);
        let pose = joints::space3::Pose::new([0.0; 3], e);
        let unit = |axis| [0, 1, 2].map(|k| if k == axis { 1.0 } else { 0.0 });
        [0, 1, 2].map(|axis| pose.direction_to_global(unit(axis)))
    }

    /// Returns a marker at this point of the body frame (m), with the axes of the body.
    #[must_use]
    pub fn new(name: &str, body: BodyRef, point: [f64; 3]) -> Self {
        Self {
            name: name.to_owned(),
            body,
            point,
            angle: None,
            orientation: None,
            tolerance: None,
        }
    }

    /// Returns the position relative to the centre of mass (m), as joints and forces require.
    /// `bodies` must contain the body of the marker.
    #[must_use]
    pub fn from_centre(&self, bodies: &[BodyRecord]) -> [f64; 3] {
        let own = self.body.moving().and_then(|at| bodies.get(at));
        own.map_or(self.point, |body| body.from_centre(self.point))
    }
}

/// A quantity of the second marker relative to the first marker.
#[derive(Clone, Debug, PartialEq)]
pub struct Measure {
    /// Name of the measure.
    pub name: String,
    /// Kind of the measured quantity.
    pub kind: MeasureKind,
    /// Indices of two markers; `None` denotes the ground.
    pub between: [Option<usize>; 2],
}

/// Kind of the measured quantity. Here p = Rᵀ·(r₂ − r₁) is the position of the second marker in the
/// axes of the first marker; in the plane the markers have the angles θ. Directions may have any
/// length. The directions a, n and o are fixed in the first marker and given in its axes. The
/// direction b is fixed in the second marker. In the formulas, all directions are unit vectors in
/// the axes of the first marker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MeasureKind {
    /// Distance |p| (m).
    Distance,
    /// Component n·p (m).
    Along([f64; 3]),
    /// Angle from the direction a to the direction b (rad). In the plane, it is counted about the
    /// normal of the plane and includes full revolutions.
    Angle {
        /// The directions a and b.
        directions: [[f64; 3]; 2],
        /// In space, the direction o about which the angle is counted. The angle is measured
        /// between the projections of a and b perpendicular to o: atan2(o·(a × b), a·b −
        /// (o·a)·(o·b)). The angle is greater than −π and at most π. `None` means that the angle
        /// has no sign: atan2(|a × b|, a·b).
        about: Option<[f64; 3]>,
    },
    /// In space, the angle from the plane perpendicular to a to the direction b (rad). The angle is
    /// positive on the side of a: atan2(a·b, |a × b|).
    Inclination([[f64; 3]; 2]),
    /// Speed |ṗ| (m/s).
    Speed,
    /// Angular velocity θ̇₂ − θ̇₁ (rad/s); in space |ω₂ − ω₁|.
    AngularVelocity,
}

/// Two directions count as parallel if the sine of the angle between them is below this limit (–).
/// An angle about a direction is then not defined. Too small: rounding errors of 1e-16 change the
/// angle visibly. Too large: valid angles are rejected. Test:
/// `an_angle_about_a_parallel_direction_is_rejected`.
pub(crate) const PARALLEL: f64 = 1e-9;

impl MeasureKind {
    /// Component of p along the first axis of the first marker (m).
    pub const X: Self = Self::Along([1.0, 0.0, 0.0]);
    /// Component of p along the second axis of the first marker (m).
    pub const Y: Self = Self::Along([0.0, 1.0, 0.0]);
    /// Component of p along the third axis of the first marker (m), in space.
    pub const Z: Self = Self::Along([0.0, 0.0, 1.0]);
    /// Angle between the first axes of the markers (rad).
    pub const ANGLE: Self = Self::Angle {
        directions: [[1.0, 0.0, 0.0]; 2],
        about: None,
    };

    /// Names of the columns of a measure and of its derivatives. The column of the value has only
    /// the name of the measure.
    pub const COLUMNS: [&str; 3] = ["", "rate", "acceleration"];

    /// One kind for each name; the directions are examples.
    pub const ALL: [Self; 9] = [
        Self::Distance,
        Self::ANGLE,
        Self::Inclination([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]),
        Self::X,
        Self::Y,
        Self::Z,
        Self::Along([1.0, 1.0, 0.0]),
        Self::Speed,
        Self::AngularVelocity,
    ];

    /// Returns the reason why a space has no such measure, or `None` if the measure exists.
    ///
    /// ```
    /// use pfaff_model::{MeasureKind, SpaceKind};
    /// assert_eq!(MeasureKind::Z.fault(SpaceKind::Space3), None);
    /// assert!(MeasureKind::Z.fault(SpaceKind::Plane).is_some());
    /// assert!(MeasureKind::Along([0.0; 3]).fault(SpaceKind::Plane).is_some());
    /// ```
    #[must_use]
    pub fn fault(self, space: SpaceKind) -> Option<&'static str> {
        let is_spatial = space == SpaceKind::Space3;
        let (directions, is_in_plane) = match self {
            Self::Along(n) => ([Some(n), None, None], true),
            Self::Angle {
                directions: [a, b],
                about,
            } => ([Some(a), Some(b), about], about.is_none()),
            Self::Inclination([a, b]) => ([Some(a), Some(b), None], false),
            _ => ([None; 3], true),
        };
        let mut all = directions.into_iter().flatten();
        if all.any(|d| d == [0.0; 3] || !d.iter().all(|x| joints::is_usable(*x))) {
            return Some("a direction needs finite components that are not all zero");
        }
        let mut all = directions.into_iter().flatten();
        if !(is_spatial || is_in_plane && all.all(|[_, _, z]| z == 0.0)) {
            return Some(
                "it needs a direction out of the plane: omit it, or use `space = \"spatial\"`",
            );
        }
        match directions {
            [Some(a), _, Some(about)] if are_parallel(unit(a), unit(about)) => {
                Some("its first direction must not be parallel to `about`")
            }
            _ => None,
        }
    }

    /// Returns the name used in scenes.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Distance => "distance",
            Self::Angle { .. } => "angle",
            Self::Inclination(_) => "inclination",
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
            Self::Along(_) => "component",
            Self::Speed => "speed",
            Self::AngularVelocity => "angular-velocity",
        }
    }

    /// Returns the units of the measure, of its rate and of its second derivative. `None` means
    /// that the second derivative requires more than accelerations.
    #[must_use]
    pub fn units(self) -> [Option<&'static str>; 3] {
        match self {
            Self::Distance | Self::Along(_) => [Some("m"), Some("m/s"), Some("m/s²")],
            Self::Angle { .. } | Self::Inclination(_) => {
                [Some("rad"), Some("rad/s"), Some("rad/s²")]
            }
            Self::Speed => [Some("m/s"), Some("m/s²"), None],
            Self::AngularVelocity => [Some("rad/s"), Some("rad/s²"), None],
        }
    }

    /// Returns the unit of the measure.
    #[must_use]
    pub fn unit(self) -> &'static str {
        self.units()[0].unwrap_or_default()
    }
}

/// Returns the unit vector of a direction.
pub(crate) fn unit(direction: [f64; 3]) -> [f64; 3] {
    let length = norm(&direction);
    direction.map(|x| x / length)
}

/// Returns whether two unit vectors are parallel.
pub(crate) fn are_parallel(a: [f64; 3], b: [f64; 3]) -> bool {
    norm(&cross(a, b)) < PARALLEL
}

/// The markers and measures of a mechanism.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Observables {
    /// Markers of the mechanism.
    pub markers: Vec<Marker>,
    /// Measures of the mechanism.
    pub measures: Vec<Measure>,
}

impl Observables {
    pub(crate) fn has_tolerances(&self) -> bool {
        self.markers.iter().any(|marker| marker.tolerance.is_some())
    }

    /// Returns the stated tolerance of a marker at this point of a body, or `None`. The point is
    /// relative to the centre of mass.
    pub(crate) fn tolerance_at(
        &self,
        bodies: &[BodyRecord],
        body: BodyRef,
        point: &[f64],
    ) -> Option<f64> {
        let mut here = self.markers.iter().filter(|marker| {
            marker.tolerance.is_some()
                && marker.body == body
                && marker.from_centre(bodies)[..point.len()] == *point
        });
        here.next()?.tolerance
    }

    /// Returns the markers with a tolerance whose bodies have a reference in `here`. The result has
    /// these references and no measures. Markers without a tolerance have no influence on the
    /// equations.
    pub(crate) fn stated_for(&self, here: impl Fn(&BodyRef) -> Option<BodyRef>) -> Self {
        let stated = self.markers.iter().filter(|m| m.tolerance.is_some());
        let own = stated.filter_map(|marker| {
            let body = here(&marker.body)?;
            Some(Marker {
                body,
                ..marker.clone()
            })
        });
        Self {
            markers: own.collect(),
            measures: Vec::new(),
        }
    }
}
