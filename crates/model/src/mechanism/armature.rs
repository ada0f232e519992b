//! Inertias of joint coordinates: M at a configuration, and the loads of armatures.

use linalg::{AddedMass, MassMatrix};

use super::Mechanism;
use crate::body::BodyRef;
use crate::element::Bodies;

/// M of a mechanism at a configuration.
#[derive(Clone, Debug)]
pub struct InertiaAt<'m> {
    mass: &'m [f64],
    added: AddedMass,
}

impl InertiaAt<'_> {
    /// Returns M.
    #[must_use]
    pub fn matrix(&self) -> MassMatrix<'_> {
        MassMatrix::new(self.mass, &self.added)
    }

    /// Adds the sizes of the terms of `M·x` to y.
    ///
    /// # Panics
    /// Panics if x or y is too short.
    pub fn add_sizes(&self, x: &[f64], y: &mut [f64]) {
        for ((y, m), x) in y.iter_mut().zip(self.mass).zip(x) {
            *y += (m * x).abs();
        }
        for (inertia, columns, values) in self.added.rows() {
            let terms = columns.iter().zip(values);
            let size = inertia * terms.map(|(&j, g)| (g * x[j]).abs()).sum::<f64>();
            for (&j, g) in columns.iter().zip(values) {
                y[j] += g.abs() * size;
            }
        }
    }

    /// Returns `xᵀ·M·y`.
    ///
    /// # Panics
    /// Panics if x or y is too short.
    #[must_use]
    pub fn between(&self, x: &[f64], y: &[f64]) -> f64 {
        self.matrix().between(x, y)
    }
}

/// An armature of a mechanism: the inertia of a joint coordinate.
#[derive(Clone, Copy, Debug)]
pub struct JointArmature<'m> {
    /// Name of the joint.
    pub joint: &'m str,
    /// Name of the joint coordinate.
    pub measure: &'static str,
    /// Bodies of the joint.
    pub bodies: &'m [BodyRef],
    /// Inertia (kg·m² for an angle, kg for a length).
    pub inertia: f64,
    /// Whether the joint coordinate is an angle.
    pub is_angle: bool,
}

impl std::fmt::Display for JointArmature<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "armature of {}.{}", self.joint, self.measure)
    }
}

impl Mechanism {
    /// Returns M at a configuration. The function allocates memory.
    #[must_use]
    pub fn inertia_at(&self, q: &[f64]) -> InertiaAt<'_> {
        let mut added = AddedMass::default();
        if !self.elements.armatures.is_empty() {
            let bodies = Bodies::at(self.space(), self.of_bodies(q));
            for (k, armature) in self.elements.armatures.iter().enumerate() {
                added.push(armature.inertia, &armature.columns());
                armature.gradient_at(&bodies, added.values_mut(k));
            }
        }
        InertiaAt {
            mass: &self.mass,
            added,
        }
    }

    /// Returns the armatures of joints, in the order of their rows of M. An armature that is zero
    /// is not included.
    pub fn armatures(&self) -> impl Iterator<Item = JointArmature<'_>> {
        self.elements.armatures.iter().map(|of| JointArmature {
            joint: &of.joint,
            measure: of.measure,
            bodies: &of.site.bodies,
            inertia: of.inertia,
            is_angle: of.is_angle(),
        })
    }

    /// Returns whether a joint has an armature that is not zero.
    #[must_use]
    pub fn has_armatures(&self) -> bool {
        !self.elements.armatures.is_empty()
    }
}
