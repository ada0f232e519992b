//! Properties of the coordinates and velocities of one body in the plane and in space.

use joints::Ring;

use super::number::Number;

/// Largest number of coordinates of a body.
pub(super) const MOST_COORDINATES: usize = 7;

/// A space in which bodies move. All slices belong to one body. `q` has [`Space::N_Q`] values, and
/// `v` and `d` have [`Space::N_V`] values each; translations come first. A force on a body has one
/// component for each translation, and a torque has one for each rotation.
pub trait Space {
    /// Number of coordinates of a body; the position comes first.
    const N_Q: usize;

    /// Number of velocity components of a body.
    const N_V: usize;

    /// Number of velocity components of a body that are translations.
    const N_TRANSLATIONS: usize;

    /// Names of the coordinates.
    const COORDINATES: &'static [&'static str];

    /// Names of the output values of a frame: first its position and orientation, then its
    /// [`Space::N_V`] velocity components.
    const COLUMNS: &'static [&'static str];

    /// Names of the output values of the accelerations of a frame, in the order of its velocity
    /// components.
    const ACCELERATIONS: &'static [&'static str];

    /// Names of the directions in which a body moves, in the order of its velocity components.
    const DIRECTIONS: &'static [&'static str];

    /// Names of the components of a force and a torque, in the order of the velocity components.
    const COMPONENTS: &'static [&'static str];

    /// Names of these components in the axes of the body.
    const BODY_COMPONENTS: &'static [&'static str];

    /// Names of these components in the axes of the joint.
    const JOINT_COMPONENTS: &'static [&'static str];

    /// Names of these components in axes whose first direction is that of the force, for joints
    /// with exactly one force.
    const EDGE_COMPONENTS: &'static [&'static str];

    /// Returns the position of a body for one velocity component. The position is a coordinate (m)
    /// or an angle (rad).
    #[must_use]
    fn position(q: &[f64], dof: usize) -> f64;

    /// Computes q̇ = T(q)·v.
    fn rate<T: Ring>(q: &[T], v: &[T], qd: &mut [T]);

    /// Returns one velocity component (index below [`Space::N_V`]) as a linear form of q̇ = T(q)·v.
    /// The result contains the coefficients of q̇. Components of q̇ that do not change the pose are
    /// ignored. Coefficients beyond the number of coordinates are zero.
    #[must_use]
    fn velocity_from_rate(q: &[f64], dof: usize) -> [f64; MOST_COORDINATES];

    /// Returns the unit direction of q̇ that does not change the pose, or `None` if every q̇
    /// changes the pose.
    #[must_use]
    fn normal(_q: &[f64]) -> Option<[f64; MOST_COORDINATES]> {
        None
    }

    /// Displaces q by d: a translation along the ground axes (m), and a rotation (rad).
    fn displace<T: Number>(q: &mut [T], d: &[T]);

    /// Returns the displacement d with which [`Space::displace`] maps `from` to `q`.
    fn difference(q: &[f64], from: &[f64], d: &mut [f64]);

    /// Copies the coordinates of one velocity component from another configuration exactly. A
    /// displacement by the difference would have rounding errors.
    fn take(q: &mut [f64], from: &[f64], dof: usize);
}

/// A space with planar poses. Any coordinates may represent the poses.
pub trait PlanarSpace: Space {
    /// Returns the angle of a body (rad).
    #[must_use]
    fn angle<T: Number>(q: &[T]) -> T;

    /// Returns the sine and cosine of the angle of a body.
    #[must_use]
    fn sin_cos<T: Number>(q: &[T]) -> (T, T);
}
