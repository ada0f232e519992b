//! Elements in a mechanism: the kernels of joints, drives and forces with the poses and velocities
//! of their bodies.
//!
//! This is the only place that knows in which form kernels take poses and velocities. The rest of
//! the crate asks a [`PlacedConstraint`] or a [`PlacedForce`], with [`Slots`], and asks [`Bodies`]
//! where a body is; an element with kernels of another form is added here.

use std::ops::Range;

use joints::plane::{Pose, Twist};
use joints::spec::{ConstraintSpec, ForceSpec};
use joints::{
    Constraint, Derivatives, Element, Force, ForceElement, Magnitude, Plane, Recorded, Ring,
    Space3, space3,
};
use linalg::Dd;

use crate::body::{Body, BodyRecord, BodyRef, DescribedBody, SpatialBody};
use crate::law::DriveForce;
use crate::space::{self, Number, PlanarSpace, Space, SpaceKind, in_plane, normalised, quaternion};

/// Meaning of an input of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    /// A coordinate, by its index in q.
    Coordinate(usize),
    /// The cosine of the coordinate with this index in q.
    Cos(usize),
    /// The sine of the coordinate with this index in q.
    Sin(usize),
    /// A velocity, by its index in v.
    Velocity(usize),
    /// A function of time as used by the mechanism, or a derivative of it.
    Function {
        /// Index of the function, in the order of [`crate::Mechanism::functions`].
        function: usize,
        /// Order of the derivative: 0, 1 or 2.
        derivative: usize,
    },
}

/// A space of kernels in which bodies are described: the plane, or space.
pub trait BodySpace: joints::Space + Sized {
    /// A body as described.
    type Body: Clone + std::fmt::Debug + Into<DescribedBody>;

    /// The space of a mechanism of such bodies.
    const KIND: SpaceKind;

    /// Kernels as one of those of a mechanism.
    #[doc(hidden)]
    fn any_constraint(kernels: Box<dyn ConstraintKernels<Self>>) -> AnyConstraint;

    /// The same of a force.
    #[doc(hidden)]
    fn any_force(kernels: Box<dyn ForceKernels<Self>>) -> AnyForce;

    /// A point of a body with three coordinates.
    #[doc(hidden)]
    fn point(point: Self::Vector<f64>) -> [f64; 3];

    /// The components of a vector in this space.
    #[doc(hidden)]
    fn vector(components: [f64; 3]) -> Self::Vector<f64>;

    /// A global point relative to the centre of mass of a body, in its axes.
    #[doc(hidden)]
    fn to_local(body: &Self::Body, point: Self::Vector<f64>) -> Self::Vector<f64>;
}

impl BodySpace for Plane {
    type Body = Body;

    const KIND: SpaceKind = SpaceKind::Plane;

    fn any_constraint(kernels: Box<dyn ConstraintKernels>) -> AnyConstraint {
        AnyConstraint::Plane(kernels)
    }

    fn any_force(kernels: Box<dyn ForceKernels>) -> AnyForce {
        AnyForce::Plane(kernels)
    }

    fn point([x, y]: [f64; 2]) -> [f64; 3] {
        [x, y, 0.0]
    }

    fn vector([x, y, _]: [f64; 3]) -> [f64; 2] {
        [x, y]
    }

    fn to_local(body: &Body, point: [f64; 2]) -> [f64; 2] {
        body.pose().to_local(point)
    }
}

impl BodySpace for Space3 {
    type Body = SpatialBody;

    const KIND: SpaceKind = SpaceKind::Space3;

    fn any_constraint(kernels: Box<dyn ConstraintKernels<Self>>) -> AnyConstraint {
        AnyConstraint::Space3(kernels)
    }

    fn any_force(kernels: Box<dyn ForceKernels<Self>>) -> AnyForce {
        AnyForce::Space3(kernels)
    }

    fn point(point: [f64; 3]) -> [f64; 3] {
        point
    }

    fn vector(components: [f64; 3]) -> [f64; 3] {
        components
    }

    fn to_local(body: &SpatialBody, point: [f64; 3]) -> [f64; 3] {
        body.pose().to_local(point)
    }
}

/// Kernels of a constraint in the plane or in space.
#[doc(hidden)]
#[derive(Clone)]
pub enum AnyConstraint {
    /// In the plane.
    Plane(Box<dyn ConstraintKernels>),
    /// In space.
    Space3(Box<dyn ConstraintKernels<Space3>>),
}

/// Kernels of a force in the plane or in space.
#[doc(hidden)]
#[derive(Clone)]
pub enum AnyForce {
    /// In the plane.
    Plane(Box<dyn ForceKernels>),
    /// In space.
    Space3(Box<dyn ForceKernels<Space3>>),
}

/// Evaluates an expression in which `$element` are the kernels, and `$space` their space.
macro_rules! with {
    ($any:ident, $kernels:expr, $element:ident, $space:ident => $body:expr) => {
        match $kernels {
            $any::Plane($element) => {
                type $space = Plane;
                $body
            }
            $any::Space3($element) => {
                type $space = Space3;
                $body
            }
        }
    };
}

