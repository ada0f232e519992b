//! Markers and measures: named points, and quantities between them, for the output of a motion.
//! They do not constrain the mechanism, and [`crate::frame`] evaluates them on request.

use crate::body::{BodyRecord, BodyRef};
use crate::space::SpaceKind;

/// A named point of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Marker {
    /// Name of the marker.
    pub name: String,
    /// Body of the marker.
    pub body: BodyRef,
    /// Position in the frame of the body (m); in the plane z = 0.
    pub point: [f64; 3],
    /// In the plane, the angle of its axes in the frame of the body (rad). `None` means that its
    /// axes are those of the body, and its angle is not used.
    pub angle: Option<f64>,
    /// In space, the orientation of its axes in the frame of the body: a quaternion (w, x, y, z) of
    /// any nonzero length. `None` means that its axes are those of the body.
    pub orientation: Option<[f64; 4]>,
    /// Tolerance of its point (m), also if joints use this point. It takes precedence over the
    /// tolerances of its body and of the scene.
    pub tolerance: Option<f64>,
}

impl Marker {
    /// Returns the axes x, y and z in the frame of its body.
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

    /// Returns a marker with the axes of its body, at this point of its frame (m).
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

    /// Returns the position relative to the centre of mass of its body, one of `bodies` (m), which
    /// joints and forces require.
    #[must_use]
    pub fn from_centre(&self, bodies: &[BodyRecord]) -> [f64; 3] {
        let own = self.body.moving().and_then(|at| bodies.get(at));
        own.map_or(self.point, |body| body.from_centre(self.point))
    }
}

/// A quantity between two markers, the second relative to the first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Measure {
    /// Name of the measure.
    pub name: String,
    /// Kind of the measured quantity.
    pub kind: MeasureKind,
    /// Indices of two markers; `None` stands for the ground.
    pub between: [Option<usize>; 2],
}

/// Kind of the measured quantity. Here p = Rᵀ·(r₂ − r₁) is the position of the second marker in the
/// axes of the first; in the plane the markers have the angles θ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeasureKind {
    /// Distance |p| (m).
    Distance,
    /// Angle θ₂ − θ₁ (rad), not reduced to one revolution; in the plane.
    Angle,
    /// Component p_x (m).
    X,
    /// Component p_y (m).
    Y,
    /// Component p_z (m), in space.
    Z,
    /// Speed |ṗ| (m/s).
    Speed,
    /// Angular velocity θ̇₂ − θ̇₁ (rad/s); in space |ω₂ − ω₁|.
    AngularVelocity,
}

impl MeasureKind {
    /// All kinds.
    pub const ALL: [Self; 7] = [
        Self::Distance,
        Self::Angle,
        Self::X,
        Self::Y,
        Self::Z,
        Self::Speed,
        Self::AngularVelocity,
    ];

    /// Returns whether this measure exists in a space.
    #[must_use]
    pub fn exists_in(self, space: SpaceKind) -> bool {
        match self {
            Self::Angle => space != SpaceKind::Space3,
            Self::Z => space == SpaceKind::Space3,
            _ => true,
        }
    }

    /// Returns the name in scenes.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Distance => "distance",
            Self::Angle => "angle",
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
            Self::Speed => "speed",
            Self::AngularVelocity => "angular-velocity",
        }
    }

    /// Returns the unit.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Distance | Self::X | Self::Y | Self::Z => "m",
            Self::Angle => "rad",
            Self::Speed => "m/s",
            Self::AngularVelocity => "rad/s",
        }
    }
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

    /// Returns the stated tolerance of a point of a body, given relative to its centre of mass, if
    /// a marker with a tolerance is at this point.
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

    /// Returns the markers with a tolerance on some bodies, with the references that `here`
    /// returns, and without measures. The other markers have no influence on the equations.
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
