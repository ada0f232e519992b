//! Mass, centre of mass and inertia tensor of rigid bodies: sums, transformation to other axes, and
//! simple solids.

use nalgebra::{Isometry3, Matrix3, UnitQuaternion, Vector3};

use crate::limits::ROUNDING;

/// Mass of a rigid body in some axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Mass {
    /// Mass (kg).
    pub(crate) mass: f64,
    /// Centre of mass (m).
    pub(crate) centre: Vector3<f64>,
    /// Inertia tensor about the centre of mass, in the same axes (kg·m²).
    pub(crate) inertia: Matrix3<f64>,
}

impl Default for Mass {
    fn default() -> Self {
        let (centre, inertia) = (Vector3::zeros(), Matrix3::zeros());
        Self {
            mass: 0.0,
            centre,
            inertia,
        }
    }
}

impl Mass {
    /// Creates the mass of a body. The given tensor is in axes that are rotated relative to the
    /// axes of the body.
    pub(crate) fn turned(
        mass: f64,
        centre: Vector3<f64>,
        axes: UnitQuaternion<f64>,
        inertia: Matrix3<f64>,
    ) -> Self {
        let inertia = turned(axes, inertia);
        Self {
            mass,
            centre,
            inertia,
        }
    }

    /// Returns the mass of the same body in other axes. `pose` transforms coordinates in the
    /// current axes to coordinates in the new axes.
    pub(crate) fn seen(&self, pose: &Isometry3<f64>) -> Self {
        Self {
            mass: self.mass,
            centre: pose.translation.vector + pose.rotation * self.centre,
            inertia: turned(pose.rotation, self.inertia),
        }
    }

    pub(crate) fn is_nothing(&self) -> bool {
        self.mass == 0.0 && self.inertia == Matrix3::zeros()
    }

    /// Combines two bodies into one body. If one of the bodies has no mass, the values of the other
    /// body are returned unchanged.
    pub(crate) fn plus(&self, other: &Self) -> Self {
        if other.is_nothing() {
            return *self;
        }
        if self.is_nothing() {
            return *other;
        }
        let mass = self.mass + other.mass;
        let centre = if mass > 0.0 {
            (self.centre * self.mass + other.centre * other.mass) / mass
        } else {
            self.centre
        };
        let about = |body: &Self| body.inertia + steiner(body.mass, body.centre - centre);
        Self {
            mass,
            centre,
            inertia: without_rounding(about(self) + about(other)),
        }
    }

    pub(crate) fn scaled(&self, factor: f64) -> Self {
        Self {
            mass: self.mass * factor,
            centre: self.centre,
            inertia: self.inertia * factor,
        }
    }
}

/// Returns a tensor in other axes. If the rotation is zero, the digits of the tensor do not change.
fn turned(axes: UnitQuaternion<f64>, inertia: Matrix3<f64>) -> Matrix3<f64> {
    if axes == UnitQuaternion::identity() {
        return inertia;
    }
    let r = axes.to_rotation_matrix();
    let turned = r.matrix() * inertia * r.matrix().transpose();
    without_rounding((turned + turned.transpose()) * 0.5)
}

/// Returns the tensor without products of inertia that are rounding errors relative to the largest
/// entry.
fn without_rounding(mut inertia: Matrix3<f64>) -> Matrix3<f64> {
    let floor = ROUNDING * inertia.amax();
    for (i, j) in [(0, 1), (0, 2), (1, 2)] {
        if inertia[(i, j)].abs() <= floor {
            (inertia[(i, j)], inertia[(j, i)]) = (0.0, 0.0);
        }
    }
    inertia
}

/// Tensor of a point mass at d: m·(d·d − d dᵀ).
fn steiner(mass: f64, d: Vector3<f64>) -> Matrix3<f64> {
    (Matrix3::identity() * d.dot(&d) - d * d.transpose()) * mass
}

/// A homogeneous solid with its centre of mass at the origin and its axis along z.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Solid {
    Sphere {
        radius: f64,
    },
    /// A cylinder with this half length and with hemispheres at both ends.
    Capsule {
        radius: f64,
        half: f64,
    },
    Cylinder {
        radius: f64,
        half: f64,
    },
    /// A circular cone with this half height. Its centre of mass is half of this length from its
    /// base.
    Cone {
        radius: f64,
        half: f64,
    },
    Ellipsoid {
        half: [f64; 3],
    },
    Box {
        half: [f64; 3],
    },
}

impl Solid {
    /// Volume (m³).
    pub(crate) fn volume(self) -> f64 {
        use std::f64::consts::PI;
        match self {
            Self::Sphere { radius: r } => 4.0 / 3.0 * PI * r * r * r,
            Self::Capsule { radius: r, half } => PI * r * r * (2.0 * half + 4.0 / 3.0 * r),
            Self::Cylinder { radius: r, half } => PI * r * r * 2.0 * half,
            Self::Cone { radius: r, half } => PI * r * r * 2.0 * half / 3.0,
            Self::Ellipsoid { half: [a, b, c] } => 4.0 / 3.0 * PI * a * b * c,
            Self::Box { half: [a, b, c] } => 8.0 * a * b * c,
        }
    }