/// The kernels of a constraint as a trait object: in `f64` for motion, and in other number types.
pub trait ConstraintKernels<S: BodySpace = Plane>: Derivatives<f64, S> {
    /// Kernels for certificates.
    fn extended(&self) -> &dyn Element<Dd, S>;
    /// Kernels for bounds on the rounding of data.
    fn magnitude(&self) -> &dyn Element<Magnitude, S>;
    /// Kernels that record their operations.
    fn recorded(&self) -> &dyn Element<Recorded, S>;
    /// A copy.
    fn boxed(&self) -> Box<dyn ConstraintKernels<S>>;
}

impl<K: Constraint<S>, S: BodySpace> ConstraintKernels<S> for K {
    fn extended(&self) -> &dyn Element<Dd, S> {
        self.element()
    }
    fn magnitude(&self) -> &dyn Element<Magnitude, S> {
        self.element()
    }
    fn recorded(&self) -> &dyn Element<Recorded, S> {
        self.element()
    }
    fn boxed(&self) -> Box<dyn ConstraintKernels<S>> {
        Box::new(self.clone())
    }
}

impl<S: BodySpace> Clone for Box<dyn ConstraintKernels<S>> {
    fn clone(&self) -> Self {
        self.as_ref().boxed()
    }
}

/// The kernels of a force as a trait object.
pub trait ForceKernels<S: BodySpace = Plane>: ForceElement<f64, S> {
    /// Kernels that record their operations.
    fn recorded(&self) -> &dyn ForceElement<Recorded, S>;
    /// A copy.
    fn boxed(&self) -> Box<dyn ForceKernels<S>>;
    /// Whether this is a drive by a law.
    fn is_law(&self) -> bool {
        false
    }
    /// The force along the measure of a drive by a law.
    fn drive(
        &self,
        _x: &[S::Pose<f64>],
        _v: &[S::Twist<f64>],
        _f: &[[f64; 3]],
    ) -> Option<DriveForce> {
        None
    }
}

impl<K: Force<S>, S: BodySpace> ForceKernels<S> for K {
    fn recorded(&self) -> &dyn ForceElement<Recorded, S> {
        self.element()
    }
    fn boxed(&self) -> Box<dyn ForceKernels<S>> {
        Box::new(self.clone())
    }
}

impl<S: BodySpace> Clone for Box<dyn ForceKernels<S>> {
    fn clone(&self) -> Self {
        self.as_ref().boxed()
    }
}

/// Largest change by rounding of an angle that is held constant.
const HELD: f64 = 4.0 * f64::EPSILON;

/// One value for each body or slot, in the space of the mechanism; the list of the other space is
/// empty.
#[derive(Clone, Debug)]
pub(crate) struct InEach<P, S> {
    plane: Vec<P>,
    space3: Vec<S>,
}

impl<P: Copy, S: Copy> InEach<P, S> {
    fn filled(space: SpaceKind, count: usize, plane: P, space3: S) -> Self {
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

/// Poses of bodies or slots.
type Poses<T> = InEach<Pose<T>, space3::Pose<T>>;
/// Twists of slots.
type Twists<T> = InEach<Twist<T>, space3::Twist<T>>;

impl<P, S> Default for InEach<P, S> {
    fn default() -> Self {
        Self {
            plane: Vec::new(),
            space3: Vec::new(),
        }
    }
}

/// The poses of all bodies of a mechanism: positions of their centres of mass, and orientations.
///
/// Methods panic if there is no such body.
#[derive(Clone, Debug)]
pub struct Bodies<T: Ring = f64> {
    poses: Poses<T>,
    /// Angles for which sine and cosine were computed; NaN at the beginning.
    turned_to: Vec<f64>,
}

impl<T: Number> Bodies<T> {
    /// The poses at coordinates q; allocates.
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

    /// Takes the coordinates q. Sines and cosines of angles that have not changed are kept;
    /// `turns` is called for each that is computed.
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

    /// Number of bodies.
    #[must_use]
    pub fn len(&self) -> usize {
        self.poses.plane.len() + self.poses.space3.len()
    }

    /// Whether there is no body.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The pose of a body in the plane or in space.
    fn of(&self, body: usize) -> Either<&Pose, &space3::Pose> {
        match self.poses.plane.get(body) {
            Some(pose) => Either::Plane(pose),
            None => Either::Space3(&self.poses.space3[body]),
        }
    }

    /// The centre of mass of a body (m), ground axes.
    #[must_use]
    pub fn origin(&self, body: usize) -> [f64; 3] {
        match self.of(body) {
            Either::Plane(pose) => [pose.x, pose.y, 0.0],
            Either::Space3(pose) => pose.r,
        }
    }

    /// The centres of mass of all bodies.
    pub fn origins(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        (0..self.len()).map(|body| self.origin(body))
    }

    /// The axes of a body as unit vectors in ground axes: the columns of its rotation matrix.
    #[must_use]
    pub fn axes(&self, body: usize) -> [[f64; 3]; 3] {
        match self.of(body) {
            Either::Plane(&Pose { cos, sin, .. }) => {
                [[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]]
            }
            Either::Space3(pose) => [0, 1, 2].map(|k| pose.rot.map(|row| row[k])),
        }
    }

    /// A vector in the axes of a body, in ground axes.
    #[must_use]
    pub fn turned(&self, body: usize, v: [f64; 3]) -> [f64; 3] {
        match self.of(body) {
            Either::Plane(pose) => turned_by(pose.sin, pose.cos, v),
            Either::Space3(pose) => pose.direction_to_global(v),
        }
    }

    /// A point relative to the centre of mass of a body, in its axes, as a point of the ground.
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

    /// A point of the ground relative to the centre of mass of a body, in its axes.
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

    /// The angle by which a body is turned against the ground (rad): in the plane not reduced to
    /// one revolution, in space 0, because a rotation has no such angle.
    #[must_use]
    pub fn angle(&self, body: usize) -> f64 {
        match self.of(body) {
            Either::Plane(pose) => pose.angle,
            Either::Space3(_) => 0.0,
        }
    }

    /// Position of a body along a freedom: a coordinate (m) or an angle (rad).
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

    /// How far a body is from where it was (m), and by what angle it has turned (rad).
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
                // Three axes that turn by α: the squares of their changes add up to 4·(1 − cos α).
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
    /// Its pose at the start: that of the centre of mass, with the axes of its frame.
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
    /// Its pose at the start: that of the centre of mass, with the axes of its frame.
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
    /// Its coordinates at the start.
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
                // Of a quaternion and its negative, the one with w ≥ 0.
                let sign = if w < 0.0 { -1.0 } else { 1.0 };
                q[3..].copy_from_slice(&normalised(body.orientation.map(|e| sign * e)));
            }
        }
    }
}

