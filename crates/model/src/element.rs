//! Elements in a mechanism: the kernels of joints, drives and forces with the poses and velocities
//! of their bodies.
//!
//! This is the only place that knows in which form kernels take poses and velocities. The rest of
//! the crate asks a [`PlacedConstraint`] or a [`PlacedForce`], with [`Slots`], and asks [`Bodies`]
//! where a body is; an element with kernels of another form is added here.

use std::ops::Range;

use joints::spec::{ConstraintSpec, ForceSpec};
use joints::{
    Constraint, Derivatives, Element, Force, ForceElement, Magnitude, Pose, Recorded, Ring, Twist,
};
use linalg::Dd;

use crate::description::{Body, BodyRef};
use crate::law::DriveForce;
use crate::record::Input;
use crate::space::{Number, PlanarSpace, Space, SpaceKind, in_space};

/// The kernels of a constraint as a trait object: in `f64` for motion, and in other number types.
pub trait ConstraintKernels: Derivatives {
    /// Kernels for certificates.
    fn extended(&self) -> &dyn Element<Dd>;
    /// Kernels for bounds on the rounding of data.
    fn magnitude(&self) -> &dyn Element<Magnitude>;
    /// Kernels that record their operations.
    fn recorded(&self) -> &dyn Element<Recorded>;
    /// A copy.
    fn boxed(&self) -> Box<dyn ConstraintKernels>;
}

impl<K: Constraint> ConstraintKernels for K {
    fn extended(&self) -> &dyn Element<Dd> {
        self.element()
    }
    fn magnitude(&self) -> &dyn Element<Magnitude> {
        self.element()
    }
    fn recorded(&self) -> &dyn Element<Recorded> {
        self.element()
    }
    fn boxed(&self) -> Box<dyn ConstraintKernels> {
        Box::new(self.clone())
    }
}

impl Clone for Box<dyn ConstraintKernels> {
    fn clone(&self) -> Self {
        self.as_ref().boxed()
    }
}

/// The kernels of a force as a trait object.
pub trait ForceKernels: ForceElement {
    /// Kernels that record their operations.
    fn recorded(&self) -> &dyn ForceElement<Recorded>;
    /// A copy.
    fn boxed(&self) -> Box<dyn ForceKernels>;
    /// Whether this is a drive by a law.
    fn is_law(&self) -> bool {
        false
    }
    /// The force along the measure of a drive by a law.
    fn drive(&self, _x: &[Pose], _v: &[Twist], _f: &[[f64; 3]]) -> Option<DriveForce> {
        None
    }
}

impl<K: Force> ForceKernels for K {
    fn recorded(&self) -> &dyn ForceElement<Recorded> {
        self.element()
    }
    fn boxed(&self) -> Box<dyn ForceKernels> {
        Box::new(self.clone())
    }
}

impl Clone for Box<dyn ForceKernels> {
    fn clone(&self) -> Self {
        self.as_ref().boxed()
    }
}

/// Largest change by rounding of an angle that is held constant.
const HELD: f64 = 4.0 * f64::EPSILON;

/// The poses of all bodies of a mechanism: positions of their centres of mass, and orientations.
///
/// Methods panic if there is no such body.
#[derive(Clone, Debug)]
pub struct Bodies<T: Ring = f64> {
    poses: Vec<Pose<T>>,
    /// Angles for which sine and cosine were computed; NaN at the beginning.
    turned_to: Vec<f64>,
}

impl<T: Number> Bodies<T> {
    /// The poses at coordinates q; allocates.
    #[must_use]
    pub fn at(space: SpaceKind, q: &[T]) -> Self {
        let poses: Vec<Pose<T>> = in_space!(space, S => {
            q.chunks_exact(S::N_Q).map(pose::<S, T>).collect()
        });
        Self {
            turned_to: vec![f64::NAN; poses.len()],
            poses,
        }
    }
}

