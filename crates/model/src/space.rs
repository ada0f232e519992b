//! Spaces: how the pose of a body follows from its coordinates, and how a configuration moves along
//! velocities.
//!
//! Coordinates and velocities are different: a body has n_q coordinates and n_v velocities, and no
//! code outside this module adds a velocity to a coordinate. A configuration is moved by
//! [`Space::displace`] and compared by [`Space::difference`], both in the directions of velocities:
//! `(x, y)` along the axes of the ground, then the rotation.
//!
//! Constraints and their kernels use poses and twists only.

use std::ops::Range;

use joints::Ring;
use linalg::Dd;

/// Largest number of coordinates of a body.
const MOST_COORDINATES: usize = 7;

/// A number type with angles.
pub trait Number: Ring + std::ops::Div<Output = Self> {
    /// √self
    #[must_use]
    fn root(self) -> Self;

    /// The nearest `f64`.
    #[must_use]
    fn nearest(self) -> f64;

    /// Sine and cosine.
    #[must_use]
    fn sin_cos(self) -> (Self, Self);

    /// The angle of the direction (x, y), from −π to π.
    #[must_use]
    fn atan2(y: Self, x: Self) -> Self;

    /// The vector (x, y) scaled to length one; it must not be zero.
    #[must_use]
    fn normalised(x: Self, y: Self) -> (Self, Self);
}

impl Number for f64 {
    fn root(self) -> Self {
        self.sqrt()
    }

    fn nearest(self) -> f64 {
        self
    }

    fn sin_cos(self) -> (Self, Self) {
        f64::sin_cos(self)
    }

    fn atan2(y: Self, x: Self) -> Self {
        y.atan2(x)
    }

    fn normalised(x: Self, y: Self) -> (Self, Self) {
        let length = x.hypot(y);
        (x / length, y / length)
    }
}

impl Number for Dd {
    fn root(self) -> Self {
        self.sqrt()
    }

    fn nearest(self) -> f64 {
        self.to_f64()
    }

    fn sin_cos(self) -> (Self, Self) {
        Dd::sin_cos(self)
    }

    /// The angle in `f64`, corrected by the remaining angle, whose square is below the last digit.
    fn atan2(y: Self, x: Self) -> Self {
        let (x, y) = Self::normalised(x, y);
        let near = Self::from(y.to_f64().atan2(x.to_f64()));
        let (sin, cos) = near.sin_cos();
        near + (y * cos - x * sin)
    }

    fn normalised(x: Self, y: Self) -> (Self, Self) {
        let length = (x * x + y * y).sqrt();
        (x / length, y / length)
    }
}

/// A space in which bodies move. All slices belong to one body: `q` has [`Space::N_Q`] values, `v`
/// and `d` have [`Space::N_V`], of which the translations come first. A force on a body has a
/// component for each translation, a torque one for each rotation.
pub trait Space {
    /// Number of coordinates of a body; the position comes first.
    const N_Q: usize;

    /// Number of velocities of a body.
    const N_V: usize;

    /// Number of its velocities that are translations.
    const N_TRANSLATIONS: usize;