/// The angle of a body in the plane, from its own coordinates (rad), not reduced; 0 in space.
pub(crate) fn angle_at(space: SpaceKind, q: &[f64]) -> f64 {
    in_plane!(space, S => <S as PlanarSpace>::angle(q), 0.0)
}

/// A vector in the axes of a body, from its own coordinates, in ground axes.
pub(crate) fn turned_at(space: SpaceKind, q: &[f64], v: [f64; 3]) -> [f64; 3] {
    in_plane!(space, S => {
        let (sin, cos) = <S as PlanarSpace>::sin_cos(q);
        turned_by(sin, cos, v)
    }, spatial_pose(q).direction_to_global(v))
}

/// The axes of a body, from its own coordinates, in ground components.
pub(crate) fn axes_at(space: SpaceKind, q: &[f64]) -> [[f64; 3]; 3] {
    let units = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    units.map(|axis| turned_at(space, q, axis))
}

fn turned_by(sin: f64, cos: f64, [x, y, z]: [f64; 3]) -> [f64; 3] {
    [cos * x - sin * y, sin * x + cos * y, z]
}

/// The pose of a spatial body from its coordinates: the rotation divided by the square of the
/// quaternion's length, so that this does not matter.
fn spatial_pose<T: Number>(q: &[T]) -> space3::Pose<T> {
    let e = quaternion(q);
    let [w, x, y, z] = e;
    let square = w * w + x * x + y * y + z * z;
    space3::Pose {
        r: [q[0], q[1], q[2]],
        rot: space3::rotation(e).map(|row| row.map(|entry| entry / square)),
    }
}

/// Whether a body keeps its sine and cosine when its angle changes. If rows of angles hold the
/// angle, a change by rounding is not a rotation; otherwise every bit counts: the sine of −0 is not
/// that of 0.
fn stays(is_held: bool, from: f64, to: f64) -> bool {
    if is_held {
        (to - from).abs() <= HELD * from.abs().max(1.0)
    } else {
        to.to_bits() == from.to_bits()
    }
}

/// The pose of a body from its coordinates.
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

/// What the kernels of a space take of bodies.
pub(crate) trait Kinematics: joints::Space {
    fn ground<T: Ring>() -> Self::Pose<T>;
    fn poses<T: Ring>(all: &Poses<T>) -> &[Self::Pose<T>];
    fn poses_mut<T: Ring>(all: &mut Poses<T>) -> &mut [Self::Pose<T>];
    fn twists<T: Ring>(all: &Twists<T>) -> &[Self::Twist<T>];
    fn twists_mut<T: Ring>(all: &mut Twists<T>) -> &mut [Self::Twist<T>];
    /// The twist with these velocities.
    fn twist<T: Ring>(v: &[T]) -> Self::Twist<T>;
    /// Sizes of the contributions of a pose to a polynomial.
    fn magnitude(pose: &Self::Pose<f64>) -> Self::Pose<Magnitude>;
    fn first_origin(poses: &[Self::Pose<f64>]) -> [f64; 3];
}