impl Bodies {
    pub(crate) fn new(count: usize) -> Self {
        Self {
            poses: vec![Pose::GROUND; count],
            turned_to: vec![f64::NAN; count],
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
        in_space!(space, S => {
            for (k, (pose, q)) in self.poses.iter_mut().zip(q.chunks_exact(S::N_Q)).enumerate() {
                (pose.x, pose.y, pose.angle) = (q[0], q[1], <S as PlanarSpace>::angle(q));
                if !stays(held[k], self.turned_to[k], pose.angle) {
                    self.turned_to[k] = pose.angle;
                    (pose.sin, pose.cos) = <S as PlanarSpace>::sin_cos(q);
                    turns();
                }
            }
        });
    }

    /// Number of bodies.
    #[must_use]
    pub fn len(&self) -> usize {
        self.poses.len()
    }

    /// Whether there is no body.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.poses.is_empty()
    }

    /// The centre of mass of a body (m), ground axes.
    #[must_use]
    pub fn origin(&self, body: usize) -> [f64; 3] {
        let pose = &self.poses[body];
        [pose.x, pose.y, 0.0]
    }

    /// The centres of mass of all bodies.
    pub fn origins(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        (0..self.len()).map(|body| self.origin(body))
    }

    /// The axes of a body as unit vectors in ground axes: the columns of its rotation matrix.
    #[must_use]
    pub fn axes(&self, body: usize) -> [[f64; 3]; 3] {
        let Pose { cos, sin, .. } = self.poses[body];
        [[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]]
    }

    /// A vector in the axes of a body, in ground axes.
    #[must_use]
    pub fn turned(&self, body: usize, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let Pose { cos, sin, .. } = self.poses[body];
        [cos * x - sin * y, sin * x + cos * y, z]
    }

    /// A point relative to the centre of mass of a body, in its axes, as a point of the ground.
    #[must_use]
    pub fn to_global(&self, body: usize, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let [x, y] = self.poses[body].to_global([x, y]);
        [x, y, z]
    }

    /// A point of the ground relative to the centre of mass of a body, in its axes.
    #[must_use]
    pub fn to_local(&self, body: usize, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let pose = &self.poses[body];
        let (dx, dy) = (x - pose.x, y - pose.y);
        let own = [pose.cos * dx + pose.sin * dy, pose.cos * dy - pose.sin * dx];
        [own[0], own[1], z]
    }

    /// The angle by which a body is turned against the ground (rad); in the plane not reduced to
    /// one revolution.
    #[must_use]
    pub fn angle(&self, body: usize) -> f64 {
        self.poses[body].angle
    }

    /// Position of a body along a freedom: a coordinate (m) or an angle (rad).
    pub(crate) fn position(&self, body: usize, dof: usize) -> f64 {
        let pose = &self.poses[body];
        match dof {
            0 => pose.x,
            1 => pose.y,
            _ => pose.angle,
        }
    }

