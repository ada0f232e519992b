//! Poses of all bodies, computed from coordinates. A pose consists of the position of the centre of
//! mass and the orientation.

use joints::plane::{Pose, Twist};
use joints::{Ring, space3};

use crate::body::{Body, BodyRecord, DescribedBody, SpatialBody};
use crate::space::{self, Number, PlanarSpace, Space, SpaceKind, in_plane, normalised, quaternion};

/// Largest change of an angle that counts as rounding for an angle that the constraints keep
/// constant.
const HELD: f64 = 4.0 * f64::EPSILON;

/// One value for each body of the mechanism, or for each body of each element, in the space of the
/// mechanism. The list that belongs to the other space is empty.
#[derive(Clone, Debug)]
pub(crate) struct InEach<P, S> {
    pub(super) plane: Vec<P>,
    pub(super) space3: Vec<S>,
}

impl<P: Copy, S: Copy> InEach<P, S> {
    pub(super) fn filled(space: SpaceKind, count: usize, plane: P, space3: S) -> Self {
        let [in_plane, in_space] = match space {
            SpaceKind::Space3 => [0, count],
            _ => [count, 0],
        };
        Self {
            plane: vec![plane; in_plane],
            space3: vec![space3; in_space],
        }
    }
}

/// Poses, one for each body of the mechanism or of each element.
pub(crate) type Poses<T> = InEach<Pose<T>, space3::Pose<T>>;
/// Twists, one for each body of each element.
pub(crate) type Twists<T> = InEach<Twist<T>, space3::Twist<T>>;

impl<P, S> Default for InEach<P, S> {
    fn default() -> Self {
        Self {
            plane: Vec::new(),
            space3: Vec::new(),
        }
    }
}

/// The poses of all bodies of a mechanism. A pose consists of the position of the centre of mass
/// and the orientation.
///
/// Methods panic if the body does not exist.
#[derive(Clone, Debug)]
pub struct Bodies<T: Ring = f64> {
    pub(super) poses: Poses<T>,
    /// Angles for which sine and cosine were last computed; initially NaN.
    turned_to: Vec<f64>,
}

impl<T: Number> Bodies<T> {
    /// Returns the poses at coordinates q. The function allocates memory.
    #[must_use]
    pub fn at(space: SpaceKind, q: &[T]) -> Self {
        let poses: Poses<T> = in_plane!(space, S => InEach {
            plane: q.chunks_exact(S::N_Q).map(pose::<S, T>).collect(),
            space3: Vec::new(),
        }, InEach {
            plane: Vec::new(),
            space3: q.chunks_exact(space::Space3::N_Q).map(spatial_pose).collect(),
        });
        Self {
            turned_to: vec![f64::NAN; poses.plane.len()],
            poses,
        }
    }
}

impl Bodies {
    pub(crate) fn new(space: SpaceKind, count: usize) -> Self {
        let poses = InEach::filled(space, count, Pose::GROUND, space3::Pose::GROUND);
        Self {
            turned_to: vec![f64::NAN; poses.plane.len()],
            poses,
        }
    }

    /// Sets the coordinates q. Sines and cosines of unchanged angles are not recomputed. The
    /// function calls `turns` for each recomputed angle.
    #[inline]
    pub(crate) fn take(
        &mut self,
        space: SpaceKind,
        q: &[f64],
        held: &[bool],
        mut turns: impl FnMut(),
    ) {
        let Self { poses, turned_to } = self;
        in_plane!(space, S => {
            let places = poses.plane.iter_mut().zip(q.chunks_exact(S::N_Q));
            for (k, (pose, q)) in places.enumerate() {
                (pose.x, pose.y, pose.angle) = (q[0], q[1], <S as PlanarSpace>::angle(q));
                if !stays(held[k], turned_to[k], pose.angle) {
                    turned_to[k] = pose.angle;
                    (pose.sin, pose.cos) = <S as PlanarSpace>::sin_cos(q);
                    turns();
                }
            }
        }, {
            let places = poses.space3.iter_mut().zip(q.chunks_exact(space::Space3::N_Q));
            places.for_each(|(pose, q)| *pose = spatial_pose(q));
        });
    }

    /// Returns the number of bodies.
    #[must_use]
    pub fn len(&self) -> usize {
        self.poses.plane.len() + self.poses.space3.len()
    }