impl Kinematics for Plane {
    fn ground<T: Ring>() -> Pose<T> {
        Pose::GROUND.cast()
    }
    fn poses<T: Ring>(all: &Poses<T>) -> &[Pose<T>] {
        &all.plane
    }
    fn poses_mut<T: Ring>(all: &mut Poses<T>) -> &mut [Pose<T>] {
        &mut all.plane
    }
    fn twists<T: Ring>(all: &Twists<T>) -> &[Twist<T>] {
        &all.plane
    }
    fn twists_mut<T: Ring>(all: &mut Twists<T>) -> &mut [Twist<T>] {
        &mut all.plane
    }
    fn twist<T: Ring>(v: &[T]) -> Twist<T> {
        Twist {
            x: v[0],
            y: v[1],
            omega: v[2],
        }
    }
    /// Cosine and sine are accurate to the rounding of their angle.
    fn magnitude(pose: &Pose) -> Pose<Magnitude> {
        let turned = Magnitude::from(pose.angle.abs().max(1.0));
        Pose {
            x: pose.x.into(),
            y: pose.y.into(),
            angle: pose.angle.into(),
            cos: turned,
            sin: turned,
        }
    }
    fn first_origin(poses: &[Pose]) -> [f64; 3] {
        [poses[0].x, poses[0].y, 0.0]
    }
}

impl Kinematics for Space3 {
    fn ground<T: Ring>() -> space3::Pose<T> {
        space3::Pose::GROUND.cast()
    }
    fn poses<T: Ring>(all: &Poses<T>) -> &[space3::Pose<T>] {
        &all.space3
    }
    fn poses_mut<T: Ring>(all: &mut Poses<T>) -> &mut [space3::Pose<T>] {
        &mut all.space3
    }
    fn twists<T: Ring>(all: &Twists<T>) -> &[space3::Twist<T>] {
        &all.space3
    }
    fn twists_mut<T: Ring>(all: &mut Twists<T>) -> &mut [space3::Twist<T>] {
        &mut all.space3
    }
    fn twist<T: Ring>(v: &[T]) -> space3::Twist<T> {
        space3::Twist {
            v: [v[0], v[1], v[2]],
            omega: [v[3], v[4], v[5]],
        }
    }
    /// Every entry of a rotation is accurate to the rounding of 1.
    fn magnitude(pose: &space3::Pose) -> space3::Pose<Magnitude> {
        space3::Pose {
            r: pose.r.map(Magnitude::from),
            rot: [[Magnitude::from(1.0); 3]; 3],
        }
    }
    fn first_origin(poses: &[space3::Pose]) -> [f64; 3] {
        poses[0].r
    }
}

/// The pose of a body, taken from those of all.
fn pose_of<S: Kinematics, T: Ring>(poses: &Poses<T>, body: BodyRef) -> S::Pose<T> {
    match body {
        BodyRef::Ground => S::ground(),
        BodyRef::Body(k) => S::poses(poses)[k],
    }
}

/// The velocity of a body, taken from those of all.
fn twist_of<S: Kinematics>(body: BodyRef, v: &[f64]) -> S::Twist<f64> {
    match body {
        BodyRef::Ground => S::twist(&[0.0; 6]),
        BodyRef::Body(k) => S::twist(&v[S::N_DOF * k..S::N_DOF * (k + 1)]),
    }
}

/// Evaluates an expression in which `$kernels` is the space of kernels of a [`SpaceKind`].
macro_rules! in_kernels {
    ($kind:expr, $kernels:ident => $body:expr) => {
        match $kind {
            SpaceKind::Space3 => {
                type $kernels = Space3;
                $body
            }
            _ => {
                type $kernels = Plane;
                $body
            }
        }
    };
}

/// Arguments of the kernels of all elements, one after the other: constraints, then forces.
#[derive(Clone, Debug)]
pub(crate) struct Slots {
    space: SpaceKind,
    /// Poses of the bodies in their slots.
    poses: Poses<f64>,
    /// Velocities of the same slots.
    pub(crate) rates: Rates,
    /// Values of the functions of time.
    pub(crate) jets: Vec<[f64; 3]>,
}

impl Slots {
    pub(crate) fn new(space: SpaceKind, slots: usize, functions: usize) -> Self {
        Self {
            space,
            poses: InEach::filled(space, slots, Pose::GROUND, space3::Pose::GROUND),
            rates: Rates::zero(space, slots),
            jets: vec![[0.0; 3]; functions],
        }
    }

    /// Takes the poses of the bodies.
    #[inline]
    pub(crate) fn take<'a>(&mut self, sites: impl Iterator<Item = &'a Site>, bodies: &Bodies) {
        in_kernels!(self.space, S => {
            let all = S::poses_mut(&mut self.poses);
            for site in sites {
                let slots = &mut all[site.slots.clone()];
                for (pose, &body) in slots.iter_mut().zip(&site.bodies) {
                    *pose = pose_of::<S, f64>(&bodies.poses, body);
                }
            }
        });
    }
}

/// Velocities or accelerations of slots.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rates {
    space: SpaceKind,
    twists: Twists<f64>,
}

impl Rates {
    pub(crate) fn zero(space: SpaceKind, slots: usize) -> Self {
        let twists = InEach::filled(space, slots, Twist::zero(), space3::Twist::zero());
        Self { space, twists }
    }

    /// Sets so many slots at rest, in the same storage.
    fn rest(&mut self, space: SpaceKind, slots: usize) {
        self.space = space;
        let InEach { plane, space3 } = &mut self.twists;
        plane.clear();
        space3.clear();
        match space {
            SpaceKind::Space3 => space3.resize(slots, space3::Twist::zero()),
            _ => plane.resize(slots, Twist::zero()),
        }
    }

