//! Markers and measures: places by name, and quantities between them, read off a motion. They
//! restrict nothing, and are evaluated by [`crate::frame`] where somebody asks.

use crate::body::{BodyRecord, BodyRef};
use crate::space::SpaceKind;

/// A place of a body by name.
#[derive(Clone, Debug, PartialEq)]
pub struct Marker {
    /// Its name.
    pub name: String,
    /// Its body.
    pub body: BodyRef,
    /// In the frame of the body (m); in the plane z = 0.
    pub point: [f64; 3],
    /// In the plane, the angle of its axes in the frame of the body (rad); `None`: they are those
    /// of the body, and nobody asks for their angle.
    pub angle: Option<f64>,
    /// In space, the orientation of its axes in the frame of the body: a quaternion (w, x, y, z) of
    /// any length but zero; `None`: they are those of the body.
    pub orientation: Option<[f64; 4]>,
    /// Tolerance of its point (m), also as a point of joints; takes precedence over those of its
    /// body and of the scene.
    pub tolerance: Option<f64>,
}

impl Marker {
    /// Its axes x, y and z in the frame of its body.
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

    /// A marker with the axes of its body, at this point of its frame (m).
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

    /// Its place relative to the centre of mass of its body, one of `bodies` (m), as joints and
    /// forces take it.
    #[must_use]
    pub fn from_centre(&self, bodies: &[BodyRecord]) -> [f64; 3] {
        let own = self.body.moving().and_then(|at| bodies.get(at));
        own.map_or(self.point, |body| body.from_centre(self.point))
    }
}

/// A quantity between two markers, the second relative to the first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Measure {
    /// Its name.
    pub name: String,
    /// What is measured.
    pub kind: MeasureKind,
    /// Indices of two markers; `None` is the ground.
    pub between: [Option<usize>; 2],
}

/// What is measured, with p = Rᵀ·(r₂ − r₁) the place of the second marker in the axes of the first,
/// in the plane at angles θ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeasureKind {
    /// |p| (m)
    Distance,
    /// θ₂ − θ₁ (rad), not reduced to one revolution; in the plane.
    Angle,
    /// p_x (m)
    X,
    /// p_y (m)
    Y,
    /// p_z (m), in space
    Z,
    /// |ṗ| (m/s)
    Speed,
    /// θ̇₂ − θ̇₁ (rad/s), in space |ω₂ − ω₁|
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

    /// Whether there is such a measure in a space.
    #[must_use]
    pub fn exists_in(self, space: SpaceKind) -> bool {
        match self {
            Self::Angle => space != SpaceKind::Space3,
            Self::Z => space == SpaceKind::Space3,
            _ => true,
        }
    }

    /// Its name in scenes.
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

    /// Its unit.
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
    /// Its markers.
    pub markers: Vec<Marker>,
    /// Its measures.
    pub measures: Vec<Measure>,
}

impl Observables {
    pub(crate) fn has_tolerances(&self) -> bool {
        self.markers.iter().any(|marker| marker.tolerance.is_some())
    }

    /// The stated tolerance of a point of a body, given relative to its centre of mass, if a marker
    /// with a tolerance is there.
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

    /// The markers with a tolerance on some bodies, renamed as there; without measures. The other
    /// markers play no part in the equations.
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