    /// How far a body is from where it was (m), and by what angle it has turned (rad).
    #[must_use]
    pub fn moved(&self, from: &Self, body: usize) -> [f64; 2] {
        let (from, to) = (&from.poses[body], &self.poses[body]);
        [
            (to.x - from.x).hypot(to.y - from.y),
            (to.angle - from.angle).abs(),
        ]
    }
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

/// The angle of a body in the plane, from its own coordinates (rad), not reduced.
pub(crate) fn angle_at(space: SpaceKind, q: &[f64]) -> f64 {
    in_space!(space, S => <S as PlanarSpace>::angle(q))
}

/// A vector in the axes of a body, from its own coordinates, in ground axes.
pub(crate) fn turned_at(space: SpaceKind, q: &[f64], [x, y, z]: [f64; 3]) -> [f64; 3] {
    let (sin, cos) = in_space!(space, S => <S as PlanarSpace>::sin_cos(q));
    [cos * x - sin * y, sin * x + cos * y, z]
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

/// The pose of a body, taken from those of all.
fn pose_of<T: Ring>(poses: &[Pose<T>], body: BodyRef) -> Pose<T> {
    match body {
        BodyRef::Ground => Pose::GROUND.cast(),
        BodyRef::Body(k) => poses[k],
    }
}

/// The velocity of a body, taken from those of all.
fn twist_of(body: BodyRef, v: &[f64]) -> Twist {
    const N: usize = <crate::space::Plane as Space>::N_V;
    match body {
        BodyRef::Ground => Twist::zero(),
        BodyRef::Body(k) => {
            let [x, y, omega] = [0, 1, 2].map(|dof| v[N * k + dof]);
            Twist { x, y, omega }
        }
    }
}

/// Arguments of the kernels of all elements, one after the other: constraints, then forces.
#[derive(Clone, Debug)]
pub(crate) struct Slots {
    /// Poses of the bodies in their slots.
    poses: Vec<Pose>,
    /// Velocities of the same slots.
    pub(crate) rates: Rates,
    /// Values of the functions of time.
    pub(crate) jets: Vec<[f64; 3]>,
}

impl Slots {
    pub(crate) fn new(slots: usize, functions: usize) -> Self {
        Self {
            poses: vec![Pose::GROUND; slots],
            rates: Rates::zero(slots),
            jets: vec![[0.0; 3]; functions],
        }
    }

    /// Takes the poses of the bodies.
    #[inline]
    pub(crate) fn take<'a>(&mut self, sites: impl Iterator<Item = &'a Site>, bodies: &Bodies) {
        for site in sites {
            let slots = &mut self.poses[site.slots.clone()];
            for (pose, &body) in slots.iter_mut().zip(&site.bodies) {
                *pose = pose_of(&bodies.poses, body);
            }
        }
    }
}

/// Velocities or accelerations of slots.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rates(Vec<Twist>);

impl Rates {
    pub(crate) fn zero(slots: usize) -> Self {
        Self(vec![Twist::zero(); slots])
    }

    /// Takes velocities or accelerations of the bodies (n_v); those of the ground stay zero.
    #[inline]
    pub(crate) fn take<'a>(&mut self, sites: impl Iterator<Item = &'a Site>, v: &[f64]) {
        for site in sites {
            let twists = &mut self.0[site.slots.clone()];
            for (twist, &body) in twists.iter_mut().zip(&site.bodies) {
                if body != BodyRef::Ground {
                    *twist = twist_of(body, v);
                }
            }
        }
    }
}

/// Velocities of the slots of one constraint for [`PlacedConstraint::d_power_dp`].
#[derive(Clone, Debug, Default)]
pub(crate) struct OwnRates {
    own: Vec<Twist>,
    still: Vec<Twist>,
    no_f: Vec<[f64; 3]>,
}

impl OwnRates {
    /// Takes the constraint, with all its bodies at rest.
    fn still(&mut self, c: &PlacedConstraint) {
        let slots = c.site.bodies.len();
        self.own.clear();
        self.own.resize(slots, Twist::zero());
        self.still.resize(slots, Twist::zero());
        self.no_f.resize(c.site.functions.len(), [0.0; 3]);
    }

    /// Takes velocities or accelerations of all bodies (n_v).
    pub(crate) fn take(&mut self, c: &PlacedConstraint, v: &[f64]) {
        self.still(c);
        let bodies = self.own.iter_mut().zip(&c.site.bodies);
        bodies.for_each(|(twist, &body)| *twist = twist_of(body, v));
    }

    /// The body of one slot moves at 1 m/s or 1 rad/s along one of its freedoms, alone.
    pub(crate) fn unit(&mut self, c: &PlacedConstraint, slot: usize, dof: usize) {
        self.still(c);
        let twist = &mut self.own[slot];
        *match dof {
            0 => &mut twist.x,
            1 => &mut twist.y,
            _ => &mut twist.omega,
        } = 1.0;
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
    fn x<'s>(&self, all: &'s Slots) -> &'s [Pose] {
        &all.poses[self.slots.clone()]
    }

    /// Twists of its bodies.
    fn v<'s>(&self, all: &'s Rates) -> &'s [Twist] {
        &all.0[self.slots.clone()]
    }

    /// Values of its functions of time.
    pub(crate) fn f<'s>(&self, all: &'s Slots) -> &'s [[f64; 3]] {
        &all.jets[self.functions.clone()]
    }

    /// Poses of its bodies in any number type, from those of all bodies; allocates.
    fn poses<T: Ring>(&self, all: &Bodies<T>) -> Vec<Pose<T>> {
        let bodies = self.bodies.iter();
        bodies.map(|&b| pose_of(&all.poses, b)).collect()
    }

    /// Poses, twists and values of functions.
    fn xvf<'s>(&self, all: &'s Slots) -> (&'s [Pose], &'s [Twist], &'s [[f64; 3]]) {
        (self.x(all), self.v(&all.rates), self.f(all))
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
    element: Box<dyn ConstraintKernels>,
    pub(crate) site: Site,
    /// Its entries of C in the scratch.
    pub(crate) entries: Range<usize>,
    /// Indices of the varying entries, relative to `entries`.
    pub(crate) varying: Vec<usize>,
    pub(crate) rows: Range<usize>,
    /// Tolerance of its data (m), if stated.
    pub(crate) tolerance: Option<f64>,
}