    /// Names of the coordinates.
    const COORDINATES: &'static [&'static str];

    /// Names of the numbers that are written of a frame: its place and orientation, then its
    /// [`Space::N_V`] velocities.
    const COLUMNS: &'static [&'static str];

    /// Names of the directions in which a body moves, in the order of its velocities.
    const DIRECTIONS: &'static [&'static str];

    /// Names of the components of a force and a torque, in the order of the velocities.
    const COMPONENTS: &'static [&'static str];

    /// Their names in the axes of a body.
    const BODY_COMPONENTS: &'static [&'static str];

    /// Their names in axes of which the first is the direction of the only force of a joint.
    const EDGE_COMPONENTS: &'static [&'static str];

    /// Position of a body in the direction of one freedom: a coordinate (m) or an angle (rad).
    #[must_use]
    fn position(q: &[f64], dof: usize) -> f64;

    /// q̇ = T(q)·v.
    fn rate(q: &[f64], v: &[f64], qd: &mut [f64]);

    /// The velocity of one freedom, below [`Space::N_V`], as factors of q̇ = T(q)·v; components of
    /// q̇ that change no pose are ignored. Factors beyond the coordinates are zero.
    #[must_use]
    fn velocity_from_rate(q: &[f64], dof: usize) -> [f64; MOST_COORDINATES];

    /// The unit direction of q̇ along which no pose changes; `None` if every q̇ belongs to a
    /// velocity.
    #[must_use]
    fn normal(_q: &[f64]) -> Option<[f64; MOST_COORDINATES]> {
        None
    }

    /// Moves q by d: a translation along the axes of the ground (m), and a rotation (rad).
    fn displace<T: Number>(q: &mut [T], d: &[T]);

    /// The d by which [`Space::displace`] moves `from` to `q`.
    fn difference(q: &[f64], from: &[f64], d: &mut [f64]);

    /// Copies one freedom of velocity from another configuration exactly; a difference would be
    /// rounded.
    fn take(q: &mut [f64], from: &[f64], dof: usize);
}

/// A space whose bodies have planar poses, whatever their coordinates are.
pub trait PlanarSpace: Space {
    /// The angle of a body (rad).
    #[must_use]
    fn angle<T: Number>(q: &[T]) -> T;

    /// Sine and cosine of this angle.
    #[must_use]
    fn sin_cos<T: Number>(q: &[T]) -> (T, T);
}

/// Numbers that are written of a planar frame.
const PLANE_COLUMNS: &[&str] = &["x", "y", "angle", "vx", "vy", "omega"];
const PLANE_DIRECTIONS: &[&str] = &["x", "y", "angle"];
const PLANE_COMPONENTS: &[&str] = &["Fx", "Fy", "T"];
const PLANE_BODY_COMPONENTS: &[&str] = &["Fx'", "Fy'", "T"];
const PLANE_EDGE_COMPONENTS: &[&str] = &["Fn", "Ft", "T"];

/// The plane: q = (x, y, φ), q̇ = v.
#[derive(Clone, Copy, Debug)]
pub struct Plane;

impl Space for Plane {
    const N_Q: usize = 3;
    const N_V: usize = 3;
    const N_TRANSLATIONS: usize = 2;
    const COORDINATES: &'static [&'static str] = &["x", "y", "angle"];
    const COLUMNS: &'static [&'static str] = PLANE_COLUMNS;
    const DIRECTIONS: &'static [&'static str] = PLANE_DIRECTIONS;
    const COMPONENTS: &'static [&'static str] = PLANE_COMPONENTS;
    const BODY_COMPONENTS: &'static [&'static str] = PLANE_BODY_COMPONENTS;
    const EDGE_COMPONENTS: &'static [&'static str] = PLANE_EDGE_COMPONENTS;

    fn position(q: &[f64], dof: usize) -> f64 {
        q[dof]
    }

    fn rate(_q: &[f64], v: &[f64], qd: &mut [f64]) {
        qd.copy_from_slice(v);
    }

    fn velocity_from_rate(_q: &[f64], dof: usize) -> [f64; MOST_COORDINATES] {
        std::array::from_fn(|k| if k == dof { 1.0 } else { 0.0 })
    }

    fn displace<T: Number>(q: &mut [T], d: &[T]) {
        for (q, d) in q.iter_mut().zip(d) {
            *q = *q + *d;
        }
    }

    fn difference(q: &[f64], from: &[f64], d: &mut [f64]) {
        for (d, (q, from)) in d.iter_mut().zip(q.iter().zip(from)) {
            *d = q - from;
        }
    }

    fn take(q: &mut [f64], from: &[f64], dof: usize) {
        q[dof] = from[dof];
    }
}

impl PlanarSpace for Plane {
    fn angle<T: Number>(q: &[T]) -> T {
        q[2]
    }

