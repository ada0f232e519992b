//! Arguments of the kernels of all elements: poses and velocities of their bodies, and functions of
//! time.

use std::ops::Range;

use joints::plane::{Pose, Twist};
use joints::{Magnitude, Plane, Ring, Space3, space3};

use super::BodySpace;
use super::bodies::{Bodies, InEach, Poses, Twists, spatial_pose};
use super::turned::lent;
use crate::body::BodyRef;
use crate::called::Commands;
use crate::space::SpaceKind;

/// Largest number of bodies of an element for which no memory is allocated. No joint of the library
/// has more bodies.
const FEW: usize = 4;

/// A space whose kernels can be evaluated for the bodies of a mechanism.
pub(crate) trait Kinematics: BodySpace {
    fn ground<T: Ring>() -> Self::Pose<T>;
    fn poses<T: Ring>(all: &Poses<T>) -> &[Self::Pose<T>];
    fn poses_mut<T: Ring>(all: &mut Poses<T>) -> &mut [Self::Pose<T>];
    fn twists<T: Ring>(all: &Twists<T>) -> &[Self::Twist<T>];
    fn twists_mut<T: Ring>(all: &mut Twists<T>) -> &mut [Self::Twist<T>];
    /// Returns the sizes of those terms of a polynomial that depend on a pose.
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
    /// Cosine and sine are accurate to the rounding error of the angle.
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
    /// Every entry of a rotation matrix is accurate to the rounding error of 1.
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

/// The pose of a body in a space.
pub(crate) type PoseOf<S, T = f64> = <S as joints::Space>::Pose<T>;
/// The velocity of a body in a space.
pub(crate) type TwistOf<S, T = f64> = <S as joints::Space>::Twist<T>;

/// Returns the pose of a body, selected from the poses of all bodies.
pub(super) fn pose_of<S: Kinematics, T: Ring>(poses: &Poses<T>, body: BodyRef) -> S::Pose<T> {
    match body {
        BodyRef::Ground => S::ground(),
        BodyRef::Body(k) => S::poses(poses)[k],
    }
}

/// Returns the velocity of a body, selected from the velocities of all bodies.
fn twist_of<S: Kinematics>(body: BodyRef, v: &[f64]) -> S::Twist<f64> {
    match body {
        BodyRef::Ground => S::twist(&[0.0; 6]),
        BodyRef::Body(k) => S::twist(&v[S::N_DOF * k..S::N_DOF * (k + 1)]),
    }
}

/// Evaluates an expression in which `$kernels` denotes the kernel type of a [`SpaceKind`].
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

/// Arguments of the kernels of all elements in sequence: first the constraints, then the forces.
#[derive(Clone, Debug)]
pub(crate) struct Slots {
    space: SpaceKind,
    /// Poses of the bodies of each element.
    pub(super) poses: Poses<f64>,
    /// Velocities of these bodies.
    pub(crate) rates: Rates,
    /// Values of the functions of time and of the controllers.
    pub(crate) jets: Vec<[f64; 3]>,
    pub(crate) commands: Commands,
}

impl Slots {
    pub(crate) fn new(space: SpaceKind, slots: usize, functions: usize) -> Self {
        Self {
            space,
            poses: InEach::filled(space, slots, Pose::GROUND, space3::Pose::GROUND),
            rates: Rates::zero(space, slots),
            jets: vec![[0.0; 3]; functions],
            commands: Commands::default(),
        }
    }

    /// Sets the poses of the bodies.
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

impl Slots {
    /// Exchanges the pose and the velocity of one body of an element with another storage.
    pub(crate) fn exchange(&mut self, other: &mut Self, site: &Site, body: usize) {
        in_kernels!(self.space, S => {
            for (k, own) in site.slots.clone().zip(&site.bodies) {
                if own.moving() == Some(body) {
                    let poses = (&mut self.poses, &mut other.poses);
                    std::mem::swap(&mut S::poses_mut(poses.0)[k], &mut S::poses_mut(poses.1)[k]);
                    let rates = (&mut self.rates.twists, &mut other.rates.twists);
                    std::mem::swap(&mut S::twists_mut(rates.0)[k], &mut S::twists_mut(rates.1)[k]);
                }
            }
        });
    }
}

/// Velocities or accelerations of the bodies of each element.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rates {
    space: SpaceKind,
    pub(super) twists: Twists<f64>,
}

impl Rates {
    pub(crate) fn zero(space: SpaceKind, slots: usize) -> Self {
        let twists = InEach::filled(space, slots, Twist::zero(), space3::Twist::zero());
        Self { space, twists }
    }