impl PlacedConstraint {
    pub(crate) fn new(
        element: &dyn ConstraintKernels,
        site: Site,
        [entries, rows]: [Range<usize>; 2],
        tolerance: Option<f64>,
    ) -> Self {
        let all = element.spec().c.iter().enumerate();
        let varying = all.filter(|(_, e)| !e.constant).map(|(at, _)| at);
        Self {
            varying: varying.collect(),
            element: element.boxed(),
            site,
            entries,
            rows,
            tolerance,
        }
    }

    pub(crate) fn kernels(&self) -> &dyn ConstraintKernels {
        self.element.as_ref()
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
        self.element.spec().rheonomic
    }

    /// Whether Γ of its rows may differ from zero. C of the other rows is constant, so `C·v̇ = 0`.
    pub(crate) fn has_gamma(&self) -> bool {
        self.has_varying_entries() || self.depends_on_time()
    }

    pub(crate) fn points(&self) -> Vec<[f64; 2]> {
        self.element.points()
    }

    pub(crate) fn data(&self, out: &mut [f64]) {
        self.element.data(out);
    }

    pub(crate) fn initialise(&mut self, bodies: &Bodies) {
        self.element.initialise(&self.site.poses(bodies));
    }

    /// The first requirement of its definition that is not met at these poses.
    pub(crate) fn unmet_requirement(&self, bodies: &Bodies) -> Option<&'static str> {
        let (words, x) = (self.spec().common.requirements, self.site.poses(bodies));
        let unmet = (0..words.len()).find(|&k| !self.element.requirement(k, &x))?;
        Some(words[unmet])
    }

    #[inline]
    pub(crate) fn phi(&self, s: &Slots, out: &mut [f64]) {
        self.element.phi(self.site.x(s), self.site.f(s), out);
    }

    /// Entries of C that depend on parameters only; the others are left as they are.
    pub(crate) fn c_constant(&self, out: &mut [f64]) {
        self.element.c_constant(out);
    }

    #[inline]
    pub(crate) fn c(&self, s: &Slots, out: &mut [f64]) {
        self.element.c(self.site.x(s), self.site.f(s), out);
    }

    #[inline]
    pub(crate) fn b(&self, s: &Slots, out: &mut [f64]) {
        self.element.b(self.site.x(s), self.site.f(s), out);
    }

    #[inline]
    pub(crate) fn gamma(&self, s: &Slots, out: &mut [f64]) {
        let (x, v, f) = self.site.xvf(s);
        self.element.gamma(x, v, f, out);
    }

    #[inline]
    pub(crate) fn wrench(&self, s: &Slots, out: &mut [f64]) {
        self.element.wrench(self.site.x(s), self.site.f(s), out);
    }

    #[inline]
    pub(crate) fn component(&self, s: &Slots, out: &mut [f64]) {
        self.element.component(self.site.x(s), self.site.f(s), out);
    }

    /// The place of its reaction (m), ground axes.
    pub(crate) fn place(&self, s: &Slots) -> [f64; 3] {
        let [x, y] = self.element.place(self.site.x(s));
        [x, y, 0.0]
    }

    /// The origin of its first body (m), ground axes.
    pub(crate) fn first_origin(&self, s: &Slots) -> [f64; 3] {
        let first = &self.site.x(s)[0];
        [first.x, first.y, 0.0]
    }

    pub(crate) fn d_force_dx(&self, s: &Slots, lambda: &[f64], out: &mut [f64]) {
        let (x, f) = (self.site.x(s), self.site.f(s));
        self.element.d_force_dx(x, f, lambda, out);
    }

    pub(crate) fn d_residual_dx(&self, s: &Slots, a: &Rates, out: &mut [f64]) {
        let (x, v, f) = self.site.xvf(s);
        self.element.d_residual_dx(x, v, self.site.v(a), f, out);
    }

    pub(crate) fn d_gamma_dv(&self, s: &Slots, out: &mut [f64]) {
        let (x, v, f) = self.site.xvf(s);
        self.element.d_gamma_dv(x, v, f, out);
    }

    pub(crate) fn d_velocity_dx(&self, s: &Slots, out: &mut [f64]) {
        let (x, v, f) = self.site.xvf(s);
        self.element.d_velocity_dx(x, v, f, out);
    }

    /// Gradient of `λᵀ·Φ` with respect to its numbers.
    pub(crate) fn d_phi_dp(&self, s: &Slots, lambda: &[f64], out: &mut [f64]) {
        let (x, f) = (self.site.x(s), self.site.f(s));
        self.element.d_phi_dp(x, f, lambda, out);
    }

    /// Gradient of `λᵀ·(C·a − Γ)` with respect to its numbers.
    pub(crate) fn d_residual_dp(&self, s: &Slots, a: &OwnRates, lambda: &[f64], out: &mut [f64]) {
        let (x, v, f) = self.site.xvf(s);
        self.element.d_residual_dp(x, v, &a.own, f, lambda, out);
    }

    /// Gradient of `λᵀ·C·v` with respect to its numbers: without velocities and functions of time Γ
    /// vanishes.
    pub(crate) fn d_power_dp(&self, s: &Slots, v: &OwnRates, lambda: &[f64], out: &mut [f64]) {
        let OwnRates { own, still, no_f } = v;
        let x = self.site.x(s);
        self.element.d_residual_dp(x, still, own, no_f, lambda, out);
    }

    /// Φ in double-double, with all functions of time of the mechanism.
    pub(crate) fn extended_phi(&self, bodies: &Bodies<Dd>, jets: &[[Dd; 3]], out: &mut [Dd]) {
        let (x, f) = (self.site.poses(bodies), &jets[self.site.functions.clone()]);
        self.element.extended().phi(&x, f, out);
    }

    /// C in double-double.
    pub(crate) fn extended_c(&self, bodies: &Bodies<Dd>, jets: &[[Dd; 3]], out: &mut [Dd]) {
        let (x, f) = (self.site.poses(bodies), &jets[self.site.functions.clone()]);
        self.element.extended().c(&x, f, out);
    }

    /// Sizes of the terms of C.
    pub(crate) fn magnitude_c(&self, s: &Slots, out: &mut [Magnitude]) {
        let x: Vec<Pose<Magnitude>> = self.site.x(s).iter().map(magnitude).collect();
        let jets = self.site.f(s).iter();
        let f: Vec<[Magnitude; 3]> = jets.map(|jet| jet.map(Magnitude::from)).collect();
        self.element.magnitude().c(&x, &f, out);
    }

    pub(crate) fn recorded_phi(&self, at: &RecordedSlots, out: &mut [Recorded]) {
        let (x, _, f) = at.of(&self.site);
        self.element.recorded().phi(&x, f, out);
    }

    pub(crate) fn recorded_c(&self, at: &RecordedSlots, out: &mut [Recorded]) {
        let (x, _, f) = at.of(&self.site);
        self.element.recorded().c(&x, f, out);
    }

    pub(crate) fn recorded_b(&self, at: &RecordedSlots, out: &mut [Recorded]) {
        let (x, _, f) = at.of(&self.site);
        self.element.recorded().b(&x, f, out);
    }

    pub(crate) fn recorded_gamma(&self, at: &RecordedSlots, out: &mut [Recorded]) {
        let (x, v, f) = at.of(&self.site);
        self.element.recorded().gamma(&x, &v, f, out);
    }
}

