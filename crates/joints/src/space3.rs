//! Poses and twists of spatial bodies, and directions and axes fixed in a body, as the arguments of
//! kernels. Kernels do not use the coordinates of the whole system.
//!
//! The rotation of a body is given by a matrix R, which transforms vectors from the body frame to
//! the ground frame. The components of its angular velocity ω are in the **frame of the body**:
//! `Ṙ = R·[ω]×`. The components of the velocity of the origin are in ground axes.

use crate::ring::Ring;

pub use crate::generated::space3::*;

/// Number of velocity components of a spatial body: x, y, z, then the rotations about the axes of
/// the body frame.
pub const N_DOF: usize = 6;

/// Position and rotation of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<T = f64> {
    /// Ground components of the position of the origin of the body frame (m).
    pub r: [T; 3],
    /// R, by rows. Column k is the k-th axis of the body frame in ground components.
    pub rot: [[T; 3]; 3],
}

impl Pose<f64> {
    /// The pose of the ground, whose frame is the ground frame.
    pub const GROUND: Self = Self {
        r: [0.0; 3],
        rot: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    };

    /// Returns the pose with this position and this quaternion (w, x, y, z). The quaternion may
    /// have any length except zero.
    ///
    /// ```
    /// use pfaff_joints::space3::Pose;
    /// // A quarter turn about z.
    /// let pose = Pose::new([0.0; 3], [1.0, 0.0, 0.0, 1.0]);
    /// assert_eq!(pose.to_global([1.0, 0.0, 5.0]), [0.0, 1.0, 5.0]);
    /// ```
    #[must_use]
    pub fn new(r: [f64; 3], quaternion: [f64; 4]) -> Self {
        let square: f64 = quaternion.iter().map(|e| e * e).sum();
        Self {
            r,
            rot: rotation(quaternion).map(|row| row.map(|entry| entry / square)),
        }
    }

    /// Converts a point from ground coordinates to body coordinates: `Rᵀ·(p − r)`.
    #[must_use]
    pub fn to_local(&self, p: [f64; 3]) -> [f64; 3] {
        self.direction_to_local(std::array::from_fn(|k| p[k] - self.r[k]))
    }

    /// Converts a point from body coordinates to ground coordinates: `r + R·s`.
    #[must_use]
    pub fn to_global(&self, s: [f64; 3]) -> [f64; 3] {
        let arm = self.direction_to_global(s);
        std::array::from_fn(|k| self.r[k] + arm[k])
    }

    /// Converts a vector from ground components to body components: `Rᵀ·v`.
    #[must_use]
    pub fn direction_to_local(&self, v: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|k| dot(std::array::from_fn(|row| self.rot[row][k]), v))
    }

    /// Converts a vector from body components to ground components: `R·v`.
    #[must_use]
    pub fn direction_to_global(&self, v: [f64; 3]) -> [f64; 3] {
        self.rot.map(|row| dot(row, v))
    }

    /// Returns the same pose in another number type.
    #[must_use]
    pub fn cast<T: Ring>(&self) -> Pose<T> {
        Pose {
            r: self.r.map(T::from),
            rot: self.rot.map(|row| row.map(T::from)),
        }
    }
}

/// Returns |e|²·R (by rows) for the quaternion e = (w, x, y, z). The entries are polynomials of
/// second degree; for any length of e except zero, the result is |e|² times a rotation matrix.
#[must_use]
pub fn rotation<T: Ring>([w, x, y, z]: [T; 4]) -> [[T; 3]; 3] {
    let twice = |a: T| a + a;
    let (ww, xx, yy, zz) = (w * w, x * x, y * y, z * z);
    let (wx, wy, wz) = (twice(w * x), twice(w * y), twice(w * z));
    let (xy, xz, yz) = (twice(x * y), twice(x * z), twice(y * z));
    [
        [ww + xx - yy - zz, xy - wz, xz + wy],
        [xy + wz, ww - xx + yy - zz, yz - wx],
        [xz - wy, yz + wx, ww - xx - yy + zz],
    ]
}

/// Velocity of a body, or any other derivative with these six components.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist<T = f64> {
    /// Ground components of the velocity of the origin of the body frame (m/s).
    pub v: [T; 3],
    /// Components of the angular velocity in the body frame (rad/s).
    pub omega: [T; 3],
}

impl<T: Ring> Twist<T> {
    /// Returns the twist of a body at rest.
    #[must_use]
    pub fn zero() -> Self {
        let zero = [T::from(0.0); 3];
        Self {
            v: zero,
            omega: zero,
        }
    }
}

/// A unit vector in the frame of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction([f64; 3]);

impl Direction {
    /// The direction of the x-axis of the frame.
    pub const X: Self = Self([1.0, 0.0, 0.0]);
    /// The direction of the y-axis of the frame.
    pub const Y: Self = Self([0.0, 1.0, 0.0]);
    /// The direction of the z-axis of the frame.
    pub const Z: Self = Self([0.0, 0.0, 1.0]);

    /// Returns the direction of `v`. Returns `None` if `v` is zero or not finite.
    #[must_use]
    pub fn new(v: impl Into<[f64; 3]>) -> Option<Self> {
        let v = v.into();
        // The vector is scaled first, so that no square overflows or underflows.
        let size = v.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
        if !(size > 0.0 && size.is_finite() && v.iter().all(|x| x.is_finite())) {
            return None;
        }
        let v = v.map(|x| x / size);
        let length = dot(v, v).sqrt();
        Some(Self(v.map(|x| x / length)))
    }

    /// Creates a direction from the components that `Definition::data` returns, which may have
    /// small changes. The direction is not normalised, because a derivative with respect to one
    /// component needs a vector outside the unit sphere. This function is for generated code.
    #[doc(hidden)]
    #[must_use]
    pub fn from_data(xyz: [f64; 3]) -> Self {
        Self(xyz)
    }

