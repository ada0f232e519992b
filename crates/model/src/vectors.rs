//! Conversions of bodies in space, their frames and their reactions to the `nalgebra` types of
//! poses, vectors and tensors.

use nalgebra::{Isometry3, Matrix3, Quaternion, Translation3, UnitQuaternion, Vector3};

use crate::body::SpatialBody;
use crate::frame::FrameState;
use crate::reaction::Reaction;
use crate::space::SpaceKind;

impl SpatialBody {
    /// Returns the body with its frame at this pose (from body to ground).
    ///
    /// ```
    /// use pfaff_model::nalgebra::{Isometry3, Matrix3, Vector3};
    /// use pfaff_model::{Mechanism, SpatialBody, SpatialDescription};
    ///
    /// let half_turn = Vector3::z() * std::f64::consts::PI;
    /// let there = Isometry3::new(Vector3::new(1.0, 2.0, 3.0), half_turn);
    /// let tensor = Matrix3::from_diagonal(&Vector3::new(0.1, 0.2, 0.2));
    /// let rod = SpatialBody { centre: [0.5, 0.0, 0.0], ..SpatialBody::new("rod", 2.0, tensor) };
    /// let mut d = SpatialDescription::new("rod");
    /// d.body(rod.posed(&there).moving(&Vector3::x(), &Vector3::z()));
    ///
    /// let mechanism = Mechanism::build(&d).map_err(|faults| format!("{faults:?}"))?;
    /// let (q, v) = mechanism.described_state();
    /// let frame = mechanism.frames().body(0, &q, &v);
    /// assert!((frame.isometry().inverse() * there).rotation.angle() < 1e-15);
    /// assert!((frame.isometry() * Vector3::x() - there * Vector3::x()).norm() < 1e-15);
    /// assert!((Vector3::from(frame.velocity) - Vector3::x()).norm() < 1e-15);
    /// # Ok::<(), String>(())
    /// ```
    #[must_use]
    pub fn posed(self, pose: &Isometry3<f64>) -> Self {
        let q = pose.rotation;
        Self {
            position: pose.translation.vector.into(),
            orientation: [q.w, q.i, q.j, q.k],
            ..self
        }
    }

    /// Returns the body with this velocity of the origin of the body frame (m/s) and this angular
    /// velocity (rad/s), both in ground axes.
    #[must_use]
    pub fn moving(self, velocity: &Vector3<f64>, omega: &Vector3<f64>) -> Self {
        Self {
            velocity: Some((*velocity).into()),
            angular_velocity: Some((*omega).into()),
            ..self
        }
    }

    /// Returns the pose of the body frame, from body to ground.
    #[must_use]
    pub fn isometry(&self) -> Isometry3<f64> {
        isometry(self.position, self.orientation)
    }

    /// Returns the inertia about the centre of mass, in the axes of the body frame (kg·m²).
    #[must_use]
    pub fn tensor(&self) -> Matrix3<f64> {
        Matrix3::from_row_slice(self.inertia.as_flattened())
    }
}

impl FrameState {
    /// Returns the pose relative to the ground; in the plane, the rotation is about z.
    #[must_use]
    pub fn isometry(&self) -> Isometry3<f64> {
        if self.space == SpaceKind::Space3 {
            return isometry(self.place, self.quaternion);
        }
        Isometry3::new(self.place.into(), Vector3::z() * self.angle)
    }
}

impl Reaction {
    /// Returns the force (N), in ground axes.
    #[must_use]
    pub fn force_vector(&self) -> Vector3<f64> {
        self.force.into()
    }

    /// Returns the torque about the reference point (N·m), in ground axes.
    #[must_use]
    pub fn torque_vector(&self) -> Vector3<f64> {
        self.torque.into()
    }
}

fn isometry(place: [f64; 3], [w, x, y, z]: [f64; 4]) -> Isometry3<f64> {
    let rotation = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
    Isometry3::from_parts(Translation3::from(Vector3::from(place)), rotation)
}