    /// Returns whether there is no body.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the pose of a body in the plane or in space.
    fn of(&self, body: usize) -> Either<&Pose, &space3::Pose> {
        match self.poses.plane.get(body) {
            Some(pose) => Either::Plane(pose),
            None => Either::Space3(&self.poses.space3[body]),
        }
    }

    /// Returns the centre of mass of a body (m), in ground axes.
    #[must_use]
    pub fn origin(&self, body: usize) -> [f64; 3] {
        match self.of(body) {
            Either::Plane(pose) => [pose.x, pose.y, 0.0],
            Either::Space3(pose) => pose.r,
        }
    }

    /// Returns the centres of mass of all bodies.
    pub fn origins(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        (0..self.len()).map(|body| self.origin(body))
    }

    /// Returns the axes of a body as unit vectors in ground axes. The axes are the columns of the
    /// rotation matrix of the body.
    #[must_use]
    pub fn axes(&self, body: usize) -> [[f64; 3]; 3] {
        match self.of(body) {
            Either::Plane(&Pose { cos, sin, .. }) => {
                [[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]]
            }
            Either::Space3(pose) => [0, 1, 2].map(|k| pose.rot.map(|row| row[k])),
        }
    }

    /// Transforms a vector from the axes of a body to ground axes.
    #[must_use]
    pub fn turned(&self, body: usize, v: [f64; 3]) -> [f64; 3] {
        match self.of(body) {
            Either::Plane(pose) => turned_by(pose.sin, pose.cos, v),
            Either::Space3(pose) => pose.direction_to_global(v),
        }
    }

    /// Transforms a point of a body from coordinates relative to its centre of mass to ground
    /// coordinates.
    #[must_use]
    pub fn to_global(&self, body: usize, point: [f64; 3]) -> [f64; 3] {
        match self.of(body) {
            Either::Plane(pose) => {
                let [x, y] = pose.to_global([point[0], point[1]]);
                [x, y, point[2]]
            }
            Either::Space3(pose) => pose.to_global(point),
        }
    }

    /// Transforms a point from ground coordinates to coordinates relative to the centre of mass of
    /// a body, in the axes of the body.
    #[must_use]
    pub fn to_local(&self, body: usize, point: [f64; 3]) -> [f64; 3] {
        match self.of(body) {
            Either::Plane(pose) => {
                let [x, y] = pose.to_local([point[0], point[1]]);
                [x, y, point[2]]
            }
            Either::Space3(pose) => pose.to_local(point),
        }
    }

    /// Returns the angle of a body relative to the ground (rad). In the plane, the angle includes
    /// full revolutions. In space, the result is 0, because a rotation does not define such an
    /// angle.
    #[must_use]
    pub fn angle(&self, body: usize) -> f64 {
        match self.of(body) {
            Either::Plane(pose) => pose.angle,
            Either::Space3(_) => 0.0,
        }
    }

    /// Returns the position of a body for one of its velocity components: a coordinate (m) or an
    /// angle (rad).
    pub(crate) fn position(&self, body: usize, dof: usize) -> f64 {
        match self.of(body) {
            Either::Plane(pose) => match dof {
                0 => pose.x,
                1 => pose.y,
                _ => pose.angle,
            },
            Either::Space3(pose) => pose.r.get(dof).copied().unwrap_or_default(),
        }
    }

    /// Returns how far a body has moved from its previous pose: the distance (m) and the angle of
    /// rotation (rad).
    #[must_use]
    pub fn moved(&self, from: &Self, body: usize) -> [f64; 2] {
        match (from.of(body), self.of(body)) {
            (Either::Plane(from), Either::Plane(to)) => [
                (to.x - from.x).hypot(to.y - from.y),
                (to.angle - from.angle).abs(),
            ],
            _ => {
                let way = space::difference(self.origin(body), from.origin(body));
                let (old, new) = (from.axes(body), self.axes(body));
                // If three axes rotate by α, the squares of their changes add up to 4·(1 − cos α).
                let changes = old.iter().zip(new).map(|(&a, b)| {
                    let change = space::norm(&space::difference(b, a));
                    change * change
                });
                let square: f64 = changes.sum();
                let half_sine = (square / 8.0).sqrt().min(1.0);
                [space::norm(&way), 2.0 * half_sine.asin()]
            }
        }
    }
}

/// A value in the plane or in space.
enum Either<P, S> {
    Plane(P),
    Space3(S),
}