    /// Takes velocities or accelerations of the bodies (n_v); those of the ground stay zero.
    #[inline]
    pub(crate) fn take<'a>(&mut self, sites: impl Iterator<Item = &'a Site>, v: &[f64]) {
        in_kernels!(self.space, S => {
            let all = S::twists_mut(&mut self.twists);
            for site in sites {
                let twists = &mut all[site.slots.clone()];
                for (twist, &body) in twists.iter_mut().zip(&site.bodies) {
                    if body != BodyRef::Ground {
                        *twist = twist_of::<S>(body, v);
                    }
                }
            }
        });
    }
}

/// Velocities of the slots of one constraint for [`PlacedConstraint::d_power_dp`].
#[derive(Clone, Debug, Default)]
pub(crate) struct OwnRates {
    own: Rates,
    still: Rates,
    /// Functions of time as they are, at rest.
    still_f: Vec<[f64; 3]>,
}

impl OwnRates {
    /// Takes the constraint, with all its bodies at rest.
    fn still(&mut self, c: &PlacedConstraint) {
        let (space, slots) = (c.site.space, c.site.bodies.len());
        self.own.rest(space, slots);
        self.still.rest(space, slots);
    }

    /// Takes velocities or accelerations of all bodies (n_v).
    pub(crate) fn take(&mut self, c: &PlacedConstraint, v: &[f64]) {
        self.still(c);
        in_kernels!(c.site.space, S => {
            let twists = S::twists_mut(&mut self.own.twists).iter_mut();
            let bodies = twists.zip(&c.site.bodies);
            bodies.for_each(|(twist, &body)| *twist = twist_of::<S>(body, v));
        });
    }

    /// The body of one slot moves at 1 m/s or 1 rad/s along one of its freedoms, alone.
    pub(crate) fn unit(&mut self, c: &PlacedConstraint, slot: usize, dof: usize) {
        self.still(c);
        let mut unit = [0.0; 6];
        unit[dof] = 1.0;
        in_kernels!(c.site.space, S => {
            S::twists_mut(&mut self.own.twists)[slot] = S::twist(&unit);
        });
    }
}

/// Indices of an element: its bodies, and its ranges in [`Slots`].
#[derive(Clone)]
pub(crate) struct Site {
    pub(crate) space: SpaceKind,
    pub(crate) bodies: Vec<BodyRef>,
    pub(crate) slots: Range<usize>,
    pub(crate) functions: Range<usize>,
}

impl Site {
    /// Poses of its bodies.
    fn x<'s, S: Kinematics>(&self, all: &'s Slots) -> &'s [S::Pose<f64>] {
        &S::poses(&all.poses)[self.slots.clone()]
    }

    /// Twists of its bodies.
    fn v<'s, S: Kinematics>(&self, all: &'s Rates) -> &'s [S::Twist<f64>] {
        &S::twists(&all.twists)[self.slots.clone()]
    }

    /// Values of its functions of time.
    pub(crate) fn f<'s>(&self, all: &'s Slots) -> &'s [[f64; 3]] {
        &all.jets[self.functions.clone()]
    }

    /// Poses of its bodies in any number type, from those of all bodies; allocates.
    fn poses<S: Kinematics, T: Ring>(&self, all: &Bodies<T>) -> Vec<S::Pose<T>> {
        let bodies = self.bodies.iter();
        bodies.map(|&b| pose_of::<S, T>(&all.poses, b)).collect()
    }

    /// Its bodies except the ground.
    pub(crate) fn moving(&self) -> impl Iterator<Item = usize> + '_ {
        self.bodies.iter().filter_map(|b| b.moving())
    }

    /// Column of C for a column of its block; `None` for the ground.
    pub(crate) fn column(&self, k: usize) -> Option<usize> {
        let body = self.bodies[self.space.body_of(k)].moving()?;
        Some(self.space.n_v() * body + self.space.dof_of(k))
    }
}

/// A constraint with its indices in the mechanism. Kernels need the poses of their slots and, where
/// they depend on them, the velocities; `out` is overwritten.
#[derive(Clone)]
pub(crate) struct PlacedConstraint {
    element: AnyConstraint,
    pub(crate) site: Site,
    /// Its entries of C in the scratch.
    pub(crate) entries: Range<usize>,
    /// Indices of the varying entries, relative to `entries`.
    pub(crate) varying: Vec<usize>,
    pub(crate) rows: Range<usize>,
    /// Tolerance of its data (m), if stated.
    pub(crate) tolerance: Option<f64>,
}

impl AnyConstraint {
    pub(crate) fn spec(&self) -> &'static ConstraintSpec {
        with!(AnyConstraint, self, element, _S => element.spec())
    }

    pub(crate) fn points(&self) -> Vec<[f64; 3]> {
        with!(AnyConstraint, self, element, S => {
            element.points().into_iter().map(S::point).collect()
        })
    }

    pub(crate) fn data(&self, out: &mut [f64]) {
        with!(AnyConstraint, self, element, _S => element.data(out));
    }

    /// Entries of C that depend on parameters only; the others are left as they are.
    pub(crate) fn c_constant(&self, out: &mut [f64]) {
        with!(AnyConstraint, self, element, _S => element.c_constant(out));
    }
}

