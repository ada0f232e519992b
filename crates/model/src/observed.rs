//! Markers and measures: places by name, and quantities between them, read off a motion. They
//! restrict nothing, and are evaluated where somebody asks.

use crate::description::{Body, BodyRef, Description};
use crate::frame::FrameState;
use crate::mechanism::{BuildError, Mechanism};

/// A place of a body by name.
#[derive(Clone, Debug, PartialEq)]
pub struct Marker {
    /// Its name.
    pub name: String,
    /// Its body.
    pub body: BodyRef,
    /// In the frame of the body (m).
    pub point: [f64; 2],
    /// Angle of its axes in the frame of the body (rad); `None`: they are those of the body, and
    /// nobody asks for their angle.
    pub angle: Option<f64>,
    /// Tolerance of its point (m), also as a point of joints; takes precedence over those of its
    /// body and of the scene.
    pub tolerance: Option<f64>,
}

impl Marker {
    /// Its place relative to the centre of mass of its body (m), as joints and forces take it.
    #[must_use]
    pub fn from_centre(&self, bodies: &[Body]) -> [f64; 2] {
        self.body.from_centre(bodies, self.point)
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
/// at angles θ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeasureKind {
    /// |p| (m)
    Distance,
    /// θ₂ − θ₁ (rad), not reduced to one revolution.
    Angle,
    /// p_x (m)
    X,
    /// p_y (m)
    Y,
    /// |ṗ| (m/s)
    Speed,
    /// θ̇₂ − θ̇₁ (rad/s)
    AngularVelocity,
}

impl MeasureKind {
    /// All kinds.
    pub const ALL: [Self; 6] = [
        Self::Distance,
        Self::Angle,
        Self::X,
        Self::Y,
        Self::Speed,
        Self::AngularVelocity,
    ];

    /// Its name in scenes.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Distance => "distance",
            Self::Angle => "angle",
            Self::X => "x",
            Self::Y => "y",
            Self::Speed => "speed",
            Self::AngularVelocity => "angular-velocity",
        }
    }

    /// Its unit.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Distance | Self::X | Self::Y => "m",
            Self::Angle => "rad",
            Self::Speed => "m/s",
            Self::AngularVelocity => "rad/s",
        }
    }

    /// Its value from the states of both markers.
    fn of(self, first: &FrameState, second: &FrameState) -> f64 {
        let difference = |a: [f64; 2], b: [f64; 2]| [b[0] - a[0], b[1] - a[1]];
        let [dx, dy] = difference(first.place, second.place);
        let (sin, cos) = first.angle.sin_cos();
        match self {
            Self::Distance => dx.hypot(dy),
            Self::Angle => second.angle - first.angle,
            Self::X => cos * dx + sin * dy,
            Self::Y => cos * dy - sin * dx,
            Self::Speed => {
                let [vx, vy] = difference(first.velocity, second.velocity);
                (vx + first.omega * dy).hypot(vy - first.omega * dx)
            }
            Self::AngularVelocity => second.omega - first.omega,
        }
    }
}

/// The markers and measures of a mechanism.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Observed {
    /// Its markers.
    pub markers: Vec<Marker>,
    /// Its measures.
    pub measures: Vec<Measure>,
}

impl Observed {
    pub(crate) fn has_tolerances(&self) -> bool {
        self.markers.iter().any(|marker| marker.tolerance.is_some())
    }

    /// The stated tolerance of a point of a body, given relative to its centre of mass, if a marker
    /// with a tolerance is there.
    pub(crate) fn tolerance_at(
        &self,
        bodies: &[Body],
        body: BodyRef,
        point: &[f64],
    ) -> Option<f64> {
        let mut here = self.markers.iter().filter(|marker| {
            marker.tolerance.is_some()
                && marker.body == body
                && marker.from_centre(bodies).as_slice() == point
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

impl Mechanism {
    /// State of a marker at q and v. Its angle is that of its axes.
    ///
    /// # Panics
    /// If there is no such marker, or q and v are not those of the mechanism.
    #[must_use]
    pub fn marker(&self, marker: usize, q: &[f64], v: &[f64]) -> FrameState {
        let Marker {
            body, point, angle, ..
        } = self.observed().markers[marker];
        let of_body = match body {
            BodyRef::Body(k) => self.state_of(k, point, q, v),
            BodyRef::Ground => FrameState {
                place: point,
                ..FrameState::default()
            },
        };
        FrameState {
            angle: of_body.angle + angle.unwrap_or_default(),
            ..of_body
        }
    }

    /// Value of a measure at q and v.
    ///
    /// ```
    /// use model::{Body, Description, Marker, Measure, MeasureKind, Mechanism};
    /// let mut d = Description::new("top");
    /// let body = d.body(Body::new("top", 1.0, 1.0));
    /// let marker = Marker { name: "rim".into(), body, point: [2.0, 0.0], angle: None, tolerance: None };
    /// d.observed.markers.push(marker);
    /// for kind in [MeasureKind::Y, MeasureKind::Speed, MeasureKind::Angle] {
    ///     let (name, between) = (kind.name().into(), [None, Some(0)]);
    ///     d.observed.measures.push(Measure { name, kind, between });
    /// }
    /// let top = Mechanism::build(&d).unwrap();
    /// // After one and a half turns, at 3 rad/s.
    /// let turned = 3.0 * std::f64::consts::PI;
    /// let value = |k| top.measure(k, &[0.0, 1.0, turned], &[0.0, 0.0, 3.0]);
    /// assert!((value(0) - 1.0).abs() < 1e-14 && (value(1) - 6.0).abs() < 1e-14);
    /// assert_eq!(value(2), turned);
    /// ```
    ///
    /// # Panics
    /// If there is no such measure, or q and v are not those of the mechanism.
    #[must_use]
    pub fn measure(&self, measure: usize, q: &[f64], v: &[f64]) -> f64 {
        let Measure { kind, between, .. } = self.observed().measures[measure];
        let state = |of: Option<usize>| {
            of.map_or_else(FrameState::default, |marker| self.marker(marker, q, v))
        };
        let [first, second] = between.map(state);
        kind.of(&first, &second)
    }
}

/// Reports markers and measures that cannot be evaluated.
pub(crate) fn check(d: &Description, errors: &mut Vec<BuildError>) {
    let Observed { markers, measures } = &d.observed;
    for marker in markers {
        let name = || marker.name.clone();
        if let Some(body) = marker.body.moving().filter(|k| *k >= d.bodies.len()) {
            errors.push(BuildError::UnknownBody {
                name: name(),
                body,
                n_bodies: d.bodies.len(),
            });
        }
        let ([x, y], angle) = (marker.point, marker.angle.unwrap_or_default());
        if ![x, y, angle].iter().all(|x| x.is_finite()) {
            errors.push(BuildError::Marker {
                name: name(),
                x,
                y,
                angle,
            });
        }
    }
    for measure in measures {
        let [first, second] = measure.between;
        let name = measure.name.clone();
        let unknown = |k: &usize| *k >= markers.len();
        if let Some(marker) = [first, second].into_iter().flatten().find(unknown) {
            errors.push(BuildError::UnknownMarker {
                name,
                marker,
                n_markers: markers.len(),
            });
        } else if first == second {
            errors.push(BuildError::SameMarker { name });
        }
    }
}