impl Body {
    /// Returns the initial pose: the position of the centre of mass, with the axes of the body
    /// frame.
    #[must_use]
    pub fn pose(&self) -> Pose {
        let [x, y] = self.position;
        let origin = Pose::new(x, y, self.angle);
        if self.is_centred() {
            return origin;
        }
        let [x, y] = origin.to_global(self.centre);
        Pose { x, y, ..origin }
    }
}

impl SpatialBody {
    /// Returns the initial pose: the position of the centre of mass, with the axes of the body
    /// frame.
    #[must_use]
    pub fn pose(&self) -> space3::Pose {
        let origin = space3::Pose::new(self.position, self.orientation);
        space3::Pose {
            r: origin.to_global(self.centre),
            ..origin
        }
    }
}

impl BodyRecord {
    /// Returns the initial coordinates of the body.
    pub(crate) fn coordinates(&self, space: SpaceKind, q: &mut [f64]) {
        match &self.described {
            DescribedBody::Plane(body) => {
                let Pose {
                    x,
                    y,
                    angle,
                    cos,
                    sin,
                } = body.pose();
                (q[0], q[1]) = (x, y);
                match space {
                    #[cfg(feature = "unit-circle")]
                    SpaceKind::UnitCircle => (q[2], q[3]) = (cos, sin),
                    _ => {
                        let _ = (cos, sin);
                        q[2] = angle;
                    }
                }
            }
            DescribedBody::Space3(body) => {
                q[..3].copy_from_slice(&body.pose().r);
                let [w, ..] = body.orientation;
                // A quaternion and its negative are equivalent; the quaternion with w ≥ 0 is used.
                let sign = if w < 0.0 { -1.0 } else { 1.0 };
                let frame = normalised(body.orientation.map(|e| sign * e));
                let own = self
                    .principal
                    .as_ref()
                    .map_or(frame, |own| own.turned(frame));
                q[3..].copy_from_slice(&own);
            }
        }
    }
}

/// Returns the angle of a body in the plane (rad) from the coordinates of the body, including full
/// revolutions. The result is 0 in space.
pub(crate) fn angle_at(space: SpaceKind, q: &[f64]) -> f64 {
    in_plane!(space, S => <S as PlanarSpace>::angle(q), 0.0)
}

/// Transforms a vector from the axes of a body to ground axes; `q` are the coordinates of the body.
pub(crate) fn turned_at(space: SpaceKind, q: &[f64], v: [f64; 3]) -> [f64; 3] {
    in_plane!(space, S => {
        let (sin, cos) = <S as PlanarSpace>::sin_cos(q);
        turned_by(sin, cos, v)
    }, spatial_pose(q).direction_to_global(v))
}

/// Returns the axes of a body in ground components; `q` are the coordinates of the body.
pub(crate) fn axes_at(space: SpaceKind, q: &[f64]) -> [[f64; 3]; 3] {
    let units = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    units.map(|axis| turned_at(space, q, axis))
}

fn turned_by(sin: f64, cos: f64, [x, y, z]: [f64; 3]) -> [f64; 3] {
    [cos * x - sin * y, sin * x + cos * y, z]
}

/// Returns the pose of a spatial body from its coordinates. The rotation is divided by the square
/// of the length of the quaternion. Therefore this length has no influence.
pub(super) fn spatial_pose<T: Number>(q: &[T]) -> space3::Pose<T> {
    let e = quaternion(q);
    let [w, x, y, z] = e;
    let square = w * w + x * x + y * y + z * z;
    space3::Pose {
        r: [q[0], q[1], q[2]],
        rot: space3::rotation(e).map(|row| row.map(|entry| entry / square)),
    }
}

/// Returns whether the stored sine and cosine of a body are still used after its angle has changed.
/// If rows fix the angle, a change that is not larger than rounding is ignored. Otherwise every bit
/// is significant. For example, the sine of −0 differs from the sine of 0.
fn stays(is_held: bool, from: f64, to: f64) -> bool {
    if is_held {
        (to - from).abs() <= HELD * from.abs().max(1.0)
    } else {
        to.to_bits() == from.to_bits()
    }
}

/// Returns the pose of a body from its coordinates.
fn pose<S: PlanarSpace, T: Number>(q: &[T]) -> Pose<T> {
    let (sin, cos) = S::sin_cos(q);
    Pose {
        x: q[0],
        y: q[1],
        angle: S::angle(q),
        cos,
        sin,
    }
}