/// Sizes of the contributions of a pose to a polynomial; cosine and sine are accurate to the
/// rounding of their angle.
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

/// A force with its indices in the mechanism.
#[derive(Clone)]
pub(crate) struct PlacedForce {
    pub(crate) name: String,
    element: Box<dyn ForceKernels>,
    pub(crate) site: Site,
    /// Column of Q for each value of the kernel; `None` for the ground.
    pub(crate) columns: Vec<Option<usize>>,
}

impl PlacedForce {
    pub(crate) fn new(name: &str, element: &dyn ForceKernels, site: Site) -> Self {
        let columns = element.spec().q.iter().map(|&k| site.column(k));
        Self {
            name: name.to_owned(),
            columns: columns.collect(),
            element: element.boxed(),
            site,
        }
    }

    pub(crate) fn kernels(&self) -> &dyn ForceKernels {
        self.element.as_ref()
    }

    pub(crate) fn spec(&self) -> &'static ForceSpec {
        self.element.spec()
    }

    pub(crate) fn points(&self) -> Vec<[f64; 2]> {
        self.element.points()
    }

    pub(crate) fn is_law(&self) -> bool {
        self.element.is_law()
    }

    pub(crate) fn initialise(&mut self, bodies: &Bodies) {
        self.element.initialise(&self.site.poses(bodies));
    }

    /// The first requirement of its definition that is not met at these poses.
    pub(crate) fn unmet_requirement(&self, bodies: &Bodies) -> Option<&'static str> {
        let (words, x) = (self.spec().common.requirements, self.site.poses(bodies));
        let unmet = (0..words.len()).find(|&k| !self.element.requirement(k, &x))?;
        Some(words[unmet])
    }

    #[inline]
    pub(crate) fn q(&self, s: &Slots, out: &mut [f64]) {
        let (x, v, f) = self.site.xvf(s);
        self.element.q(x, v, f, out);
    }

    pub(crate) fn dq_dx(&self, s: &Slots, out: &mut [f64]) {
        let (x, v, f) = self.site.xvf(s);
        self.element.dq_dx(x, v, f, out);
    }

    pub(crate) fn dq_dv(&self, s: &Slots, out: &mut [f64]) {
        let (x, v, f) = self.site.xvf(s);
        self.element.dq_dv(x, v, f, out);
    }

    /// The force along the measure of a drive by a law.
    pub(crate) fn drive(&self, s: &Slots) -> Option<DriveForce> {
        let (x, v, f) = self.site.xvf(s);
        self.element.drive(x, v, f)
    }

    pub(crate) fn recorded_q(&self, at: &RecordedSlots, out: &mut [Recorded]) {
        let (x, v, f) = at.of(&self.site);
        self.element.recorded().q(&x, &v, f, out);
    }
}

/// Poses, twists and functions of time of one element.
type Arguments<'a> = (
    Vec<Pose<Recorded>>,
    Vec<Twist<Recorded>>,
    &'a [[Recorded; 3]],
);

/// Poses and twists of all bodies, and functions of time, as inputs of a recording.
pub(crate) struct RecordedSlots {
    poses: Vec<Pose<Recorded>>,
    twists: Vec<Twist<Recorded>>,
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
        let poses = poses.collect();
        let twists = (0..bodies).map(|k| Twist {
            x: input(Input::Velocity(N * k)),
            y: input(Input::Velocity(N * k + 1)),
            omega: input(Input::Velocity(N * k + 2)),
        });
        let twists = twists.collect();
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
    fn of(&self, site: &Site) -> Arguments<'_> {
        let twist = |b: &BodyRef| b.moving().map_or(Twist::zero(), |k| self.twists[k]);
        (
            site.bodies
                .iter()
                .map(|&b| pose_of(&self.poses, b))
                .collect(),
            site.bodies.iter().map(twist).collect(),
            &self.jets[site.functions.clone()],
        )
    }
}