    fn sin_cos<T: Number>(q: &[T]) -> (T, T) {
        q[2].sin_cos()
    }
}

/// The plane with a point of the unit circle instead of the angle: q = (x, y, cos φ, sin φ), n_q =
/// 4. Only for tests: a space in which coordinates and velocities differ, as quaternions and
/// angular velocities do.
///
/// Only the direction of (c, s) counts, so a stage of an integrator may leave the circle; a
/// displacement keeps the point on the circle. Angles are determined up to full revolutions, so
/// rows that measure them are valid within half a revolution only.
#[cfg(feature = "unit-circle")]
#[derive(Clone, Copy, Debug)]
pub struct UnitCircle;

#[cfg(feature = "unit-circle")]
impl Space for UnitCircle {
    const N_Q: usize = 4;
    const N_V: usize = 3;
    const N_TRANSLATIONS: usize = 2;
    const COORDINATES: &'static [&'static str] = &["x", "y", "cosine", "sine"];
    const COLUMNS: &'static [&'static str] = PLANE_COLUMNS;
    const DIRECTIONS: &'static [&'static str] = PLANE_DIRECTIONS;
    const COMPONENTS: &'static [&'static str] = PLANE_COMPONENTS;
    const BODY_COMPONENTS: &'static [&'static str] = PLANE_BODY_COMPONENTS;
    const EDGE_COMPONENTS: &'static [&'static str] = PLANE_EDGE_COMPONENTS;

    fn position(q: &[f64], dof: usize) -> f64 {
        match dof {
            2 => Self::angle(q),
            _ => q[dof],
        }
    }

    fn rate(q: &[f64], v: &[f64], qd: &mut [f64]) {
        qd.copy_from_slice(&[v[0], v[1], -q[3] * v[2], q[2] * v[2]]);
    }

    fn velocity_from_rate(q: &[f64], dof: usize) -> [f64; MOST_COORDINATES] {
        let [c, s] = [q[2], q[3]];
        let square = c * c + s * s;
        match dof {
            2 => [0.0, 0.0, -s / square, c / square, 0.0, 0.0, 0.0],
            _ => std::array::from_fn(|k| if k == dof { 1.0 } else { 0.0 }),
        }
    }

    fn normal(q: &[f64]) -> Option<[f64; MOST_COORDINATES]> {
        let (c, s) = f64::normalised(q[2], q[3]);
        Some([0.0, 0.0, c, s, 0.0, 0.0, 0.0])
    }

    fn displace<T: Number>(q: &mut [T], d: &[T]) {
        q[0] = q[0] + d[0];
        q[1] = q[1] + d[1];
        let (sin, cos) = d[2].sin_cos();
        let turned = (q[2] * cos - q[3] * sin, q[3] * cos + q[2] * sin);
        (q[2], q[3]) = T::normalised(turned.0, turned.1);
    }

    fn difference(q: &[f64], from: &[f64], d: &mut [f64]) {
        let along = q[2] * from[2] + q[3] * from[3];
        let across = q[3] * from[2] - q[2] * from[3];
        d.copy_from_slice(&[q[0] - from[0], q[1] - from[1], across.atan2(along)]);
    }

    fn take(q: &mut [f64], from: &[f64], dof: usize) {
        match dof {
            2 => q[2..4].copy_from_slice(&from[2..4]),
            _ => q[dof] = from[dof],
        }
    }
}

#[cfg(feature = "unit-circle")]
impl PlanarSpace for UnitCircle {
    fn angle<T: Number>(q: &[T]) -> T {
        T::atan2(q[3], q[2])
    }

    fn sin_cos<T: Number>(q: &[T]) -> (T, T) {
        let (cos, sin) = T::normalised(q[2], q[3]);
        (sin, cos)
    }
}

/// Space: q = (x, y, z, w, x', y', z') with the quaternion of the axes of the body, v = (ẋ, ẏ, ż,
/// ω) with ω in these axes.
///
/// Only the direction of the quaternion counts, so a stage of an integrator may leave the sphere; a
/// displacement keeps it on the sphere. A quaternion and its negative are one pose.
#[derive(Clone, Copy, Debug)]
pub struct Space3;