    /// Sets velocities or accelerations of the bodies (n_v values). The values of the ground stay
    /// zero.
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

/// Indices of an element: its bodies, and its ranges in the lists of [`Slots`].
#[derive(Clone)]
pub(crate) struct Site {
    pub(crate) space: SpaceKind,
    pub(crate) bodies: Vec<BodyRef>,
    pub(crate) slots: Range<usize>,
    pub(crate) functions: Range<usize>,
}

impl Site {
    /// Returns the poses of the bodies of the element.
    pub(super) fn x<'s, S: Kinematics>(&self, all: &'s Slots) -> &'s [S::Pose<f64>] {
        &S::poses(&all.poses)[self.slots.clone()]
    }

    /// Returns the twists of the bodies of the element.
    pub(super) fn v<'s, S: Kinematics>(&self, all: &'s Rates) -> &'s [S::Twist<f64>] {
        &S::twists(&all.twists)[self.slots.clone()]
    }

    /// Calls a function with the poses of the bodies in space at the coordinates q, and with the
    /// twists of the bodies at velocities v or at rest.
    pub(crate) fn with_spatial<R>(
        &self,
        (q, v): (&[f64], Option<&[f64]>),
        use_them: impl FnOnce(&[space3::Pose], &[space3::Twist]) -> R,
    ) -> R {
        let n = self.bodies.len();
        let (mut few, mut many) = ([space3::Pose::GROUND; FEW], Vec::new());
        let x = lent(&mut few, &mut many, n);
        for (pose, body) in x.iter_mut().zip(&self.bodies) {
            let own = body.moving().map(|k| &q[SpaceKind::Space3.coordinates(k)]);
            *pose = own.map_or(space3::Pose::GROUND, spatial_pose);
        }
        let (mut few, mut many) = ([space3::Twist::zero(); FEW], Vec::new());
        let twists = lent(&mut few, &mut many, n);
        for (twist, &body) in twists.iter_mut().zip(&self.bodies) {
            *twist = v.map_or_else(space3::Twist::zero, |v| twist_of::<Space3>(body, v));
        }
        use_them(x, twists)
    }

    /// Returns the poses and twists of the bodies of the element in space.
    pub(crate) fn in_space<'s>(&self, all: &'s Slots) -> (&'s [space3::Pose], &'s [space3::Twist]) {
        (self.x::<Space3>(all), self.v::<Space3>(&all.rates))
    }

    /// Returns the values of the functions of time of the element.
    pub(crate) fn f<'s>(&self, all: &'s Slots) -> &'s [[f64; 3]] {
        &all.jets[self.functions.clone()]
    }

    /// Selects the poses of the bodies of the element from the poses of all bodies, in any number
    /// type. The function allocates memory.
    pub(super) fn poses<S: Kinematics, T: Ring>(&self, all: &Bodies<T>) -> Vec<S::Pose<T>> {
        let bodies = self.bodies.iter();
        bodies.map(|&b| pose_of::<S, T>(&all.poses, b)).collect()
    }

    /// Returns the bodies except the ground.
    pub(crate) fn moving(&self) -> impl Iterator<Item = usize> + '_ {
        self.bodies.iter().filter_map(|b| b.moving())
    }

    /// Selects the velocities or accelerations of the bodies of the element from the values of all
    /// bodies (n_v values). The selected values are zero for the ground.
    pub(crate) fn own_rates(&self, all: &[f64], out: &mut Vec<f64>) {
        out.clear();
        for body in &self.bodies {
            match body.moving() {
                Some(body) => out.extend_from_slice(&all[self.space.columns_of(body)]),
                None => out.resize(out.len() + self.space.n_v(), 0.0),
            }
        }
    }

    /// Converts a column of the block of the element to a column of C, or to `None` for the ground.
    pub(crate) fn column(&self, k: usize) -> Option<usize> {
        let body = self.bodies[self.space.body_of(k)].moving()?;
        Some(self.space.n_v() * body + self.space.dof_of(k))
    }
}
