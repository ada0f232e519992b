//! Planar bodies in kernels: their poses and twists. Kernels do not use the coordinates of the
//! whole system.

use crate::ring::Ring;

/// Number of velocity degrees of freedom of a planar body: x, y, rotation.
pub const N_DOF: usize = 3;

/// Position and rotation of a body: origin of its frame, angle with its cosine and sine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<T = f64> {
    /// Global x of the frame's origin (m).
    pub x: T,
    /// Global y of the frame's origin (m).
    pub y: T,
    /// Angle of the frame relative to the global one (rad), with full revolutions.
    pub angle: T,
    /// cos(angle)
    pub cos: T,
    /// sin(angle)
    pub sin: T,
}

impl Pose<f64> {
    /// The pose of the ground: the global frame.
    pub const GROUND: Self = Self {
        x: 0.0,
        y: 0.0,
        angle: 0.0,
        cos: 1.0,
        sin: 0.0,
    };

    /// A pose with this position and angle; cosine and sine are computed.
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

    /// The local coordinates of a global point: `R ᵀ·(p − r)`.
    #[must_use]
    pub fn to_local(&self, p: [f64; 2]) -> [f64; 2] {
        let (dx, dy) = (p[0] - self.x, p[1] - self.y);
        [self.cos * dx + self.sin * dy, self.cos * dy - self.sin * dx]
    }

    /// The global coordinates of a point of the body: `r + R·s`.
    #[must_use]
    pub fn to_global(&self, s: [f64; 2]) -> [f64; 2] {
        [
            self.x + (self.cos * s[0] - self.sin * s[1]),
            self.y + (self.sin * s[0] + self.cos * s[1]),
        ]
    }

    /// The same pose in another number type.
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

/// Velocity of a body, or any other derivative along its three degrees of freedom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist<T = f64> {
    /// Global x velocity of the frame's origin (m/s).
    pub x: T,
    /// Global y velocity of the frame's origin (m/s).
    pub y: T,
    /// Angular velocity (rad/s).
    pub omega: T,
}

impl<T: Ring> Twist<T> {
    /// A body at rest.
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
    /// The direction of the frame's x-axis.
    pub const X: Self = Self([1.0, 0.0]);
    /// The direction of the frame's y-axis.
    pub const Y: Self = Self([0.0, 1.0]);

    /// The direction of `v`; `None` if `v` is zero or not finite.
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

    /// Sets components as returned by `Definition::data`, possibly with small changes, without
    /// normalisation: a derivative with respect to a component leaves the unit circle. For
    /// generated code.
    #[doc(hidden)]
    #[must_use]
    pub fn from_data(xy: [f64; 2]) -> Self {
        Self(xy)
    }

    /// Components of the direction.
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
    /// The line through two points; `None` if they coincide or are not finite.
    #[must_use]
    pub fn new(start: [f64; 2], end: [f64; 2]) -> Option<Self> {
        let along = Direction::new([end[0] - start[0], end[1] - start[1]])?;
        Some(Self { start, along })
    }

    /// Sets start and direction as returned by `Definition::data`, without normalisation; see
    /// [`Direction::from_data`].
    #[doc(hidden)]
    #[must_use]
    pub fn from_data(start: [f64; 2], along: [f64; 2]) -> Self {
        Self {
            start,
            along: Direction::from_data(along),
        }
    }

    /// The first point.
    #[must_use]
    pub fn start(&self) -> [f64; 2] {
        self.start
    }

    /// The unit vector from the first point to the second.
    #[must_use]
    pub fn along(&self) -> Direction {
        self.along
    }
}