impl Space for Space3 {
    const N_Q: usize = 7;
    const N_V: usize = 6;
    const N_TRANSLATIONS: usize = 3;
    const COORDINATES: &'static [&'static str] = &["x", "y", "z", "qw", "qx", "qy", "qz"];
    const COLUMNS: &'static [&'static str] = &[
        "x", "y", "z", "qw", "qx", "qy", "qz", "vx", "vy", "vz", "wx", "wy", "wz",
    ];
    const DIRECTIONS: &'static [&'static str] = &[
        "x",
        "y",
        "z",
        "rotation about x",
        "rotation about y",
        "rotation about z",
    ];
    const COMPONENTS: &'static [&'static str] = &["Fx", "Fy", "Fz", "Tx", "Ty", "Tz"];
    const BODY_COMPONENTS: &'static [&'static str] = &["Fx'", "Fy'", "Fz'", "Tx'", "Ty'", "Tz'"];
    const EDGE_COMPONENTS: &'static [&'static str] = &["Fn", "Ft", "Fb", "Tn", "Tt", "Tb"];

    /// A rotation has no angle that goes on over full turns: it counts as none.
    fn position(q: &[f64], dof: usize) -> f64 {
        if dof < 3 { q[dof] } else { 0.0 }
    }

    /// ė = ½·e∘(0, ω)
    fn rate(q: &[f64], v: &[f64], qd: &mut [f64]) {
        qd[..3].copy_from_slice(&v[..3]);
        let half = quaternion_product(quaternion(q), [0.0, v[3], v[4], v[5]]);
        for (qd, e) in qd[3..].iter_mut().zip(half) {
            *qd = 0.5 * e;
        }
    }

    /// ω = 2·ē∘ė/|e|², its vector part.
    fn velocity_from_rate(q: &[f64], dof: usize) -> [f64; MOST_COORDINATES] {
        let [w, x, y, z] = quaternion(q);
        let twice = 2.0 / (w * w + x * x + y * y + z * z);
        let of_rates = match dof {
            3 => [-x, w, z, -y],
            4 => [-y, -z, w, x],
            5 => [-z, y, -x, w],
            _ => return std::array::from_fn(|k| if k == dof { 1.0 } else { 0.0 }),
        };
        let [a, b, c, d] = of_rates.map(|e| twice * e);
        [0.0, 0.0, 0.0, a, b, c, d]
    }

    fn normal(q: &[f64]) -> Option<[f64; MOST_COORDINATES]> {
        let [w, x, y, z] = normalised(quaternion(q));
        Some([0.0, 0.0, 0.0, w, x, y, z])
    }

    /// e∘exp(½·θ), with θ the rotation vector in the axes of the body.
    fn displace<T: Number>(q: &mut [T], d: &[T]) {
        for (q, d) in q.iter_mut().zip(&d[..3]) {
            *q = *q + *d;
        }
        let turned = quaternion_product(quaternion(q), exponential([d[3], d[4], d[5]]));
        q[3..].copy_from_slice(&normalised(turned));
    }

    fn difference(q: &[f64], from: &[f64], d: &mut [f64]) {
        for k in 0..3 {
            d[k] = q[k] - from[k];
        }
        let [w, x, y, z] = quaternion(from);
        let [w, x, y, z] = quaternion_product([w, -x, -y, -z], quaternion(q));
        // Of a quaternion and its negative, the one of the shorter way.
        let sign = 1.0_f64.copysign(w);
        let length = norm(&[x, y, z]);
        let angle = 2.0 * length.atan2(w.abs());
        // 2/w at the limit, where the angle is the double of the sine.
        let factor = if length > 0.0 { angle / length } else { 0.0 };
        for (d, e) in d[3..].iter_mut().zip([x, y, z]) {
            *d = sign * factor * e;
        }
    }

    /// The first rotation takes the whole orientation, the others nothing more: rotations are kept
    /// together.
    fn take(q: &mut [f64], from: &[f64], dof: usize) {
        match dof {
            0..3 => q[dof] = from[dof],
            3 => q[3..7].copy_from_slice(&from[3..7]),
            _ => {}
        }
    }
}