    /// Principal moments of a mass of this shape.
    pub(crate) fn moments(self, mass: f64) -> [f64; 3] {
        match self {
            Self::Sphere { radius } => [0.4 * mass * radius * radius; 3],
            Self::Capsule { radius: r, half } => {
                let height = 2.0 * half;
                let whole = height + 4.0 / 3.0 * r;
                let (tube, ends) = (mass * height / whole, mass * (4.0 / 3.0 * r) / whole);
                let along = tube * r * r / 2.0 + 0.4 * ends * r * r;
                // A hemisphere has its centre of mass at 3r/8 from its plane, and the moment of
                // inertia 83/320·m·r² about the centre of mass.
                let across = tube * (3.0 * r * r + height * height) / 12.0
                    + ends * (0.4 * r * r + 0.375 * r * height + 0.25 * height * height);
                [across, across, along]
            }
            Self::Cylinder { radius: r, half } => {
                let across = mass * (3.0 * r * r + 4.0 * half * half) / 12.0;
                [across, across, mass * r * r / 2.0]
            }
            Self::Cone { radius: r, half } => {
                let across = 0.15 * mass * (r * r + half * half);
                [across, across, 0.3 * mass * r * r]
            }
            Self::Ellipsoid { half: [a, b, c] } => {
                [b * b + c * c, c * c + a * a, a * a + b * b].map(|sum| mass * sum / 5.0)
            }
            Self::Box { half: [a, b, c] } => {
                [b * b + c * c, c * c + a * a, a * a + b * b].map(|sum| mass * sum / 3.0)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares volume and moments of a capsule with the sum over 400 000 discs.
    #[test]
    fn a_capsule_is_the_sum_of_its_discs() {
        let (radius, half) = (0.3, 0.5);
        let solid = Solid::Capsule { radius, half };
        let (n, whole) = (400_000, half + radius);
        let step = 2.0 * whole / f64::from(n);
        let (mut volume, mut along, mut across) = (0.0, 0.0, 0.0);
        for k in 0..n {
            let z = -whole + (f64::from(k) + 0.5) * step;
            let cap = (z.abs() - half).max(0.0);
            let r2 = radius * radius - cap * cap;
            let disc = std::f64::consts::PI * r2 * step;
            volume += disc;
            along += disc * r2 / 2.0;
            across += disc * (r2 / 4.0 + z * z);
        }
        let [x, _, z] = solid.moments(volume);
        assert!((solid.volume() - volume).abs() < 1e-9);
        assert!((z - along).abs() < 1e-9 && (x - across).abs() < 1e-9);
    }

    /// Compares volume, centre and moments of a cone with the sum over 400 000 discs.
    #[test]
    fn a_cone_is_the_sum_of_its_discs() {
        let (radius, half) = (0.3, 0.5);
        let solid = Solid::Cone { radius, half };
        let n = 400_000;
        let step = 2.0 * half / f64::from(n);
        let (mut volume, mut first, mut along, mut across) = (0.0, 0.0, 0.0, 0.0);
        for k in 0..n {
            // The centre of mass is at a quarter of the height.
            let z = -0.5 * half + (f64::from(k) + 0.5) * step;
            let r = radius * (1.5 * half - z) / (2.0 * half);
            let disc = std::f64::consts::PI * r * r * step;
            volume += disc;
            first += disc * z;
            along += disc * r * r / 2.0;
            across += disc * (r * r / 4.0 + z * z);
        }
        let [x, _, z] = solid.moments(volume);
        assert!((solid.volume() - volume).abs() < 1e-9 && first.abs() < 1e-9);
        assert!((z - along).abs() < 1e-9 && (x - across).abs() < 1e-9);
    }

    /// The computed cosine of a quarter turn is 2e-16, but a diagonal tensor remains diagonal.
    /// Products of inertia that a file contains do not change.
    #[test]
    fn rounded_products_are_zero() {
        use std::f64::consts::FRAC_PI_2;
        let quarter = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), FRAC_PI_2);
        let tensor = Matrix3::from_diagonal(&Vector3::new(0.1, 0.2, 0.25));
        let body = Mass::turned(1.0, Vector3::zeros(), quarter, tensor);
        let expected = Matrix3::from_diagonal(&Vector3::new(0.25, 0.2, 0.1));
        assert!((body.inertia - expected).amax() < 1e-15);
        for at in [(0, 1), (0, 2), (1, 2), (1, 0), (2, 0), (2, 1)] {
            assert_eq!(body.inertia[at].to_bits(), 0, "{}", body.inertia);
        }
        let mut tensor = tensor;
        (tensor[(0, 1)], tensor[(1, 0)]) = (1e-13, 1e-13);
        let body = Mass::turned(1.0, Vector3::zeros(), quarter, tensor);
        assert!((body.inertia[(1, 2)].abs() - 1e-13).abs() < 1e-16);
    }

    /// Two halves of a cube have the mass and the tensor of the cube.
    #[test]
    fn parts_add_up() {
        let half = Solid::Box {
            half: [0.5, 1.0, 1.0],
        };
        let part = |x: f64| {
            let inertia = Matrix3::from_diagonal(&Vector3::from(half.moments(4.0)));
            Mass {
                mass: 4.0,
                centre: Vector3::new(x, 0.0, 0.0),
                inertia,
            }
        };
        let whole = part(-0.5).plus(&part(0.5));
        let cube = Solid::Box { half: [1.0; 3] }.moments(8.0);
        assert_eq!(whole.centre, Vector3::zeros());
        for k in 0..3 {
            assert!((whole.inertia[(k, k)] - cube[k]).abs() < 1e-14);
        }
    }
}