impl AnyForce {
    pub(crate) fn spec(&self) -> &'static ForceSpec {
        with!(AnyForce, self, element, _S => element.spec())
    }

    pub(crate) fn points(&self) -> Vec<[f64; 3]> {
        with!(AnyForce, self, element, S => {
            element.points().into_iter().map(S::point).collect()
        })
    }
}

impl PlacedConstraint {
    pub(crate) fn new(
        element: AnyConstraint,
        site: Site,
        [entries, rows]: [Range<usize>; 2],
        tolerance: Option<f64>,
    ) -> Self {
        let all = element.spec().c.iter().enumerate();
        let varying = all.filter(|(_, e)| !e.constant).map(|(at, _)| at);
        Self {
            varying: varying.collect(),
            element,
            site,
            entries,
            rows,
            tolerance,
        }
    }

    pub(crate) fn kernels(&self) -> &AnyConstraint {
        &self.element
    }

    pub(crate) fn spec(&self) -> &'static ConstraintSpec {
        self.element.spec()
    }

    /// Whether its block of C depends on the configuration.
    pub(crate) fn has_varying_entries(&self) -> bool {
        !self.varying.is_empty()
    }

    /// Whether b and Φt of its rows may differ from zero.
    pub(crate) fn depends_on_time(&self) -> bool {
        self.spec().rheonomic
    }

    /// Whether Γ of its rows may differ from zero. C of the other rows is constant, so `C·v̇ = 0`.
    pub(crate) fn has_gamma(&self) -> bool {
        self.has_varying_entries() || self.depends_on_time()
    }

    pub(crate) fn initialise(&mut self, bodies: &Bodies) {
        with!(AnyConstraint, &mut self.element, element, S => {
            element.initialise(&self.site.poses::<S, f64>(bodies));
        });
    }

    /// The first requirement of its definition that is not met at these poses.
    pub(crate) fn unmet_requirement(&self, bodies: &Bodies) -> Option<&'static str> {
        let words = self.spec().common.requirements;
        let unmet = with!(AnyConstraint, &self.element, element, S => {
            let x = self.site.poses::<S, f64>(bodies);
            (0..words.len()).find(|&k| !element.requirement(k, &x))
        })?;
        Some(words[unmet])
    }

    #[inline]
    pub(crate) fn phi(&self, s: &Slots, out: &mut [f64]) {
        with!(AnyConstraint, &self.element, element, S => {
            element.phi(self.site.x::<S>(s), self.site.f(s), out);
        });
    }

    #[inline]
    pub(crate) fn c(&self, s: &Slots, out: &mut [f64]) {
        with!(AnyConstraint, &self.element, element, S => {
            element.c(self.site.x::<S>(s), self.site.f(s), out);
        });
    }

    #[inline]
    pub(crate) fn b(&self, s: &Slots, out: &mut [f64]) {
        with!(AnyConstraint, &self.element, element, S => {
            element.b(self.site.x::<S>(s), self.site.f(s), out);
        });
    }

    #[inline]
    pub(crate) fn gamma(&self, s: &Slots, out: &mut [f64]) {
        with!(AnyConstraint, &self.element, element, S => {
            let (x, v, f) = (self.site.x::<S>(s), self.site.v::<S>(&s.rates), self.site.f(s));
            element.gamma(x, v, f, out);
        });
    }

    #[inline]
    pub(crate) fn wrench(&self, s: &Slots, out: &mut [f64]) {
        with!(AnyConstraint, &self.element, element, S => {
            element.wrench(self.site.x::<S>(s), self.site.f(s), out);
        });
    }

    #[inline]
    pub(crate) fn component(&self, s: &Slots, out: &mut [f64]) {
        with!(AnyConstraint, &self.element, element, S => {
            element.component(self.site.x::<S>(s), self.site.f(s), out);
        });
    }

    /// The place of its reaction (m), ground axes.
    pub(crate) fn place(&self, s: &Slots) -> [f64; 3] {
        with!(AnyConstraint, &self.element, element, S => {
            S::point(element.place(self.site.x::<S>(s)))
        })
    }

    /// The origin of its first body (m), ground axes.
    pub(crate) fn first_origin(&self, s: &Slots) -> [f64; 3] {
        with!(AnyConstraint, &self.element, _element, S => {
            S::first_origin(self.site.x::<S>(s))
        })
    }

    pub(crate) fn d_force_dx(&self, s: &Slots, lambda: &[f64], out: &mut [f64]) {
        with!(AnyConstraint, &self.element, element, S => {
            element.d_force_dx(self.site.x::<S>(s), self.site.f(s), lambda, out);
        });
    }

    pub(crate) fn d_residual_dx(&self, s: &Slots, a: &Rates, out: &mut [f64]) {
        with!(AnyConstraint, &self.element, element, S => {
            let (x, v, f) = (self.site.x::<S>(s), self.site.v::<S>(&s.rates), self.site.f(s));
            element.d_residual_dx(x, v, self.site.v::<S>(a), f, out);
        });
    }

    pub(crate) fn d_gamma_dv(&self, s: &Slots, out: &mut [f64]) {
        with!(AnyConstraint, &self.element, element, S => {
            let (x, v, f) = (self.site.x::<S>(s), self.site.v::<S>(&s.rates), self.site.f(s));
            element.d_gamma_dv(x, v, f, out);
        });
    }

    pub(crate) fn d_velocity_dx(&self, s: &Slots, out: &mut [f64]) {
        with!(AnyConstraint, &self.element, element, S => {
            let (x, v, f) = (self.site.x::<S>(s), self.site.v::<S>(&s.rates), self.site.f(s));
            element.d_velocity_dx(x, v, f, out);
        });
    }

    /// Gradient of `λᵀ·Φ` with respect to its numbers.
    pub(crate) fn d_phi_dp(&self, s: &Slots, lambda: &[f64], out: &mut [f64]) {
        with!(AnyConstraint, &self.element, element, S => {
            element.d_phi_dp(self.site.x::<S>(s), self.site.f(s), lambda, out);
        });
    }

    /// Gradient of `λᵀ·(C·a − Γ)` with respect to its numbers.
    pub(crate) fn d_residual_dp(&self, s: &Slots, a: &OwnRates, lambda: &[f64], out: &mut [f64]) {
        with!(AnyConstraint, &self.element, element, S => {
            let (x, v, f) = (self.site.x::<S>(s), self.site.v::<S>(&s.rates), self.site.f(s));
            element.d_residual_dp(x, v, S::twists(&a.own.twists), f, lambda, out);
        });
    }

    /// Gradient of `λᵀ·C·v` with respect to its numbers: without velocities and rates of functions
    /// of time Γ vanishes.
    pub(crate) fn d_power_dp(&self, s: &Slots, v: &mut OwnRates, lambda: &[f64], out: &mut [f64]) {
        v.still_f.clear();
        let still = self.site.f(s).iter().map(|[f, ..]| [*f, 0.0, 0.0]);
        v.still_f.extend(still);
        with!(AnyConstraint, &self.element, element, S => {
            let (own, still) = (S::twists(&v.own.twists), S::twists(&v.still.twists));
            element.d_residual_dp(self.site.x::<S>(s), still, own, &v.still_f, lambda, out);
        });
    }

    /// Φ in double-double, with all functions of time of the mechanism.
    pub(crate) fn extended_phi(&self, bodies: &Bodies<Dd>, jets: &[[Dd; 3]], out: &mut [Dd]) {
        with!(AnyConstraint, &self.element, element, S => {
            let x = self.site.poses::<S, Dd>(bodies);
            element.extended().phi(&x, &jets[self.site.functions.clone()], out);
        });
    }

    /// C in double-double.
    pub(crate) fn extended_c(&self, bodies: &Bodies<Dd>, jets: &[[Dd; 3]], out: &mut [Dd]) {
        with!(AnyConstraint, &self.element, element, S => {
            let x = self.site.poses::<S, Dd>(bodies);
            element.extended().c(&x, &jets[self.site.functions.clone()], out);
        });
    }

    /// Sizes of the terms of C.
    pub(crate) fn magnitude_c(&self, s: &Slots, out: &mut [Magnitude]) {
        let jets = self.site.f(s).iter();
        let f: Vec<[Magnitude; 3]> = jets.map(|jet| jet.map(Magnitude::from)).collect();
        with!(AnyConstraint, &self.element, element, S => {
            let x: Vec<_> = self.site.x::<S>(s).iter().map(S::magnitude).collect();
            element.magnitude().c(&x, &f, out);
        });
    }

    pub(crate) fn recorded_phi(&self, at: &RecordedSlots, out: &mut [Recorded]) {
        with!(AnyConstraint, &self.element, element, S => {
            let (x, _, f) = at.of::<S>(&self.site);
            element.recorded().phi(&x, f, out);
        });
    }

    pub(crate) fn recorded_c(&self, at: &RecordedSlots, out: &mut [Recorded]) {
        with!(AnyConstraint, &self.element, element, S => {
            let (x, _, f) = at.of::<S>(&self.site);
            element.recorded().c(&x, f, out);
        });
    }

    pub(crate) fn recorded_b(&self, at: &RecordedSlots, out: &mut [Recorded]) {
        with!(AnyConstraint, &self.element, element, S => {
            let (x, _, f) = at.of::<S>(&self.site);
            element.recorded().b(&x, f, out);
        });
    }

    pub(crate) fn recorded_gamma(&self, at: &RecordedSlots, out: &mut [Recorded]) {
        with!(AnyConstraint, &self.element, element, S => {
            let (x, v, f) = at.of::<S>(&self.site);
            element.recorded().gamma(&x, &v, f, out);
        });
    }
}