/// The quaternion (w, x, y, z) among the coordinates of a spatial body.
pub(crate) fn quaternion<T: Copy>(q: &[T]) -> [T; 4] {
    [q[3], q[4], q[5], q[6]]
}

/// a∘b
pub(crate) fn quaternion_product<T: Ring>(a: [T; 4], b: [T; 4]) -> [T; 4] {
    let [aw, ax, ay, az] = a;
    let [bw, bx, by, bz] = b;
    [
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by + ay * bw + az * bx - ax * bz,
        aw * bz + az * bw + ax * by - ay * bx,
    ]
}

/// A quaternion scaled to length one; it must not be zero.
pub(crate) fn normalised<T: Number>(e: [T; 4]) -> [T; 4] {
    let [w, x, y, z] = e;
    let length = (w * w + x * x + y * y + z * z).root();
    e.map(|part| part / length)
}

/// Below this square of half an angle, sine and cosine are summed as series: six terms are exact to
/// the last digit of double-double there.
const SERIES: f64 = 1e-4;

/// The unit quaternion of a rotation vector: (cos ½|θ|, sin ½|θ|·θ/|θ|).
fn exponential<T: Number>(turn: [T; 3]) -> [T; 4] {
    let [x, y, z] = turn;
    let square = (x * x + y * y + z * z) * T::from(0.25);
    // cos h and ½·sin(h)/h of h = ½·|θ|.
    let (cos, half_sinc) = if square.nearest() < SERIES {
        let series = |first: f64| {
            let mut sum = T::from(0.0);
            let mut term = T::from(1.0);
            for k in 0..8 {
                sum = sum + term;
                let n = 2.0 * f64::from(k) + first;
                term = -(term * square) / T::from(n * (n + 1.0));
            }
            sum
        };
        (series(1.0), T::from(0.5) * series(2.0))
    } else {
        let half = square.root();
        let (sin, cos) = half.sin_cos();
        (cos, T::from(0.5) * (sin / half))
    };
    [cos, half_sinc * x, half_sinc * y, half_sinc * z]
}

/// Axes in which the force of a reaction is expressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// The axes of the ground.
    Global,
    /// The axes of the first body of the joint; global for the ground.
    FirstBody,
    /// The only direction in which the joint can transmit a force, followed by the direction
    /// rotated by +90°: normal and along for a knife edge, across and along the axis for a slot.
    /// Joints with no row, or several rows, that have a force do not have this frame.
    Edge,
}

impl Frame {
    /// All frames.
    pub const ALL: [Self; 3] = [Self::Global, Self::FirstBody, Self::Edge];
}

/// The space of a mechanism.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SpaceKind {
    /// [`Plane`]
    #[default]
    Plane,
    /// [`Space3`]
    Space3,
    /// [`UnitCircle`]
    #[cfg(feature = "unit-circle")]
    UnitCircle,
}

/// Evaluates an expression in which `$space` is the type of a [`SpaceKind`].
macro_rules! in_space {
    ($kind:expr, $space:ident => $body:expr) => {
        match $kind {
            $crate::space::SpaceKind::Plane => {
                type $space = $crate::space::Plane;
                $body
            }
            $crate::space::SpaceKind::Space3 => {
                type $space = $crate::space::Space3;
                $body
            }
            #[cfg(feature = "unit-circle")]
            $crate::space::SpaceKind::UnitCircle => {
                type $space = $crate::space::UnitCircle;
                $body
            }
        }
    };
}
pub(crate) use in_space;