    /// Returns the components of the direction.
    #[must_use]
    pub fn xyz(self) -> [f64; 3] {
        self.0
    }
}

/// Three orthonormal directions u, v and w that are fixed in a body and right-handed. w is the axis
/// of a joint, and u and v are perpendicular to this axis.
///
/// As data, the three directions are one quantity. The only possible change of this quantity is a
/// rotation. Its three values are the components of a rotation vector in the body frame (rad); they
/// are zero for the stored axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes([[f64; 3]; 3]);

/// Smallest sine of the angle between an axis and the direction that should be perpendicular to the
/// axis. At 1e-6, the perpendicular directions are accurate to ten digits.
const LEAST_ANGLE: f64 = 1e-6;

impl Axes {
    /// The axes of the frame.
    pub const FRAME: Self = Self([Direction::X.0, Direction::Y.0, Direction::Z.0]);

    /// Returns the axes with w along `axis`, and with u along the part of `across` that is
    /// perpendicular to w. Without `across`, u is the coordinate axis with the smallest component
    /// along w, made orthogonal to w. Returns `None` if `axis` has length zero, or if the sine of
    /// the angle between `across` and the axis is below 1e-6.
    ///
    /// ```
    /// use pfaff_joints::space3::Axes;
    /// let axes = Axes::new([0.0, 0.0, 2.0], Some([3.0, 0.0, 7.0])).unwrap();
    /// assert_eq!(axes.uvw(), [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    /// assert_eq!(Axes::new([1.0, 0.0, 0.0], None).unwrap().uvw()[0], [0.0, 1.0, 0.0]);
    /// assert!(Axes::new([0.0, 0.0, 1.0], Some([0.0, 0.0, -1.0])).is_none());
    /// ```
    #[must_use]
    pub fn new(axis: impl Into<[f64; 3]>, across: Option<[f64; 3]>) -> Option<Self> {
        let w = Direction::new(axis)?.0;
        let across = match across {
            Some(across) => Direction::new(across)?.0,
            None => {
                let least = (1..3).fold(0, |k, j| if w[j].abs() < w[k].abs() { j } else { k });
                std::array::from_fn(|k| if k == least { 1.0 } else { 0.0 })
            }
        };
        let along = dot(across, w);
        let across: [f64; 3] = std::array::from_fn(|k| across[k] - along * w[k]);
        if dot(across, across).sqrt() < LEAST_ANGLE {
            return None;
        }
        // The second pass is necessary, because the rounding error of the first pass is relative to
        // the part that the first pass removes.
        let u = Direction::new(across)?.0;
        let along = dot(u, w);
        let u = Direction::new(std::array::from_fn(|k| u[k] - along * w[k]))?.0;
        Some(Self([u, cross(w, u), w]))
    }

    /// Returns the directions u, v and w.
    #[must_use]
    pub fn uvw(self) -> [[f64; 3]; 3] {
        self.0
    }

    /// Returns the same axes in the frame of another body. `map` transforms each direction and must
    /// be a rotation.
    #[must_use]
    pub fn map(self, map: impl FnMut([f64; 3]) -> [f64; 3]) -> Self {
        Self(self.0.map(map))
    }

    /// Returns the axes after a rotation by this rotation vector, given in the body frame (rad).
    /// This function is for generated code.
    #[doc(hidden)]
    #[must_use]
    pub fn turned(self, turn: [f64; 3]) -> Self {
        let angle = dot(turn, turn).sqrt();
        if angle == 0.0 {
            return self;
        }
        // The coefficients sin(a)/a and (1 − cos a)/a².
        let half = (0.5 * angle).sin() / angle;
        let (first, second) = (angle.sin() / angle, 2.0 * half * half);
        self.map(|d| {
            let once = cross(turn, d);
            let twice = cross(turn, once);
            std::array::from_fn(|k| d[k] + first * once[k] + second * twice[k])
        })
    }
}

/// A plane of the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundPlane {
    point: [f64; 3],
    normal: Direction,
    along: Direction,
}

impl GroundPlane {
    /// The plane z = 0.
    pub const Z: Self = Self {
        point: [0.0; 3],
        normal: Direction::Z,
        along: Direction::X,
    };

    /// Returns the plane through a point that is perpendicular to a vector. Returns `None` if the
    /// vector is zero or not finite.
    #[must_use]
    pub fn new(point: impl Into<[f64; 3]>, normal: impl Into<[f64; 3]>) -> Option<Self> {
        let normal = Direction::new(normal)?;
        let [along, ..] = Axes::new(normal.xyz(), None)?.uvw();
        Some(Self {
            point: point.into(),
            normal,
            along: Direction(along),
        })
    }

    /// Replaces point and normal by values that `Definition::data` returns, without normalisation;
    /// see [`Direction::from_data`]. The direction along the plane does not change.
    #[doc(hidden)]
    #[must_use]
    pub fn with_data(self, point: [f64; 3], normal: [f64; 3]) -> Self {
        Self {
            point,
            normal: Direction::from_data(normal),
            ..self
        }
    }

    /// Returns the point.
    #[must_use]
    pub fn point(&self) -> [f64; 3] {
        self.point
    }

    /// Returns the unit normal of the plane.
    #[must_use]
    pub fn normal(&self) -> Direction {
        self.normal
    }

    /// Returns a unit vector in the plane. It is the coordinate axis with the smallest component
    /// along the normal, made orthogonal to the normal. For the plane z = 0, it is x.
    #[must_use]
    pub fn along(&self) -> Direction {
        self.along
    }
}

/// a·b
#[must_use]
pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// a × b
#[must_use]
pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