/// A force with its indices in the mechanism.
#[derive(Clone)]
pub(crate) struct PlacedForce {
    pub(crate) name: String,
    element: AnyForce,
    pub(crate) site: Site,
    /// Column of Q for each value of the kernel; `None` for the ground.
    pub(crate) columns: Vec<Option<usize>>,
}

impl PlacedForce {
    pub(crate) fn new(name: &str, element: AnyForce, site: Site) -> Self {
        let columns = element.spec().q.iter().map(|&k| site.column(k));
        Self {
            name: name.to_owned(),
            columns: columns.collect(),
            element,
            site,
        }
    }

    pub(crate) fn kernels(&self) -> &AnyForce {
        &self.element
    }

    pub(crate) fn spec(&self) -> &'static ForceSpec {
        self.element.spec()
    }

    pub(crate) fn points(&self) -> Vec<[f64; 3]> {
        self.element.points()
    }

    pub(crate) fn is_law(&self) -> bool {
        with!(AnyForce, &self.element, element, _S => element.is_law())
    }

    pub(crate) fn initialise(&mut self, bodies: &Bodies) {
        with!(AnyForce, &mut self.element, element, S => {
            element.initialise(&self.site.poses::<S, f64>(bodies));
        });
    }

    /// The first requirement of its definition that is not met at these poses.
    pub(crate) fn unmet_requirement(&self, bodies: &Bodies) -> Option<&'static str> {
        let words = self.spec().common.requirements;
        let unmet = with!(AnyForce, &self.element, element, S => {
            let x = self.site.poses::<S, f64>(bodies);
            (0..words.len()).find(|&k| !element.requirement(k, &x))
        })?;
        Some(words[unmet])
    }

    #[inline]
    pub(crate) fn q(&self, s: &Slots, out: &mut [f64]) {
        with!(AnyForce, &self.element, element, S => {
            let (x, v, f) = (self.site.x::<S>(s), self.site.v::<S>(&s.rates), self.site.f(s));
            element.q(x, v, f, out);
        });
    }

    pub(crate) fn dq_dx(&self, s: &Slots, out: &mut [f64]) {
        with!(AnyForce, &self.element, element, S => {
            let (x, v, f) = (self.site.x::<S>(s), self.site.v::<S>(&s.rates), self.site.f(s));
            element.dq_dx(x, v, f, out);
        });
    }

    pub(crate) fn dq_dv(&self, s: &Slots, out: &mut [f64]) {
        with!(AnyForce, &self.element, element, S => {
            let (x, v, f) = (self.site.x::<S>(s), self.site.v::<S>(&s.rates), self.site.f(s));
            element.dq_dv(x, v, f, out);
        });
    }

    /// The force along the measure of a drive by a law.
    pub(crate) fn drive(&self, s: &Slots) -> Option<DriveForce> {
        with!(AnyForce, &self.element, element, S => {
            let (x, v, f) = (self.site.x::<S>(s), self.site.v::<S>(&s.rates), self.site.f(s));
            element.drive(x, v, f)
        })
    }

    pub(crate) fn recorded_q(&self, at: &RecordedSlots, out: &mut [Recorded]) {
        with!(AnyForce, &self.element, element, S => {
            let (x, v, f) = at.of::<S>(&self.site);
            element.recorded().q(&x, &v, f, out);
        });
    }
}