/// The same for the spaces whose bodies have planar poses; the second expression is that of space.
macro_rules! in_plane {
    ($kind:expr, $space:ident => $body:expr, $other:expr) => {
        match $kind {
            $crate::space::SpaceKind::Plane => {
                type $space = $crate::space::Plane;
                $body
            }
            #[cfg(feature = "unit-circle")]
            $crate::space::SpaceKind::UnitCircle => {
                type $space = $crate::space::UnitCircle;
                $body
            }
            $crate::space::SpaceKind::Space3 => $other,
        }
    };
}
pub(crate) use in_plane;

impl SpaceKind {
    /// Number of coordinates of a body.
    #[must_use]
    pub fn n_q(self) -> usize {
        in_space!(self, S => S::N_Q)
    }

    /// Number of velocities of a body, translations first: its columns of C, and the components of
    /// a force and a torque on it.
    #[must_use]
    pub fn n_v(self) -> usize {
        in_space!(self, S => S::N_V)
    }

    /// Number of these velocities that are translations, and components of a force.
    #[must_use]
    pub fn n_translations(self) -> usize {
        in_space!(self, S => S::N_TRANSLATIONS)
    }

    /// Number of these velocities that are rotations, and components of a torque.
    #[must_use]
    pub fn n_rotations(self) -> usize {
        in_space!(self, S => S::N_V - S::N_TRANSLATIONS)
    }

    /// The body that moves with a column of C.
    // The divisors are constants of each space: this is asked entry by entry.
    #[must_use]
    pub fn body_of(self, column: usize) -> usize {
        in_space!(self, S => column / S::N_V)
    }

    /// The freedom of this body, below [`Self::n_v`].
    #[must_use]
    pub fn dof_of(self, column: usize) -> usize {
        in_space!(self, S => column % S::N_V)
    }

    /// Whether a column of C is that of a rotation.
    #[must_use]
    pub fn is_rotation(self, column: usize) -> bool {
        in_space!(self, S => column % S::N_V >= S::N_TRANSLATIONS)
    }

    /// Columns of C of a body.
    #[must_use]
    pub fn columns_of(self, body: usize) -> Range<usize> {
        let n = self.n_v();
        n * body..n * (body + 1)
    }

    /// Columns of C of the translations of a body.
    #[must_use]
    pub fn translations_of(self, body: usize) -> Range<usize> {
        let first = self.n_v() * body;
        first..first + self.n_translations()
    }

    /// Columns of C of the rotations of a body.
    #[must_use]
    pub fn rotations_of(self, body: usize) -> Range<usize> {
        let first = self.n_v() * body;
        first + self.n_translations()..first + self.n_v()
    }

    /// Unit of motions along a column of C: `size` for lengths, one radian for angles.
    #[must_use]
    pub fn unit(self, column: usize, size: f64) -> f64 {
        if self.is_rotation(column) { 1.0 } else { size }
    }

