//! Markers (named points) and measures (quantities between markers) for the output of a motion.
//! They do not constrain the mechanism; [`crate::frame`] evaluates them on request.

use crate::body::{BodyRecord, BodyRef};
use crate::space::SpaceKind;

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
    /// Tolerance of the point (m). It also applies to joints at this point. This tolerance takes
    /// precedence over the tolerances of the body and of the scene.
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

    /// Returns the position relative to the centre of mass (m), as joints and forces require;
    /// `bodies` contains the body of the marker.
    #[must_use]
    pub fn from_centre(&self, bodies: &[BodyRecord]) -> [f64; 3] {
        let own = self.body.moving().and_then(|at| bodies.get(at));
        own.map_or(self.point, |body| body.from_centre(self.point))
    }
}

/// A quantity of the second marker relative to the first.
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
    /// Angle θ₂ − θ₁ (rad), including full revolutions; in the plane.
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

    /// Returns whether this kind of measure exists in a space.
    #[must_use]
    pub fn exists_in(self, space: SpaceKind) -> bool {
        match self {
            Self::Angle => space != SpaceKind::Space3,
            Self::Z => space == SpaceKind::Space3,
            _ => true,
        }
    }

    /// Returns the name used in scenes.
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

    /// Returns the unit of the measure.
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

    /// Returns the markers with a tolerance whose bodies have a reference in `here`, with these
    /// references, and without measures. Markers without a tolerance have no influence on the
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