/// Poses, twists and functions of time of one element.
type Arguments<'a, S> = (
    Vec<<S as joints::Space>::Pose<Recorded>>,
    Vec<<S as joints::Space>::Twist<Recorded>>,
    &'a [[Recorded; 3]],
);

/// Poses and twists of all bodies, and functions of time, as inputs of a recording.
pub(crate) struct RecordedSlots {
    poses: Poses<Recorded>,
    twists: Twists<Recorded>,
    jets: Vec<[Recorded; 3]>,
}

impl RecordedSlots {
    /// Inputs of a planar mechanism whose coordinates are positions and angles; `input` gives the
    /// number of each.
    pub(crate) fn new(
        bodies: usize,
        functions: usize,
        mut input: impl FnMut(Input) -> Recorded,
    ) -> Self {
        const N: usize = <crate::space::Plane as Space>::N_Q;
        let poses = (0..bodies).map(|k| Pose {
            x: input(Input::Coordinate(N * k)),
            y: input(Input::Coordinate(N * k + 1)),
            angle: input(Input::Coordinate(N * k + 2)),
            cos: input(Input::Cos(N * k + 2)),
            sin: input(Input::Sin(N * k + 2)),
        });
        let poses = InEach {
            plane: poses.collect(),
            space3: Vec::new(),
        };
        let twists = (0..bodies).map(|k| Twist {
            x: input(Input::Velocity(N * k)),
            y: input(Input::Velocity(N * k + 1)),
            omega: input(Input::Velocity(N * k + 2)),
        });
        let twists = InEach {
            plane: twists.collect(),
            space3: Vec::new(),
        };
        let jets = (0..functions).map(|function| {
            [0, 1, 2].map(|derivative| {
                input(Input::Function {
                    function,
                    derivative,
                })
            })
        });
        let jets = jets.collect();
        Self {
            poses,
            twists,
            jets,
        }
    }

    /// Poses, twists and functions of time of an element.
    fn of<S: Kinematics>(&self, site: &Site) -> Arguments<'_, S> {
        let rest = || S::twist(&[Recorded::from(0.0); 6]);
        let twist = |b: &BodyRef| b.moving().map_or_else(rest, |k| S::twists(&self.twists)[k]);
        (
            site.bodies
                .iter()
                .map(|&b| pose_of::<S, Recorded>(&self.poses, b))
                .collect(),
            site.bodies.iter().map(twist).collect(),
            &self.jets[site.functions.clone()],
        )
    }
}
