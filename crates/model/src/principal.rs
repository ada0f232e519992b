//! Principal axes of bodies in space.
//!
//! The equations use principal axes, in which M is diagonal and constant. For a body with products
//! of inertia, the build transforms coordinates, velocities, points and directions to these axes.
//! Outputs are transformed back to the axes of the body frame ([`crate::frame`]). If the given
//! tensor is diagonal, no rotation and no rounding error occur.

use joints::Ring;
use joints::space3::Pose;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion};

use crate::space::quaternion_product;

/// Principal axes of a body, if they differ from the axes of the body frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Principal {
    /// Principal moments (kg·m²).
    pub(crate) moments: [f64; 3],
    /// Columns are the axes, in the body frame.
    axes: [[f64; 3]; 3],
    /// The rotation from the principal axes to the axes of the body frame as a quaternion (w, x, y,
    /// z).
    quaternion: [f64; 4],
}

impl Principal {
    /// Returns the principal axes of an inertia tensor in the axes of a frame. Returns `None` if
    /// the principal axes are the axes of this frame.
    pub(crate) fn of(inertia: &[[f64; 3]; 3]) -> Option<Self> {
        let [[_, xy, xz], [_, _, yz], _] = *inertia;
        let numbers = inertia.as_flattened();
        if [xy, xz, yz] == [0.0; 3] || !numbers.iter().all(|x| x.is_finite()) {
            return None;
        }
        let eigen = Matrix3::from_row_slice(numbers).symmetric_eigen();
        let mut axes = eigen.eigenvectors;
        if axes.determinant() < 0.0 {
            axes.neg_mut();
        }
        let rotation = Rotation3::from_matrix_unchecked(axes);
        let q = UnitQuaternion::from_rotation_matrix(&rotation);
        // The axes are computed from the quaternion, so that both represent the same rotation up to
        // rounding.
        let quaternion = [q.w, q.i, q.j, q.k];
        Some(Self {
            moments: eigen.eigenvalues.into(),
            axes: Pose::new([0.0; 3], quaternion).rot,
            quaternion,
        })
    }

    /// Returns the rotation from the principal axes to the axes of the body frame (w, x, y, z).
    #[must_use]
    pub fn quaternion(&self) -> [f64; 4] {
        self.quaternion
    }

    /// Transforms a vector from the body frame to the principal axes.
    pub(crate) fn own<T: Ring>(&self, v: [T; 3]) -> [T; 3] {
        std::array::from_fn(|k| sum_of([0, 1, 2].map(|row| T::from(self.axes[row][k]) * v[row])))
    }

    /// Transforms a vector from the principal axes to the body frame.
    pub(crate) fn to_frame<T: Ring>(&self, own: [T; 3]) -> [T; 3] {
        std::array::from_fn(|row| sum_of([0, 1, 2].map(|k| T::from(self.axes[row][k]) * own[k])))
    }

    /// Returns the axes of the body frame; the argument contains the principal axes.
    pub(crate) fn framed(&self, own: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
        let axis = |row: usize| {
            std::array::from_fn(|k| (0..3).map(|j| self.axes[row][j] * own[j][k]).sum())
        };
        [0, 1, 2].map(axis)
    }

    /// Returns the orientation of the principal axes of a body, given the orientation of its frame.
    pub(crate) fn turned(&self, frame: [f64; 4]) -> [f64; 4] {
        quaternion_product(frame, self.quaternion)
    }

    /// Returns the orientation of the frame of a body, given the orientation of its principal axes.
    pub(crate) fn turned_back(&self, own: [f64; 4]) -> [f64; 4] {
        let [w, x, y, z] = self.quaternion;
        quaternion_product(own, [w, -x, -y, -z])
    }

    /// Returns the rotation vector of the rotation that [`Self::own`] applies.
    pub(crate) fn rotation_vector(&self) -> [f64; 3] {
        let [w, x, y, z] = self.quaternion;
        let q = nalgebra::Quaternion::new(w, -x, -y, -z);
        UnitQuaternion::from_quaternion(q).scaled_axis().into()
    }
}

fn sum_of<T: Ring>([a, b, c]: [T; 3]) -> T {
    a + b + c
}

#[cfg(test)]
mod tests;