    /// Names of the numbers that are written of a frame: its place and orientation, then its
    /// velocities.
    ///
    /// ```
    /// let plane = model::SpaceKind::Plane;
    /// assert_eq!(plane.columns(), ["x", "y", "angle", "vx", "vy", "omega"]);
    /// assert_eq!(plane.velocities(), ["vx", "vy", "omega"]);
    /// assert_eq!(plane.directions(), ["x", "y", "angle"]);
    /// assert_eq!(&plane.components()[plane.torques()], ["T"]);
    /// ```
    #[must_use]
    pub fn columns(self) -> &'static [&'static str] {
        in_space!(self, S => S::COLUMNS)
    }

    /// Names of the velocities of a body.
    #[must_use]
    pub fn velocities(self) -> &'static [&'static str] {
        in_space!(self, S => &S::COLUMNS[S::COLUMNS.len() - S::N_V..])
    }

    /// Names of the directions in which a body moves with its velocities.
    #[must_use]
    pub fn directions(self) -> &'static [&'static str] {
        in_space!(self, S => S::DIRECTIONS)
    }

    /// Names of the components of a force and a torque.
    #[must_use]
    pub fn components(self) -> &'static [&'static str] {
        in_space!(self, S => S::COMPONENTS)
    }

    /// Names of the components of a force and a torque in the axes of a frame.
    #[must_use]
    pub fn components_in(self, frame: Frame) -> &'static [&'static str] {
        in_space!(self, S => match frame {
            Frame::Global => S::COMPONENTS,
            Frame::FirstBody => S::BODY_COMPONENTS,
            Frame::Edge => S::EDGE_COMPONENTS,
        })
    }

    /// The component of this name in the axes of the ground.
    #[must_use]
    pub fn component(self, name: &str) -> Option<usize> {
        self.components()
            .iter()
            .position(|component| *component == name)
    }

    /// The axis of the ground, 0 for x to 2 for z, along or about which a component of a force or a
    /// torque acts.
    #[must_use]
    pub fn axis_of(self, component: usize) -> usize {
        if component < self.n_translations() {
            component
        } else {
            3 + component - self.n_v()
        }
    }

    /// The velocities of a body in one of the [`Self::n_v`] rigid motions: along an axis of the
    /// ground at 1 m/s, or about one, at this arm from it, at 1 rad/s. `axes` are those of the
    /// body, in ground components: angular velocities in space are in these axes.
    ///
    /// ```
    /// let plane = model::SpaceKind::Plane;
    /// assert_eq!(plane.rigid_motion(1, [2.0, 3.0, 0.0], [[0.0; 3]; 3]), [0.0, 1.0, 0.0]);
    /// assert_eq!(plane.rigid_motion(2, [2.0, 3.0, 0.0], [[0.0; 3]; 3]), [-3.0, 2.0, 1.0]);
    /// ```
    #[must_use]
    pub fn rigid_motion(self, motion: usize, arm: [f64; 3], axes: [[f64; 3]; 3]) -> Vec<f64> {
        let mut v = vec![0.0; self.n_v()];
        let axis = self.axis_of(motion);
        if self.torques().contains(&motion) {
            let moved = unit_cross(axis, arm);
            v[self.forces()].copy_from_slice(&moved[self.forces()]);
            if self.n_rotations() > 1 {
                for k in self.torques() {
                    v[k] = axes[self.axis_of(k)][axis];
                }
                return v;
            }
        }
        v[motion] = 1.0;
        v
    }

    /// The components of a force among [`Self::components`].
    #[must_use]
    pub fn forces(self) -> Range<usize> {
        0..self.n_translations()
    }

    /// The components of a torque among [`Self::components`].
    #[must_use]
    pub fn torques(self) -> Range<usize> {
        self.n_translations()..self.n_v()
    }

    /// Indices of the coordinates of a body in q.
    #[must_use]
    pub fn coordinates(self, body: usize) -> Range<usize> {
        let n = self.n_q();
        n * body..n * (body + 1)
    }

    /// Moves the configuration q by d (n_v).
    pub(crate) fn displace<T: Number>(self, q: &mut [T], d: &[T]) {
        in_space!(self, S => {
            for (q, d) in q.chunks_exact_mut(S::N_Q).zip(d.chunks_exact(S::N_V)) {
                S::displace(q, d);
            }
        });
    }

    /// A copy of q, moved by `factor` times d; allocates.
    #[must_use]
    pub fn displaced(self, q: &[f64], factor: f64, d: &[f64]) -> Vec<f64> {
        let mut moved = q.to_vec();
        let d: Vec<f64> = d.iter().map(|d| factor * d).collect();
        self.displace(&mut moved, &d);
        moved
    }

    /// The displacement (n_v) that moves the configuration `from` to q.
    pub(crate) fn difference(self, q: &[f64], from: &[f64], d: &mut [f64]) {
        in_space!(self, S => {
            let bodies = q.chunks_exact(S::N_Q).zip(from.chunks_exact(S::N_Q));
            for ((q, from), d) in bodies.zip(d.chunks_exact_mut(S::N_V)) {
                S::difference(q, from, d);
            }
        });
    }

    /// Like `difference`, as a vector; allocates.
    #[must_use]
    pub fn difference_of(self, q: &[f64], from: &[f64]) -> Vec<f64> {
        let mut d = vec![0.0; self.n_v() * (q.len() / self.n_q())];
        self.difference(q, from, &mut d);
        d
    }

    /// The column of C along which two configurations differ most, and the difference: lengths as a
    /// fraction of `size`, angles in radians.
    #[must_use]
    pub fn largest_difference(self, a: &[f64], b: &[f64], size: f64) -> (usize, f64) {
        let mut largest = (0, 0.0);
        let mut d = vec![0.0; self.n_v()];
        let n = self.n_q();
        for (body, (a, b)) in a.chunks_exact(n).zip(b.chunks_exact(n)).enumerate() {
            self.difference(a, b, &mut d);
            for (dof, d) in d.iter().enumerate() {
                let j = self.n_v() * body + dof;
                let difference = d.abs() / self.unit(j, size);
                if difference > largest.1 {
                    largest = (j, difference);
                }
            }
        }
        largest
    }

    /// Copies the freedoms of these columns of C from another configuration, exactly.
    pub fn take(self, q: &mut [f64], from: &[f64], columns: &[usize]) {
        in_space!(self, S => {
            for column in columns {
                let body = self.coordinates(column / S::N_V);
                S::take(&mut q[body.clone()], &from[body], column % S::N_V);
            }
        });
    }

    /// Writes the velocity of a column of C as a sum over q̇ at the configuration q to `terms`:
    /// indices of q̇ with their coefficients.
    pub fn read_velocity(self, q: &[f64], column: usize, terms: &mut Vec<(usize, f64)>) {
        let body = self.coordinates(self.body_of(column));
        let first = body.start;
        terms.clear();
        in_space!(self, S => {
            let factors = S::velocity_from_rate(&q[body], column % S::N_V);
            terms.extend(factors.into_iter().enumerate().filter(|(_, factor)| *factor != 0.0));
            terms.iter_mut().for_each(|(place, _)| *place += first);
        });
    }

    /// Unit directions of q̇ along which no pose changes at the configuration q: indices of q̇ with
    /// their entries.
    #[must_use]
    pub fn normals(self, q: &[f64]) -> Vec<Vec<(usize, f64)>> {
        in_space!(self, S => {
            let bodies = q.chunks_exact(S::N_Q).enumerate();
            let of_body = |(body, q): (usize, &[f64])| {
                let entries = S::normal(q)?.into_iter().enumerate();
                let places = entries.filter(|(_, entry)| *entry != 0.0);
                Some(places.map(|(k, entry)| (S::N_Q * body + k, entry)).collect())
            };
            bodies.filter_map(of_body).collect()
        })
    }

    /// Position of a body at coordinates q in the direction of a column of C: a coordinate (m) or
    /// an angle (rad).
    #[must_use]
    pub fn position(self, q: &[f64], column: usize) -> f64 {
        let own = &q[self.coordinates(self.body_of(column))];
        in_space!(self, S => S::position(own, column % S::N_V))
    }
}

/// The unit vector along an axis of the ground, 0 for x to 2 for z, times a vector: `e × a`, the
/// velocity at an arm of a body that turns at 1 rad/s about this axis.
#[must_use]
pub fn unit_cross(axis: usize, a: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| match (k + 3 - axis) % 3 {
        0 => 0.0,
        // Not `-a`: there is one zero.
        1 => 0.0 - a[(k + 1) % 3],
        _ => a[(k + 2) % 3],
    })
}

/// a − b
#[must_use]
pub fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a[k] - b[k])
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

/// Length of a vector with any number of components.
#[must_use]
pub fn norm(x: &[f64]) -> f64 {
    match x {
        [x, others @ ..] => others.iter().fold(x.abs(), |norm, x| match *x {
            // Most vectors of planar mechanisms have zeros; roots take time.
            0.0 => norm,
            x if norm == 0.0 => x.abs(),
            x => norm.hypot(x),
        }),
        [] => 0.0,
    }
}
