//! Poses and twists of planar bodies, as the arguments of kernels. Kernels do not use the
//! coordinates of the whole system.

use crate::ring::Ring;

/// Number of velocity components of a planar body: x, y, rotation.
pub const N_DOF: usize = 3;

/// Position and rotation of a body: the origin and the angle of the body frame, and the cosine and
/// sine of this angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<T = f64> {
    /// Ground coordinate x of the origin of the body frame (m).
    pub x: T,
    /// Ground coordinate y of the origin of the body frame (m).
    pub y: T,
    /// Angle of the body frame relative to the ground frame (rad), including full revolutions.
    pub angle: T,
    /// cos(angle)
    pub cos: T,
    /// sin(angle)
    pub sin: T,
}

impl Pose<f64> {
    /// The pose of the ground, whose frame is the ground frame.
    pub const GROUND: Self = Self {
        x: 0.0,
        y: 0.0,
        angle: 0.0,
        cos: 1.0,
        sin: 0.0,
    };

    /// Returns a pose with this position and angle. Cosine and sine are computed.
    #[must_use]
    pub fn new(x: f64, y: f64, angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self {
            x,
            y,
            angle,
            cos,
            sin,
        }
    }

    /// Converts a point from ground coordinates to body coordinates: `R ᵀ·(p − r)`.
    #[must_use]
    pub fn to_local(&self, p: [f64; 2]) -> [f64; 2] {
        let (dx, dy) = (p[0] - self.x, p[1] - self.y);
        [self.cos * dx + self.sin * dy, self.cos * dy - self.sin * dx]
    }

    /// Converts a point from body coordinates to ground coordinates: `r + R·s`.
    #[must_use]
    pub fn to_global(&self, s: [f64; 2]) -> [f64; 2] {
        [
            self.x + (self.cos * s[0] - self.sin * s[1]),
            self.y + (self.sin * s[0] + self.cos * s[1]),
        ]
    }

    /// Returns the same pose in another number type.
    #[must_use]
    pub fn cast<T: Ring>(&self) -> Pose<T> {
        Pose {
            x: T::from(self.x),
            y: T::from(self.y),
            angle: T::from(self.angle),
            cos: T::from(self.cos),
            sin: T::from(self.sin),
        }
    }
}

/// Velocity of a body, or any other derivative with these three components.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist<T = f64> {
    /// Velocity of the origin of the body frame along ground x (m/s).
    pub x: T,
    /// Velocity of the origin of the body frame along ground y (m/s).
    pub y: T,
    /// Angular velocity (rad/s).
    pub omega: T,
}

impl<T: Ring> Twist<T> {
    /// Returns the twist of a body at rest.
    #[must_use]
    pub fn zero() -> Self {
        Self {
            x: T::from(0.0),
            y: T::from(0.0),
            omega: T::from(0.0),
        }
    }
}

/// A unit vector in the frame of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction([f64; 2]);

impl Direction {
    /// The direction of the x-axis of the frame.
    pub const X: Self = Self([1.0, 0.0]);
    /// The direction of the y-axis of the frame.
    pub const Y: Self = Self([0.0, 1.0]);

    /// Returns the direction of `v`. Returns `None` if `v` is zero or not finite.
    ///
    /// ```
    /// use pfaff_joints::Direction;
    /// assert_eq!(Direction::new([3.0, 4.0]).unwrap().xy(), [0.6, 0.8]);
    /// assert!(Direction::new([0.0, 0.0]).is_none());
    /// ```
    #[must_use]
    pub fn new(v: [f64; 2]) -> Option<Self> {
        // The vector is scaled first, so that no square overflows or underflows.
        let size = v[0].abs().max(v[1].abs());
        if !(size > 0.0 && size.is_finite() && v[0].is_finite() && v[1].is_finite()) {
            return None;
        }
        let v = [v[0] / size, v[1] / size];
        let length = v[0].hypot(v[1]);
        Some(Self([v[0] / length, v[1] / length]))
    }

    /// Creates a direction from the components that `Definition::data` returns, which may have
    /// small changes. The direction is not normalised, because a derivative with respect to one
    /// component needs a vector outside the unit circle. This function is for generated code.
    #[doc(hidden)]
    #[must_use]
    pub fn from_data(xy: [f64; 2]) -> Self {
        Self(xy)
    }

    /// Returns the components of the direction.
    #[must_use]
    pub fn xy(self) -> [f64; 2] {
        self.0
    }
}

/// A straight line of the ground through two distinct points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    start: [f64; 2],
    along: Direction,
}

impl Line {
    /// Returns the line through two points. Returns `None` if the points coincide or are not
    /// finite.
    #[must_use]
    pub fn new(start: [f64; 2], end: [f64; 2]) -> Option<Self> {
        let along = Direction::new([end[0] - start[0], end[1] - start[1]])?;
        Some(Self { start, along })
    }

    /// Creates a line from the start and the direction that `Definition::data` returns, without
    /// normalisation; see [`Direction::from_data`].
    #[doc(hidden)]
    #[must_use]
    pub fn from_data(start: [f64; 2], along: [f64; 2]) -> Self {
        Self {
            start,
            along: Direction::from_data(along),
        }
    }

    /// Returns the first point.
    #[must_use]
    pub fn start(&self) -> [f64; 2] {
        self.start
    }

    /// Returns the unit vector from the first point to the second.
    #[must_use]
    pub fn along(&self) -> Direction {
        self.along
    }
}
